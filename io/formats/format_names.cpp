#include "io/formats/format_names.h"

#include <array>
#include <utility>

#include "io/images/image_format.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

constexpr std::array<std::pair<std::string_view, MeshFormat>, 16> kNames = {{{"ply", MeshFormat::kPly},
                                                                             {"obj", MeshFormat::kObj},
                                                                             {"off", MeshFormat::kOff},
                                                                             {"stl", MeshFormat::kBinaryStl},
                                                                             {"sma", MeshFormat::kStreaming},
                                                                             {"smb", MeshFormat::kStreaming},
                                                                             {"smc", MeshFormat::kStreaming},
                                                                             {"sva", MeshFormat::kStreaming},
                                                                             {"svb", MeshFormat::kStreaming},
                                                                             {"cx", MeshFormat::kCx},
                                                                             {"vtk", MeshFormat::kVtkLegacy},
                                                                             {"vtu", MeshFormat::kVtkXml},
                                                                             {"vtp", MeshFormat::kVtkXml},
                                                                             {"msh", MeshFormat::kMsh},
                                                                             {"medit", MeshFormat::kMedit},
                                                                             {"tetgen", MeshFormat::kTetgen}}};

MeshFormat format_of(const std::string& name) {
  std::string known;
  for (const auto& [entry, format] : kNames) {
    if (entry == name) return format;
    known.append(known.empty() ? "" : ", ").append(entry);
  }
  known.append(", nrrd, nifti, mha, vti, npy, asc, raw");
  throw Error(ErrorKind::kUsage, "'" + name + "' is not a format of meshes", "choose one of " + known);
}

}  // namespace

void check_format_name(const std::string& name) {
  if (!image_format_named(name)) (void)format_of(name);
}

MeshFormat chosen_format(const std::string& name, ContentSource& source) {
  const MeshFormat format = format_of(name);
  // A stream may come slowly, so little of it is waited for.
  constexpr std::size_t kMarkBytes = 16;
  const auto marked = marked_content(source, format == MeshFormat::kStreaming ? kMarkBytes : ContentSource::kLookahead);
  if (marked && marked->format != format)
    throw Error(ErrorKind::kBadInput, "its content is " + std::string(marked->name) + ", but --format says " + name,
                "--format is the format of the mesh that is read; leave it out")
        .at(source.name());
  return format == MeshFormat::kBinaryStl && is_text_stl(source) ? MeshFormat::kAsciiStl : format;
}

std::string name_for_streams(const std::string& path, const std::string& format) {
  return format.empty() ? path : "mesh." + format;
}

}  // namespace reeb::io
