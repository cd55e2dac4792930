/// @file
/// A path as a page holds it.

#pragma once

#include <firstcontact/page/path_look.h>
#include <firstcontact/text/json_tree.h>

namespace firstcontact::detail {

/// The path with its trees, in the form of the page (docs/viewer.md).
[[nodiscard]] JsonValue path_look_json(const PathLook& look);

}  // namespace firstcontact::detail
