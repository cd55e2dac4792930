/// @file
/// Local sockets of drivers. Their waits have a deadline and can be stopped.

#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace firstcontact::detail {

/// Owns a file descriptor.
class FileDescriptor {
 public:
  explicit FileDescriptor(int number = -1) noexcept : number_(number) {}
  FileDescriptor(FileDescriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~FileDescriptor();

  [[nodiscard]] int number() const noexcept { return number_; }
  [[nodiscard]] bool is_open() const noexcept { return number_ >= 0; }

 private:
  int number_;
};

/// A signal that ends the waits of one thread, from another one. Once set it stays set.
class StopSignal {
 public:
  /// Makes a signal that is not set.
  ///
  /// @throws std::system_error  if the system gives no descriptor
  StopSignal();

  void set() noexcept;
  [[nodiscard]] bool is_set() const noexcept { return set_.load(std::memory_order_acquire); }
  [[nodiscard]] int number() const noexcept { return event_.number(); }

 private:
  FileDescriptor event_;
  std::atomic<bool> set_{false};
};

/// The reason why a wait ended.
enum class WaitEnd { ready, stopped, timed_out };
/// The operation for which a socket has to be ready.
enum class WaitFor { reading, writing };

/// Waits until a socket can be read or written, the signal is set, or the steady clock is at
/// `until_ns`. A socket that the other side has closed is ready.
[[nodiscard]] WaitEnd wait_for(const FileDescriptor& socket, WaitFor what, const StopSignal& stop,
                               std::int64_t until_ns) noexcept;

/// Sleeps until the signal is set or the steady clock is at `until_ns`.
[[nodiscard]] WaitEnd wait_for(const StopSignal& stop, std::int64_t until_ns) noexcept;

/// Connects to a socket of the file system. On failure the descriptor is closed, and `problem` has
/// the reason.
[[nodiscard]] FileDescriptor connect_local(const std::string& path, std::string& problem);

/// Connects to a port of TCP, by all addresses of the host. A look-up of its name that takes longer
/// goes on alone, without result.
[[nodiscard]] FileDescriptor connect_tcp(const std::string& host, std::uint16_t port,
                                         const StopSignal& stop, std::int64_t until_ns,
                                         std::string& problem);

/// Listens on a port of 127.0.0.1; with 0 on a free one. `port` becomes the port.
///
/// On failure the descriptor is closed, and `problem` has the reason.
[[nodiscard]] FileDescriptor listen_local_tcp(std::uint16_t wanted, std::uint16_t& port,
                                              std::string& problem);

/// Accepts a waiting connection; a closed descriptor if there is none.
[[nodiscard]] FileDescriptor accept_one(const FileDescriptor& listener) noexcept;

/// Sends as much as goes without waiting. Returns the number of bytes; none if the other side is
/// gone.
[[nodiscard]] std::optional<std::size_t> send_some(const FileDescriptor& socket,
                                                   std::string_view bytes) noexcept;

/// Sends all bytes. False if the other side is gone, or the wait ended.
[[nodiscard]] bool send_all(const FileDescriptor& socket, std::string_view bytes,
                            const StopSignal& stop, std::int64_t until_ns) noexcept;

/// The result of a read from a socket.
struct Received {
  std::size_t count = 0;  ///< [byte]  May be 0 although the connection stands.
  bool open = true;       ///< False if the other side is gone.
};

/// Reads all bytes that are there, without waiting.
[[nodiscard]] Received receive(const FileDescriptor& socket, std::span<char> buffer) noexcept;

}  // namespace firstcontact::detail
