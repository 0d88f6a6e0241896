// Writes streaming meshes event by event.
//
// The events must be a legal stream (stream_event.h); the first one decides between pre-order and
// post-order. Memory follows the front. Output goes to a stream; a file under its final name is
// the caller's business.
#pragma once

#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "io/events/stream_event.h"

namespace reeb::io {

class StreamWriter {
 public:
  StreamWriter() = default;
  StreamWriter(const StreamWriter&) = delete;
  StreamWriter& operator=(const StreamWriter&) = delete;
  virtual ~StreamWriter() = default;

  // THROWS: Error{kBadInput} for what the format cannot hold: cells of the other kind, and in SMC
  //         non-finite coordinates, repeated corners and post-order.
  virtual void write(const StreamEvent& event) = 0;
  // Ends the file. THROWS: Error{kResource} if something could not be written.
  virtual void close() = 0;
  // What the format could not hold, one line each. Final after close().
  virtual std::vector<std::string> warnings() const { return {}; }
};

// Of the header counts, box, comments, volume and the numbers of values are used; what is unknown
// is left out. Text, SMA or (where header.volume) SVA.
std::unique_ptr<StreamWriter> make_text_writer(std::ostream& out, const StreamHeader& header);
// Little endian, SMB or (where header.volume) SVB. Unknown counts are patched in at the end if the
// output can seek. Finalizations apart from the last cell of a vertex are dropped and counted.
std::unique_ptr<StreamWriter> make_block_writer(std::ostream& out, const StreamHeader& header);

struct SmcOptions {
  unsigned version = 3;         // 3, or 1: only if no edge is left open at the end
  std::uint32_t precision = 0;  // bits a coordinate; 0 is lossless; needs header.box to be a grid
};
// Vertices are numbered anew, in order of first use; isolated ones are dropped and counted.
std::unique_ptr<StreamWriter> make_smc_writer(std::ostream& out, const StreamHeader& header,
                                              const SmcOptions& options = {});

}  // namespace reeb::io
