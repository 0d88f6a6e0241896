// Where the data of the tests is. A test without its data is skipped.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace reeb::test {

// Streaming meshes with golden listings: part of the repository.
inline std::string sample_folder() { return REEB_SOURCE_DIR "/tests/golden/streaming"; }

// Real meshes, with tables of known facts about them: too large for the repository. The only place where tests look for
// them is $REEB_DATA/meshes if REEB_DATA is set, else next to the checkout.
inline std::string mesh_folder() {
  const char* data = std::getenv("REEB_DATA");
  return std::string(data != nullptr ? data : REEB_SOURCE_DIR "/../shared/data") + "/meshes";
}

inline bool has_meshes() { return std::filesystem::is_directory(mesh_folder()); }

// tests/run.sh --no-skips allows a skip only if its reason begins with "no data:" or "not here:".
inline std::string no_meshes() {
  return std::getenv("REEB_DATA") == nullptr ? "no data: there is no " + mesh_folder() + ", and REEB_DATA is not set"
                                             : "REEB_DATA is set, but there is no " + mesh_folder();
}

#define REEB_REQUIRE_MESHES() \
  if (!reeb::test::has_meshes()) GTEST_SKIP() << reeb::test::no_meshes()

}  // namespace reeb::test
