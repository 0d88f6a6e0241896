#include "tools/defects/patch_files.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "io/file/file.h"
#include "io/file/file_ostream.h"
#include "io/text/words.h"
#include "libreeb/base/error.h"
#include "tools/defects/cut_patches.h"

namespace reeb::tools {
namespace {

constexpr std::size_t kMostVertices = 200'000;

std::string name(const std::string& folder, std::size_t rank, const char* ending) {
  return fmt::format("{}/defect-{}{}.ply", folder, rank, ending);
}

// Whether a row of some rank has a file of this name.
bool is_patch_name(std::string_view name) {
  constexpr std::string_view kBegin = "defect-", kEnd = ".ply", kCurves = "-curves";
  if (!name.starts_with(kBegin) || !name.ends_with(kEnd) || name.size() < kBegin.size() + kEnd.size()) return false;
  std::string_view rank = name.substr(kBegin.size(), name.size() - kBegin.size() - kEnd.size());
  if (rank.ends_with(kCurves)) rank.remove_suffix(kCurves.size());
  return !rank.starts_with('0') && io::whole_number<std::uint64_t>(rank).has_value();
}

// From blue by white to red.
std::array<int, 3> color(double part) {
  const auto level = [](double x) { return static_cast<int>(std::lround(255 * std::clamp(x, 0.0, 1.0))); };
  return {level(2 * part), level(1 - std::abs(2 * part - 1)), level(2 - 2 * part)};
}

void write_file(const std::string& path, io::Existing existing, const std::string& text) {
  io::AtomicFile file(path, {.existing = existing});
  io::FileOstream stream(file.out());
  stream << text;
  stream.flush();
  file.commit();
}

std::string surface_text(const SurfacePatch& patch, std::span<const double> values) {
  const auto [least, most] = std::ranges::minmax(values);
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty double value\n"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      patch.vertex_count(), patch.triangle_count());
  for (std::uint32_t v = 0; v < patch.vertex_count(); ++v) {
    const Point& p = patch.position(v);
    const auto [r, g, b] = color(most > least ? (values[v] - least) / (most - least) : 0.5);
    text += fmt::format("{} {} {} {} {} {} {}\n", p[0], p[1], p[2], r, g, b, values[v]);
  }
  for (std::uint32_t t = 0; t < patch.triangle_count(); ++t) {
    const auto& c = patch.triangle(t);
    text += fmt::format("3 {} {} {}\n", c[0], c[1], c[2]);
  }
  return text;
}

std::string curves_text(const SurfacePatch& patch, const DefectRow& row) {
  std::string vertices, edges;
  std::size_t vertex_count = 0, edge_count = 0;
  for (const auto* path : {&row.curve.path, &row.other_path}) {
    std::vector<std::uint32_t> local;
    for (const VertexId vertex : *path) local.push_back(patch.find(vertex));
    // A curve that leaves the file is not drawn in part.
    if (local.empty() || std::ranges::find(local, SurfacePatch::kNone) != local.end()) continue;
    const char* rgb = path == &row.curve.path ? "255 0 0" : "0 160 0";
    for (std::size_t i = 0; i < local.size(); ++i) {
      const Point& p = patch.position(local[i]);
      vertices += fmt::format("{} {} {} {}\n", p[0], p[1], p[2], rgb);
      edges += fmt::format("{} {} {}\n", vertex_count + i, vertex_count + (i + 1) % local.size(), rgb);
    }
    vertex_count += local.size();
    edge_count += local.size();
  }
  return fmt::format(
             "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
             "property uchar red\nproperty uchar green\nproperty uchar blue\nelement edge {}\n"
             "property int vertex1\nproperty int vertex2\nproperty uchar red\nproperty uchar green\n"
             "property uchar blue\nend_header\n",
             vertex_count, edge_count) +
         vertices + edges;
}

// As io::require_output_folder(), in the words of the option.
void require_place(const std::string& path) {
  try {
    io::require_output_folder(path);
  } catch (const Error& error) {
    std::error_code failure;
    const bool is_there = std::filesystem::exists(error.file(), failure);
    throw Error(error.kind(), is_there ? error.message() : "this folder does not exist",
                is_there ? "name a folder that can be written with --patches DIR"
                         : "create it, or name another folder with --patches DIR")
        .at(error.file());
  }
}

}  // namespace

void add_patches(const std::string& folder, io::Existing existing, RunFiles& files) {
  std::error_code failure;
  if (!std::filesystem::exists(folder, failure)) {
    require_place(folder);
    files.add_output(folder, "the folder of patches", existing);
  }
  files.add_series({folder, "a patch", is_patch_name, existing});
}

void check_patch_folder(const std::string& folder, io::Existing existing) {
  namespace fs = std::filesystem;
  std::error_code failure;
  if (!fs::exists(folder, failure)) {
    require_place(folder);
    return;
  }
  if (!fs::is_directory(folder, failure))
    throw Error(ErrorKind::kResource, "it is not a folder", "name a folder for the patches").at(folder);
  require_place(name(folder, 1, ""));
  std::vector<std::string> patches;
  io::for_each_name(folder, [&](const std::string& file) {
    if (is_patch_name(file)) patches.push_back(folder + "/" + file);
  });
  std::sort(patches.begin(), patches.end());
  for (const std::string& path : patches) io::check_output_name(path, existing);
}

void write_patches(const ValuedMesh& mesh, const Defects& defects, std::span<const RankedRow> rows,
                   const std::string& folder, io::Existing existing) {
  check_patch_folder(folder, existing);
  std::error_code failure;
  std::filesystem::create_directory(folder, failure);
  if (failure)
    throw Error(ErrorKind::kResource, "the folder cannot be created: " + failure.message(),
                "name a folder that can be written")
        .at(folder);
  std::vector<const DefectRow*> plain;
  for (const RankedRow& ranked : rows) plain.push_back(ranked.row);
  cut_patches(mesh, defects, plain, kMostVertices, [&](std::size_t i, const ooc::CollectedSurface::Patch& patch) {
    const DefectRow& row = *plain[i];
    write_file(name(folder, rows[i].rank, ""), existing, surface_text(patch.surface, patch.values[row.function]));
    write_file(name(folder, rows[i].rank, "-curves"), existing, curves_text(patch.surface, row));
  });
}

}  // namespace reeb::tools
