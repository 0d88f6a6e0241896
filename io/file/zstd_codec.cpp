#include "io/file/zstd_codec.h"

#include <memory>
#include <new>
#include <string>

#include "libreeb/base/error.h"

namespace reeb::io {

ZstdCompressor::ZstdCompressor() : context_(ZSTD_createCCtx()) {
  if (context_ == nullptr) throw std::bad_alloc();
}

// Compresses into its own uninitialized memory first, so that `out` grows by the compressed size only.
void ZstdCompressor::compress(std::span<const std::byte> bytes, int level, std::vector<std::byte>& out) {
  const std::size_t bound = ZSTD_compressBound(bytes.size());
  if (capacity_ < bound) frame_ = std::make_unique_for_overwrite<std::byte[]>(capacity_ = bound);
  ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_compressionLevel, level);
  // A small table stays in the fastest cache. With it, the fast levels are a fifth faster, and the result is half a
  // percent larger.
  constexpr int kLevelsOwn = 0, kSmallTable = 10;
  ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_hashLog, level < 0 ? kSmallTable : kLevelsOwn);
  const std::size_t size = ZSTD_compress2(context_.get(), frame_.get(), capacity_, bytes.data(), bytes.size());
  if (ZSTD_isError(size) != 0)
    throw Error(ErrorKind::kResource, std::string("zstd: ") + ZSTD_getErrorName(size),
                "close other programs, or allow less with --memory SIZE")
        .because(ErrorCause::kMemory);
  out.insert(out.end(), frame_.get(), frame_.get() + size);
}

void zstd_compress(std::span<const std::byte> bytes, int level, std::vector<std::byte>& out) {
  ZstdCompressor().compress(bytes, level, out);
}

std::size_t zstd_frame_size(std::span<const std::byte> bytes) {
  const std::size_t size = ZSTD_findFrameCompressedSize(bytes.data(), bytes.size());
  return ZSTD_isError(size) != 0 ? 0 : size;
}

std::size_t zstd_content_size(std::span<const std::byte> bytes) {
  const unsigned long long size = ZSTD_getFrameContentSize(bytes.data(), bytes.size());
  return size == ZSTD_CONTENTSIZE_UNKNOWN || size == ZSTD_CONTENTSIZE_ERROR ? 0 : static_cast<std::size_t>(size);
}

// Each thread keeps its context: creating one costs as much as decompressing a small block.
bool zstd_decompress(std::span<const std::byte> bytes, std::span<std::byte> out) {
  struct Free {
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
  };
  thread_local const std::unique_ptr<ZSTD_DCtx, Free> context(ZSTD_createDCtx());
  if (context == nullptr) throw std::bad_alloc();
  const std::size_t size = ZSTD_decompressDCtx(context.get(), out.data(), out.size(), bytes.data(), bytes.size());
  return ZSTD_isError(size) == 0 && size == out.size();
}

}  // namespace reeb::io
