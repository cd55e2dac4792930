/// @file
/// Shows long work on a terminal.

#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace firstcontact::app {

/// One line on stderr with the present work and its duration.
///
/// It begins after a second and is erased in the end. It is silent where stderr is no terminal.
class Progress {
 public:
  Progress();
  ~Progress();

  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Sets the name of the present work. May be called by any thread.
  void doing(std::string text);

  /// Prints a line on stderr in place of the present one. May be called by any thread.
  void say(std::string_view line);

 private:
  void show(const std::stop_token& over);
  void wipe();

  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::string text_;
  bool shown_ = false;
  std::jthread writer_;  // The last member, so that it ends first.
};

}  // namespace firstcontact::app
