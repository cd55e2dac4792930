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

/// A header of `time` and joint names, as table_columns knows them, then one line of numbers for
/// each point. Columns are separated by commas, semicolons, tabs or blanks, as the header has them;
/// beside all but commas, numbers may have decimal commas. Comments, empty lines and a separator at
/// the end of a line are passed over.
///
/// @throws ParseError
[[nodiscard]] Trajectory read_trajectory_table(std::string_view text, const std::string& source,
                                               const RobotModel& robot);

}  // namespace firstcontact::detail
