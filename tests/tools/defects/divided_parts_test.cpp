// Which curves divide a torus: one around its tube does not, a second one does.
#include "tools/repair/divided_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/program.h"

namespace reeb::test {
namespace {

constexpr std::uint64_t kAround = 24, kAcross = 6;

class DividedPartsTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    std::ostringstream text;
    text << "OFF\n" << kAround * kAcross << ' ' << 2 * kAround * kAcross << " 0\n";
    for (std::uint64_t i = 0; i < kAround; ++i)
      for (std::uint64_t j = 0; j < kAcross; ++j) {
        const double u = 6.283185307 * double(i) / kAround, w = 6.283185307 * double(j) / kAcross;
        text << (4 + std::cos(w)) * std::cos(u) << ' ' << (4 + std::cos(w)) * std::sin(u) << ' ' << std::sin(w) << '\n';
      }
    const auto at = [](std::uint64_t i, std::uint64_t j) { return i % kAround * kAcross + j % kAcross; };
    for (std::uint64_t i = 0; i < kAround; ++i)
      for (std::uint64_t j = 0; j < kAcross; ++j) {
        text << "3 " << at(i, j) << ' ' << at(i + 1, j) << ' ' << at(i + 1, j + 1) << '\n';
        text << "3 " << at(i, j) << ' ' << at(i + 1, j + 1) << ' ' << at(i, j + 1) << '\n';
      }
    write("torus.off", text.str());
  }

  // Removes the band between a ring and the next one, and closes both. The job has the number of the ring.
  static tools::RimPair cut(std::uint64_t ring, tools::MeshEdits& edits) {
    const auto old = [](std::uint64_t v) { return tools::VertexRef{v, false}; };
    for (std::uint64_t t = 0; t < 2 * kAcross; ++t) edits.removed.push_back(2 * kAcross * ring + t);
    for (const std::uint64_t rim : {ring * kAcross, (ring + 1) % kAround * kAcross})
      for (std::uint64_t j = 1; j + 1 < kAcross; ++j)
        edits.triangles.push_back({old(rim), old(rim + j), old(rim + j + 1)});
    return {static_cast<std::uint32_t>(ring), old(ring * kAcross + 2), old((ring + 1) % kAround * kAcross + 3)};
  }

  std::vector<std::uint32_t> dividing(const std::vector<std::uint64_t>& rings, std::uint64_t memory) const {
    tools::MeshEdits edits;
    std::vector<tools::RimPair> pairs;
    for (const std::uint64_t ring : rings) pairs.push_back(cut(ring, edits));
    edits.sort();
    tools::MeshSource source;
    source.path = in_folder("torus.off");
    const tools::ValuedMesh mesh(source, {});
    ooc::Workspace space(in_folder("."), memory);
    std::vector<std::uint32_t> jobs;
    for (const auto& [job, reason] :
         tools::dividing_curves(mesh, edits, kAround * kAcross, pairs, space, [](std::uint64_t, std::uint64_t) {})) {
      jobs.push_back(job);
      EXPECT_EQ(reason, "cutting along it would divide the surface");
    }
    std::sort(jobs.begin(), jobs.end());
    return jobs;
  }
};

TEST_F(DividedPartsTest, AreFoundFromTheLastCurveOn) {
  using Jobs = std::vector<std::uint32_t>;
  for (const std::uint64_t memory : {MemoryBudget::kUnlimited, std::uint64_t{4} << 20}) {
    EXPECT_EQ(dividing({5}, memory), Jobs{});
    EXPECT_EQ(dividing({0, 12}, memory), Jobs{12});
    EXPECT_EQ(dividing({3, 9, 15, 23}, memory), (Jobs{9, 15, 23}));
  }
  EXPECT_THROW(dividing({0, 12}, 100), Error);
}

}  // namespace
}  // namespace reeb::test
