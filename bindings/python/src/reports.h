/// @file
/// Reports of files and counts of pairs, as firstcontact/_reports.py has them.

#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <firstcontact/scene/pair_counts.h>
#include <firstcontact/scene_files/write_reports.h>

namespace firstcontact::python {

inline pybind11::object report_function(const char* name) {
  return pybind11::module_::import("firstcontact._reports").attr(name);
}

inline pybind11::object files_tuple(std::span<const FileReport> reports) {
  return report_function("file_reports")(write_file_reports(reports));
}

inline pybind11::object pair_counts_tuple(const PairCounts& counts) {
  return report_function("pair_counts")(write_pair_counts(counts));
}

/// The text with control characters as escapes, as a representation shows it on a terminal.
inline std::string printable(const std::string& text) {
  const pybind11::str shown(text);
  if (shown.attr("isprintable")().cast<bool>()) {
    return text;
  }
  const auto quoted = pybind11::repr(shown).cast<std::string>();
  return quoted.substr(1, quoted.size() - 2);
}

/// The reports of a scene before it is loaded, for pickles.
inline pybind11::tuple reports_state(const std::vector<FileReport>& reports) {
  pybind11::list list;
  for (const FileReport& report : reports) {
    std::vector<std::pair<std::string, std::size_t>> contents;
    for (const FileContent& content : report.contents) {
      contents.emplace_back(content.what, content.count);
    }
    list.append(pybind11::make_tuple(report.path, report.format, contents, report.unit));
  }
  return pybind11::tuple(list);
}

inline std::vector<FileReport> reports_from(const pybind11::tuple& state) {
  std::vector<FileReport> reports;
  for (const pybind11::handle element : state) {
    const auto fields = element.cast<pybind11::tuple>();
    FileReport& report = reports.emplace_back();
    report.path = fields[0].cast<std::string>();
    report.format = fields[1].cast<std::string>();
    for (auto& [what, count] : fields[2].cast<std::vector<std::pair<std::string, std::size_t>>>()) {
      report.contents.push_back({what, count});
    }
    report.unit = fields[3].cast<std::string>();
  }
  return reports;
}

}  // namespace firstcontact::python
