#include "interrupt.h"

#include <cstdlib>
#include <functional>

#include "atomic_file.h"

namespace firstcontact::app {
namespace {

void watch(const std::stop_token& over, const sigset_t& signals, std::stop_source& source) {
  for (bool first = true;; first = false) {
    int signal = 0;
    sigwait(&signals, &signal);
    if (over.stop_requested()) {
      return;
    }
    if (!first) {
      remove_temporaries();
      std::_Exit(128 + signal);  // The status that the shell reports for a process that a signal
                                 // ended.
    }
    source.request_stop();
  }
}

}  // namespace

Interrupt::Interrupt() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  watcher_ = std::jthread(watch, std::cref(signals_), std::ref(source_));
}

Interrupt::~Interrupt() {
  watcher_.request_stop();
  pthread_kill(watcher_.native_handle(), SIGINT);  // Wakes it from its wait.
  watcher_.join();
}

}  // namespace firstcontact::app
