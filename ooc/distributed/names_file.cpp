#include "ooc/distributed/names_file.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <vector>

#include "io/file/atomic_file.h"
#include "io/file/checksum.h"
#include "io/file/file.h"
#include "io/file/input_file.h"
#include "libreeb/base/error.h"
#include "ooc/states/state_file.h"

namespace reeb::ooc {
namespace {

constexpr std::array<char, 8> kNamesMagic = {'R', 'E', 'E', 'B', 'N', 'A', 'M', '\n'};
constexpr std::uint64_t kNamesVersion = 1;
constexpr std::size_t kRunsAtOnce = 4096;

struct NamesHeader {
  std::array<char, 8> magic;
  std::uint64_t version;
  std::uint64_t mesh_bytes, mesh_digest, reading;
  std::uint64_t vertices, triangles, parts, part;
  std::uint64_t runs;
  std::uint64_t runs_checksum;
  std::uint64_t checksum;  // of the header before
};
static_assert(sizeof(NamesHeader) == std::size_t{12} * 8);

struct Run {
  std::uint64_t first, count;
};

NamesHeader header_of(const WholeMeshInfo& mesh, std::uint32_t part) {
  return {kNamesMagic,
          kNamesVersion,
          mesh.bytes,
          mesh.digest,
          mesh.reading,
          mesh.shares.vertices,
          mesh.shares.triangles,
          mesh.shares.parts,
          part,
          0,
          0,
          0};
}

[[noreturn]] void fail(const io::File& file, const std::string& why, std::uint64_t offset) {
  throw Error(ErrorKind::kBadInput, why, "make it again with `reeb fragment --scan`")
      .at(file.path(), std::to_string(offset));
}

NamesHeader read_header(const io::File& file, const WholeMeshInfo& mesh) {
  NamesHeader header{};
  if (file.size() < sizeof(header)) fail(file, "this file of names was cut off, or is not one", file.size());
  file.read_at(0, std::as_writable_bytes(std::span(&header, 1)));
  if (header.magic != kNamesMagic) fail(file, "this is not a file of names", 0);
  if (header.version != kNamesVersion) fail(file, "this file of names is of another version of this program", 0);
  if (header.checksum != io::header_checksum(header)) fail(file, "this file of names is damaged", 0);
  const NamesHeader own = header_of(mesh, 0);
  if (header.mesh_bytes != own.mesh_bytes || header.mesh_digest != own.mesh_digest || header.reading != own.reading ||
      header.vertices != own.vertices || header.triangles != own.triangles)
    fail(file, "this file of names is of another mesh", 0);
  if (header.parts != own.parts)
    fail(file,
         "this file of names is of " + std::to_string(header.parts) + " parts, not of " + std::to_string(own.parts), 0);
  const std::uint64_t bytes = file.size() - sizeof(header);
  if (header.part >= header.parts || bytes / sizeof(Run) < header.runs)
    fail(file, "this file of names was cut off", file.size());
  if (bytes / sizeof(Run) > header.runs || bytes % sizeof(Run) != 0)
    fail(file, "this file of names is damaged: it is too long", sizeof(header) + header.runs * sizeof(Run));
  return header;
}

// A file is read twice, so that nothing is used before the checksum is known to be right.
void merge_names(const io::File& file, const NamesHeader& header, PagedTable<std::uint32_t>& table) {
  std::vector<Run> runs;
  const auto read = [&](const auto& use) {
    for (std::uint64_t done = 0; done < header.runs; done += runs.size()) {
      runs.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kRunsAtOnce, header.runs - done)));
      file.read_at(sizeof(header) + done * sizeof(Run), std::as_writable_bytes(std::span(runs)));
      use();
    }
  };
  io::RunningChecksum checksum;
  read([&] { checksum.add(std::as_bytes(std::span(runs))); });
  if (checksum.value() != header.runs_checksum) fail(file, "this file of names is damaged", sizeof(header));
  read([&] {
    for (const Run& run : runs) {
      if (run.first > header.vertices || run.count > header.vertices - run.first)
        fail(file, "this file of names is damaged", sizeof(header));
      for (std::uint64_t v = run.first; v < run.first + run.count; ++v) {
        std::uint32_t& entry = table.change(v);
        entry = UseEntry(entry).used_by(static_cast<std::uint32_t>(header.part)).packed();
      }
    }
  });
}

}  // namespace

