// The graph of a generated volume is the one that its construction promises.
#include "io/generate/volume.h"

#include <gtest/gtest.h>

#include "libreeb/base/error.h"
#include "libreeb/graph/reeb_graph.h"
#include "tests/model/reference_reeb.h"
#include "tests/support/inputs/grid_complex.h"

namespace reeb::test {
namespace {

// The graph without the vertices of tunnels.
ReebGraph graph_of(const io::VolumeOptions& options, bool keeps_tunnels) {
  const io::Volume volume(options);
  Complex complex;
  std::vector<float> row(options.size[0]);
  std::vector<bool> present;
  for (std::uint64_t k = 0; k < options.size[2]; ++k)
    for (std::uint64_t j = 0; j < options.size[1]; ++j) {
      volume.row(j, k, row);
      for (const float value : row) {
        complex.values.push_back(static_cast<double>(value));
        present.push_back(keeps_tunnels || value != io::Volume::kNoData);
      }
    }
  std::vector<std::uint64_t> number(present.size());
  std::vector<double> values;
  for (std::size_t v = 0; v < present.size(); ++v)
    if (present[v]) {
      number[v] = values.size();
      values.push_back(complex.values[v]);
      complex.positions.push_back(position_in(options.size, v));
    }
  complex.values = values;
  for (auto simplex : simplices_of_grid(options.size, present)) {
    for (std::uint64_t& v : simplex) v = number[v];
    complex.simplices.push_back(simplex);
  }
  return reference_reeb(complex);
}

TEST(Volume, HasALoopForEachHandle) {
  for (const GridShape size : {GridShape{9, 8, 4}, GridShape{12, 5, 2}, GridShape{10, 11, 1}})
    for (std::uint64_t handles = 0; handles <= (size[0] / 3) * (size[1] / 3); ++handles)
      for (const bool noise : {false, true}) {
        io::VolumeOptions options{size, size[2] == 1 ? 2u : 3u, handles, {}};
        if (noise) options.noise_seed = 7;
        const ReebGraph graph = graph_of(options, false);
        EXPECT_EQ(betti_numbers(graph).components, 1u);
        EXPECT_EQ(betti_numbers(graph).loops, handles) << size[0] << 'x' << size[1] << 'x' << size[2];
        EXPECT_EQ(betti_numbers(graph_of(options, true)).loops, 0u);
      }
}

TEST(Volume, RefusesMoreHandlesThanThereIsRoomFor) {
  EXPECT_THROW(io::Volume({{9, 8, 4}, 3, 7, {}}), Error);
  EXPECT_THROW(io::Volume({{2, 8, 4}, 3, 1, {}}), Error);
  EXPECT_NO_THROW(io::Volume({{2, 2, 1}, 2, 0, {}}));
}

}  // namespace
}  // namespace reeb::test
