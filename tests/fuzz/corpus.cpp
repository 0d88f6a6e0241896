#include "tests/fuzz/corpus.h"

#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <boost/iostreams/filter/gzip.hpp>
#include <boost/iostreams/filtering_stream.hpp>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <sstream>

#include "io/file/checksum.h"
#include "io/formats/create_mesh.h"
#include "io/streaming/create_stream.h"
#include "libreeb/format/reeb_format.h"
#include "ooc/reeb_writer/reeb_file_writer.h"
#include "tests/io/streaming/samples.h"
#include "tests/ooc/reeb_file/made_up_hierarchy.h"
#include "tests/support/files.h"
#include "tests/support/inputs/complex_mesh.h"
#include "tests/support/inputs/shapes.h"

namespace reeb::test {
namespace {

namespace fs = std::filesystem;

// A folder that lives as long as the program.
const fs::path& scratch() {
  struct Folder {
    fs::path path = fs::temp_directory_path() / ("reeb-fuzz-" + std::to_string(::getpid()));
    Folder() { fs::create_directories(path); }
    ~Folder() { fs::remove_all(path); }
  };
  static const Folder folder;
  return folder.path;
}

void append(std::vector<std::string>& to, std::vector<std::string> more) {
  std::move(more.begin(), more.end(), std::back_inserter(to));
}

std::string written(const Complex& complex, const std::string& ending, bool finalize) {
  const std::string path = scratch() / ("mesh" + ending);
  const ComplexMesh mesh(complex);
  MeshBatch batch;
  batch.vertex_count = mesh.vertex_count();
  batch.coordinates.assign(mesh.columns.begin(), mesh.columns.begin() + 3);
  batch.properties = {mesh.columns[3]};
  for (const auto& corners : mesh.simplices)
    if (!io::is_volume_name(path) || corners.size() == 4)
      batch.simplices[corners.size() - 1].insert(batch.simplices[corners.size() - 1].end(), corners.begin(),
                                                 corners.end());
  for (std::uint64_t v = 0; finalize && v < mesh.vertex_count(); ++v) batch.finalized.emplace_back(v);
  io::MeshWriterOptions options;
  options.property_names = {"value"};
  options.existing = io::Existing::kReplace;
  const auto writer = io::create_mesh(path, options);
  writer->write(batch);
  writer->close();
  return read_file(path);
}

template <class T>
void append_scalar(std::string& out, T value, bool big_endian) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof value);
  if (big_endian) std::reverse(bytes.begin(), bytes.end());
  out.append(bytes.data(), bytes.size());
}

Complex two_tetrahedra() {
  Complex complex = make_complex({0, 1, 2, 3, 4}, {{0, 1, 2, 3}, {1, 2, 3, 4}});
  for (std::size_t i = 0; i < complex.vertex_count(); ++i)
    complex.positions[i] = {static_cast<double>(i % 2), static_cast<double>(i / 2), 0.25};
  return complex;
}

const std::string kPlyFaces = "element face 2\nproperty list uchar int vertex_indices\nend_header\n";

}  // namespace

std::vector<std::string> samples_ending(const std::vector<std::string>& endings) {
  std::vector<std::string> files;
  for (const io::Sample& sample : io::all_samples())
    for (const std::string& ending : endings)
      if (sample.file.ends_with(ending)) files.push_back(io::sample_bytes(sample.file));
  return files;
}

std::vector<std::string> written_meshes(const std::string& ending) {
  std::vector<std::string> files;
  for (const bool finalize : {false, true})
    for (const Complex& complex : {upright_torus(4, 3), book(3), fan(5, true), two_tetrahedra()})
      files.push_back(written(complex, ending, finalize));
  return files;
}

std::vector<std::string> ascii_ply_files() {
  const std::string head = "ply\nformat ascii 1.0\ncomment by hand\n";
  return {
      head + "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n" + kPlyFaces +
          "0 0 0\n1 0 0.5\n0 1 -1e-3\n1 1 2\n3 0 1 2\n4 0 1 3 2\n",
      head + "element vertex 3\nproperty double x\nproperty double y\nproperty uchar quality\n" + kPlyFaces +
          "0 0 7\n1 nan 8\n0 1 9\n3 0 1 2\n1 2\n",
      head +
          "element camera 2\nproperty list uchar float view\nproperty int id\nelement vertex 3\nproperty float x\n"
          "property float y\nproperty float z\nproperty list uint8 int8 marks\nelement tristrips 1\n"
          "property list int int vertex_indices\nend_header\n2 0.5 1 3\n0 4\n0 0 0 1 5\n1 0 0 0\n0 1 1 2 1 2\n"
          "7 0 1 2 -1 2 1 0\n",
      "ply\r\nformat ascii 1.0\r\nelement face 1\r\nproperty list uchar uint vertex_index\r\nproperty uchar red\r\n"
      "element vertex 3\r\nproperty float z\r\nproperty float y\r\nproperty float x\r\nend_header\r\n3 0 1 2 255\r\n"
      "0 0 0\r\n1 1 1\r\n2 2 0\r\n"};
}

