// The sample files of streaming meshes, and the results expected from them.
#pragma once

#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "io/events/event_text.h"
#include "io/streaming/open_stream.h"
#include "libreeb/base/error.h"
#include "tests/support/bytes_source.h"
#include "tests/support/data.h"
#include "tests/support/files.h"

namespace reeb::io {

struct Sample {
  std::string file, verdict, warnings;

  bool good() const { return verdict == "OK"; }
};

inline std::string sample_bytes(const std::string& file) { return test::read_file(test::sample_folder() + "/" + file); }
inline std::string golden_events(const std::string& file) { return sample_bytes(file + ".events.txt"); }

// The rows of the manifest.
inline std::vector<Sample> all_samples() {
  std::ifstream in(test::sample_folder() + "/MANIFEST.tsv");
  std::vector<Sample> samples;
  std::string line;
  std::getline(in, line);  // names of the columns
  while (std::getline(in, line)) {
    std::istringstream row(line);
    Sample sample;
    std::getline(row, sample.file, '\t');
    std::getline(row, sample.verdict, '\t');
    std::getline(row, sample.warnings, '\t');
    samples.push_back(sample);
  }
  return samples;
}

// The bytes must outlive the reader.
inline std::unique_ptr<EventReader> open_bytes(const std::string& bytes, const std::string& name = {}) {
  return open_stream(std::make_unique<test::BytesSource>(bytes), name);
}
std::unique_ptr<EventReader> open_bytes(std::string&& bytes, const std::string& name = {}) = delete;

// Writes all events of a stream as text. Those before an error are written, too.
inline void write_all_events(EventReader& reader, std::ostream& out) {
  while (const StreamEvent* event = reader.next()) {
    std::string line;
    append_event(line, *event, reader.header());
    out << line;
  }
}

// All events as text, and the error that ended them, if any.
struct Outcome {
  std::string events, error;
  std::vector<std::string> warnings;
};

inline Outcome read_all(const std::string& bytes, const std::string& name = {}) {
  Outcome outcome;
  std::ostringstream out;
  try {
    const auto reader = open_bytes(bytes, name);
    try {
      write_all_events(*reader, out);
    } catch (...) {
      outcome.events = out.str();
      throw;
    }
    outcome.warnings = reader->warnings();
  } catch (const Error& error) {
    outcome.error = error.message();
  }
  if (outcome.error.empty()) outcome.events = out.str();
  return outcome;
}

}  // namespace reeb::io
