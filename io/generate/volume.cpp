#include "io/generate/volume.h"

#include <algorithm>
#include <sstream>

#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "libreeb/base/hash.h"

namespace reeb::io {
namespace {

constexpr std::uint64_t kLeastPitch = 3;  // a tunnel of one vertex, and one on each side

}  // namespace

std::uint64_t Volume::Tiling::tunnel_at(std::uint64_t vertex) const {
  const std::uint64_t tile = vertex / pitch, width = std::max<std::uint64_t>(1, pitch / 3);
  const std::uint64_t first = (pitch - width) / 2, at = vertex % pitch;
  return tile < count && at >= first && at < first + width ? tile : count;
}

Volume::Volume(const VolumeOptions& options) : options_(options) {
  const std::uint64_t most_i = options.size[0] / kLeastPitch, most_j = options.size[1] / kLeastPitch;
  if (options.handles != 0 && (most_i == 0 || options.handles > most_i * most_j))
    throw Error(ErrorKind::kUsage,
                "the grid has no room for " + count_of(options.handles, "handle") + ", but for " +
                    std::to_string(most_i * most_j),
                "a handle takes 3 vertices along each of the first two axes");
  // As square as the limits allow.
  std::uint64_t along_i = std::min<std::uint64_t>(most_i, 1);
  while (along_i < most_i &&
         (along_i * std::min(most_j, along_i) < options.handles || along_i * most_j < options.handles))
    ++along_i;
  tiles_[0].count = std::max<std::uint64_t>(along_i, 1);
  tiles_[1].count = std::max<std::uint64_t>((options.handles + tiles_[0].count - 1) / tiles_[0].count, 1);
  for (std::size_t axis = 0; axis < 2; ++axis)
    tiles_[axis].pitch = std::max<std::uint64_t>(options.size[axis] / tiles_[axis].count, 1);
}

std::uint64_t Volume::vertex_count() const { return options_.size[0] * options_.size[1] * options_.size[2]; }

std::string Volume::nrrd_header() const {
  std::ostringstream text;
  text << "NRRD0004\ntype: float\ndimension: " << options_.axes << "\nsizes:";
  for (std::size_t axis = 0; axis < options_.axes; ++axis) text << ' ' << options_.size[axis];
  text << "\nendian: little\nencoding: raw\nnodata:=" << kNoData << "\n\n";
  return text.str();
}

void Volume::row(std::uint64_t j, std::uint64_t k, std::span<float> values) const {
  const std::uint64_t tile_j = tiles_[1].tunnel_at(j), first = options_.size[0] * (j + options_.size[1] * k);
  for (std::uint64_t i = 0; i < values.size(); ++i) {
    const std::uint64_t tile_i = tiles_[0].tunnel_at(i);
    const bool in_tunnel =
        tile_i < tiles_[0].count && tile_j < tiles_[1].count && tile_i + tiles_[0].count * tile_j < options_.handles;
    const double noise =
        options_.noise_seed ? 0x1p-55 * static_cast<double>(mix(mix(*options_.noise_seed) + first + i) >> 11) : 0;
    values[i] = in_tunnel ? kNoData : static_cast<float>(static_cast<double>(i) + noise);
  }
}

}  // namespace reeb::io
