// Files to start fuzzing from: the samples of streaming meshes if they are available, small meshes from the project's
// own writers, and texts written by hand for what the writers do not use.
#pragma once

#include <string>
#include <vector>

namespace reeb::test {

// All samples with one of these suffixes (".sma"), good and bad.
std::vector<std::string> samples_ending(const std::vector<std::string>& endings);

// A small mesh as files with this suffix, in several forms.
std::vector<std::string> written_meshes(const std::string& ending);

std::vector<std::string> ascii_ply_files();
std::vector<std::string> binary_ply_files(bool big_endian);
std::vector<std::string> obj_files();
std::vector<std::string> cx_files();
std::vector<std::string> off_files();
std::vector<std::string> ascii_stl_files();
std::vector<std::string> binary_stl_files();
std::vector<std::string> vtk_files();
std::vector<std::string> vtk_xml_files();
std::vector<std::string> msh_files();
std::vector<std::string> medit_files();
std::vector<std::string> tetgen_files();
// The name of such a file, beside which there is a file of vertices.
std::string tetgen_path();
std::vector<std::string> gzip_files();
std::vector<std::string> zstd_files();
std::vector<std::string> reeb_files();

// Corrects the checksums and the digest of a `.reeb` file, as far as its frames can be followed.
void fix_reeb_checksums(std::string& bytes);

}  // namespace reeb::test
