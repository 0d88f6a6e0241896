#include "tools/repair/row_choice.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <string_view>

#include "io/file/content_source.h"
#include "io/file/file.h"
#include "io/functions/function_spec.h"
#include "io/text/words.h"
#include "libreeb/base/error.h"

namespace reeb::tools {
namespace {

// The fields of a line of CSV.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
      fields.back() += line[i++];
    else if (line[i] == '"')
      quoted = !quoted;
    else if (line[i] == ',' && !quoted)
      fields.emplace_back();
    else if (line[i] != '\r')
      fields.back() += line[i];
  }
  return fields;
}

// Calls visit(line, number) for each line; numbers begin at 1.
void for_each_line(const std::string& path,
                   const std::function<void(const std::string& line, std::size_t number)>& visit) {
  constexpr std::size_t kMostLineBytes = 65535;  // as in lists of events
  io::File::open_for_reading(path);              // refuses what is not a regular file
  const auto source = io::open_content(path);
  std::string line;
  std::size_t number = 1;
  for (std::uint64_t at = 0;;) {
    const std::string_view view = source->view(at);
    if (view.empty()) break;
    for (const char c : view) {
      if (c == '\n') {
        visit(line, number++);
        line.clear();
      } else if (line.size() < kMostLineBytes) {
        line += c;
      } else {
        throw Error(ErrorKind::kBadInput,
                    "this line is longer than " + std::to_string(kMostLineBytes) +
                        " characters, so it is not of a "
                        "table of defects",
                    "name a table that reeb defects -o FILE.csv wrote")
            .at(path, std::to_string(number));
      }
    }
    at += view.size();
  }
  visit(line, number);
}

// The rows of the file, with the line of each.
std::map<LoopName, std::size_t> read_names(const std::string& path) {
  std::size_t lo = 0, hi = 0, function = 0;
  const auto read_header = [&](const std::vector<std::string>& header) {
    const auto column = [&](const char* name) {
      const auto it = std::ranges::find(header, name);
      if (it == header.end())
        throw Error(ErrorKind::kBadInput, std::string("it has no column ") + name,
                    "name a table that reeb defects -o FILE.csv wrote, or rows of it below its first line")
            .at(path, "1");
      return static_cast<std::size_t>(it - header.begin());
    };
    lo = column("lo");
    hi = column("hi");
    function = column("function");
  };
  std::map<LoopName, std::size_t> names;
  for_each_line(path, [&](const std::string& line, std::size_t line_number) {
    const std::vector<std::string> fields = fields_of(line);
    if (line_number == 1) return read_header(fields);
    if (line.find_first_not_of(" \t\r") == std::string::npos) return;
    const auto number = [&](std::size_t k) {
      if (const auto value = io::whole_number<std::uint64_t>(k < fields.size() ? fields[k] : std::string()))
        return *value;
      throw Error(ErrorKind::kBadInput, "this is not a row of a table of defects", "write rows as reeb defects does")
          .at(path, std::to_string(line_number));
    };
    names.emplace(LoopName{number(lo), number(hi), function < fields.size() ? fields[function] : ""}, line_number);
  });
  return names;
}

std::string why_not(const DefectRow& row, const Defects& defects, const RowFilter& filter) {
  const RowLimits& limits = filter.limits;
  if (!limits.has_persistence(row))
    return fmt::format("persistence not below {:.6g}{}", *limits.below, limits.below_is_percent ? "%" : "");
  if (std::isinf(row.length())) return "no short curve was found";
  if (!limits.has_length(row)) return fmt::format("curve longer than --longest {:.6g}", *limits.longest);
  if (filter.is_none()) {
    const auto& suggested = defects.table.suggestion.length;
    if (!suggested) return "no length is suggested that divides defects from features";
    if (!(row.length() <= *suggested)) return fmt::format("curve longer than the suggested {:.6g}", *suggested);
  }
  // A short contour need not be along edges where sheets meet.
  if (row.kind == DefectKind::kUnclear || row.curve.path.empty())
    return "kind unclear: a boundary, or no oriented manifold";
  return {};
}

}  // namespace

NamedRows read_named_rows(const std::string& loops) {
  NamedRows rows{loops, read_names(loops), {}};
  std::map<std::size_t, std::string> function_of;
  for (const auto& [name, line] : rows.lines) function_of.emplace(line, name.function);
  for (const auto& [line, function] : function_of) {
    if (std::ranges::find(rows.functions, function) != rows.functions.end()) continue;
    try {
      io::parse_function(function);
    } catch (const Error& error) {
      throw Error(ErrorKind::kBadInput, error.message(), "write rows as reeb defects does")
          .at(loops, std::to_string(line));
    }
    rows.functions.push_back(function);
  }
  return rows;
}

std::vector<ChosenRow> choose_rows(const Defects& defects, const RowFilter& filter) {
  const std::optional<NamedRows>& named = filter.named;
  std::map<LoopName, std::size_t> left;
  if (named) left = named->lines;
  std::vector<ChosenRow> chosen;
  for (std::size_t i = 0; i < defects.table.rows.size(); ++i) {
    const DefectRow& row = defects.table.rows[i];
    const LoopName name{row.lo.key.vertex.value(), row.hi.key.vertex.value(), defects.functions[row.function]};
    const bool is_wanted = !named || left.erase(name) != 0;
    chosen.push_back({i + 1, &row, is_wanted ? why_not(row, defects, filter) : "not in the file of --loops"});
  }
  if (!left.empty())
    throw Error(ErrorKind::kBadInput, "this row is not a loop of the mesh", "run reeb defects on this mesh again")
        .at(named->file, std::to_string(left.begin()->second));
  return chosen;
}

}  // namespace reeb::tools
