#include "tools/report/tables.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "io/text/number_text.h"
#include "io/text/xml_text.h"
#include "libreeb/base/count_text.h"
#include "tools/program/compute_report.h"
#include "tools/program/quantity.h"
#include "tools/program/whole_levels.h"
#include "tools/report/page_text.h"

namespace reeb::tools {
namespace {

struct Column {
  const char* name;
  bool number = true;
};

// `buttons`: the name of a first column with buttons, by which nobody sorts; null: there is none.
std::string head(const std::string& caption, const char* buttons, std::initializer_list<Column> columns) {
  std::string out = "<table class=\"sortable\">\n<caption>" + caption + "</caption>\n<thead><tr>";
  if (buttons != nullptr) out += fmt::format("<th scope=\"col\" class=\"fixed\">{}</th>", buttons);
  for (const Column& column : columns)
    out += fmt::format("<th scope=\"col\"{}>{}</th>", column.number ? " class=\"number\"" : "", column.name);
  return out + "</tr></thead>\n<tbody>\n";
}

constexpr const char* kEnd = "</tbody>\n</table>\n";

std::string number(const std::string& text) { return "<td class=\"number\">" + text + "</td>"; }
std::string number(double value, int digits = 6) {
  return std::isfinite(value) ? number(io::short_number(value, digits))
                              : "<td class=\"number\" data-value=\"Infinity\"><span class=\"quiet\">none</span></td>";
}
// A count, which sorts as the number that it is.
std::string count(std::uint64_t value) {
  return fmt::format("<td class=\"number\" data-value=\"{}\">{}</td>", value, with_commas(value));
}
std::string text(const std::string& shown) { return "<td>" + shown + "</td>"; }

// Places with as many digits as tell them apart.
class PlaceText {
 public:
  void add(const Point& point) {
    for (std::size_t k = 0; k < 3; ++k) {
      low_[k] = std::min(low_[k], point[k]);
      high_[k] = std::max(high_[k], point[k]);
    }
  }
  std::string operator()(const Point& point) const {
    std::string text;
    for (std::size_t k = 0; k < 3; ++k)
      text += (k == 0 ? "" : ", ") +
              io::short_number(point[k], std::max(kLeast, io::digits_for_range(low_[k], high_[k], kOfRange)));
    return "<td class=\"place\">" + text + "</td>";
  }

 private:
  static constexpr int kLeast = 5, kOfRange = 4;
  Point low_{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high_{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
};

std::string percent(double percent) { return number(fmt::format("{:.4g}", percent)); }
std::string percent(const ValueRange& range, double lo, double hi) {
  return percent(range.max > range.min ? percent_of(range, lo, hi) : 0.0);
}

std::string button(const char* what, std::size_t index, const std::string& label) {
  return fmt::format("<td class=\"fixed\"><button type=\"button\" data-{}=\"{}\" aria-label=\"{}\">Show</button></td>",
                     what, index, label);
}

}  // namespace

std::string summary_table(const std::string& caption, std::span<const NamedText> rows) {
  std::string out = "<table class=\"summary\">\n<caption>" + io::xml_escaped(caption) + "</caption>\n<tbody>\n";
  for (const auto& [name, value] : rows)
    out += "<tr><th scope=\"row\">" + io::xml_escaped(name) + "</th><td>" + io::xml_escaped(value) + "</td></tr>\n";
  return out + kEnd;
}

std::string pairs_table(std::span<const ooc::PairRow> rows, const ValueRange& range, bool with_buttons) {
  std::string out = head("Features by persistence", with_buttons ? "in the skeleton" : nullptr,
                         {{"rank"},
                          {"feature", false},
                          {"persistence"},
                          {"% of range"},
                          {"from value"},
                          {"to value"},
                          {"lower vertex"},
                          {"upper vertex"},
                          {"place of upper vertex", false}});
  PlaceText place;
  for (const ooc::PairRow& row : rows) place.add(row.hi.position);
  const int digits = io::digits_for_range(range.min, range.max);
  std::size_t rank = 0;
  for (const ooc::PairRow& row : rows) {
    const double persistence = row.hi.key.value - row.lo.key.value;
    ++rank;
    out += "<tr>";
    if (with_buttons) out += button("pair", rank - 1, fmt::format("Show feature {} in the skeleton", rank));
    out += number(std::to_string(rank)) +
           text(fmt::format("{} ({}){}", feature_name(row.type), name_of(row.type), row.kept ? ", kept" : "")) +
           number(persistence) + percent(range, row.lo.key.value, row.hi.key.value) + number(row.lo.key.value, digits) +
           number(row.hi.key.value, digits) + number(std::to_string(row.lo.key.vertex.value())) +
           number(std::to_string(row.hi.key.vertex.value())) + place(row.hi.position) + "</tr>\n";
  }
  return out + kEnd;
}

std::string defects_table(const Defects& defects, std::size_t most, std::size_t closeups) {
  std::string out = head("Loops of the surface, the most likely defect first", closeups > 0 ? "close-up" : nullptr,
                         {{"rank"},
                          {"kind", false},
                          {"contour length"},
                          {"cycle length"},
                          {"persistence"},
                          {"% of range"},
                          {"triangles"},
                          {"lower vertex"},
                          {"upper vertex"},
                          {"centre", false}});
  const auto& rows = defects.table.rows;
  PlaceText place;
  for (const DefectRow& row : rows) place.add(row.curve.place.center);
  for (std::size_t i = 0; i < std::min(rows.size(), most); ++i) {
    const DefectRow& row = rows[i];
    out += "<tr>";
    if (i < closeups)
      out += button("closeup", i, fmt::format("Show the close-up of defect {}", i + 1));
    else if (closeups > 0)
      out += "<td class=\"fixed\"></td>";
    out += number(std::to_string(i + 1)) + text(name_of(row.kind)) + number(row.length_contour) +
           number(row.length_cycle) + number(row.persistence) + percent(row.percent) + count(row.curve.triangles) +
           number(std::to_string(row.lo.key.vertex.value())) + number(std::to_string(row.hi.key.vertex.value())) +
           place(row.curve.place.center) + "</tr>\n";
  }
  return out + kEnd;
}

std::string levels_table(const ooc::ReebFile& file) {
  const FileHeader& header = file.header();
  const ValueRange range{header.function_min, header.function_max};
  std::string out = head("Levels of detail, from coarse to fine", nullptr,
                         {{"threshold"}, {"% of range"}, {"nodes"}, {"arcs"}, {"bytes read"}, {"bytes of memory"}});
  for (const LevelLine& line : header.levels)
    out += "<tr>" + number(threshold_text(file, line)) + percent(range, 0, line.threshold) + count(line.nodes) +
           count(line.arcs) + count(line.file_bytes) + count(line.memory_bytes) + "</tr>\n";
  return out + kEnd;
}

}  // namespace reeb::tools
