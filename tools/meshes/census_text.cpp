#include "tools/meshes/census_text.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "libreeb/base/count_text.h"

namespace reeb::tools {
namespace {

using Json = nlohmann::ordered_json;

void print_field(std::string_view label, const std::string& text) { fmt::print("  {:<13} {}\n", label, text); }

// "vertex 12 (0.5, 1, 2)", "vertices 12, 14 (0.5, 1, 2)"
std::string describe(const ooc::CensusPlace& place) {
  std::string text = place.vertices.size() == 1 ? "vertex" : "vertices";
  for (std::size_t i = 0; i < place.vertices.size(); ++i)
    text += fmt::format("{}{}", i == 0 ? " " : ", ", place.vertices[i].value());
  return fmt::format("{} ({:.6g}, {:.6g}, {:.6g})", text, place.position[0], place.position[1], place.position[2]);
}

std::string describe(const ooc::CensusCount& found, std::string_view noun) {
  if (found.count == 0) return "none";
  return fmt::format("{}{} {}", count_of(found.count, noun), found.count == 1 ? ":" : ", the first at",
                     describe(found.places.front()));
}

std::string describe_components(const ooc::MeshCensus& census) {
  if (census.components < 2 || census.largest_components.empty()) return with_commas(census.components);
  const ooc::CensusComponent& largest = census.largest_components.front();
  return fmt::format("{}, the largest of {} at {}", with_commas(census.components),
                     count_of(largest.triangles, "triangle"), describe(largest.first));
}

std::string describe_boundaries(const ooc::MeshCensus& census) {
  if (census.boundaries == 0) return "none";
  const ooc::CensusBoundary& longest = census.longest_boundaries.front();
  return fmt::format("{}{} of {} and length {:.6g} at {}", with_commas(census.boundaries),
                     census.boundaries == 1 ? "," : ", the longest", count_of(longest.edges, "edge"), longest.length,
                     describe(longest.first));
}

std::string describe_orientation(const ooc::MeshCensus& census) {
  if (!census.orientable) return "not defined: " + census.why_no_genus;
  if (!*census.orientable) return "none: it is not orientable";
  return *census.oriented ? "consistent" : "not consistent, but it can be made so";
}

Json to_json(const ooc::CensusPlace& place) {
  Json vertices = Json::array();
  for (const VertexId v : place.vertices) vertices.push_back(v.value());
  return {{"vertices", vertices}, {"position", place.position}};
}

Json to_json(const ooc::CensusCount& found) {
  Json places = Json::array();
  for (const ooc::CensusPlace& place : found.places) places.push_back(to_json(place));
  return {{"count", found.count}, {"places", places}};
}

Json components_json(const ooc::MeshCensus& census) {
  Json places = Json::array();
  for (const ooc::CensusComponent& component : census.largest_components) {
    Json place = to_json(component.first);
    place["triangles"] = component.triangles;
    place["vertex_count"] = component.vertices;
    places.push_back(place);
  }
  return {{"count", census.components}, {"places", places}};
}

Json boundaries_json(const ooc::MeshCensus& census) {
  Json places = Json::array();
  for (const ooc::CensusBoundary& boundary : census.longest_boundaries) {
    Json place = to_json(boundary.first);
    place["edges"] = boundary.edges;
    place["length"] = boundary.length;
    place["min"] = boundary.min;
    place["max"] = boundary.max;
    places.push_back(place);
  }
  return {{"count", census.boundaries}, {"places", places}};
}

template <class Value>
Json or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json();
}

}  // namespace

void print_census(const ooc::MeshCensus& census) {
  print_field("components", describe_components(census));
  if (!census.not_a_surface.empty()) {
    print_field("surface", "no: " + census.not_a_surface + ", so nothing else is counted");
    return;
  }
  print_field("boundaries", describe_boundaries(census));
  const auto non_manifold = [](const ooc::CensusCount& found, std::string_view noun) {
    if (found.count != 0) print_field("non-manifold", describe(found, noun));
  };
  non_manifold(census.nonmanifold_edges, "edge");
  non_manifold(census.nonmanifold_vertices, "vertex");
  if (census.nonmanifold_edges.count + census.nonmanifold_vertices.count == 0) print_field("non-manifold", "none");
  print_field("degenerate", describe(census.degenerate, "triangle"));
  print_field("duplicates", describe(census.duplicates, "triangle"));
  print_field("folded", describe(census.folded, "edge"));
  if (census.loose_edges != 0) print_field("loose edges", with_commas(census.loose_edges));
  print_field("orientation", describe_orientation(census));
  print_field("genus", census.genus ? with_commas(*census.genus)
                                    : fmt::format("not defined: {} (Euler characteristic {})", census.why_no_genus,
                                                  census.euler));
}

void add_defects(Json& json, const ooc::MeshCensus& census) {
  const bool surface = census.not_a_surface.empty();
  const auto of_surface = [&](Json found) { return surface ? std::move(found) : Json(); };
  json["components"] = components_json(census);
  json["boundaries"] = of_surface(boundaries_json(census));
  json["nonmanifold_edges"] = of_surface(to_json(census.nonmanifold_edges));
  json["nonmanifold_vertices"] = of_surface(to_json(census.nonmanifold_vertices));
  json["degenerate"] = of_surface(to_json(census.degenerate));
  json["duplicates"] = of_surface(to_json(census.duplicates));
  json["folded"] = of_surface(to_json(census.folded));
}

void add_topology(Json& json, const ooc::MeshCensus& census) {
  const bool surface = census.not_a_surface.empty();
  json["loose_edges"] = surface ? Json(census.loose_edges) : Json();
  json["euler"] = surface ? Json(census.euler) : Json();
  json["closed"] = surface ? Json(census.closed) : Json();
  json["orientable"] = or_null(census.orientable);
  json["oriented"] = or_null(census.oriented);
  json["genus"] = or_null(census.genus);
  json["genus_why"] = census.genus ? Json() : Json(census.why_no_genus);
}

ProgressBar::Pass pass_of(ooc::CensusProgress::Phase phase) {
  using Phase = ooc::CensusProgress::Phase;
  switch (phase) {
    case Phase::kSpool:
      return {"reading", 2};
    case Phase::kFront:
      return {"front", 1};
    case Phase::kSort:
      return {"sorting on disk", 2};
    case Phase::kCount:
      break;
  }
  return {"counting", 0};
}

}  // namespace reeb::tools
