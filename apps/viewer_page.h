/// @file
/// The viewer's page, as it was built and installed beside the tool.

#pragma once

#include <string>

namespace firstcontact::app {

/// The page without a result: ../share/firstcontact/viewer.html, relative to the tool's folder.
///
/// @throws std::runtime_error, one line with the mend, where there is none
[[nodiscard]] std::string viewer_page();

}  // namespace firstcontact::app