std::vector<std::string> binary_ply_files(bool big_endian) {
  const std::string head = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") + "_endian 1.0\n";
  std::string plain = head + "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n" + kPlyFaces;
  for (int i = 0; i < 12; ++i) append_scalar(plain, static_cast<float>(i * i % 7), big_endian);
  for (const std::initializer_list<int> face : {std::initializer_list<int>{0, 1, 2}, {0, 1, 3, 2}}) {
    plain += static_cast<char>(face.size());
    for (const int corner : face) append_scalar(plain, corner, big_endian);
  }
  std::string rich = head +
                     "element camera 1\nproperty short w\nelement vertex 3\nproperty uchar flag\nproperty double x\n"
                     "property double y\nproperty double z\nproperty ushort quality\nelement tristrips 1\n"
                     "property list uint int vertex_indices\nelement face 1\nproperty float weight\n"
                     "property list uchar ushort vertex_indices\nproperty list uchar float uv\nend_header\n";
  append_scalar(rich, std::int16_t{9}, big_endian);
  for (int i = 0; i < 3; ++i) {
    rich += static_cast<char>(i);
    for (int k = 0; k < 3; ++k) append_scalar(rich, static_cast<double>(i == k), big_endian);
    append_scalar(rich, static_cast<std::uint16_t>(100 * i), big_endian);
  }
  append_scalar(rich, std::uint32_t{5}, big_endian);
  for (const int corner : {0, 1, 2, -1, 0}) append_scalar(rich, corner, big_endian);
  append_scalar(rich, 0.5F, big_endian);
  rich += '\3';
  for (std::uint16_t corner = 0; corner < 3; ++corner) append_scalar(rich, corner, big_endian);
  rich += '\2';
  for (const float u : {0.25F, 0.75F}) append_scalar(rich, u, big_endian);
  std::vector<std::string> files = {plain, rich};
  if (!big_endian) append(files, written_meshes(".ply"));
  return files;
}

std::vector<std::string> cx_files() {
  return {"# a tetrahedron in the plane\nv 0 0\nv 1 0\nv 0 1 # c\nv 0.25 0.25\ns 0 1 2 3\ns 1\ns 0 3\n",
          "v 0 1 2 3 4 5 6 7 8\nv 1 1 1 1 1 1 1 1 1\ns 0 1 1 0 1 0 1 0 1\ns 0 1 0\nv -1e9 1 1 1 1 1 1 1 1\ns 2 0 1\n",
          "v 1\nv 2\ns 0 1\nv 3\ns 1 2\r\n\n"};
}

std::vector<std::string> obj_files() {
  std::vector<std::string> files = {
      "# by hand\nmtllib a.mtl\no one\nv 0 0 0\nv 1 0 0 1.0\nv 0 1 0 0.5 0.5 0.5\nvt 0 0\nvn 0 0 1\ng part\nusemtl m\n"
      "f 1/1/1 2/1/1 3/1/1\nf -1//1 -2//1 -3//1\nl 1 2 3\np 1\ns off\n",
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 \\\n 2 3\nv 5 5 5e-1\r\nf 5 1 1\r\n"};
  append(files, written_meshes(".obj"));
  return files;
}

std::vector<std::string> off_files() {
  std::vector<std::string> files = {
      "OFF\n# by hand\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 .5\n3 0 1 2 255 0 0\n4 0 1 3 2\n",
      "STCNOFF 3 1 3\n0 0 0 0 0 1 1 1 1 1 0 0\n1 0 0 0 0 1 1 1 1 1 0 0\n0 1 0 0 0 1 1 1 1 1 0 0\n3 0 1 2 1 0 0\n",
      "4OFF\n3 1 0\n0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2\n", "nOFF\n2\n3 2 0\n0 0\n1 0\n0 1\n3 0 1 2\n2 0 1\n"};
  std::string binary = "OFF BINARY\n";
  for (const int count : {3, 2, 0}) append_scalar(binary, count, true);
  for (int i = 0; i < 9; ++i) append_scalar(binary, static_cast<float>(i % 4), true);
  for (const int number : {3, 0, 1, 2, 1}) append_scalar(binary, number, true);
  append_scalar(binary, 0.5F, true);
  for (const int number : {2, 0, 1, 0}) append_scalar(binary, number, true);
  files.push_back(binary);
  append(files, written_meshes(".off"));
  return files;
}

std::vector<std::string> ascii_stl_files() {
  return {
      "solid one\nfacet normal 0 0 nan\n outer loop\n  vertex 0 0 0\n  vertex 1 -0 0\n  vertex 0 1 0\n "
      "endloop\nendfacet\n"
      "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 0 1e-3\n endloop\nendfacet\n"
      "endsolid one\nsolid two\nendsolid two\n",
      "SOLID\r\nFACET NORMAL 0 0 1\r\nOUTER LOOP\r\nVERTEX 0 0 0\r\nVERTEX 1 0 0\r\nVERTEX 1 0 "
      "0\r\nENDLOOP\r\nENDFACET\r\n"
      "ENDSOLID\r\n",
      "solid\nendsolid\n"};
}

std::vector<std::string> binary_stl_files() {
  std::vector<std::string> files;
  for (const std::uint32_t facets : {0u, 1u, 5u, 40u}) {
    std::string bytes = "solid but binary";
    bytes.resize(80, ' ');
    append_scalar(bytes, facets, false);
    for (std::uint32_t i = 0; i < facets; ++i) {
      for (std::uint32_t k = 0; k < 12; ++k) append_scalar(bytes, static_cast<float>(i * k % 5), false);
      append_scalar(bytes, std::uint16_t{0}, false);
    }
    files.push_back(bytes);
  }
  return files;
}

std::vector<std::string> gzip_files() {
  std::vector<std::string> files;
  for (const std::string& content : obj_files()) {
    std::ostringstream out;
    boost::iostreams::filtering_ostream chain;
    boost::iostreams::gzip_params params;
    if (files.size() % 2 == 0) params.file_name = "a.obj";
    chain.push(boost::iostreams::gzip_compressor(params));
    chain.push(out);
    chain << content;
    boost::iostreams::close(chain);
    files.push_back(out.str());
  }
  files.push_back(files[0] + files[1]);
  return files;
}

std::vector<std::string> zstd_files() {
  std::vector<std::string> files;
  for (const std::string& content : obj_files()) {
    const std::unique_ptr<ZSTD_CCtx, std::size_t (*)(ZSTD_CCtx*)> context(ZSTD_createCCtx(), &ZSTD_freeCCtx);
    ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, static_cast<int>(files.size() % 2));
    std::string packed(ZSTD_compressBound(content.size()), '\0');
    packed.resize(ZSTD_compress2(context.get(), packed.data(), packed.size(), content.data(), content.size()));
    files.push_back(packed);
  }
  files.push_back(files[0] + files[1]);
  files.push_back(std::string("\x50\x2A\x4D\x18\x03\0\0\0abc", 11) + files[0]);  // a skippable frame
  return files;
}

