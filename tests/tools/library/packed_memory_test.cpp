// The memory of runs on a mesh that was packed with a large window.
#include <gtest/gtest.h>
#include <zstd.h>

#include <memory>
#include <string>

#include "tests/tools/program.h"

namespace reeb::test {
namespace {

// As `zstd --long=27` packs a pipe: the frame does not say how long its content is, so all of the window counts.
std::string packed_with_window(const std::string& content, int window_log) {
  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(), &ZSTD_freeCCtx);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_windowLog, window_log);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_contentSizeFlag, 0);
  std::string packed(ZSTD_compressBound(content.size()) + 1024, '\0');
  ZSTD_outBuffer out{packed.data(), packed.size(), 0};
  ZSTD_inBuffer in{content.data(), content.size(), 0};
  while (in.pos < in.size) EXPECT_FALSE(ZSTD_isError(ZSTD_compressStream2(context.get(), &out, &in, ZSTD_e_continue)));
  EXPECT_EQ(ZSTD_compressStream2(context.get(), &out, &in, ZSTD_e_end), 0u);
  packed.resize(out.pos);
  return packed;
}

class PackedMemory : public ProgramTest {};

TEST_F(PackedMemory, OfALargeWindowIsPartOfTheLimit) {
  expect_success(reeb({"generate", "scan", "--triangles", "20k", "-o", "scan.ply"}));
  write("large.ply.zst", packed_with_window(file("scan.ply"), 27));
  write("usual.ply.zst", packed_with_window(file("scan.ply"), 21));
  const auto compute = [&](const std::string& mesh, const std::string& memory) {
    return reeb({"compute", mesh, "-o", "out.reeb", "--force", "--quiet", "--memory", memory});
  };
  const Outcome refused = compute("large.ply.zst", "64M");
  expect_error(refused, 3, "unpacking the input takes 1");
  EXPECT_NE(refused.error.find("--memory 1"), std::string::npos) << refused.error;
  if (!kSanitized) {
    EXPECT_LE(refused.peak_rss_bytes, std::uint64_t{64} << 20);
  }
  expect_success(compute("large.ply.zst", "160M"));
  expect_success(compute("usual.ply.zst", "16M"));
}

}  // namespace
}  // namespace reeb::test
