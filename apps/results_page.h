/// @file
/// A page that lists the results of a batch, and plays each.

#pragma once

#include <functional>
#include <stop_token>
#include <string>

#include <firstcontact/scene/scene.h>

namespace firstcontact::app {

/// Reads results again, with the meshes of their scenes, and writes the page that lists them.
///
/// Some results are in the list, but cannot be played. With them the page would be larger than a
/// browser opens, or their meshes cannot be read any more.
///
/// @param results  the file of results, one in each line
/// @param page     the file of the page
/// @param reading  options of reading files of the scenes
/// @param stop     ends the work early, without a page
/// @param doing    called with the name of each part of the work
/// @returns a report in lines: the results that the page lists, but cannot play
///
/// @throws std::runtime_error, one line, where the viewer is missing or a file cannot be read or
///         written
[[nodiscard]] std::string write_results_page(const std::string& results, const std::string& page,
                                             const ReadingOptions& reading,
                                             const std::stop_token& stop,
                                             const std::function<void(std::string)>& doing);

}  // namespace firstcontact::app
