/// @file
/// Reads the motion of a body of a fixture of Rigid IPC.

#pragma once

#include <firstcontact/foreign_scenes/detail/rigid_ipc_body.h>
#include <firstcontact/foreign_scenes/detail/rigid_ipc_keys.h>

namespace firstcontact::detail {

/// Reads a body.
///
/// @param entry  of "rigid_bodies"
/// @throws ParseError
[[nodiscard]] RigidIpcBody read_rigid_ipc_body(const JsonObject& entry, RigidIpcKeys& keys);

}  // namespace firstcontact::detail
