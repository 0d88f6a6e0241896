// Levels of a `.reeb` file: how their thresholds are typed, and what can be read of a file that was cut.
#pragma once

#include <string>

#include "libreeb/base/error.h"
#include "ooc/reeb_file/reeb_file.h"

namespace reeb::tools {

// The threshold of a line of the level table, such that it gives the level when it is typed: six digits, or as many as
// that takes. It is rounded upwards, since a level's threshold is the least.
std::string threshold_text(const ooc::ReebFile& file, const LevelLine& level);

// Whether the file has all that a line of its level table needs, as far as the file knows (ReebFile::damage()).
bool is_whole(const ooc::ReebFile& file, const LevelLine& level);

// The finest level of the table that is whole; null if none is.
const LevelLine* finest_whole_level(const ooc::ReebFile& file);

// Prints a warning if the file is damaged.
void warn_of_damage(const ooc::ReebFile& file);

// Which part of a file was wanted: a level, or the pairs, which are at its end.
enum class FilePart { kLevel, kPairs };

// Whether an error says that what was read is damaged or missing, not that it could not be read.
bool says_damage(const Error& error);

// Whether an error says that the missing part of the file is needed.
bool meets_missing_part(const ooc::ReebFile& file, const Error& error);
// Such an error, with a hint that names the finest whole level.
Error with_whole_level(const ooc::ReebFile& file, const Error& error, FilePart wanted);

// Returns read(), which reads this part of the file. THROWS: what read() throws, as with_whole_level().
template <class Read>
auto read_part(const ooc::ReebFile& file, FilePart part, const Read& read) {
  try {
    return read();
  } catch (const Error& error) {
    if (!meets_missing_part(file, error)) throw;
    throw with_whole_level(file, error, part);
  }
}

}  // namespace reeb::tools
