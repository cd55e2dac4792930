#include <firstcontact/record/write_run.h>

#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <firstcontact/math/number_text.h>
#include <firstcontact/record/detail/scene_digest.h>
#include <firstcontact/record/run.h>
#include <firstcontact/record/run_step.h>
#include <firstcontact/scene_files/write_result.h>
#include <firstcontact/scene_files/write_scene.h>

namespace firstcontact {
namespace {

using Json = nlohmann::ordered_json;

double finite(double number) {
  if (!std::isfinite(number)) {
    throw std::invalid_argument("a run holds finite numbers only, got " + detail::shortest(number));
  }
  return number;
}

/// A step as text. A tree of it would take longer to write than many a step takes to compute.
class StepText {
 public:
  [[nodiscard]] std::string take() { return std::move(text_); }

  template <class Value>
  void field(const char* name, const Value& value) {
    begin_next();
    text_ += '"';
    text_ += name;
    text_ += "\":";
    has_before_ = false;
    add(value);
    has_before_ = true;
  }

  template <class Fields>
  void object(const Fields& fields) {
    enclose('{', fields, '}');
  }

  void add(bool value) {
    begin_next();
    text_ += value ? "true" : "false";
  }
  /// Adds the shortest text that reads back to the same double.
  ///
  /// A digit behind the point keeps the sign of zero.
  void add(double number) {
    begin_next();
    std::array<char, 32> digits;
    const char* end =
        std::to_chars(digits.data(), digits.data() + digits.size(), finite(number)).ptr;
    const std::string_view written(digits.data(), end);
    text_ += written;
    if (written.find_first_of(".e") == std::string_view::npos) {
      text_ += ".0";
    }
  }
  template <std::unsigned_integral Index>
  void add(Index index) {
    begin_next();
    text_ += std::to_string(index);
  }
  void add(const Eigen::Vector3d& v) {
    enclose(
        '[', [&] { append(v); }, ']');
  }
  void add(const Eigen::Quaterniond& q) {
    enclose(
        '[', [&] { append(q); }, ']');
  }
  template <class T>
  void add(const std::vector<T>& elements) {
    add_range(elements);
  }
  template <class T, std::size_t size>
  void add(const std::array<T, size>& elements) {
    add_range(elements);
  }

  void add(const RunPiece& piece) {
    const auto numbers = [&] {
      add(piece.to);
      append(piece.X_WB.position);
      append(piece.X_WB.rotation);
      append(piece.translation);
      append(piece.rotation_vector);
    };
    enclose('[', numbers, ']');
  }
  void add(const RunBody& body) {
    object([&] {
      field("body", body.body);
      field("pieces", body.pieces);
      field("position", body.X_WB.position);
      field("quaternion_wxyz", body.X_WB.rotation);
      field("linear_velocity", body.linear_velocity);
      field("angular_velocity", body.angular_velocity);
      if (body.rests) {
        field("rests", true);
      }
      if (body.behind > 0.0) {
        field("behind", body.behind);
      }
    });
  }
  void add(const RunRobot& robot) {
    object([&] {
      field("robot", robot.robot);
      field("positions", robot.positions);
      field("velocities", robot.velocities);
      field("efforts", robot.efforts);
    });
  }
  void add(const Feature& feature) {
    object([&] {
      begin_next();
      text_ += "\"type\":\"";
      text_ += word(feature.type);
      text_ += '"';
      field("index", feature.index);
    });
  }
  void add(const RunContact& contact) {
    object([&] {
      field("bodies", contact.bodies);
      field("features", std::array{contact.feature_A, contact.feature_B});
      field("triangles", std::array{contact.feature_A.triangle, contact.feature_B.triangle});
      field("point", contact.point);
      field("normal", contact.normal);
      field("distance", contact.distance);
      field("impulse", contact.impulse);
    });
  }
  void add(const RunTie& tie) {
    object([&] {
      field("force", tie.force);
      if (tie.torque.any()) {
        field("torque", tie.torque);
      }
    });
  }
  void add(const RunDevice& device) {
    object([&] {
      field("body", device.body);
      field("position", device.X_WB.position);
      field("quaternion_wxyz", device.X_WB.rotation);
      field("force", device.force);
      field("torque", device.torque);
      if (!device.links.empty()) {
        field("links", device.links);
      }
    });
  }
  void add(const RunDeviceLink& link) {
    object([&] {
      field("body", link.body);
      field("position", link.X_WB.position);
      field("quaternion_wxyz", link.X_WB.rotation);
    });
  }
  void add(const RunImpact& impact) {
    object([&] {
      field("at", impact.at);
      field("bodies", impact.bodies);
      field("point", impact.point);
      field("impulse", impact.impulse);
    });
  }
  /// Adds a clearance; null where no pair was near.
  void add_clearance(double clearance) {
    if (clearance == std::numeric_limits<double>::infinity()) {
      begin_next();
      text_ += "\"clearance\":null";
    } else {
      field("clearance", clearance);
    }
  }

