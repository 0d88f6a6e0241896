// Standard output and standard error, whatever the caller has connected them to.
#pragma once

namespace reeb::tools {

// Call this first.
// - A standard stream that is closed becomes one that cannot be used. Else the next file that is opened would get its
//   number, and messages would be written into that file.
// - Messages that cannot be written (nothing reads them, the disk is full) are lost. The run goes on.
void protect_standard_streams();

// Passes on what was printed. If nothing reads standard output any more, the process ends as by SIGPIPE, quietly.
// THROWS: Error{kResource} if standard output cannot be written.
void finish_standard_output();

// The same question alone, for an error that was caught: ends the process if nothing reads standard output any more.
void end_if_nobody_reads();

}  // namespace reeb::tools
