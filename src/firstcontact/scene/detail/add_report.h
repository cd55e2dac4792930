/// @file
/// Adds the report on a file to the scene that it was read for.

#pragma once

#include <vector>

namespace firstcontact {
struct FileReport;
struct LoadedScene;
}  // namespace firstcontact

namespace firstcontact::detail {

/// Adds a report to the files of a scene, and its warnings to the scene's warnings.
///
/// A file or a warning that the scene has already counts once.
void add_report(const FileReport& report, LoadedScene& scene);

/// Adds the reports on the scene's text.
void add_reports(const std::vector<FileReport>& reports, LoadedScene& scene);

}  // namespace firstcontact::detail
