// Files to start fuzzing from: the samples of streaming meshes where they are there, small meshes by
// the project's own writers, and texts by hand that use what the writers do not.
#pragma once

#include <string>
#include <vector>

namespace reeb::test {

// All samples with one of these endings (".sma"), good and bad.
std::vector<std::string> samples_ending(const std::vector<std::string>& endings);

// The small mesh as a file with this ending, in several forms.
std::vector<std::string> written_meshes(const std::string& ending);

std::vector<std::string> ascii_ply_files();
std::vector<std::string> binary_ply_files(bool big_endian);
std::vector<std::string> obj_files();
std::vector<std::string> off_files();
std::vector<std::string> ascii_stl_files();
std::vector<std::string> binary_stl_files();
std::vector<std::string> gzip_files();
std::vector<std::string> zstd_files();
std::vector<std::string> reeb_files();

// Makes the checksums and the digest of a `.reeb` file right, as far as its frames can be followed.
void mend_reeb_file(std::string& bytes);

}  // namespace reeb::test
