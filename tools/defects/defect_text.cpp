#include "tools/defects/defect_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/text/output_buffer.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/printable.h"
#include "tools/meshes/census_text.h"

namespace reeb::tools {
namespace {

std::string length_text(double length) { return std::isfinite(length) ? fmt::format("{:.4g}", length) : "inf"; }

void write_length(io::OutputBuffer& out, double length) {
  if (std::isfinite(length))
    out << length;
  else
    out << "inf";
}

// JSON has no infinity.
nlohmann::ordered_json length_json(double length) {
  return std::isfinite(length) ? nlohmann::ordered_json(length) : nlohmann::ordered_json("inf");
}

nlohmann::ordered_json row_json(const Defects& defects, const RankedRow& ranked) {
  const DefectRow& row = *ranked.row;
  nlohmann::ordered_json json = {{"rank", ranked.rank},
                                 {"lo", row.lo.key.vertex.value()},
                                 {"hi", row.hi.key.vertex.value()},
                                 {"persistence", row.persistence},
                                 {"persistence_percent", row.percent}};
  constexpr const char* kAxes[] = {"x", "y", "z"};
  for (std::size_t k = 0; k < 3; ++k) json[std::string("center_") + kAxes[k]] = row.curve.place.center[k];
  for (std::size_t k = 0; k < 3; ++k) json[std::string("min_") + kAxes[k]] = row.curve.place.box[0][k];
  for (std::size_t k = 0; k < 3; ++k) json[std::string("max_") + kAxes[k]] = row.curve.place.box[1][k];
  json["kind"] = name_of(row.kind);
  json["length_contour"] = length_json(row.length_contour);
  json["length_cycle"] = length_json(row.length_cycle);
  json["triangles"] = row.curve.triangles;
  json["function"] = defects.functions[row.function];
  return json;
}

// " of f = x", or " (those of x; shorter curves also from y and z)".
std::string loops_of(const std::string& first, std::span<const std::string> others) {
  if (others.empty()) return " of f = " + first;
  std::string list;
  for (std::size_t i = 0; i < others.size(); ++i)
    list += (i == 0 ? "" : i + 1 < others.size() ? ", " : " and ") + printable(others[i]);
  return " (those of " + first + "; shorter curves also from " + list + ")";
}

}  // namespace

std::string defect_table(const Defects& defects, std::span<const RankedRow> rows) {
  std::string text;
  const SuggestedLength& suggestion = defects.table.suggestion;
  const std::size_t all = defects.table.rows.size();
  const std::string first = printable(defects.functions[0]);
  if (all == 0) return "no loops in the graph of " + first + ": nothing to list\n";
  text += count_of(all, "loop") + loops_of(first, std::span(defects.functions).subspan(1));
  if (rows.size() < all) text += fmt::format(", {} of them listed", rows.size());
  text += '\n';
  if (!rows.empty())
    text += fmt::format("{:>5}  {:<7} {:>10} {:>10} {:>10} {:>10}  {:<34} {}\n", "rank", "kind", "contour", "cycle",
                        "persist.", "of range", "center", "f");
  for (const RankedRow& ranked : rows) {
    const DefectRow& row = *ranked.row;
    text += fmt::format("{:>5}  {:<7} {:>10} {:>10} {:>10.4g} {:>8.3f} %  {:<34} {}\n", ranked.rank, name_of(row.kind),
                        length_text(row.length_contour), length_text(row.length_cycle), row.persistence, row.percent,
                        fmt::format("{:.6g} {:.6g} {:.6g}", row.curve.place.center[0], row.curve.place.center[1],
                                    row.curve.place.center[2]),
                        printable(defects.functions[row.function]));
  }
  if (std::ranges::any_of(rows, [](const RankedRow& ranked) { return ranked.row->kind == DefectKind::kUnclear; }))
    text += "unclear: at a boundary, where the surface is not an oriented manifold, or no curve was found\n";
  if (suggestion.length)
    text += fmt::format("likely defects by length: --longest {:.4g} (confidence {:.0f} %): {}\n", *suggestion.length,
                        100 * suggestion.confidence, suggestion.why);
  else
    text += fmt::format("no length divides defects from features (confidence {:.0f} %): {}\n",
                        100 * suggestion.confidence, suggestion.why);
  return text;
}

void write_defect_csv(const Defects& defects, std::span<const RankedRow> rows, std::ostream& stream) {
  io::OutputBuffer out(stream);
  out << "rank,lo,hi,persistence,persistence_percent,center_x,center_y,center_z,min_x,min_y,min_z,max_x,max_y,max_z,"
         "kind,length_contour,length_cycle,triangles,function\n";
  for (const RankedRow& ranked : rows) {
    const DefectRow& row = *ranked.row;
    out << ranked.rank << ',' << row.lo.key.vertex.value() << ',' << row.hi.key.vertex.value() << ',' << row.persistence
        << ',' << row.percent;
    for (const Point& point : {row.curve.place.center, row.curve.place.box[0], row.curve.place.box[1]})
      for (const double x : point) out << ',' << x;
    out << ',' << name_of(row.kind) << ',';
    write_length(out, row.length_contour);
    out << ',';
    write_length(out, row.length_cycle);
    out << ',' << row.curve.triangles << ',';
    // A function can be a point, a list of vertices or a file's name.
    const std::string& function = defects.functions[row.function];
    if (function.find_first_of(",\"\n") == std::string::npos) {
      out << function;
    } else {
      out << '"';
      for (const char c : function) out << (c == '"' ? "\"\"" : std::string(1, c));
      out << '"';
    }
    out << '\n';
  }
  out.flush();
}

void write_defect_json(const Defects& defects, std::span<const RankedRow> rows, const ooc::MeshCensus& census,
                       std::ostream& stream) {
  auto loops = nlohmann::ordered_json::array();
  for (const RankedRow& ranked : rows) loops.push_back(row_json(defects, ranked));
  const SuggestedLength& suggestion = defects.table.suggestion;
  nlohmann::ordered_json json = {{"schema", "reeb.defects.v1"}, {"loops", std::move(loops)}};
  json["suggested_threshold"] = {
      {"length", suggestion.length ? nlohmann::ordered_json(*suggestion.length) : nlohmann::ordered_json()},
      {"confidence", suggestion.confidence},
      {"why", suggestion.why}};
  add_defects(json, census);
  stream << json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
}

}  // namespace reeb::tools
