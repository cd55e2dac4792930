/// @file
/// Reads a trajectory from a table.

#pragma once

#include <string>
#include <string_view>

#include <firstcontact/scene/trajectory.h>

namespace firstcontact {
class RobotModel;
}

namespace firstcontact::detail {

/// Reads a header of `time` and joint names (table_columns()), then a line of numbers for each
/// point.
///
/// Commas, semicolons, tabs or blanks separate columns, as in the header. With any separator but
/// commas, numbers may have decimal commas. Comments, empty lines and a separator at the end of a
/// line are passed over.
///
/// @throws ParseError
[[nodiscard]] Trajectory read_trajectory_table(std::string_view text, const std::string& source,
                                               const RobotModel& robot);

}  // namespace firstcontact::detail
