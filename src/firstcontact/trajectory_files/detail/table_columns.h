/// @file
/// The meaning of the columns of a trajectory's table, by their names.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/scene/trajectory.h>

namespace firstcontact {
class RobotModel;
}

namespace firstcontact::detail {

/// The meaning of the numbers of a column.
struct TableColumn {
  enum class Kind {
    time,     ///< [s]
    numbers,  ///< Numbers of a joint.
    row,      ///< Counts the rows from 0 on; has no meaning.
    effort,   ///< Efforts of a joint; they move nothing.
  };
  std::string name;  ///< Name in the header.
  Kind kind = Kind::time;
  std::vector<double> TrajectoryPoint::*numbers = nullptr;
  std::size_t joint = 0;  ///< Index among the joint names.
};

/// The columns of a table, and the joints in the order of their columns of positions.
struct TableColumns {
  std::vector<TableColumn> columns;
  std::vector<std::string> joint_names;  ///< Names of the robot; fixed joints, too.
};

/// Whether a column of this name holds the time [s].
///
/// That is "time" in any capitals, alone or with its unit as "time [s]"; or "__time",
/// "time_from_start".
[[nodiscard]] bool is_time_column(std::string_view name);

/// Finds the meaning of columns by their names.
///
/// They are:
/// - the time;
/// - positions by the joint's name, which may have its unit ("rad" where it turns, "m" where it
///   slides) or ".position" after it;
/// - NAME.velocity, NAME.acceleration, NAME.effort, also with '/' in place of the point and then
///   with a topic before the joint;
/// - an unnamed first column, which counts the rows.
///
/// @throws std::invalid_argument  names the column, and what was expected in its place
[[nodiscard]] TableColumns table_columns(const std::vector<std::string>& names,
                                         const RobotModel& robot);

}  // namespace firstcontact::detail
