/// @file
/// A file that is known to be writable before long work.

#pragma once

#include <optional>
#include <string>

#include "atomic_file.h"

namespace firstcontact::app {

/// A file that is begun before the work whose result it holds, if it has a name.
class BegunFile {
 public:
  BegunFile() = default;
  explicit BegunFile(const std::string& path, const std::string& header = "") {
    if (!path.empty()) {
      file_.emplace(path);
      file_->write(header);
    }
  }
  void write(const std::string& text) {
    if (file_) {
      file_->write(text);
    }
  }
  void commit() {
    if (file_) {
      file_->commit();
    }
  }
  [[nodiscard]] bool is_open() const { return file_.has_value(); }

 private:
  std::optional<AtomicFile> file_;
};

}  // namespace firstcontact::app
