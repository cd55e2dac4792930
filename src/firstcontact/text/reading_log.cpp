#include <firstcontact/text/reading_log.h>

#include <algorithm>
#include <utility>

namespace firstcontact::detail {
namespace {

/// Most errors in one line; the others are counted.
constexpr std::size_t kMostErrors = 20;

/// The place of an error in its file, for the middle of a line: "line 7: ".
std::string place(const ParseError& error) {
  if (error.line()) {
    return "line " + std::to_string(*error.line()) + ": ";
  }
  return error.offset() ? "byte " + std::to_string(*error.offset()) + ": " : "";
}

/// An error with another message at the same place.
ParseError with_message(const ParseError& error, const std::string& message) {
  if (error.line()) {
    return ParseError(error.path(), *error.line(), message);
  }
  return error.offset() ? ParseError::at_byte(error.path(), *error.offset(), message)
                        : ParseError(error.path(), message);
}

}  // namespace

ReadingLog::ReadingLog(std::string path, std::string format, const ReadingOptions& options)
    : options_(options) {
  report_.path = std::move(path);
  report_.format = std::move(format);
}

void ReadingLog::add_content(std::string_view what, std::size_t count) {
  const auto known = std::find_if(report_.contents.begin(), report_.contents.end(),
                                  [&](const FileContent& content) { return content.what == what; });
  if (known != report_.contents.end()) {
    known->count += count;
  } else {
    report_.contents.push_back({std::string(what), count});
  }
}

void ReadingLog::leave_out(std::string_view name, std::string_view reason, std::size_t count) {
  const auto known = std::find_if(
      report_.left_out.begin(), report_.left_out.end(),
      [&](const LeftOut& entry) { return entry.name == name && entry.reason == reason; });
  if (known != report_.left_out.end()) {
    known->count += count;
  } else {
    report_.left_out.push_back({std::string(name), std::string(reason), count});
  }
}

void ReadingLog::warn(const ParseError& warning, std::string_view cause) {
  const auto known = std::find_if(warnings_.begin(), warnings_.end(), [&](const Warning& entry) {
    return cause.empty() ? entry.text == warning.what() : entry.cause == cause;
  });
  if (known != warnings_.end()) {
    ++known->count;
  } else {
    warnings_.push_back({warning.what(), std::string(cause), 1});
  }
}

void ReadingLog::add_error(const ParseError& error) { errors_.push_back(error); }

void ReadingLog::refuse(const ParseError& error, std::string_view cause) {
  if (options_.lenient) {
    warn(error, cause);
  } else {
    add_error(error);
  }
}

void ReadingLog::throw_errors() const {
  if (errors_.empty()) {
    return;
  }
  std::string message = errors_.front().message();
  for (std::size_t i = 1; i < std::min(errors_.size(), kMostErrors); ++i) {
    const bool is_same_file = errors_[i].path() == errors_.front().path();
    message += "; " + (is_same_file ? place(errors_[i]) + errors_[i].message() : errors_[i].what());
  }
  if (errors_.size() > kMostErrors) {
    message += "; and " + std::to_string(errors_.size() - kMostErrors) + " more errors";
  }
  throw with_message(errors_.front(), message);
}

FileReport ReadingLog::finish() {
  throw_errors();
  for (const Warning& warning : warnings_) {
    report_.warnings.push_back(warning.count == 1
                                   ? warning.text
                                   : warning.text + " (and " + std::to_string(warning.count - 1) +
                                         " more like it)");
  }
  warnings_.clear();
  return report_;
}

}  // namespace firstcontact::detail
