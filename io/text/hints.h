// What errors of all readers say about a file that is cut or damaged.
#pragma once

namespace reeb::io {

inline constexpr const char* kCutHint = "the file is cut; get a whole copy";
inline constexpr const char* kCutOrDamagedHint = "the file is cut or damaged; get a whole copy";
inline constexpr const char* kCutOrHeaderHint = "the file is cut, or its header is damaged; get a whole copy";
inline constexpr const char* kHeaderHint = "fix the header, or write the file again";
inline constexpr const char* kDamagedHereHint = "the file may be damaged here";
inline constexpr const char* kCutOrDamagedHereHint = "the file may be cut or damaged here";
// A note, of formats that do not say how much is to come.
inline constexpr const char* kOpenLineNote = "the last line has no line end; the file may be cut there";

}  // namespace reeb::io
