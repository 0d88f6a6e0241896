// Writes streaming meshes event by event.
//
// A StreamWriter takes events, and so everything that a streaming mesh can have: post-order, integers, values of cells,
// finalizations in any place. A MeshWriter (libreeb/port/mesh_writer.h) takes the batches of any mesh, which have none
// of these but are fast to pass on; the one of streaming formats (create_stream.h) turns batches into events.
//
// The events must be a legal stream (stream_event.h); the first one decides between pre-order and post-order. Output
// goes to a stream: giving a file its final name is left to the caller.
// MEMORY: follows the front.
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
  // What the format could not hold, one line each. Complete after close().
  virtual std::vector<std::string> warnings() const { return {}; }
};

// Text: SMA or (if header.volume) SVA. Uses the counts, box, comments, volume and numbers of values of the header;
// unknown ones are left out of the file.
std::unique_ptr<StreamWriter> make_text_writer(std::ostream& out, const StreamHeader& header);
// Little endian: SMB or (if header.volume) SVB. Counts that are wrong or not known yet are patched in at the end if the
// output can seek. A finalization that is not directly after a cell of its vertex cannot be stored: it is dropped and
// counted.
std::unique_ptr<StreamWriter> make_block_writer(std::ostream& out, const StreamHeader& header);

struct SmcOptions {
  unsigned version = 3;         // 3; or 1, which requires that no edge is open at the end
  std::uint32_t precision = 0;  // bits per coordinate; 0 is lossless; a grid needs header.box
};
// Vertices are renumbered in order of first use; isolated ones are dropped and counted.
std::unique_ptr<StreamWriter> make_smc_writer(std::ostream& out, const StreamHeader& header,
                                              const SmcOptions& options = {});

}  // namespace reeb::io
