#include "atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>
#include <system_error>

#include "write_all.h"

namespace firstcontact::app {
namespace {

/// What a new file may be read and written by: 0666 without the umask.
mode_t new_file_mode() {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0666 & ~mask;
}

/// Where a symbolic link leads, so that the link stays one; it need not lead to a file yet.
std::filesystem::path resolved(std::filesystem::path path) {
  constexpr int kMostLinks = 40;  // As the kernel.
  std::error_code error;
  for (int k = 0; k < kMostLinks && std::filesystem::is_symlink(path, error); ++k) {
    const std::filesystem::path target = std::filesystem::read_symlink(path, error);
    if (error) {
      break;
    }
    path = path.parent_path() / target;  // An absolute target replaces the folder.
  }
  return path;
}

}  // namespace

AtomicFile::AtomicFile(const std::filesystem::path& target) : target_(resolved(target)) {
  std::error_code error;
  if (std::filesystem::is_symlink(target_, error)) {
    errno = ELOOP;
    fail("cannot write this file");
  }
  const auto status = std::filesystem::status(target_, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    descriptor_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    std::string name = target_.string() + ".XXXXXX";
    descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
    temporary_ = descriptor_ < 0 ? "" : name;
  }
  if (descriptor_ < 0) {
    fail("cannot write this file");
  }
  if (!temporary_.empty()) {
    ::fchmod(descriptor_, new_file_mode());
  }
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
  if (!temporary_.empty()) {
    ::unlink(temporary_.c_str());
  }
}

void AtomicFile::write(std::string_view text) {
  if (!write_all(descriptor_, text)) {
    fail("cannot write this file");
  }
}

void AtomicFile::commit() {
  const int closed = ::close(descriptor_);
  descriptor_ = -1;
  if (closed != 0) {
    fail("cannot write this file");
  }
  if (!temporary_.empty()) {
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
      fail("cannot give a file this name");
    }
    temporary_.clear();
  }
}

void AtomicFile::fail(const char* what) const {
  const std::string reason = std::strerror(errno);
  throw std::runtime_error(target_.string() + ": " + what + ": " + reason);
}

void write_file(const std::filesystem::path& target, std::string_view text) {
  AtomicFile file(target);
  file.write(text);
  file.commit();
}

}  // namespace firstcontact::app
