#include "results_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "write_all.h"

namespace firstcontact::app {
namespace {

/// The end of the lines of a file: just behind its last line feed.
std::uintmax_t end_of_lines(std::ifstream& file, std::uintmax_t size) {
  std::string block;
  constexpr std::uintmax_t kBlock = 1 << 16;
  for (std::uintmax_t end = size; end > 0;) {
    const std::uintmax_t begin = end - std::min(end, kBlock);
    block.resize(static_cast<std::size_t>(end - begin));
    file.seekg(static_cast<std::streamoff>(begin));
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    if (const auto found = block.rfind('\n'); found != std::string::npos) {
      return begin + found + 1;
    }
    end = begin;
  }
  return 0;
}

/// Describes the line of their origin in which two results differ.
std::string first_difference(const std::string& was, const std::string& is) {
  std::istringstream old_lines(was);
  std::istringstream new_lines(is);
  std::string old_line;
  std::string new_line;
  while (std::getline(old_lines, old_line) && std::getline(new_lines, new_line)) {
    if (old_line != new_line) {
      return fmt::format("of {}, not of {}", old_line, new_line);
    }
  }
  return "of something else";
}

}  // namespace

ResultsFile::Descriptor::~Descriptor() {
  if (value >= 0) {
    ::close(value);
  }
}

ResultsFile::ResultsFile(std::filesystem::path path, const std::string& origin, bool resume)
    : path_(std::move(path)), origin_path_(path_.string() + ".batch") {
  open();
  if (std::filesystem::file_size(path_) == 0) {
    write_origin(origin);
    return;
  }
  if (!resume) {
    fail("there are results already; go on with --resume, or remove them");
  }
  require_origin(origin);
  cut_off_part_of_a_line();
}

void ResultsFile::open() {
  descriptor_.value = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_.value < 0) {
    fail_errno("cannot write this file");
  }
  if (!std::filesystem::is_regular_file(path_)) {
    fail("expected a plain file for the results, got something else");
  }
  // The lock ends with the process, however the process ends.
  if (::flock(descriptor_.value, LOCK_EX | LOCK_NB) != 0) {
    fail("another batch is writing this file");
  }
}

void ResultsFile::write_origin(const std::string& origin) const {
  std::ofstream file(origin_path_, std::ios::binary);
  if (!(file << origin << std::flush)) {
    fail(fmt::format("cannot write {}", origin_path_.string()));
  }
}

void ResultsFile::require_origin(const std::string& origin) const {
  std::ifstream file(origin_path_, std::ios::binary);
  if (!file) {
    fail(fmt::format("cannot go on: {}, which says what these results are of, is missing",
                     origin_path_.string()));
  }
  const std::string was{std::istreambuf_iterator<char>(file), {}};
  if (was != origin) {
    fail(fmt::format("cannot go on: these results are {}", first_difference(was, origin)));
  }
}

void ResultsFile::cut_off_part_of_a_line() const {
  std::ifstream file(path_, std::ios::binary);
  const std::uintmax_t kept = end_of_lines(file, std::filesystem::file_size(path_));
  if (::ftruncate(descriptor_.value, static_cast<off_t>(kept)) != 0) {
    fail_errno("cannot cut off part of a line");
  }
}

void ResultsFile::for_each_kept(
    const std::function<void(std::size_t number, const std::string&)>& visit) const {
  std::ifstream file(path_, std::ios::binary);
  std::string line;
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    visit(number, line);
  }
}

void ResultsFile::append(std::string_view line) {
  std::string text(line);
  text += '\n';
  if (!write_all(descriptor_.value, text)) {
    fail_errno("cannot write all results");
  }
}

void ResultsFile::fail(const std::string& what) const {
  throw std::runtime_error(path_.string() + ": " + what);
}

void ResultsFile::fail_errno(const char* what) const {
  const std::string reason = std::strerror(errno);
  fail(fmt::format("{}: {}", what, reason));
}

}  // namespace firstcontact::app
