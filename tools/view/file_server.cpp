#include "tools/view/file_server.h"

#include <fmt/core.h>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <exception>
#include <filesystem>
#include <list>
#include <random>
#include <span>
#include <system_error>
#include <thread>
#include <vector>

#include "libreeb/base/error.h"
#include "tools/view/http_text.h"

namespace reeb::tools {
namespace {

constexpr int kMillisecondsBetweenStops = 100;
constexpr std::size_t kMostConnections = 32, kMostRequestBytes = 16 * 1024, kPieceBytes = 64 * 1024;

std::string random_word() {
  std::random_device device;
  std::string word;
  for (int i = 0; i < 4; ++i) word += fmt::format("{:08x}", device());
  return word;
}

Error unusable_port(std::uint16_t port, int error) {
  const std::string why = error == EADDRINUSE ? "is in use" : fmt::format("cannot be used: {}", std::strerror(error));
  return {ErrorKind::kResource, fmt::format("port {} {}", port, why),
          "choose another --port, or leave it out for a free one"};
}

int listen_on(std::uint16_t port) {
  const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (listener < 0) throw unusable_port(port, errno);
  // A port that was used a moment ago can be used again.
  const int yes = 1;
  ::setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(listener, SOMAXCONN) != 0) {
    const int error = errno;
    ::close(listener);
    throw unusable_port(port, error);
  }
  return listener;
}

std::uint16_t port_of(int listener) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  ::getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.sin_port);
}

// False if the client does not take them.
bool send_all(int socket, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

void limit_waiting(int socket, int option, std::chrono::microseconds limit) {
  constexpr std::int64_t kSecond = 1'000'000;
  const timeval time{.tv_sec = limit.count() / kSecond, .tv_usec = limit.count() % kSecond};
  ::setsockopt(socket, SOL_SOCKET, option, &time, sizeof time);
}

// Empty if no whole request comes in this time.
std::string receive_request(int socket, std::chrono::milliseconds patience) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end = Clock::now() + patience;
  std::string text;
  std::array<char, 4096> piece{};
  while (text.find("\r\n\r\n") == std::string::npos) {
    const auto left = std::chrono::duration_cast<std::chrono::microseconds>(end - Clock::now());
    if (left.count() <= 0) return {};
    limit_waiting(socket, SO_RCVTIMEO, left);
    const ssize_t size = ::recv(socket, piece.data(), piece.size(), 0);
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0 || text.size() > kMostRequestBytes) return {};
    text.append(piece.data(), static_cast<std::size_t>(size));
  }
  return text;
}

std::string head(std::string_view status, std::string_view type, std::uint64_t length, std::string_view more = {}) {
  return fmt::format(
      "HTTP/1.1 {}\r\nContent-Type: {}\r\nContent-Length: {}\r\n{}Cache-Control: no-store\r\n"
      "X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\n"
      "Cross-Origin-Resource-Policy: same-origin\r\nX-Frame-Options: DENY\r\nConnection: close\r\n\r\n",
      status, type, length, more);
}

void send_text(int socket, std::string_view status, bool with_body, std::string_view more = {}) {
  const std::string body = fmt::format("{}\n", status);
  send_all(socket, head(status, "text/plain", body.size(), more) + (with_body ? body : ""));
}

// The page takes the name of its file from its own address. What it takes is an address, too, so the name is escaped
// twice: nothing in it can end the text in the script.
std::string page_of_file(std::string_view page, const std::string& name) {
  constexpr std::string_view kHead = "<head>";
  std::string text(page);
  text.insert(text.find(kHead) + kHead.size(),
              fmt::format("<script>history.replaceState(null, '', '?file={}' + location.hash)</script>",
                          path_part(path_part(name))));
  return text;
}

}  // namespace

// Each has its thread. All end with the destructor.
class FileServer::Connections {
 public:
  Connections(const FileServer& server, std::chrono::milliseconds patience) : server_(server), patience_(patience) {}
  Connections(const Connections&) = delete;
  Connections& operator=(const Connections&) = delete;
  ~Connections() {
    for (Connection& connection : open_) ::shutdown(connection.socket, SHUT_RDWR);
    open_.clear();
  }

  bool has_room() {
    open_.remove_if([](const Connection& connection) { return connection.is_done.load(); });
    return open_.size() < kMostConnections;
  }