bool is_names_file(const std::string& path) { return begins_with(path, kNamesMagic); }

void visit_names(RunContext& run, WholeMesh& mesh, std::uint32_t part,
                 const std::function<void(std::uint64_t first, std::uint64_t count)>& visit) {
  const Shares& shares = mesh.info.shares;
  const std::unique_ptr<MeshShare> share = mesh.share(part);
  LastUseOptions options;
  options.block_triangles = shares.size();
  options.allowance_bytes = run.plan.table_bytes;
  options.progress = [&](std::uint64_t read) {
    run.tell({ComputeProgress::Phase::kFinalization, read, share->bytes_total()});
  };
  LastUse uses = *scan_last_use(*share, run.temp, run.budget, options);
  std::vector<std::uint32_t> entries(kRunsAtOnce);
  Run run_now{0, 0};
  for (std::uint64_t first = 0; (first = uses.next_used(first)) < shares.vertices; first += entries.size()) {
    entries.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kRunsAtOnce, shares.vertices - first)));
    uses.read(VertexId(first), entries);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (UseEntry(entries[i]).unused()) continue;
      if (run_now.count != 0 && run_now.first + run_now.count != first + i) {
        visit(run_now.first, run_now.count);
        run_now.count = 0;
      }
      if (run_now.count++ == 0) run_now.first = first + i;
    }
  }
  if (run_now.count != 0) visit(run_now.first, run_now.count);
}

std::uint64_t write_names(const std::string& path, const OutputOptions& output, RunContext& run, WholeMesh& mesh,
                          std::uint32_t part) {
  io::AtomicFile file(path, {.existing = output.existing, .overwrites = true, .temp_folder = output.temp_folder});
  NamesHeader header = header_of(mesh.info, part);
  file.out().append(io::object_bytes(header));
  io::RunningChecksum checksum;
  std::uint64_t names = 0;
  visit_names(run, mesh, part, [&](std::uint64_t first, std::uint64_t count) {
    const Run one{first, count};
    file.out().append(io::object_bytes(one));
    checksum.add(io::object_bytes(one));
    ++header.runs;
    names += count;
  });
  header.runs_checksum = checksum.value();
  header.checksum = io::header_checksum(header);
  file.out().overwrite(0, io::object_bytes(header));
  run.check_inputs();
  file.commit();
  return names;
}

PartUses read_names(std::span<const std::string> files, RunContext& run, const WholeMesh& mesh) {
  std::map<std::uint64_t, std::string> by_part;
  for (const std::string& path : files) {
    io::check_input_file(path);
    const io::File file = io::File::open_for_reading(path);
    const NamesHeader header = read_header(file, mesh.info);
    if (!by_part.emplace(header.part, path).second)
      throw Error(ErrorKind::kBadInput,
                  "the names of part " + std::to_string(header.part + 1) + " are here a second time",
                  "name the file of each part once")
          .at(path);
  }
  for (std::uint64_t part = 0; part < mesh.info.shares.parts; ++part)
    if (!by_part.contains(part))
      throw Error(ErrorKind::kBadInput,
                  "the names of part " + std::to_string(part + 1) + " of " + std::to_string(mesh.info.shares.parts) +
                      " are missing",
                  "make them with `reeb fragment --scan`, and name the files of all parts")
          .at(files[0]);
  PagedTable<std::uint32_t> table = empty_uses(run);
  for (const auto& [part, path] : by_part) {
    run.tell({ComputeProgress::Phase::kFinalization, part, mesh.info.shares.parts});
    const io::File file = io::File::open_for_reading(path);
    merge_names(file, read_header(file, mesh.info), table);
  }
  return uses_of_table(std::move(table), mesh.info.shares,
                       input_changed("the files of names are of other content than the mesh",
                                     "make them again with --scan, and then all parts"));
}

}  // namespace reeb::ooc
