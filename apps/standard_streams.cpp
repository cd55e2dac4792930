#include "standard_streams.h"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <iostream>
#include <iterator>
#include <stdexcept>

namespace firstcontact::app {

void occupy_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) < 0) {
      // Takes the least free number, which is this one. Not for writing: that has to fail.
      (void)::open("/dev/null", O_RDONLY);
    }
  }
}

void say_on_stderr(std::string_view text) {
  (void)std::fwrite(text.data(), 1, text.size(), stderr);
  (void)std::fflush(stderr);
}

void flush_stdout() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    throw std::runtime_error("standard output: cannot write all of the answer");
  }
}

void refuse_long_files_by_error() { std::signal(SIGXFSZ, SIG_IGN); }

std::string read_stdin() {
  std::string text{std::istreambuf_iterator<char>(std::cin), {}};
  if (std::cin.bad()) {
    throw std::runtime_error("standard input: cannot read all of it");
  }
  return text;
}

}  // namespace firstcontact::app
