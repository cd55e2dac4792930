#include "atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>

#include "write_all.h"

namespace firstcontact::app {
namespace {

/// The permissions of a new file: 0666 without the umask.
mode_t new_file_mode() {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0666 & ~mask;
}

constexpr int kMostLinks = 40;  // The limit of the kernel.

/// The target of a symbolic link.
std::filesystem::path next_of(const std::filesystem::path& link) {
  std::error_code error;
  const std::filesystem::path target = std::filesystem::read_symlink(link, error);
  return error ? link : link.parent_path() / target;  // An absolute target replaces the folder.
}

/// The last target of symbolic links, so that the links stay; the target need not exist yet.
std::filesystem::path resolved(std::filesystem::path path) {
  std::error_code error;
  for (int k = 0; k < kMostLinks && std::filesystem::is_symlink(path, error); ++k) {
    path = next_of(path);
  }
  return path;
}

/// The descriptor of this process that a path names, as /dev/stdout and /dev/fd/63 do; or -1.
///
/// Its links show the open file. To open that a second time would overwrite the output of the
/// descriptor, and a pipe may have no name.
int own_descriptor(std::filesystem::path path) {
  std::error_code error;
  const std::filesystem::path own = std::filesystem::canonical("/proc/self/fd", error);
  for (int k = 0; k < kMostLinks && std::filesystem::is_symlink(path, error); ++k) {
    const std::string name = path.filename().string();
    int number = -1;
    const auto [rest, failed] = std::from_chars(name.data(), name.data() + name.size(), number);
    const bool is_number = failed == std::errc() && rest == name.data() + name.size();
    if (is_number && !own.empty() && std::filesystem::canonical(path.parent_path(), error) == own) {
      return number;
    }
    path = next_of(path);
  }
  return -1;
}

/// The temporary files that are there, so that a process that ends at once can remove them.
struct Temporaries {
  std::mutex mutex;
  std::set<std::filesystem::path> names;
};

Temporaries& temporaries() {
  static Temporaries all;
  return all;
}

}  // namespace

AtomicFile::AtomicFile(const std::filesystem::path& target) : target_(target) {
  std::error_code error;
  const auto status = std::filesystem::status(target, error);
  if (const int own = own_descriptor(target); own >= 0) {
    descriptor_ = ::fcntl(own, F_DUPFD_CLOEXEC, 0);
  } else if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    descriptor_ = ::open(target.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    begin_temporary();
  }
  if (descriptor_ < 0) {
    fail("cannot write this file");
  }
}

void AtomicFile::begin_temporary() {
  target_ = resolved(target_);
  std::error_code error;
  if (std::filesystem::is_symlink(target_, error)) {
    errno = ELOOP;
    fail("cannot write this file");
  }
  struct stat replaced = {};
  const bool replaces = ::stat(target_.c_str(), &replaced) == 0;
  if (replaces && ((replaced.st_mode & S_IWUSR) == 0 || ::access(target_.c_str(), W_OK) != 0)) {
    errno = EACCES;  // As for a write to it, which a new file in its place would evade.
    fail("cannot write this file");
  }
  const std::scoped_lock lock(temporaries().mutex);
  std::string name = target_.string() + ".XXXXXX";
  descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor_ < 0) {
    fail("cannot write this file");
  }
  temporary_ = name;
  temporaries().names.insert(temporary_);
  if (replaces) {
    // Only root may give files away; other users keep what they write.
    [[maybe_unused]] const int kept = ::fchown(descriptor_, replaced.st_uid, replaced.st_gid);
  }
  constexpr mode_t kPermissions = 0777;
  ::fchmod(descriptor_, replaces ? replaced.st_mode & kPermissions : new_file_mode());
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
  if (!temporary_.empty()) {
    ::unlink(temporary_.c_str());
    end_temporary();
  }
}

void AtomicFile::end_temporary() noexcept {
  const std::scoped_lock lock(temporaries().mutex);
  temporaries().names.erase(temporary_);
  temporary_.clear();
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
    end_temporary();
  }
}

void remove_temporaries() noexcept {
  const std::scoped_lock lock(temporaries().mutex);
  for (const std::filesystem::path& name : temporaries().names) {
    ::unlink(name.c_str());
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
