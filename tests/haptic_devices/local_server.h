/// @file
/// Servers of tests on local sockets, and functions that wait for another thread.

#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include <firstcontact/haptic_devices/detail/socket.h>

namespace firstcontact::test {

/// Waits until a condition holds; the time limit matters only where it never does.
inline bool eventually(const std::function<bool()>& holds) {
  const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!holds()) {
    if (std::chrono::steady_clock::now() > limit) {
      return false;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  return true;
}

/// Waits until a descriptor can be read, for at most `milliseconds`.
inline bool readable(int number, int milliseconds) {
  pollfd descriptor{number, POLLIN, 0};
  return ::poll(&descriptor, 1, milliseconds) > 0;
}

/// New folder, which is removed with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "fcXXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) {
      throw std::runtime_error("mkdtemp");
    }
    path_ = pattern;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }

  [[nodiscard]] std::string file(const char* name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// Listens on a socket of the file system.
inline detail::FileDescriptor listen_local(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) {
    throw std::runtime_error("path of a socket is too long");
  }
  std::memcpy(address.sun_path, path.data(), path.size());
  ::unlink(path.c_str());
  detail::FileDescriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (::bind(socket.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(socket.number(), 4) != 0) {
    throw std::runtime_error("cannot listen at " + path);
  }
  return socket;
}

/// Listens on a free port of this machine.
inline std::pair<detail::FileDescriptor, std::uint16_t> listen_tcp(std::uint16_t port = 0) {
  detail::FileDescriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const int on = 1;
  ::setsockopt(socket.number(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  socklen_t size = sizeof address;
  if (::bind(socket.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(socket.number(), 4) != 0 ||
      ::getsockname(socket.number(), reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    throw std::runtime_error("cannot listen on a port");
  }
  return {std::move(socket), ntohs(address.sin_port)};
}

/// Accepts a connection that comes within 20 s.
inline detail::FileDescriptor accept_one(const detail::FileDescriptor& listener) {
  if (!readable(listener.number(), 20'000)) {
    throw std::runtime_error("nobody connects");
  }
  return detail::FileDescriptor(::accept(listener.number(), nullptr, nullptr));
}

/// Sends all bytes; a peer that is gone is no error.
inline void send_bytes(const detail::FileDescriptor& socket, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::send(socket.number(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count <= 0) {
      return;
    }
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

/// Reads some bytes that come within the time; empty if none come or the peer is gone.
inline std::string receive_bytes(const detail::FileDescriptor& socket, int milliseconds) {
  std::array<char, 65'536> buffer{};
  if (!readable(socket.number(), milliseconds)) {
    return {};
  }
  const ssize_t count = ::recv(socket.number(), buffer.data(), buffer.size(), 0);
  return {buffer.data(), count > 0 ? static_cast<std::size_t>(count) : 0};
}

}  // namespace firstcontact::test
