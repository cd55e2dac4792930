#include <firstcontact/scene/detail/add_report.h>

#include <algorithm>

namespace firstcontact::detail {

void add_report(const FileReport& report, LoadedScene& scene) {
  const auto is_same = [&](const FileReport& known) { return known.path == report.path; };
  if (std::any_of(scene.files.begin(), scene.files.end(), is_same)) {
    return;
  }
  scene.files.push_back(report);
  scene.warnings.insert(scene.warnings.end(), report.warnings.begin(), report.warnings.end());
}

void add_reports(const std::vector<FileReport>& reports, LoadedScene& scene) {
  scene.files.insert(scene.files.end(), reports.begin(), reports.end());
}

}  // namespace firstcontact::detail
