// A web server for one page and one file, for programs of this computer only.
//
// It is written by hand, since a library costs every run of the program: cpp-httplib, as Debian packages it, loads
// OpenSSL and Brotli, which keep 4 MiB resident.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "io/file/file.h"

namespace reeb::tools {

// Listens on 127.0.0.1 from the constructor on. It answers only requests that name this computer as their host and
// whose path begins with a random word, so neither other pages nor other users can read the file: not even its name.
class FileServer {
 public:
  // REQUIRES: the page has a <head>. The file stays open, so it can be replaced or removed meanwhile. Port 0: any free
  // one.
  // THROWS: Error{kBadInput} if the file cannot be opened, Error{kResource} if the port cannot be used.
  FileServer(std::string_view page, const std::string& file, std::uint16_t port);
  FileServer(const FileServer&) = delete;
  FileServer& operator=(const FileServer&) = delete;
  ~FileServer();

  // Of the page, which opens the file.
  const std::string& address() const { return address_; }

  // Answers requests, several at a time, until `stop` returns true; it is asked a few times a second. A client whose
  // request takes longer than `patience` gets no answer, nor does one that takes nothing of it for so long.
  void serve(const std::function<bool()>& stop, std::chrono::milliseconds patience = std::chrono::seconds(20));

 private:
  class Connections;

  void answer(int socket, std::chrono::milliseconds patience) const;
  void send_file(int socket, std::uint64_t begin, std::uint64_t end) const;

  io::File file_;
  std::uint64_t file_bytes_ = 0;
  int socket_ = -1;
  std::string port_, token_, name_, address_, page_;
};

}  // namespace reeb::tools
