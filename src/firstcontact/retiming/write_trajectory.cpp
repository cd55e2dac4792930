#include <firstcontact/retiming/write_trajectory.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <stdexcept>
#include <vector>

#include <firstcontact/retiming/executed_proof.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

constexpr std::int64_t kNanosecondsInSecond = 1'000'000'000;

/// The text of a number that YAML 1.1 reads as a number: 1.0e-07, not 1e-07.
std::string yaml_number(double value) {
  std::string text = detail::write_json(value);
  const std::size_t exponent = text.find('e');
  std::string mantissa = text.substr(0, exponent);
  if (mantissa.find('.') == std::string::npos) {
    mantissa += ".0";
  }
  if (exponent == std::string::npos) {
    return mantissa;
  }
  std::string power = text.substr(exponent + 1);
  if (power.front() != '-' && power.front() != '+') {
    power.insert(power.begin(), '+');
  }
  return mantissa + 'e' + power;
}

template <class Write>
std::string list_of(const std::vector<double>& numbers, const Write& write) {
  std::string text = "[";
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    text += (k == 0 ? "" : ", ") + write(numbers[k]);
  }
  return text + "]";
}

std::string names_of(const TimedMotion& motion) {
  std::string text = "[";
  for (std::size_t k = 0; k < motion.joint_names.size(); ++k) {
    text += (k == 0 ? "" : ", ") + detail::write_json(std::string_view(motion.joint_names[k]));
  }
  return text + "]";
}

std::string seconds_and_nanoseconds(const TimedPoint& point, const char* quote) {
  const auto key = [quote](const char* name) { return quote + std::string(name) + quote; };
  return "{" + key("sec") + ": " + std::to_string(point.time / kNanosecondsInSecond) + ", " +
         key("nanosec") + ": " + std::to_string(point.time % kNanosecondsInSecond) + "}";
}

std::string write_yaml(const TimedMotion& motion) {
  std::string text = "joint_names: " + names_of(motion) + "\npoints:\n";
  for (const TimedPoint& point : motion.points) {
    text += "- positions: " + list_of(point.positions, yaml_number) + "\n";
    if (motion.has_velocities()) {
      text += "  velocities: " + list_of(point.velocities, yaml_number) + "\n";
    }
    if (motion.has_accelerations()) {
      text += "  accelerations: " + list_of(point.accelerations, yaml_number) + "\n";
    }
    text += "  time_from_start: " + seconds_and_nanoseconds(point, "") + "\n";
  }
  return text;
}

std::string write_json_message(const TimedMotion& motion) {
  const auto number = [](double value) { return detail::write_json(value); };
  std::string text = "{\"joint_names\": " + names_of(motion) + ",\n \"points\": [";
  for (std::size_t k = 0; k < motion.points.size(); ++k) {
    const TimedPoint& point = motion.points[k];
    text += (k == 0 ? "\n" : ",\n");
    text += "  {\"positions\": " + list_of(point.positions, number);
    if (motion.has_velocities()) {
      text += ",\n   \"velocities\": " + list_of(point.velocities, number);
    }
    if (motion.has_accelerations()) {
      text += ",\n   \"accelerations\": " + list_of(point.accelerations, number);
    }
    text += ",\n   \"time_from_start\": " + seconds_and_nanoseconds(point, "\"") + "}";
  }
  return text + "\n]}\n";
}

/// A time as "1.000000250": with all nine digits it is whole nanoseconds for any reader.
std::string decimal_seconds(std::int64_t time) {
  std::string digits = std::to_string(time % kNanosecondsInSecond);
  digits.insert(0, 9 - digits.size(), '0');
  return std::to_string(time / kNanosecondsInSecond) + "." + digits;
}

/// A name, quoted where the reader would split it.
std::string csv_name(const std::string& name) {
  if (name.find_first_of(",;\"\t #%") == std::string::npos) {
    return name;
  }
  std::string quoted = "\"";
  for (const char c : name) {
    quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  }
  return quoted + "\"";
}

std::string write_csv(const TimedMotion& motion) {
  std::string text = "time";
  const auto add_header = [&](const char* ending) {
    for (const std::string& name : motion.joint_names) {
      text += ',';
      text += csv_name(name + ending);
    }
  };
  add_header("");
  if (motion.has_velocities()) {
    add_header(".velocity");
  }
  if (motion.has_accelerations()) {
    add_header(".acceleration");
  }
  text += '\n';
  for (const TimedPoint& point : motion.points) {
    text += decimal_seconds(point.time);
    for (const std::vector<double>* numbers :
         {&point.positions, &point.velocities, &point.accelerations}) {
      for (const double value : *numbers) {
        text += "," + detail::write_json(value);
      }
    }
    text += '\n';
  }
  return text;
}

}  // namespace

TrajectoryFormat trajectory_format_of(std::string_view path) {
  const auto ends = [&](std::string_view ending) { return path.ends_with(ending); };
  if (ends(".yaml") || ends(".yml")) {
    return TrajectoryFormat::yaml;
  }
  if (ends(".json")) {
    return TrajectoryFormat::json;
  }
  if (ends(".csv")) {
    return TrajectoryFormat::csv;
  }
  throw std::invalid_argument("expected a trajectory file .yaml, .json or .csv, got " +
                              detail::in_quotes(path));
}

std::string write_trajectory(const TimedMotion& motion, TrajectoryFormat format) {
  switch (format) {
    case TrajectoryFormat::json:
      return write_json_message(motion);
    case TrajectoryFormat::csv:
      return write_csv(motion);
    case TrajectoryFormat::yaml:
      break;
  }
  return write_yaml(motion);
}

void require_names(const std::vector<std::string>& joint_names, TrajectoryFormat format,
                   const RobotModel& robot) {
  const auto are_kept = [&](const std::vector<std::string>& names) {
    const std::vector<double> zeros(names.size(), 0.0);
    const TimedMotion motion{
        .joint_names = names,
        .points = {{0, zeros, zeros, zeros}, {kNanosecondsInSecond, zeros, zeros, zeros}}};
    const std::string file =
        std::string("names") + kTrajectoryEndings.at(static_cast<std::size_t>(format));
    try {
      return parse_timed_motion(write_trajectory(motion, format), file, robot) == motion;
    } catch (const std::exception&) {
      return false;
    }
  };
  if (are_kept(joint_names)) {
    return;
  }
  const auto lost =
      std::ranges::find_if(joint_names, [&](const std::string& name) { return !are_kept({name}); });
  throw std::invalid_argument(
      "joint " + detail::in_quotes(lost != joint_names.end() ? *lost : joint_names.back()) +
      ": this name cannot be written as " +
      kTrajectoryEndings.at(static_cast<std::size_t>(format)) +
      ", as it would be read as something else; write another format");
}

}  // namespace firstcontact