 private:
  void begin_next() {
    if (has_before_) {
      text_ += ',';
    }
    has_before_ = true;
  }
  template <class Content>
  void enclose(char open, const Content& content, char close) {
    begin_next();
    text_ += open;
    has_before_ = false;
    content();
    text_ += close;
    has_before_ = true;
  }
  void append(const Eigen::Vector3d& v) {
    add(v.x());
    add(v.y());
    add(v.z());
  }
  void append(const Eigen::Quaterniond& q) {
    add(q.w());
    add(q.x());
    add(q.y());
    add(q.z());
  }
  template <class Range>
  void add_range(const Range& elements) {
    const auto each = [&] {
      for (const auto& element : elements) {
        add(element);
      }
    };
    enclose('[', each, ']');
  }

  std::string text_;
  bool has_before_ = false;  // Whether a value stands before in the open object or array.
};

Json to_json(const Eigen::Vector3d& v) {
  return Json::array({finite(v.x()), finite(v.y()), finite(v.z())});
}
Json to_json(double number) { return finite(number); }

template <class T>
Json to_json(const std::vector<T>& elements) {
  Json array = Json::array();
  for (const T& element : elements) {
    array.push_back(to_json(element));
  }
  return array;
}

}  // namespace

std::string write_run_header(const RunHeader& header) {
  const std::string scene = write_scene(header.scene);
  const Json rest = {{"version", header.version},
                     {"scene_digest", header.scene.text_digest},
                     {"resolved_digest", detail::digest_of_scene(scene)},
                     {"input_digest", header.input_digest},
                     {"masses", to_json(header.masses)},
                     {"centres_of_mass", to_json(header.centres_of_mass)}};
  const char* kind = header.kind == RunKind::haptics ? "\"kind\":\"haptics\"," : "";
  // The scene has a writer of its own.
  return std::string("{\"firstcontact_run\":1,") + kind + "\"scene\":" + scene + "," +
         rest.dump().substr(1) + "\n";
}

std::string write_run_step(const RunStep& step) {
  StepText text;
  text.object([&] {
    text.field("step", step.index);
    text.field("time", step.time);
    text.field("lasted", step.lasted);
    text.field("time_lost", step.time_lost);
    text.field("bodies", step.bodies);
    text.field("contacts", step.contacts);
    text.add_clearance(step.clearance);
    text.field("kinetic_energy", step.kinetic_energy);
    text.field("potential_energy", step.potential_energy);
    text.field("linear_momentum", step.linear_momentum);
    text.field("angular_momentum", step.angular_momentum);
    text.field("residual", step.residual);
    text.field("events", step.events);
    if (!step.robots.empty()) {
      text.field("robots", step.robots);
    }
    if (!step.impacts.empty()) {
      text.field("impacts", step.impacts);
    }
    if (!step.ties.empty()) {
      text.field("ties", step.ties);
    }
    if (!step.devices.empty()) {
      text.field("devices", step.devices);
    }
  });
  return text.take() + "\n";
}

}  // namespace firstcontact
