#include "io/functions/function_spec.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <ranges>
#include <utility>

#include "io/text/text_cursor.h"
#include "io/text/words.h"
#include "libreeb/base/error.h"
#include "libreeb/base/nearest_name.h"

namespace reeb::io {
namespace {

using Kind = FunctionSpec::Kind;

// "1,2,3": `read` reads each part. Nothing if one is not as it should be.
template <class T, class Read>
std::optional<std::vector<T>> list_of(std::string_view text, const Read& read) {
  std::vector<T> items;
  for (bool more = true; more;) {
    const std::size_t comma = text.find(',');
    const std::optional<T> item = read(text.substr(0, comma));
    if (!item) return std::nullopt;
    items.push_back(*item);
    more = comma != std::string_view::npos;
    if (more) text.remove_prefix(comma + 1);
  }
  return items;
}

std::optional<double> finite_number(std::string_view text) {
  const auto parsed = parse_number<double>(text);
  return parsed.ok && std::isfinite(parsed.value) ? std::optional(parsed.value + 0.0) : std::nullopt;
}

std::optional<FunctionSpec> parse_distance(std::string_view argument, FunctionSpec spec) {
  if (const auto vertex = whole_number<std::uint64_t>(argument)) {
    spec.kind = Kind::kDistanceToVertex;
    spec.number = *vertex;
    return spec;
  }
  const auto point = list_of<double>(argument, finite_number);
  if (!point || point->size() != 3) return std::nullopt;
  spec.kind = Kind::kDistanceToPoint;
  std::ranges::copy(*point, spec.point.begin());
  return spec;
}

std::optional<FunctionSpec> try_parse(std::string_view text) {
  FunctionSpec spec{.text = std::string(text)};
  const auto numbered = [&spec](Kind kind, std::uint64_t number) {
    spec.kind = kind;
    spec.number = number;
    return spec;
  };
  if (text == "x" || text == "y" || text == "z")
    return numbered(Kind::kCoordinate, static_cast<std::uint64_t>(text[0] - 'x'));
  if (text == "value") {
    spec.kind = Kind::kValue;
    spec.number = 0;
    spec.argument = text;
    return spec;
  }
  if (text == "index") return numbered(Kind::kIndex, 0);
  if (text == "spectral") return numbered(Kind::kLaplacian, 1);
  if (text.starts_with('c')) {
    const auto coordinate = whole_number<std::uint64_t>(text.substr(1));
    return coordinate ? std::optional(numbered(Kind::kCoordinate, *coordinate)) : std::nullopt;
  }
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos || colon + 1 == text.size()) return std::nullopt;
  const std::string_view name = text.substr(0, colon), argument = text.substr(colon + 1);
  spec.number = 0;
  if (name == "property" || name == "file") {
    spec.kind = name == "file" ? Kind::kFile : Kind::kProperty;
    spec.argument = argument;
    return spec;
  }
  if (name == "distance") return parse_distance(argument, std::move(spec));
  if (name == "geodesic") {
    const auto vertices = list_of<std::uint64_t>(argument, whole_number<std::uint64_t>);
    if (!vertices) return std::nullopt;
    spec.kind = Kind::kGeodesic;
    spec.vertices = *vertices;
    return spec;
  }
  const auto number = whole_number<std::uint64_t>(argument);
  if (!number) return std::nullopt;
  if (name == "value") {
    spec.argument = *number == 0 ? "value" : text;
    return numbered(Kind::kValue, *number);
  }
  if (name == "random") return numbered(Kind::kRandom, *number);
  if (name == "laplacian" && *number != 0) return numbered(Kind::kLaplacian, *number);
  return std::nullopt;
}

constexpr struct {
  std::string_view name, needs, example;
} kNeeds[] = {{"geodesic", "a vertex", "geodesic:0"},         {"distance", "a vertex or a point", "distance:0"},
              {"laplacian", "a number", "laplacian:1"},       {"random", "a seed", "random:1"},
              {"property", "a name", "property:temperature"}, {"file", "a path", "file:values.f64"}};

// What a user may have meant by a text that is not a function; empty if nothing is near.
std::string meant_function(std::string_view text) {
  std::string small(text);
  std::ranges::transform(small, small.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (small != text && try_parse(small)) return small;
  constexpr std::size_t kFewLetters = 3;  // near to anything
  if (small.size() < kFewLetters) return {};
  const std::size_t colon = std::min(small.find(':'), small.size());
  const std::string name = small.substr(0, colon);
  std::vector<std::string> names{"index", "spectral", "value", "height", "elevation"};
  for (const auto& need : kNeeds) names.emplace_back(need.name);
  const std::string near = nearest(name, names);
  if (near == "height" || near == "elevation") return "z";
  if (near == name) return {};  // its argument is wrong
  const std::string meant = near + std::string(text.substr(colon));
  if (try_parse(meant)) return meant;
  const auto need = std::ranges::find(kNeeds, near, [](const auto& one) { return one.name; });
  return need == std::end(kNeeds) ? std::string() : std::string(need->example);
}

// "-f x -f y" for "x,y"; empty if the text is no list of functions.
std::string repeated_options(std::string_view text) {
  std::string options;
  for (const auto part : text | std::views::split(',')) {
    const std::string function(part.begin(), part.end());
    if (!try_parse(function)) return {};
    options.append(options.empty() ? "-f " : " -f ").append(function);
  }
  return options;
}

}  // namespace

FunctionSpec parse_function(std::string_view text) {
  if (auto spec = try_parse(text)) return *std::move(spec);
  if (text == "laplacian:0")
    throw Error(ErrorKind::kUsage, "\"laplacian:0\" is not a function: K of laplacian:K is at least 1",
                "laplacian:1, or spectral, is the first eigenvector that is not constant");
  if (text.starts_with("distance:"))
    throw Error(ErrorKind::kUsage, std::string("\"").append(text).append("\" is not a function"),
                "distance:VERTEX has the number of a vertex, distance:X,Y,Z three coordinates");
  for (const auto& [name, needs, example] : kNeeds)
    if (text == name)
      throw Error(ErrorKind::kUsage, std::string(name) + " needs " + std::string(needs),
                  "for instance " + std::string(example));
  const std::string what = std::string("\"").append(text).append("\" is not a function");
  if (const std::string options = repeated_options(text); !options.empty())
    throw Error(ErrorKind::kUsage, what, "for several functions repeat -f: " + options);
  const std::string meant = meant_function(text);
  throw Error(ErrorKind::kUsage, what + (meant.empty() ? meant : " (did you mean " + meant + "?)"),
              "functions are x, y, z, cK (a coordinate, from 0), index, random:SEED, property:NAME, file:PATH, "
              "value or value:K (of an image), distance:VERTEX, distance:X,Y,Z, geodesic:VERTEX[,VERTEX...], "
              "laplacian:K, spectral");
}

FunctionSpec default_function(const MeshInfo& info) {
  if (info.grid) return parse_function("value");
  return parse_function(info.dimension == 1 ? "x" : info.dimension == 2 ? "y" : "z");
}

std::string file_name_part(const FunctionSpec& spec) {
  std::string name = spec.text;
  for (const char c : {':', '/'}) std::ranges::replace(name, c, '-');
  return name;
}

std::vector<std::string> needed_properties(std::span<const FunctionSpec> specs) {
  std::vector<std::string> names;
  for (const FunctionSpec& spec : specs)
    if ((spec.kind == Kind::kProperty || spec.kind == Kind::kValue) &&
        std::ranges::find(names, spec.argument) == names.end())
      names.push_back(spec.argument);
  return names;
}

}  // namespace reeb::io
