/// @file
/// Ctrl-C as a stop token.

#pragma once

#include <csignal>
#include <stop_token>
#include <thread>

namespace firstcontact::app {

/// Stops the work through a token on the first SIGINT or SIGTERM, during its lifetime.
///
/// The work then ends with what is proven so far. The second signal ends the process at once. Make
/// it before other threads: they inherit the block of these signals.
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
