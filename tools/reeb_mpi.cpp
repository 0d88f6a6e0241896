// The program `reeb-mpi`: `reeb compute` by many processes (docs/DISTRIBUTED.md).
#include <fmt/core.h>
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "io/file/file.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/base/printable.h"
#include "ooc/run/explained_error.h"
#include "ooc/threads/machine_threads.h"
#include "tools/arguments/arguments.h"
#include "tools/mpi/distributed_run.h"
#include "tools/mpi/world.h"
#include "tools/program/compute_report.h"
#include "tools/program/output.h"
#include "tools/program/process_memory.h"
#include "tools/program/signals.h"
#include "tools/program/standard_streams.h"
#include "tools/program/wrapping.h"
#include "tools/runs/run_options.h"

namespace {

namespace fs = std::filesystem;
using reeb::Error;
using reeb::ErrorKind;
using reeb::tools::RankFigures;
using reeb::tools::RunFacts;

struct Arguments : reeb::tools::RunArguments {
  std::string output, report;
};

std::uint64_t sum(const std::vector<RankFigures>& ranks, std::uint64_t RankFigures::*figure) {
  return std::accumulate(ranks.begin(), ranks.end(), std::uint64_t{0},
                         [&](std::uint64_t all, const RankFigures& rank) { return all + rank.*figure; });
}

std::uint64_t greatest(const std::vector<RankFigures>& ranks, std::uint64_t RankFigures::*figure) {
  return std::ranges::max(ranks, {}, figure).*figure;
}

std::string seconds(std::uint64_t ms) { return fmt::format("{:.2f} s", static_cast<double>(ms) / 1000); }

void print_ranks(const std::vector<RankFigures>& ranks) {
  reeb::tools::print_line(
      fmt::format("  {}: shares {}, tree {}; sent {} of names and {} up the tree; a rank took at most {}",
                  reeb::count_of(ranks.size(), "rank"), seconds(greatest(ranks, &RankFigures::share_ms)),
                  seconds(ranks[0].tree_ms), reeb::format_bytes(sum(ranks, &RankFigures::names_bytes)),
                  reeb::format_bytes(sum(ranks, &RankFigures::tree_bytes)),
                  reeb::format_bytes(greatest(ranks, &RankFigures::peak_bytes))));
}

// That of `reeb compute`, with the figures of all ranks.
std::string report_of(const RunFacts& facts, const reeb::tools::DistributedResult& done) {
  using Json = nlohmann::ordered_json;
  struct Column {
    const char* name;
    std::uint64_t RankFigures::*figure;
    bool is_sum;
  };
  static constexpr Column kColumns[] = {
      {"triangles", &RankFigures::triangles, true},
      {"share_ms", &RankFigures::share_ms, false},
      {"tree_ms", &RankFigures::tree_ms, false},
      {"cpu_ms", &RankFigures::cpu_ms, true},
      {"names_bytes", &RankFigures::names_bytes, true},
      {"tree_bytes", &RankFigures::tree_bytes, true},
      {"live_vertices", &RankFigures::live_vertices, false},
      {"peak_bytes", &RankFigures::peak_bytes, false},
  };
  Json sums = Json::object(), maxima = Json::object(), list = Json::array();
  for (const auto& [name, figure, is_sum] : kColumns) {
    if (is_sum) sums[name] = sum(done.ranks, figure);
    maxima[name] = greatest(done.ranks, figure);
  }
  for (const RankFigures& rank : done.ranks) {
    Json one = Json::object();
    for (const auto& [name, figure, is_sum] : kColumns) one[name] = rank.*figure;
    list.push_back(std::move(one));
  }
  const Json ranks = {{"count", done.ranks.size()}, {"sum", sums}, {"max", maxima}, {"each", list}};
  Json report = Json::parse(reeb::tools::report_json(facts, done.results));
  if (report.is_array())
    for (Json& of_function : report) of_function["ranks"] = ranks;
  else
    report["ranks"] = ranks;
  return report.dump(2) + "\n";
}

void compute(reeb::tools::World& world, Arguments arguments) {
  using reeb::tools::print_line;
  if (arguments.functions.empty()) arguments.functions.emplace_back();
  if (arguments.options.threads == 0)
    arguments.options.threads = std::max(1u, reeb::ooc::machine_threads() / world.ranks_here());
  const std::vector<std::string> outputs = reeb::tools::output_names(arguments.output, arguments.functions);
  reeb::tools::take_denoise(arguments);
  if (world.is_root()) {
    if (arguments.mesh == "-" || reeb::io::is_device(arguments.output))
      throw Error(ErrorKind::kUsage, "many processes cannot share standard input, standard output or a device",
                  "name files for the mesh and the output");
    reeb::tools::check_files(arguments, outputs, arguments.report);
  }
  world.wait_for_all();  // the root says what is wrong with files
  const bool speaks = world.is_root() && !arguments.quiet;
  RunFacts facts;
  facts.path = arguments.mesh;
  arguments.options.opened = [&](const reeb::MeshInfo& info) {
    facts.format = info.format;
    facts.input_bytes = info.file_bytes;
    facts.is_image = info.grid.has_value();
    if (speaks) print_line(reeb::printable(arguments.mesh + ": " + reeb::tools::describe(info)));
  };
  arguments.options.interrupted = reeb::tools::watch_signals();
  const auto done =
      reeb::tools::compute_distributed(world, arguments.mesh, arguments.functions, outputs, arguments.options);
  arguments.options.interrupted = {};
  if (speaks) {
    reeb::tools::print_summary(facts, done.results);
    print_ranks(done.ranks);
  }
  if (world.is_root() && !arguments.report.empty())
    reeb::tools::write_output(arguments.report, arguments.options.replace,
                              [&](std::ostream& out) { out << report_of(facts, done); });
}

void run(reeb::tools::World& world, int argc, char** argv) {
  Arguments arguments;
  reeb::tools::Program program("reeb-mpi", "Exact Reeb graphs of meshes of any size, by many processes");
  program.set_version("reeb-mpi " REEB_VERSION);
  reeb::tools::Command command = program.add_command("compute", "Compute the Reeb graph of a mesh");
  command.add_option("MESH", arguments.mesh, "Mesh or image of any format, which every rank can read")
      .required()
      .type_name("");
  command.add_option("-o,--output", arguments.output, "File to write, where every rank can write")
      .required()
      .type_name("FILE");
  reeb::tools::add_run_options(
      command, arguments,
      {.memory = "Memory that each rank may use: 64M, 1.5GiB (default: no limit)",
       .threads = "Number of threads of each rank, 1 to 1024 (default: the cores of a machine, divided by the ranks on "
                  "it)"});
  reeb::tools::refuse_whole_mesh_options(command);
  command.add_option("--report", arguments.report, "Write figures of the run as JSON").type_name("FILE");
  command.footer("Example:\n  mpirun -n 8 reeb-mpi compute scan.ply -o scan.reeb");
  command.callback([&] { compute(world, std::move(arguments)); });
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (!words.empty() && !words[0].starts_with('-') && !program.has_command(words[0]))
    throw Error(ErrorKind::kUsage, "there is no command '" + words[0] + "'",
                fs::exists(words[0]) ? "write reeb-mpi compute " + words[0] + " -o OUT.reeb"
                                     : "the only command is compute: reeb-mpi compute MESH -o OUT.reeb");
  const auto text = program.run(words.empty() ? std::vector<std::string>{"--help"} : words);
  if (text && world.is_root()) fmt::print("{}", *text);
}

// Ends all ranks. Where several fail for the same reason, one text suffices: that of the first is out, and the others
// are ended, before they speak.
[[noreturn]] void end_all(const Error& error) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  constexpr int kMostTurns = 100;
  constexpr std::chrono::milliseconds kFirst(400), kTurn(50);
  if (rank != 0) std::this_thread::sleep_for(kFirst + std::min(rank, kMostTurns) * kTurn);
  fmt::print(stderr, "reeb-mpi: error: {}\nhint: {}\n", reeb::printable(error.what()), reeb::printable(error.hint()));
  std::fflush(stderr);
  MPI_Abort(MPI_COMM_WORLD, static_cast<int>(error.kind()));
  std::abort();  // not reached
}

}  // namespace

int main(int argc, char** argv) {
  reeb::tools::set_up_process_memory();
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  reeb::tools::handle_signals(false);  // mpirun ends all ranks after one failed, whose text is the one to read
  try {
    reeb::tools::World world;
    try {
      run(world, argc, argv);
    } catch (const Error& error) {
      // What is wrong with the command line is wrong for all: one says it, and ends the others.
      if (error.kind() == ErrorKind::kUsage && !world.is_root()) world.wait_for_all();
      throw;
    }
    reeb::tools::finish_standard_output();
  } catch (const Error& error) {
    end_all(error);
  } catch (const std::bad_alloc&) {
    end_all(Error(ErrorKind::kResource, "out of memory", "use more ranks, or more machines"));
  } catch (const std::exception& error) {
    end_all(reeb::ooc::error_of_limit(error).value_or(
        Error(ErrorKind::kResource, error.what(), "please report this as a bug")));
  }
  MPI_Finalize();
  return 0;
}
