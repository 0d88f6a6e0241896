// `reeb pairs`: the persistence pairs of a .reeb file as CSV, as JSON, or as the lists of GUDHI.
#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "io/file/file.h"
#include "io/file/file_name.h"
#include "io/text/json_text.h"
#include "io/text/output_buffer.h"
#include "libreeb/base/error.h"
#include "libreeb/base/printable.h"
#include "ooc/reeb_file/reeb_file.h"
#include "tools/arguments/options.h"
#include "tools/commands/commands.h"
#include "tools/library/run_files.h"
#include "tools/program/input_kind.h"
#include "tools/program/output.h"
#include "tools/program/whole_levels.h"
#include "tools/program/wrapping.h"

namespace reeb::tools {
namespace {

struct PairsOptions {
  std::string file, output = io::kStandardOutput, format;
  bool force = false, quiet = false;
};

using Rows = std::vector<ooc::PairRow>;

double persistence(const ooc::PairRow& pair) { return pair.hi.key.value - pair.lo.key.value; }

void sort_rows(Rows& rows) {
  const auto key = [](const ooc::PairRow& pair) {
    return std::tuple(-persistence(pair), pair.type, pair.lo.key.vertex, pair.hi.key.vertex);
  };
  std::sort(rows.begin(), rows.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
}

void write_csv(const ooc::ReebFile&, const Rows& rows, io::OutputBuffer& out) {
  out << "type,lo,hi,lo_value,hi_value,persistence,lo_x,lo_y,lo_z,hi_x,hi_y,hi_z,kept\n";
  for (const ooc::PairRow& pair : rows) {
    out << name_of(pair.type) << ',' << pair.lo.key.vertex.value() << ',' << pair.hi.key.vertex.value() << ','
        << io::Shortest{pair.lo.key.value} << ',' << io::Shortest{pair.hi.key.value} << ','
        << io::Shortest{persistence(pair)};
    for (const Point& point : {pair.lo.position, pair.hi.position})
      for (const double coordinate : point) out << ',' << io::Shortest{coordinate};
    out << (pair.kept ? ",1\n" : ",0\n");
  }
}

void write_json(const ooc::ReebFile& file, const Rows& rows, io::OutputBuffer& out) {
  out << "{\"schema\": \"reeb.pairs.v1\", \"function\": ";
  io::write_json_string(file.header().function, out);
  out << ",\n\"pairs\": [";
  bool first = true;
  for (const ooc::PairRow& pair : rows) {
    out << (std::exchange(first, false) ? "\n" : ",\n") << "{\"type\": \"" << name_of(pair.type)
        << "\", \"lo\": " << pair.lo.key.vertex.value() << ", \"hi\": " << pair.hi.key.vertex.value()
        << ", \"lo_value\": " << io::Shortest{pair.lo.key.value}
        << ", \"hi_value\": " << io::Shortest{pair.hi.key.value} << ", \"persistence\": ";
    io::write_json_number(persistence(pair), out);
    out << ", \"lo_position\": ";
    io::write_json_point(pair.lo.position, out);
    out << ", \"hi_position\": ";
    io::write_json_point(pair.hi.position, out);
    out << ", \"kept\": " << (pair.kept ? "true}" : "false}");
  }
  out << "]}\n";
}

// The four lists that extended_persistence() of GUDHI returns, as JSON (docs/SEMANTICS.md, Pairs). A class that is born
// while values fall has its birth above its death.
void write_gudhi(const ooc::ReebFile&, const Rows& rows, io::OutputBuffer& out) {
  struct Diagram {
    PairType type;
    int dimension;
    bool falls;
  };
  constexpr std::array kDiagrams = {Diagram{PairType::kOrd0, 0, false}, Diagram{PairType::kRel1, 1, true},
                                    Diagram{PairType::kExt0, 0, false}, Diagram{PairType::kExt1, 1, true}};
  out << '[';
  for (const Diagram& diagram : kDiagrams) {
    out << (diagram.type == PairType::kOrd0 ? "[" : ",\n[");
    bool first = true;
    for (const ooc::PairRow& pair : rows) {
      if (pair.type != diagram.type) continue;
      const double birth = diagram.falls ? pair.hi.key.value : pair.lo.key.value;
      const double death = diagram.falls ? pair.lo.key.value : pair.hi.key.value;
      out << (std::exchange(first, false) ? "[" : ", [") << diagram.dimension << ", [" << io::Shortest{birth} << ", "
          << io::Shortest{death} << "]]";
    }
    out << ']';
  }
  out << "]\n";
}

struct Format {
  std::string_view name;
  void (*write)(const ooc::ReebFile&, const Rows&, io::OutputBuffer&);
};
constexpr std::array kFormats = {Format{"csv", write_csv}, Format{"json", write_json}, Format{"gudhi", write_gudhi}};

// By --format, or else by the suffix of the output, with none CSV.
const Format& choose_format(const PairsOptions& options) {
  std::string name = options.format;
  if (name.empty()) {
    const std::string suffix = io::name_suffix(options.output);
    if (!suffix.empty() && suffix != ".csv" && suffix != ".json")
      throw Error(ErrorKind::kUsage, "cannot tell the format of the pairs from this name",
                  "end the name in .csv or .json, or use --format with one of: csv json gudhi")
          .at(options.output);
    name = suffix == ".json" ? "json" : "csv";
  }
  for (const Format& format : kFormats)
    if (format.name == name) return format;
  throw Error(ErrorKind::kUsage, "--format: \"" + name + "\" is not a format for pairs", "use one of: csv json gudhi");
}

void list_pairs(const PairsOptions& options) {
  RunFiles files;
  files.add_input(options.file, "the .reeb file");
  files.add_output(options.output, "the output", existing_outputs(options.force));
  files.check();
  const Format& format = choose_format(options);
  require_reeb_file(options.file, "pairs");
  const ooc::ReebFile file(options.file);
  Rows rows = read_part(file, FilePart::kPairs, [&] { return file.pairs(); });
  sort_rows(rows);
  write_output(options.output, options.force, [&](std::ostream& stream) {
    io::OutputBuffer out(stream);
    format.write(file, rows, out);
    out.flush();
  });
  if (!options.quiet && options.output != io::kStandardOutput) print_line("wrote " + printable(options.output));
}

}  // namespace

void add_pairs(Program& app) {
  auto options = std::make_shared<PairsOptions>();
  Command command = app.add_command("pairs", "List the persistence pairs as CSV or JSON");
  command.add_option("FILE", options->file, "The .reeb file").required().type_name("");
  command.add_option("-o,--output", options->output, "File to write (default, and -: standard output)")
      .type_name("FILE");
  command
      .add_option("--format", options->format,
                  "One of csv json gudhi (lists as GUDHI's extended persistence has them, in JSON); default: by the "
                  "suffix of the output, .csv or .json; csv without one")
      .type_name("NAME");
  command.refuse_option("--threshold", "all pairs are listed",
                        "levels are chosen afterwards: `reeb extract FILE.reeb --threshold 1%`");
  add_force(command, options->force);
  add_quiet(command, options->quiet);
  command.footer("Example:\n  reeb pairs scan.reeb -o scan-pairs.csv");
  command.callback([options] { list_pairs(*options); });
}

}  // namespace reeb::tools
