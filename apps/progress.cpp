#include "progress.h"

#include <unistd.h>

#include <chrono>

#include <fmt/core.h>

#include "standard_streams.h"
#include "terminal_text.h"

namespace firstcontact::app {

Progress::Progress() {
  if (::isatty(STDERR_FILENO) == 1) {
    writer_ = std::jthread([this](const std::stop_token& over) { show(over); });
  }
}

Progress::~Progress() = default;

void Progress::doing(std::string text) {
  const std::scoped_lock lock(mutex_);
  text_ = visible(text);
}

void Progress::say(std::string_view line) {
  const std::scoped_lock lock(mutex_);
  wipe();
  say_on_stderr(visible(line) + "\n");
}

void Progress::show(const std::stop_token& over) {
  using namespace std::chrono_literals;
  const auto begin = std::chrono::steady_clock::now();
  std::unique_lock lock(mutex_);
  for (auto pause = 1000ms;
       !wake_.wait_for(lock, over, pause, [&] { return over.stop_requested(); }); pause = 200ms) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    say_on_stderr(fmt::format("\r\x1b[K{} ... {:.1f} s", text_, elapsed.count()));
    shown_ = true;
  }
  wipe();
}

void Progress::wipe() {
  if (shown_) {
    say_on_stderr("\r\x1b[K");
    shown_ = false;
  }
}

}  // namespace firstcontact::app
