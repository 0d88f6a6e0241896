#include "tests/fuzz/targets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <sstream>

#include "io/cells/medit_reader.h"
#include "io/cells/msh_reader.h"
#include "io/cells/tetgen_reader.h"
#include "io/events/event_text.h"
#include "io/file/content_source.h"
#include "io/formats/cx_reader.h"
#include "io/formats/obj_reader.h"
#include "io/formats/off_reader.h"
#include "io/formats/open_input.h"
#include "io/formats/stl_reader.h"
#include "io/ply/ply_indexed.h"
#include "io/ply/ply_reader.h"
#include "io/streaming/open_stream.h"
#include "io/streaming/stream_mesh_reader.h"
#include "io/vtk/vtk_reader.h"
#include "ooc/reeb_file/reeb_file.h"
#include "tests/fuzz/corpus.h"
#include "tests/fuzz/image_targets.h"
#include "tests/fuzz/inner_targets.h"
#include "tests/fuzz/legality.h"
#include "tests/fuzz/memory_file.h"
#include "tests/fuzz/memory_source.h"

namespace reeb::test {
namespace {

using namespace reeb::io;

// A few bytes of a compressed file can stand for very many.
constexpr std::uint64_t kMaxEvents = 20'000;
constexpr std::uint64_t kMaxContentBytes = 32u << 20;
constexpr std::size_t kMaxProperties = 3;

template <class Reading>
bool without_error(const Reading& reading) {
  return error_of(reading).empty();
}

Delivered read_batches(MeshReader& reader, std::size_t properties) {
  BatchLegality legality;
  MeshBatch batch;
  bool more = true;
  for (std::uint64_t events = 0; events < kMaxEvents && (more = reader.read(batch));) {
    legality.add(batch, reader.info(), properties);
    events += batch.vertex_count + batch.simplex_count();
  }
  if (!more) {
    expect(batch.empty(), "there is nothing after the end");
    (void)reader.warnings();
    legality.delivered().whole = true;
  }
  return legality.delivered();
}

using OpenMesh = std::unique_ptr<MeshReader> (*)(std::unique_ptr<ContentSource>, const ReadOptions&);

// Reads as a file in large batches; then, usually as a pipe, in small batches and with some properties.
template <OpenMesh open, MemorySource::Kind second = MemorySource::Kind::kPipe>
bool run_mesh(const std::string& bytes) {
  Delivered file, pipe;
  std::string file_format, pipe_format;
  ReadOptions options;
  const bool good = without_error([&] {
    const auto reader = open(std::make_unique<MemorySource>(bytes, MemorySource::Kind::kFile), options);
    file_format = reader->info().format;
    options.properties = reader->info().property_names;
    file = read_batches(*reader, 0);
  });
  const std::size_t shift = bytes.size() % 7;
  if (options.properties.size() > kMaxProperties) options.properties.resize(kMaxProperties);
  const bool asks = shift < 3 && !options.properties.empty();  // the fault might be in their values
  if (!asks) options.properties.clear();
  options.batch_events = std::size_t{1} << shift;
  const std::string pipe_error = error_of([&] {
    const auto reader = open(std::make_unique<MemorySource>(bytes, second), options);
    pipe_format = reader->info().format;
    pipe = read_batches(*reader, options.properties.size());
  });
  // The byte order of a block stream is judged from its content. If the size is known, counts that exceed it help; so
  // damaged bytes can be two different meshes.
  if (!file_format.empty() && !pipe_format.empty() && file_format != pipe_format) return good;
  const bool good_pipe = pipe_error.empty();
  const bool needs_seeking = pipe_error.ends_with("the input can be read only once");
  expect(good_pipe || !good || asks || needs_seeking, "a pipe is read if the file is");
  expect(good || !good_pipe || !pipe.whole, "a file is read if the pipe is");
  if (good && good_pipe && file.whole && pipe.whole) expect(file == pipe, "file and pipe hold the same mesh");
  return good;
}

template <class Reader>
std::unique_ptr<MeshReader> make_reader(std::unique_ptr<ContentSource> source, const ReadOptions& options) {
  return std::make_unique<Reader>(std::move(source), options);
}

std::unique_ptr<MeshReader> open_any(std::unique_ptr<ContentSource> source, const ReadOptions& options) {
  return open_mesh(std::move(source), "input", options);
}

// The vertices are those of a file that stays; the input is the tetrahedra.
std::unique_ptr<MeshReader> open_tetrahedra(std::unique_ptr<ContentSource> source, const ReadOptions& options) {
  return open_tetgen(std::move(source), tetgen_path(), options);
}

const char* stream_name(bool volume) { return volume ? "input.sva" : "input.sma"; }

template <bool volume>
std::unique_ptr<MeshReader> open_stream_mesh(std::unique_ptr<ContentSource> source, const ReadOptions& options) {
  return make_stream_mesh_reader(open_stream(std::move(source), stream_name(volume)), options);
}

template <bool volume>
bool run_stream(const std::string& bytes) {
  std::ostringstream listing;
  const bool good = without_error([&] {
    const auto reader =
        open_stream(std::make_unique<MemorySource>(bytes, MemorySource::Kind::kFile), stream_name(volume));
    EventLegality legality;
    std::string line;
    const StreamEvent* event = nullptr;
    std::uint64_t events = 0;
    while (events++ < kMaxEvents && (event = reader->next()) != nullptr) {
      legality.add(*event, reader->header());
      line.clear();
      append_event(line, *event, reader->header());
      expect(line.size() > 3 && line.ends_with('\n'), "an event is a line of text");
    }
    if (event == nullptr) legality.end();
    (void)reader->warnings();
  });
  const bool good_mesh = run_mesh<open_stream_mesh<volume>>(bytes);
  expect(good == good_mesh || bytes.size() > kMaxEvents / 20, "events and batches agree on what is wrong");
  return good;
}

Delivered read_indexed(IndexedMesh& mesh) {
  Delivered delivered;
  delivered.vertices = mesh.vertex_count();
  std::vector<VertexId> corners;
  std::vector<double> values;
  std::vector<unsigned> columns;
  for (unsigned k = 0; k < mesh.column_count(); ++k) columns.push_back(k);
  while (delivered.simplices < kMaxEvents && mesh.read(corners, 100)) {
    expect(!corners.empty() && corners.size() % 3 == 0 && corners.size() <= 300,
           "triangles come whole, as many as asked for");
    for (const VertexId v : corners) expect(v.value() < mesh.vertex_count(), "a corner exists");
    values.assign(corners.size() * columns.size(), std::numeric_limits<double>::quiet_NaN());
    mesh.gather(corners, columns, values);
    for (const double value : values) expect(std::isfinite(value), "columns are finite");
    delivered.simplices += corners.size() / 3;
  }
  return delivered;
}

bool run_indexed_ply(const std::string& bytes) {
  const MemoryFile file(bytes);
  bool indexed = false;
  Delivered delivered, again, streamed;
  const bool good = without_error([&] {
    const auto mesh = open_mesh(file.path())->indexed();
    indexed = mesh != nullptr;
    if (!indexed) return;
    delivered = read_indexed(*mesh);
    mesh->rewind();
    again = read_indexed(*mesh);
  });
  if (!good || !indexed) return good;
  expect(delivered == again, "a mesh is the same after rewinding");
  const bool good_stream = without_error([&] { streamed = read_batches(*open_mesh(file.path()), 0); });
  // Random access does not read vertices that no face names; the stream does.
  if (good_stream && streamed.whole && delivered.simplices < kMaxEvents)
    expect(streamed.vertices == delivered.vertices && streamed.simplices == delivered.simplices,
           "a mesh has the same size by index and in order");
  return good;
}

bool run_packed(const std::string& bytes) {
  const MemoryFile file(bytes);
  return without_error([&] {
    if (bytes.empty()) throw Error(ErrorKind::kBadInput, "is empty", "fill it").at("input");
    const auto source = open_content(file.path());
    std::uint64_t offset = 0;
    for (std::string_view view; offset < kMaxContentBytes && !(view = source->view(offset, 1 + offset % 1000)).empty();)
      offset += view.size();
    expect(source->file_bytes() == bytes.size(), "the size of a file is known");
    expect(source->file_bytes_read() <= bytes.size(), "no more is read than there is");
  });
}

bool run_reeb(const std::string& bytes) {
  const MemoryFile memory(bytes);
  return without_error([&] {
    const ooc::ReebFile file(memory.path());
    const std::uint32_t steps = file.header().steps;
    for (const std::uint32_t version : {std::uint32_t{0}, steps / 2, steps})
      without_error([&] { (void)file.load(version); });
    without_error([&] { (void)file.load(file.version_at(0.01)); });
    without_error([&] { (void)file.load(file.finest_with_nodes(20)); });
    without_error([&] { (void)file.load(file.finest_with_memory(5000)); });
    without_error([&] { (void)file.pairs(); });
    file.verify();
  });
}

template <class... Endings>
std::vector<std::string> streams(Endings... endings) {
  auto files = samples_ending({endings...});
  for (const std::string ending : {endings...})
    for (std::string& file : written_meshes(ending)) files.push_back(std::move(file));
  return files;
}

constexpr std::string_view kStreamWords[] = {
    "# nverts",   "# nfaces", "# ncells", "# bb_min", "# bb_max", "# svtype tet", "# v_pnum_f", "# v_pnum_i",
    "# c_pnum_f", "v",        "f",        "c",        "x"};
constexpr std::string_view kPlyWords[] = {"element vertex",
                                          "element face",
                                          "element tristrips",
                                          "element other",
                                          "property list uchar int vertex_indices",
                                          "property list int uint vertex_index",
                                          "property list double char odd",
                                          "property double",
                                          "property ushort",
                                          "x",
                                          "y",
                                          "z",
                                          "comment",
                                          "obj_info",
                                          "format ascii 1.0",
                                          "format binary_big_endian 1.0",
                                          "end_header",
                                          "uint8",
                                          "float64"};
constexpr std::string_view kObjWords[] = {"v",      "f",    "l", "p",  "vn", "vt",   "g",  "o",
                                          "usemtl", "\\\n", "/", "//", "#",  "curv", "end"};
constexpr std::string_view kOffWords[] = {"OFF", "STCN4nOFF", "nOFF", "COFF", "BINARY", "#"};
constexpr std::string_view kVtkWords[] = {"POINTS",    "CELLS",        "CELL_TYPES",        "POINT_DATA",
                                          "CELL_DATA", "SCALARS",      "LOOKUP_TABLE",      "VECTORS",
                                          "FIELD",     "OFFSETS",      "METADATA",          "float",
                                          "double",    "vtktypeint64", "UNSTRUCTURED_GRID", "POLYDATA",
                                          "POLYGONS",  "LINES",        "VERTICES",          "string",
                                          "bit",       "CONNECTIVITY", "TRIANGLE_STRIPS",   "unsigned_char"};
constexpr std::string_view kXmlWords[] = {"<Piece ",
                                          "</Piece>",
                                          "<DataArray ",
                                          "</DataArray>",
                                          "<Cells>",
                                          "<Points>",
                                          "<PointData>",
                                          "<!--",
                                          "-->",
                                          "/>",
                                          "format=\"binary\"",
                                          "format=\"appended\" offset=\"",
                                          "type=\"Int32\"",
                                          "type=\"Float64\"",
                                          "Name=\"offsets\"",
                                          "NumberOfCells=\"",
                                          "NumberOfPoints=\"",
                                          "NumberOfComponents=\""};
constexpr std::string_view kMshWords[] = {"$Nodes",    "$EndNodes",    "$Elements", "$EndElements",
                                          "$NodeData", "$EndNodeData", "$Comments"};
constexpr std::string_view kMeditWords[] = {"Vertices",    "Triangles", "Quadrilaterals", "Tetrahedra",
                                            "Hexahedra",   "Prisms",    "Pyramids",       "Edges",
                                            "TrianglesP2", "End",       "Dimension",      "Corners"};
constexpr std::string_view kCxWords[] = {"v", "s", "0", "1", "-0.5", "1e300", "#"};
constexpr std::string_view kStlWords[] = {"solid",   "endsolid", "facet normal 0 0 1", "outer loop", "vertex",
                                          "endloop", "endfacet"};

std::vector<std::string> everything() {
  auto all = streams(".sma", ".smb", ".smc", ".sva", ".svb");
  for (auto* files : {&ascii_ply_files, &obj_files, &off_files, &cx_files, &ascii_stl_files, &binary_stl_files,
                      &vtk_files, &vtk_xml_files, &msh_files, &medit_files})
    for (std::string& file : files()) all.push_back(std::move(file));
  for (const bool big : {false, true})
    for (std::string& file : binary_ply_files(big)) all.push_back(std::move(file));
  return all;
}

std::vector<std::string> all_binary_ply_files() {
  auto files = binary_ply_files(false);
  for (std::string& file : binary_ply_files(true)) files.push_back(std::move(file));
  return files;
}

const std::array<FuzzTarget, 22> kTargets = {{
    {"sma", run_stream<false>, [] { return streams(".sma"); }, kStreamWords, nullptr},
    {"smb", run_stream<false>, [] { return streams(".smb"); }, {}, nullptr},
    {"smc", run_stream<false>, [] { return streams(".smc"); }, {}, nullptr},
    {"sva", run_stream<true>, [] { return streams(".sva"); }, kStreamWords, nullptr},
    {"svb", run_stream<true>, [] { return streams(".svb"); }, {}, nullptr},
    {"ply-ascii", run_mesh<open_ply>, ascii_ply_files, kPlyWords, nullptr},
    {"ply-binary", run_mesh<open_ply>, all_binary_ply_files, kPlyWords, nullptr},
    {"ply-indexed", run_indexed_ply, all_binary_ply_files, kPlyWords, nullptr},
    {"obj", run_mesh<make_reader<ObjReader>>, obj_files, kObjWords, nullptr},
    {"off", run_mesh<open_off>, off_files, kOffWords, nullptr},
    {"cx", run_mesh<make_reader<CxReader>>, cx_files, kCxWords, nullptr},
    {"stl-ascii", run_mesh<make_reader<AsciiStlReader>>, ascii_stl_files, kStlWords, nullptr},
    {"stl-binary", run_mesh<make_reader<BinaryStlReader>>, binary_stl_files, {}, nullptr},
    {"vtk", run_mesh<open_vtk_legacy, MemorySource::Kind::kFile>, vtk_files, kVtkWords, nullptr},
    {"vtk-xml", run_mesh<open_vtk_xml, MemorySource::Kind::kFile>, vtk_xml_files, kXmlWords, nullptr},
    {"msh", run_mesh<open_msh, MemorySource::Kind::kFile>, msh_files, kMshWords, nullptr},
    {"medit", run_mesh<open_medit, MemorySource::Kind::kFile>, medit_files, kMeditWords, nullptr},
    {"tetgen", run_mesh<open_tetrahedra, MemorySource::Kind::kFile>, tetgen_files, {}, nullptr},
    {"gzip", run_packed, gzip_files, {}, nullptr},
    {"zstd", run_packed, zstd_files, {}, nullptr},
    {"any-mesh", run_mesh<open_any, MemorySource::Kind::kFile>, everything, kStreamWords, nullptr},
    {"reeb", run_reeb, reeb_files, {}, fix_reeb_checksums},
}};

}  // namespace

std::span<const FuzzTarget> fuzz_targets() {
  static const std::vector<FuzzTarget> all = [] {
    std::vector<FuzzTarget> targets(kTargets.begin(), kTargets.end());
    for (const FuzzTarget& target : image_fuzz_targets()) targets.push_back(target);
    for (const FuzzTarget& target : inner_fuzz_targets()) targets.push_back(target);
    return targets;
  }();
  return all;
}

const FuzzTarget* find_fuzz_target(std::string_view name) {
  const auto targets = fuzz_targets();
  const auto found = std::ranges::find(targets, name, &FuzzTarget::name);
  return found == targets.end() ? nullptr : &*found;
}

}  // namespace reeb::test
