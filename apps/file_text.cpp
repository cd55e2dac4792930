#include "file_text.h"

#include <fmt/core.h>

#include "terminal_text.h"

namespace firstcontact::app {

std::string contents_text(const FileReport& report) {
  std::string text = report.format;
  for (const FileContent& content : report.contents) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", content.count, content.what);
  }
  return text + (report.unit.empty() ? "" : "; unit of lengths: " + report.unit);
}

std::string left_out_text(const FileReport& report) {
  std::string text;
  for (const LeftOut& left_out : report.left_out) {
    text += fmt::format("{}{} {} ({})", text.empty() ? "" : ", ", left_out.count, left_out.name,
                        left_out.reason);
  }
  return text;
}

std::string describe_files(std::span<const FileReport> reports) {
  std::string text;
  const auto line = [&text](const std::string& value) { text += visible(value) + "\n"; };
  for (const FileReport& report : reports) {
    line(fmt::format("    {}: {}", report.path, contents_text(report)));
    if (const std::string left_out = left_out_text(report); !left_out.empty()) {
      line("      left out: " + left_out);
    }
    for (const std::string& file : report.also_read) {
      line("      with: " + file);
    }
    if (!report.warnings.empty()) {
      line(fmt::format("      warnings: {}", report.warnings.size()));
    }
  }
  return text;
}

}  // namespace firstcontact::app
