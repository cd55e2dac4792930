#include "interrupts.h"

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <mutex>
#include <new>
#include <thread>

#include <pthread.h>
#include <semaphore.h>

namespace firstcontact::python {

namespace py = pybind11;

/// The thread that waits for signals, and the query that they stop. One for the whole process.
struct SignalWatch {
  pthread_t main_thread = pthread_self();
  std::mutex mutex;
  QueryStop* innermost = nullptr;  // Of the main thread; the ones around it hang on it.
  sem_t signals{};
  bool is_waiting = false;

  SignalWatch() { sem_init(&signals, 0, 0); }

  void wait_for_signals() {
    while (true) {
      if (sem_wait(&signals) == 0) {
        const std::lock_guard lock(mutex);
        for (QueryStop* query = innermost; query != nullptr; query = query->outer_) {
          query->interrupted_ = true;
          query->source_.request_stop();
        }
      }
    }
  }

  void begin() {
    if (is_waiting) {
      return;
    }
    sigset_t all;
    sigset_t kept;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &kept);  // The thread inherits this: no signal is for it.
    std::thread(&SignalWatch::wait_for_signals, this).detach();
    pthread_sigmask(SIG_SETMASK, &kept, nullptr);
    is_waiting = true;
  }
};

namespace {

SignalWatch& the_watch() {
  alignas(SignalWatch) static std::byte memory[sizeof(SignalWatch)];
  static auto* watch = new (memory) SignalWatch;  // Never destroyed: its thread outlives main.
  return *watch;
}

struct sigaction before;  // What handled SIGINT before us: Python.
sem_t* woken = nullptr;

/// Makes Python note the signal before the query ends.
extern "C" void on_interrupt(int signal) {
  const int kept = errno;
  before.sa_handler(signal);
  sem_post(woken);
  errno = kept;
}

/// Puts our handler before Python's, which may have changed since the last time.
///
/// Where Python ignores the signal or leaves it to the system, so does this library.
void stand_before_python() {
  struct sigaction now = {};
  sigaction(SIGINT, nullptr, &now);
  const bool is_handler = (now.sa_flags & SA_SIGINFO) == 0 && now.sa_handler != SIG_DFL &&
                          now.sa_handler != SIG_IGN && now.sa_handler != on_interrupt;
  if (is_handler) {
    before = now;
    now.sa_handler = on_interrupt;
    sigaction(SIGINT, &now, nullptr);
  }
}

/// A forked child has this thread only, as its main one.
void after_fork() {
  SignalWatch& watch = the_watch();
  QueryStop* const innermost = watch.innermost;
  new (&watch) SignalWatch;
  watch.innermost = innermost;
}

}  // namespace

void watch_signals() {
  woken = &the_watch().signals;
  the_watch().main_thread = pthread_self();
  pthread_atfork(nullptr, nullptr, after_fork);
}

QueryStop::QueryStop(const std::stop_source* user)
    : user_(user != nullptr ? user->get_token() : std::stop_token()) {
  if (user_.stop_possible()) {
    forward_.emplace(user_, [this] { source_.request_stop(); });
  }
  SignalWatch& watch = the_watch();
  is_watched_ = pthread_equal(pthread_self(), watch.main_thread) != 0;
  if (is_watched_) {
    stand_before_python();
    watch.begin();
    const std::lock_guard lock(watch.mutex);
    outer_ = std::exchange(watch.innermost, this);
  }
}

QueryStop::~QueryStop() {
  if (is_watched_) {
    SignalWatch& watch = the_watch();
    const std::lock_guard lock(watch.mutex);
    watch.innermost = outer_;
  }
}

void QueryStop::handle_pending() {
  if (PyErr_CheckSignals() != 0) {
    throw py::error_already_set();
  }
}

void QueryStop::fail(std::exception_ptr error) {
  error_ = std::move(error);
  source_.request_stop();
}

bool QueryStop::was_interrupted() {
  if (error_) {
    std::rethrow_exception(error_);
  }
  if (!is_watched_) {
    return false;
  }
  bool interrupted = false;
  {
    const std::lock_guard lock(the_watch().mutex);
    interrupted = interrupted_;
  }
  handle_pending();
  return interrupted && !user_.stop_requested();
}

std::function<void(double)> progress_of(const py::object& callback, QueryStop& stop) {
  if (callback.is_none()) {
    return {};
  }
  return [&callback, &stop](double done) {
    const py::gil_scoped_acquire acquire;
    try {
      callback(done);
    } catch (const py::error_already_set&) {
      stop.fail(std::current_exception());
    }
  };
}

}  // namespace firstcontact::python
