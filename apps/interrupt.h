/// @file
/// Ctrl-C as a stop token.

#pragma once

#include <csignal>
#include <stop_token>
#include <thread>

namespace firstcontact::app {

/// While it lives, the first SIGINT or SIGTERM stops the work through a token, so that it ends
/// with what is proven so far; the second ends the process at once.
///
/// Make it before other threads: they inherit that the signals wait for this.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();

  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  [[nodiscard]] std::stop_token token() const { return source_.get_token(); }

 private:
  sigset_t signals_{};
  std::stop_source source_;
  std::jthread watcher_;
};

}  // namespace firstcontact::app
