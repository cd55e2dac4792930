#include <firstcontact/trajectory_files/read_trajectory.h>

#include <string>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/text/file_extension.h>
#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/read_file.h>
#include <firstcontact/text/text_tree.h>
#include <firstcontact/trajectory_files/detail/joint_trajectory.h>
#include <firstcontact/trajectory_files/detail/trajectory_table.h>

namespace firstcontact {

Trajectory parse_trajectory(std::string_view text, const std::filesystem::path& source,
                            const RobotModel& robot) {
  const FloatEnvironmentGuard guard;
  const std::string name = source.string();
  const std::string extension = detail::file_extension(source);
  if (extension == "csv") {
    return detail::read_trajectory_table(text, name, robot);
  }
  if (!detail::is_tree_extension(extension)) {
    throw ParseError(name, "expected a trajectory, a .json, .yaml or .csv file");
  }
  const detail::JsonValue root = detail::parse_tree(text, source);
  return detail::read_joint_trajectory(root, robot, name, detail::JsonReader(root, name));
}

Trajectory read_trajectory(const std::filesystem::path& path, const RobotModel& robot) {
  return parse_trajectory(detail::read_file(path, "a trajectory file"), path, robot);
}

}  // namespace firstcontact
