#include <firstcontact/scene_files/detail/text_reports.h>

#include <string>
#include <utility>
#include <vector>

#include <firstcontact/scene/trajectory.h>

namespace firstcontact::detail {
namespace {

FileReport report_of(const std::filesystem::path& file, const char* format,
                     std::vector<FileContent> contents) {
  FileReport report;
  report.path = file.string();
  report.format = format;
  report.contents = std::move(contents);
  return report;
}

}  // namespace

FileReport surroundings_report(const std::filesystem::path& file, const char* format,
                               std::size_t bodies) {
  FileReport report = report_of(file, format, {{"bodies", bodies}});
  report.unit = "1 m";
  return report;
}

FileReport trajectory_report(const std::filesystem::path& file, const Trajectory& trajectory) {
  return report_of(
      file, "trajectory",
      {{"joints", trajectory.joint_names.size()}, {"points", trajectory.points.size()}});
}

}  // namespace firstcontact::detail