std::vector<std::string> reeb_files() {
  std::vector<std::string> files;
  const std::string path = scratch() / "graph.reeb";
  for (std::uint32_t seed = 0; seed < 24; ++seed) {
    const std::uint32_t size = seed * seed / 4;
    const MadeUp made = MadeUpMaker(seed).make(size, size * 2, size / 2);
    ooc::FileMeta meta;
    meta.function_max = 1;
    const ArcBucketsView buckets = seed % 2 == 0 ? ArcBucketsView{} : made.buckets.view();
    if (seed % 4 == 3)
      ooc::write_graph_file(path, meta, made.graph);
    else
      ooc::write_hierarchy_file(path, meta, made.graph, made.hierarchy, buckets);
    files.push_back(read_file(path));
  }
  return files;
}

namespace {

std::uint64_t load(const std::string& bytes, std::size_t at, std::size_t width) {
  std::uint64_t value = 0;
  std::memcpy(&value, bytes.data() + at, width);
  return value;
}

void store_checksum(std::string& bytes, std::size_t at, std::uint64_t value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

std::uint64_t checksum_of(const std::string& bytes, std::size_t begin, std::size_t end) {
  return io::checksum(std::as_bytes(std::span(bytes)).subspan(begin, end - begin));
}

}  // namespace

void fix_reeb_checksums(std::string& bytes) {
  if (bytes.size() < kFixedHeaderBytes + kChecksumBytes) return;
  const std::uint64_t region = load(bytes, 16, 8);
  if (region < kFixedHeaderBytes + kChecksumBytes || region > bytes.size()) return;
  io::RunningChecksum digest;
  std::size_t at = region;
  const std::uint64_t frames = load(bytes, 144, 4) + load(bytes, 148, 4);
  for (std::uint64_t i = 0; i < frames && at + kFrameHeaderBytes <= bytes.size(); ++i) {
    const std::size_t stored = load(bytes, at + 4, 4);
    const std::size_t payload = at + kFrameHeaderBytes;
    if (stored > bytes.size() - payload) break;
    std::string covered = bytes.substr(at, kFrameHeaderBytes - kChecksumBytes) + bytes.substr(payload, stored);
    store_checksum(bytes, payload - kChecksumBytes, checksum_of(covered, 0, covered.size()));
    digest.add(std::as_bytes(std::span(bytes)).subspan(payload, stored));
    at = payload + stored;
  }
  store_checksum(bytes, 128, digest.value());
  store_checksum(bytes, region - kChecksumBytes, checksum_of(bytes, 0, region - kChecksumBytes));
  const std::size_t table = at + 8 * frames + 8;
  if (table <= bytes.size() - kChecksumBytes && table > at) store_checksum(bytes, table, checksum_of(bytes, at, table));
}

}  // namespace reeb::test
