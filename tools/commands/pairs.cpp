// `reeb pairs`: the persistence pairs of a .reeb file as CSV.
#include <algorithm>
#include <memory>
#include <string>
#include <tuple>

#include "io/text/output_buffer.h"
#include "ooc/reeb_file/reeb_file.h"
#include "tools/commands/commands.h"
#include "tools/library/run_files.h"
#include "tools/program/input_kind.h"
#include "tools/program/output.h"

namespace reeb::tools {
namespace {

struct PairsOptions {
  std::string file, output;
  bool force = false;
};

double persistence(const ooc::PairRow& pair) { return pair.hi.key.value - pair.lo.key.value; }

void sort_rows(std::vector<ooc::PairRow>& rows) {
  const auto key = [](const ooc::PairRow& pair) {
    return std::tuple(-persistence(pair), pair.type, pair.lo.key.vertex, pair.hi.key.vertex);
  };
  std::sort(rows.begin(), rows.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
}

void write_rows(const std::vector<ooc::PairRow>& rows, std::ostream& stream) {
  io::OutputBuffer out(stream);
  out << "type,lo,hi,lo_value,hi_value,persistence,lo_x,lo_y,lo_z,hi_x,hi_y,hi_z,kept\n";
  for (const ooc::PairRow& pair : rows) {
    out << name_of(pair.type) << ',' << pair.lo.key.vertex.value() << ',' << pair.hi.key.vertex.value() << ','
        << pair.lo.key.value << ',' << pair.hi.key.value << ',' << persistence(pair);
    for (const Point& point : {pair.lo.position, pair.hi.position})
      for (const double coordinate : point) out << ',' << coordinate;
    out << (pair.kept ? ",1\n" : ",0\n");
  }
  out.flush();
}

}  // namespace

void add_pairs(CLI::App& app) {
  auto options = std::make_shared<PairsOptions>();
  CLI::App* command = app.add_subcommand("pairs", "List the persistence pairs as CSV");
  command->add_option("FILE", options->file, "The .reeb file")->required()->type_name("");
  command->add_option("-o,--output", options->output, "File to write (default, and -: standard output)")
      ->type_name("FILE");
  command->add_flag("--force", options->force, "Replace an existing output");
  command->footer("Example:\n  reeb pairs scan.reeb -o scan-pairs.csv");
  command->callback([options] {
    require_reeb_file(options->file, "pairs");
    RunFiles files;
    files.add_input(options->file, "the .reeb file");
    if (!options->output.empty()) files.add_output(options->output, "the output", existing_outputs(options->force));
    files.check();
    auto rows = ooc::ReebFile(options->file).pairs();
    sort_rows(rows);
    write_output(options->output, options->force, [&](std::ostream& out) { write_rows(rows, out); });
  });
}

}  // namespace reeb::tools
