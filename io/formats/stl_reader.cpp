#include "io/formats/stl_reader.h"

#include <cmath>
#include <utility>

#include "io/mesh/scalar_bytes.h"
#include "io/text/hints.h"
#include "io/text/words.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb::io {

StlReader::StlReader(const ContentSource& source, ReadOptions options, std::string format)
    : BatchReader(std::move(options)) {
  refuse_properties(this->options(), "STL", source.name());
  info_.format = std::move(format);
  info_.file_bytes = source.file_bytes();
}

void StlReader::add_corner(const VertexWeld::Coordinates& point, MeshBatch& batch) {
  const auto [number, is_new] = weld_.number(point);
  if (is_new) {
    for (std::size_t k = 0; k < point.size(); ++k) batch.coordinates[k].push_back(point[k]);
    count_vertices(batch, 1);
  }
  pending_ = VertexId(number);
}

void StlReader::fill(MeshBatch& batch) {
  while (room(batch) != 0) {
    if (pending_) {
      facet_.add(*pending_, batch);
      pending_.reset();
    } else if (!advance(batch)) {
      return;
    }
  }
}

AsciiStlReader::AsciiStlReader(std::unique_ptr<ContentSource> source, ReadOptions options)
    : StlReader(*source, std::move(options), "STL ASCII"), text_(std::move(source)) {}

bool AsciiStlReader::advance(MeshBatch& batch) {
  if (!text_.more()) {
    text_.mark();
    if (in_solid_) text_.fail("the file ends inside a solid", kCutHint);
    return false;
  }
  const std::string keyword = lower_case(text_.token());
  if (keyword == "vertex" && in_facet_) {
    VertexWeld::Coordinates point{};
    for (double& coordinate : point) coordinate = text_.finite_number<double>("coordinate");
    add_corner(point, batch);
    ++loop_corners_;
    loop_ended_ = false;
  } else if (keyword == "endloop" && in_facet_) {
    end_loop(batch);
  } else if (keyword == "facet" && in_solid_ && !in_facet_) {
    in_facet_ = true;
    loop_ended_ = false;
    facet_.begin(FaceShape::kPolygon);
  } else if (keyword == "solid" && !in_solid_) {
    in_solid_ = true;
  } else if (keyword == "endsolid" && in_solid_ && !in_facet_) {
    in_solid_ = false;
  } else if (keyword == "endfacet" && in_facet_) {
    if (!loop_ended_) end_loop(batch);
    in_facet_ = false;
  } else if (keyword != "outer" || !in_facet_) {
    text_.fail(in_quotes(keyword) + " does not belong here in an STL file", kCutOrDamagedHereHint);
  }
  text_.skip_line();
  return true;
}

void AsciiStlReader::end_loop(MeshBatch& batch) {
  if (loop_corners_ < 3) text_.fail("a facet of " + std::to_string(loop_corners_) + " corners", kCutOrDamagedHereHint);
  facet_.end(batch);
  loop_corners_ = 0;
  loop_ended_ = true;
}

BinaryStlReader::BinaryStlReader(std::unique_ptr<ContentSource> source, ReadOptions options)
    : StlReader(*source, std::move(options), "STL binary"), cursor_(std::move(source)) {
  require(kHeaderBytes);
  facets_left_ = load_scalar<std::uint32_t>(cursor_.data() + 80, false);
  info_.simplex_count = facets_left_;
  info_.float32 = true;
  const auto size = cursor_.source().size();
  if (size && facets_left_ > (*size - kHeaderBytes) / kFacetBytes)
    throw Error(ErrorKind::kBadInput,
                "the header announces " + count_of(facets_left_, "facet") + ", but the file holds " +
                    with_commas((*size - kHeaderBytes) / kFacetBytes),
                kCutOrHeaderHint)
        .at(cursor_.source().name(), "80");
  cursor_.advance(kHeaderBytes);
}

void BinaryStlReader::require(std::size_t bytes) {
  if (cursor_.ensure(bytes)) return;
  throw Error(ErrorKind::kBadInput, "the file ends before its last facet", kCutHint)
      .at(cursor_.source().name(), std::to_string(cursor_.offset() + cursor_.available()));
}

bool BinaryStlReader::advance(MeshBatch& batch) {
  if (facets_left_ == 0) {
    trailing_ = !cursor_.at_end();
    return false;
  }
  require(kFacetBytes);
  if (corner_ == 0) facet_.begin(FaceShape::kPolygon);
  const std::size_t place = 12 + 12 * corner_;  // after the normal
  VertexWeld::Coordinates point{};
  for (std::size_t k = 0; k < 3; ++k) {
    const float coordinate = load_scalar<float>(cursor_.data() + place + 4 * k, false);
    if (!std::isfinite(coordinate))
      throw Error(ErrorKind::kBadInput, "a coordinate is not finite", "fix this facet, or remove it")
          .at(cursor_.source().name(), std::to_string(cursor_.offset() + place + 4 * k));
    point[k] = static_cast<double>(coordinate) + 0.0;
  }
  add_corner(point, batch);
  if (++corner_ == 3) {
    corner_ = 0;
    --facets_left_;
    cursor_.advance(kFacetBytes);
  }
  return true;
}

std::vector<std::string> BinaryStlReader::warnings() const {
  if (!trailing_) return {};
  return {"bytes after the last facet were ignored"};
}

}  // namespace reeb::io
