#include <firstcontact/scene/detail/add_report.h>

#include <algorithm>
#include <string>

#include <firstcontact/scene/loaded_scene.h>

#include <firstcontact/text/file_report.h>

namespace firstcontact::detail {

void add_report(const FileReport& report, LoadedScene& scene) {
  const auto is_same = [&](const FileReport& known) { return known.path == report.path; };
  if (std::any_of(scene.files.begin(), scene.files.end(), is_same)) {
    return;
  }
  scene.files.push_back(report);
  for (const std::string& warning : report.warnings) {
    if (std::find(scene.warnings.begin(), scene.warnings.end(), warning) == scene.warnings.end()) {
      scene.warnings.push_back(warning);
    }
  }
}

void add_reports(const std::vector<FileReport>& reports, LoadedScene& scene) {
  for (const FileReport& report : reports) {
    add_report(report, scene);
  }
}

}  // namespace firstcontact::detail
