/// @file
/// Says on a terminal what takes long.

#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace firstcontact::app {

/// One line on stderr with what is being done and for how long; it begins after a second and is
/// wiped out in the end. Silent where stderr is no terminal.
class Progress {
 public:
  Progress();
  ~Progress();

  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// What is being done now. From any thread.
  void doing(std::string text);

  /// Prints a line on stderr in the place of the one that is shown. From any thread.
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
