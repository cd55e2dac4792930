#include <firstcontact/haptic_devices/detail/socket.h>

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <memory>
#include <system_error>
#include <thread>

#include <firstcontact/haptic_devices/device.h>

namespace firstcontact::detail {
namespace {

std::string text_of(int error) { return std::generic_category().message(error); }

/// Waits for descriptors, at most until the time.
int poll_until(std::span<pollfd> descriptors, std::int64_t until_ns) noexcept {
  while (true) {
    const std::int64_t left = std::max<std::int64_t>(0, until_ns - steady_now_ns());
    const timespec time{static_cast<time_t>(left / 1'000'000'000),
                        static_cast<long>(left % 1'000'000'000)};
    const int count = ::ppoll(descriptors.data(), descriptors.size(), &time, nullptr);
    if (count >= 0 || errno != EINTR) {
      return count;
    }
  }
}

/// Connects to one address of a host. On failure the descriptor is closed.
FileDescriptor connect_address(const addrinfo& address, const StopSignal& stop,
                               std::int64_t until_ns, std::string& problem) {
  FileDescriptor socket(::socket(
      address.ai_family, address.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, address.ai_protocol));
  if (!socket.is_open()) {
    problem = text_of(errno);
    return FileDescriptor();
  }
  int error = 0;
  if (::connect(socket.number(), address.ai_addr, address.ai_addrlen) != 0) {
    error = errno;
    if (error == EINPROGRESS) {
      if (wait_for(socket, WaitFor::writing, stop, until_ns) != WaitEnd::ready) {
        problem = "no answer in time";
        return FileDescriptor();
      }
      socklen_t size = sizeof error;
      ::getsockopt(socket.number(), SOL_SOCKET, SO_ERROR, &error, &size);
    }
  }
  if (error != 0) {
    problem = text_of(error);
    return FileDescriptor();
  }
  const int on = 1;  // Small messages leave at once.
  ::setsockopt(socket.number(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  return socket;
}

/// The addresses of a host; they are there once the event `done` can be read.
struct HostLookup {
  HostLookup() : done(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    if (!done.is_open()) {
      throw std::system_error(errno, std::generic_category(), "eventfd");
    }
  }
  ~HostLookup() {
    if (addresses != nullptr) {
      ::freeaddrinfo(addresses);
    }
  }
  HostLookup(const HostLookup&) = delete;
  HostLookup& operator=(const HostLookup&) = delete;

  FileDescriptor done;
  std::atomic<bool> is_done{false};
  addrinfo* addresses = nullptr;
  int error = 0;
};

/// Looks a host up on a thread of its own: the system has no look-up that can be ended.
std::shared_ptr<HostLookup> look_up(const std::string& host, std::uint16_t port) {
  auto lookup = std::make_shared<HostLookup>();
  std::thread([lookup, host, service = std::to_string(port)] {
    addrinfo wanted{};
    wanted.ai_socktype = SOCK_STREAM;
    lookup->error = ::getaddrinfo(host.c_str(), service.c_str(), &wanted, &lookup->addresses);
    lookup->is_done.store(true, std::memory_order_release);
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = ::write(lookup->done.number(), &one, sizeof one);
  }).detach();
  return lookup;
}

}  // namespace

FileDescriptor::~FileDescriptor() {
  if (number_ >= 0) {
    ::close(number_);
  }
}

StopSignal::StopSignal() : event_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (!event_.is_open()) {
    throw std::system_error(errno, std::generic_category(), "eventfd");
  }
}

void StopSignal::set() noexcept {
  set_.store(true, std::memory_order_release);
  const std::uint64_t one = 1;
  // The write can only fail if the counter is full, and then the event is set.
  [[maybe_unused]] const ssize_t written = ::write(event_.number(), &one, sizeof one);
}

WaitEnd wait_for(const FileDescriptor& socket, WaitFor what, const StopSignal& stop,
                 std::int64_t until_ns) noexcept {
  const auto events = static_cast<short>(what == WaitFor::reading ? POLLIN : POLLOUT);
  std::array<pollfd, 2> descriptors{{{socket.number(), events, 0}, {stop.number(), POLLIN, 0}}};
  const int count = poll_until(descriptors, until_ns);
  if (stop.is_set()) {
    return WaitEnd::stopped;
  }
  return count > 0 && descriptors[0].revents != 0 ? WaitEnd::ready : WaitEnd::timed_out;
}

WaitEnd wait_for(const StopSignal& stop, std::int64_t until_ns) noexcept {
  std::array<pollfd, 1> descriptors{{{stop.number(), POLLIN, 0}}};
  (void)poll_until(descriptors, until_ns);
  return stop.is_set() ? WaitEnd::stopped : WaitEnd::timed_out;
}

FileDescriptor connect_local(const std::string& path, std::string& problem) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) {
    problem = "the path is longer than " + std::to_string(sizeof address.sun_path - 1) + " bytes";
    return FileDescriptor();
  }
  std::memcpy(address.sun_path, path.data(), path.size());
  FileDescriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!socket.is_open() || ::connect(socket.number(), reinterpret_cast<const sockaddr*>(&address),
                                     sizeof address) != 0) {
    problem = text_of(errno);
    return FileDescriptor();
  }
  return socket;
}

FileDescriptor connect_tcp(const std::string& host, std::uint16_t port, const StopSignal& stop,
                           std::int64_t until_ns, std::string& problem) {
  std::shared_ptr<HostLookup> lookup;
  try {
    lookup = look_up(host, port);
  } catch (const std::system_error& error) {  // The system has no descriptor or no thread left.
    problem = error.what();
    return FileDescriptor();
  }
  if (wait_for(lookup->done, WaitFor::reading, stop, until_ns) != WaitEnd::ready ||
      !lookup->is_done.load(std::memory_order_acquire)) {
    problem = "no answer about its name in time";
    return FileDescriptor();
  }
  if (lookup->error != 0) {
    problem = ::gai_strerror(lookup->error);
    return FileDescriptor();
  }
  FileDescriptor socket;
  for (const addrinfo* address = lookup->addresses; address != nullptr && !socket.is_open();
       address = address->ai_next) {
    socket = connect_address(*address, stop, until_ns, problem);
  }
  return socket;
}

FileDescriptor listen_local_tcp(std::uint16_t wanted, std::uint16_t& port, std::string& problem) {
  FileDescriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int on = 1;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(wanted);
  socklen_t size = sizeof address;
  if (!socket.is_open() ||
      ::setsockopt(socket.number(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0 ||
      ::bind(socket.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(socket.number(), SOMAXCONN) != 0 ||
      ::getsockname(socket.number(), reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    problem = text_of(errno);
    return FileDescriptor();
  }
  port = ntohs(address.sin_port);
  return socket;
}

FileDescriptor accept_one(const FileDescriptor& listener) noexcept {
  return FileDescriptor(
      ::accept4(listener.number(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
}

std::optional<std::size_t> send_some(const FileDescriptor& socket,
                                     std::string_view bytes) noexcept {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t count =
        ::send(socket.number(), bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (count > 0) {
      sent += static_cast<std::size_t>(count);
    } else if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
      return sent;
    } else if (count == 0 || errno != EINTR) {
      return std::nullopt;
    }
  }
  return sent;
}

bool send_all(const FileDescriptor& socket, std::string_view bytes, const StopSignal& stop,
              std::int64_t until_ns) noexcept {
  while (!bytes.empty()) {
    const std::optional<std::size_t> sent = send_some(socket, bytes);
    if (!sent) {
      return false;
    }
    bytes.remove_prefix(*sent);
    if (!bytes.empty() && wait_for(socket, WaitFor::writing, stop, until_ns) != WaitEnd::ready) {
      return false;
    }
  }
  return true;
}

Received receive(const FileDescriptor& socket, std::span<char> buffer) noexcept {
  while (true) {
    const ssize_t count = ::recv(socket.number(), buffer.data(), buffer.size(), 0);
    if (count > 0) {
      return {static_cast<std::size_t>(count), true};
    }
    if (count < 0 && errno == EINTR) {
      continue;
    }
    return {0, count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)};
  }
}

}  // namespace firstcontact::detail
