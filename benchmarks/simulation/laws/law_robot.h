/// @file
/// The URDF of a robot in a scene of laws.py.

#pragma once

#include <filesystem>
#include <vector>

#include "benchmarks/simulation/laws/law_scene.h"

namespace firstcontact::benchmarks {

/// Reads the links of a robot, parents first.
///
/// @throws NotForPeer where a link has another geometry than a box, a ball or a cylinder, or a
///         frame is turned
std::vector<LawLink> read_links(const std::filesystem::path& urdf);

}  // namespace firstcontact::benchmarks
