#include "ooc/chunks/last_use_sidecar.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "libreeb/base/error.h"
#include "tests/ooc/chunks/model_mesh.h"
#include "tests/support/scratch.h"

namespace reeb::ooc {
namespace {

namespace fs = std::filesystem;

std::string content_of(const std::string& path) {
  std::string content(fs::file_size(path), '\0');
  std::ifstream(path, std::ios::binary).read(content.data(), static_cast<std::streamsize>(content.size()));
  return content;
}
void put(const std::string& path, const std::string& content) { std::ofstream(path, std::ios::binary) << content; }

class Sidecar : public testing::Test {
 protected:
  Sidecar() : temp_(scratch_.path()), path_(scratch_.path() + "/mesh.ply.final") {
    mesh_.columns.assign(3, std::vector<double>(mesh_.vertex_count() + 5));  // five unused ones
    ModelIndexedMesh indexed(mesh_);
    uses_ = scan_last_use(indexed, temp_, budget_, {.block_triangles = 64});
  }
  SidecarLoad load(const MeshIdentity& identity) {
    return load_sidecar(path_, identity, mesh_.vertex_count(), temp_, budget_, 0);
  }
  std::vector<std::uint32_t> table_of(LastUse& uses) const {
    std::vector<std::uint32_t> entries(mesh_.vertex_count());
    uses.read(VertexId(0), entries);
    return entries;
  }

  const Scratch scratch_;
  const io::TempDir temp_;
  MemoryBudget budget_;
  std::string path_;
  ModelMesh mesh_ = grid_mesh(60, 50);
  std::optional<LastUse> uses_;
  const MeshIdentity identity_{123, 456, 789};
};

TEST_F(Sidecar, GivesBackWhatWasSaved) {
  save_sidecar(path_, identity_, *uses_);
  SidecarLoad loaded = load(identity_);
  ASSERT_TRUE(loaded.uses.has_value()) << loaded.note;
  EXPECT_EQ(loaded.uses->summary(), uses_->summary());
  EXPECT_EQ(table_of(*loaded.uses), table_of(*uses_));
  EXPECT_EQ(std::distance(fs::directory_iterator(scratch_.path()), {}), 1) << "nothing else is left";
}

TEST_F(Sidecar, AMissingOneNeedsNoNote) {
  const SidecarLoad loaded = load(identity_);
  EXPECT_FALSE(loaded.uses.has_value());
  EXPECT_EQ(loaded.note, "");
}

TEST_F(Sidecar, AStaleOneIsIgnoredWithANote) {
  save_sidecar(path_, identity_, *uses_);
  for (const MeshIdentity& other :
       {MeshIdentity{124, 456, 789}, MeshIdentity{123, 457, 789}, MeshIdentity{123, 456, 788}}) {
    const SidecarLoad loaded = load(other);
    EXPECT_FALSE(loaded.uses.has_value());
    EXPECT_NE(loaded.note.find("another state"), std::string::npos);
  }
  EXPECT_FALSE(load_sidecar(path_, identity_, 7, temp_, budget_, 0).uses.has_value());
}

TEST_F(Sidecar, EveryPrefixAndEveryFlippedByteIsIgnoredWithANote) {
  save_sidecar(path_, identity_, *uses_);
  const std::string whole = content_of(path_);
  ASSERT_GT(whole.size(), 200u);
  for (std::size_t size = 0; size < whole.size(); size += 1 + size / 40) {
    put(path_, whole.substr(0, size));
    const SidecarLoad loaded = load(identity_);
    EXPECT_FALSE(loaded.uses.has_value()) << "prefix " << size;
    EXPECT_NE(loaded.note, "");
  }
  for (std::size_t at = 0; at < whole.size(); at += 1 + at / 200) {
    std::string bad = whole;
    bad[at] = static_cast<char>(bad[at] ^ 0x41);
    put(path_, bad);
    EXPECT_FALSE(load(identity_).uses.has_value()) << "byte " << at;
  }
  put(path_, whole + "x");
  EXPECT_FALSE(load(identity_).uses.has_value());
}

TEST_F(Sidecar, AFolderThatCannotBeWrittenIsAResourceErrorNamingTheOption) {
  try {
    save_sidecar(scratch_.path() + "/none/mesh.final", identity_, *uses_);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::kResource);
    EXPECT_NE(e.hint().find("--sidecar"), std::string::npos);
  }
}

TEST(MeshIdentity, SeesSizeTimeAndContent) {
  const Scratch scratch;
  const std::string path = scratch.path() + "/mesh";
  const auto time = fs::file_time_type::clock::now();
  const auto identity_of = [&](const std::string& content) {
    put(path, content);
    fs::last_write_time(path, time);
    return identify_mesh(path);
  };
  std::string content(3 << 20, 'a');
  const MeshIdentity before = identity_of(content);
  EXPECT_EQ(identity_of(content), before);
  content.back() = 'b';
  EXPECT_NE(identity_of(content).digest, before.digest);
  EXPECT_NE(identity_of("short").bytes, before.bytes);
  EXPECT_EQ(identity_of("").bytes, 0u);
  fs::last_write_time(path, time - std::chrono::hours(1));
  EXPECT_NE(identify_mesh(path).changed_ns, before.changed_ns);
  EXPECT_THROW(identify_mesh(scratch.path() + "/none"), Error);
}

TEST(MeshIdentity, IsThatOfOneFileIfAnotherGetsItsName) {
  const Scratch scratch;
  const std::string path = scratch.path() + "/mesh", other = scratch.path() + "/other";
  put(path, "the first");
  put(other, "the second one");
  const auto time = fs::last_write_time(path);
  fs::last_write_time(other, time - std::chrono::hours(1));
  const MeshIdentity first = identify_mesh(path), second = identify_mesh(other);
  const io::File opened = io::File::open_for_reading(path);
  fs::rename(other, path);
  EXPECT_EQ(identify_mesh(opened), first);
  EXPECT_EQ(identify_mesh(path), second);
}

}  // namespace
}  // namespace reeb::ooc
