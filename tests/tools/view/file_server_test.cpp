#include "tools/view/file_server.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <thread>

#include "tests/support/files.h"
#include "tests/support/scratch.h"

namespace reeb::tools {
namespace {

using namespace std::chrono_literals;

class Client {
 public:
  explicit Client(const std::string& address) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const std::string port = address.substr(address.rfind(':') + 1);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(std::stoi(port)));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  ~Client() { ::close(socket_); }

  void send(std::string_view bytes) { ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL); }
  bool is_closed() {
    char byte = 0;
    const ssize_t size = ::recv(socket_, &byte, 1, MSG_DONTWAIT | MSG_PEEK);
    return size == 0 || (size < 0 && errno != EAGAIN);
  }
  char next() {
    char byte = 0;
    return ::recv(socket_, &byte, 1, 0) == 1 ? byte : '\0';
  }

 private:
  int socket_;
};

// Each piece comes in time, but the request does not.
TEST(FileServer, ARequestHasADeadline) {
  const ooc::Scratch folder;
  const std::string file = folder.path() + "/file";
  test::write_file(file, "content");
  FileServer server("<html><head></head></html>", file, 0);
  std::atomic<bool> ends = false;
  std::jthread serving([&] { server.serve([&] { return ends.load(); }, 500ms); });

  Client prompt(server.address());
  prompt.send("GET / HTTP/1.1\r\n\r\n");
  EXPECT_EQ(prompt.next(), 'H');

  Client slow(server.address());
  slow.send("GET / HTTP/1.1\r\nX: ");
  int pieces = 0;
  for (; pieces < 200 && !slow.is_closed(); ++pieces) {
    slow.send("x");
    std::this_thread::sleep_for(50ms);
  }
  EXPECT_LT(pieces, 200);
  ends = true;
}

}  // namespace
}  // namespace reeb::tools