  void add(int socket) {
    Connection& connection = open_.emplace_back(socket);
    try {
      connection.thread = std::jthread([this, &connection] {
        try {
          server_.answer(connection.socket, patience_);
        } catch (const std::exception&) {
          // There is too little memory: this client gets no answer, or part of one.
        }
        // The client sees the end at once; the socket is closed when no thread knows it any more.
        ::shutdown(connection.socket, SHUT_RDWR);
        connection.is_done = true;
      });
    } catch (const std::system_error&) {
      open_.pop_back();  // no thread is left: this client is not answered
    }
  }

 private:
  struct Connection {
    explicit Connection(int opened) : socket(opened) {}
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;
    ~Connection() {
      if (thread.joinable()) thread.join();
      ::close(socket);
    }
    int socket;
    std::atomic<bool> is_done = false;
    std::jthread thread;
  };

  const FileServer& server_;
  const std::chrono::milliseconds patience_;
  std::list<Connection> open_;
};

FileServer::FileServer(std::string_view page, const std::string& file, std::uint16_t port)
    : file_(io::File::open_for_reading(file)),
      file_bytes_(file_.size()),
      socket_(listen_on(port)),
      port_(fmt::format("{}", port_of(socket_))),
      token_(random_word()),
      name_(std::filesystem::path(file).filename().string()) {
  address_ = fmt::format("http://127.0.0.1:{}/{}/", port_, token_);
  page_ = page_of_file(page, name_);
}

FileServer::~FileServer() { ::close(socket_); }

void FileServer::serve(const std::function<bool()>& stop, std::chrono::milliseconds patience) {
  Connections connections(*this, patience);
  while (!stop()) {
    pollfd waiting{.fd = connections.has_room() ? socket_ : -1, .events = POLLIN, .revents = 0};
    if (::poll(&waiting, 1, kMillisecondsBetweenStops) <= 0) continue;
    const int client = ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC);
    if (client < 0) {
      // Without a free descriptor the client keeps waiting, and poll() would return at once.
      std::this_thread::sleep_for(std::chrono::milliseconds(kMillisecondsBetweenStops));
      continue;
    }
    limit_waiting(client, SO_SNDTIMEO, patience);
    connections.add(client);
  }
}

void FileServer::answer(int socket, std::chrono::milliseconds patience) const {
  const std::string text = receive_request(socket, patience);
  if (text.empty()) return;
  const auto request = parse_request(text);
  if (!request) return send_text(socket, "400 Bad Request", true);
  const bool with_body = request->method != "HEAD";
  if (request->method != "GET" && with_body)
    return send_text(socket, "405 Method Not Allowed", true, "Allow: GET, HEAD\r\n");
  // A page elsewhere can let its own name lead to this computer; then the host is that name.
  if (request->host != "127.0.0.1:" + port_ && request->host != "localhost:" + port_)
    return send_text(socket, "403 Forbidden", with_body);
  const std::string folder = "/" + token_ + "/";
  if (request->path == folder) {
    if (send_all(socket, head("200 OK", "text/html; charset=utf-8", page_.size())) && with_body)
      send_all(socket, page_);
    return;
  }
  if (request->path != folder + name_) return send_text(socket, "404 Not Found", with_body);
  const AskedRange asked = asked_range(request->range, file_bytes_);
  if (asked.kind == RangeKind::kNone)
    return send_text(socket, "416 Range Not Satisfiable", with_body,
                     fmt::format("Content-Range: bytes */{}\r\n", file_bytes_));
  const auto [begin, end] = asked.range;
  std::string more = "Accept-Ranges: bytes\r\n";
  const bool is_part = asked.kind == RangeKind::kPart;
  if (is_part) more += fmt::format("Content-Range: bytes {}-{}/{}\r\n", begin, end - 1, file_bytes_);
  if (!send_all(socket,
                head(is_part ? "206 Partial Content" : "200 OK", "application/octet-stream", end - begin, more)))
    return;
  if (with_body) send_file(socket, begin, end);
}

void FileServer::send_file(int socket, std::uint64_t begin, std::uint64_t end) const {
  std::vector<char> piece(kPieceBytes);
  while (begin < end) {
    const std::size_t size = static_cast<std::size_t>(std::min<std::uint64_t>(piece.size(), end - begin));
    try {
      file_.read_at(begin, std::as_writable_bytes(std::span(piece.data(), size)));
    } catch (const Error&) {
      return;  // the client sees that bytes are missing
    }
    if (!send_all(socket, {piece.data(), size})) return;
    begin += size;
  }
}

}  // namespace reeb::tools
