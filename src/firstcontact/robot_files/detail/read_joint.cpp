#include <firstcontact/robot_files/detail/read_joint.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <system_error>
#include <vector>

#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/read_double.h>
#include <firstcontact/text/text_cursor.h>

namespace firstcontact::detail {
namespace {

struct TypeWord {
  const char* word;
  JointType type;
};
constexpr std::array<TypeWord, 9> kTypes = {{{"fixed", JointType::fixed},
                                             {"revolute", JointType::revolute},
                                             {"continuous", JointType::continuous},
                                             {"prismatic", JointType::prismatic},
                                             {"planar", JointType::planar},
                                             {"floating", JointType::floating},
                                             {"screw", JointType::screw},
                                             {"ball", JointType::ball},
                                             {"spherical", JointType::ball}}};

/// Reads one joint.
class JointReader {
 public:
  JointReader(const XmlElement& element, const UrdfContext& context)
      : element_(element), context_(context), xml_(context.xml) {}

  std::optional<Joint> read() {
    context_.names.check(element_, urdf_names().joint);
    bool is_whole = false;
    context_.attempt([&] {
      joint_.name = xml_.text(element_, "name");
      joint_.type = type();
      joint_.parent = link_name("parent");
      joint_.child = link_name("child");
      is_whole = true;
    });
    if (!is_whole) {
      return {};
    }
    context_.attempt([&] { joint_.X_PJ = context_.origin(element_); });
    context_.attempt([&] { read_axis(); });
    context_.attempt([&] { read_pitch(); });
    context_.attempt([&] { read_limits(); });
    context_.attempt([&] { read_mimic(); });
    context_.attempt([&] { read_dynamics(); });
    return joint_;
  }

 private:
  JointType type() const {
    const std::string word = xml_.text(element_, "type");
    std::string known;
    for (const TypeWord& entry : kTypes) {
      if (word == entry.word) {
        return entry.type;
      }
      known += (known.empty() ? "" : ", ") + std::string(entry.word);
    }
    xml_.fail(element_, "unknown joint type " + detail::quoted(word) + "; known are: " + known);
  }

  std::string link_name(const char* role) const {
    const XmlElement& element = xml_.required_child(element_, role);
    context_.names.check(element, urdf_names().link_name);
    return xml_.text(element, "link");
  }

  void read_axis() {
    const XmlElement* axis = xml_.child(element_, "axis");
    if (axis == nullptr) {
      return;
    }
    context_.names.check(*axis, urdf_names().axis);
    if (axis->Attribute("rpy") != nullptr) {
      Pose turn;
      if (!xml_.vector3(*axis, "rpy").isZero(0.0)) {
        turn.rotation = Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);  // Any rotation.
      }
      context_.pass_over_pose(*axis, "'rpy' of an <axis>", turn);
    }
    if (axis->Attribute("xyz") == nullptr) {
      return;
    }
    const Eigen::Vector3d direction = xml_.vector3(*axis, "xyz");
    // Tools write a zero axis for joints that have none.
    const bool has_none = joint_.type == JointType::fixed || joint_.type == JointType::floating ||
                          joint_.type == JointType::ball;
    if (!has_none || !direction.isZero(0.0)) {
      joint_.axis = direction;
    }
  }

  void read_pitch() {
    if (joint_.type == JointType::screw) {
      joint_.pitch = xml_.number(element_, "pitch");
    } else if (element_.Attribute("pitch") != nullptr) {
      xml_.fail(element_, "'pitch' belongs to joints of type screw");
    }
  }

  void read_limits() {
    const bool is_bounded =
        joint_.type == JointType::revolute || joint_.type == JointType::prismatic;
    const XmlElement* element = xml_.child(element_, "limit");
    if (element == nullptr) {
      if (is_bounded) {
        xml_.fail(element_, "expected an element <limit> inside: the joint is " +
                                std::string(to_string(joint_.type)));
      }
      return;
    }
    context_.names.check(*element, urdf_names().limit);
    JointLimits& limits = joint_.limits;
    limits.lower = limit(*element, "lower");
    limits.upper = limit(*element, "upper");
    limits.velocity = not_negative(*element, "velocity");
    limits.effort = not_negative(*element, "effort");
    if (is_bounded) {  // Both are 0 where they are left out.
      limits.lower = element->Attribute("lower") == nullptr ? 0.0 : limits.lower;
      limits.upper = element->Attribute("upper") == nullptr ? 0.0 : limits.upper;
    } else if (joint_.type == JointType::continuous) {  // They have no meaning for continuous
                                                        // joints.
      limits.lower.reset();
      limits.upper.reset();
    }
    if (limits.lower && limits.upper && *limits.lower > *limits.upper) {
      context_.log.warn(xml_.error(element_,
                                   "its lower limit is above its upper limit: neither "
                                   "is looked at"),
                        "lower limit above upper");
      limits.lower.reset();
      limits.upper.reset();
    }
  }

  /// A limit; none where it is missing, or so great that it does not limit.
  ///
  /// Writers put infinities and the greatest double there.
  std::optional<double> limit(const XmlElement& element, const char* attribute) const {
    constexpr double kEndless = 1e60;
    if (element.Attribute(attribute) == nullptr) {
      return {};
    }
    const std::string word = xml_.text(element, attribute);
    const char* end = word.data() + word.size();
    double value = 0.0;
    const auto [stop, error] =
        read_double(word.data() + (word.starts_with('+') ? 1 : 0), end, value);
    const bool is_endless = error == std::errc::result_out_of_range || std::abs(value) > kEndless;
    if (stop == end && is_endless) {
      context_.log.leave_out("'" + std::string(attribute) + "' of <limit>", "so great as none");
      return {};
    }
    return xml_.number(element, attribute);
  }

  /// A limit; none, with a warning, where it is negative, as no joint could obey it.
  std::optional<double> not_negative(const XmlElement& limit, const char* attribute) const {
    const std::optional<double> number = this->limit(limit, attribute);
    if (!number || *number >= 0.0) {
      return number;
    }
    context_.log.warn(xml_.error(element_, "its limit of '" + std::string(attribute) +
                                               "' is negative: it is not looked at"),
                      std::string("negative ") + attribute);
    return {};
  }

  void read_mimic() {
    const XmlElement* plain = xml_.child(element_, "mimic");
    const XmlElement* drakes = xml_.child(element_, "drake:mimic");
    const XmlElement* element = plain != nullptr ? plain : drakes;
    if (element == nullptr) {
      return;
    }
    context_.names.check(*element, urdf_names().mimic);
    if (joint_.type == JointType::fixed) {
      context_.log.warn(xml_.error(element_,
                                   "a fixed joint mimics nothing; its <mimic> is left "
                                   "out"),
                        "mimic of a fixed joint");
      return;
    }
    const Mimic mimic = read_mimic(*element);
    if (plain != nullptr && drakes != nullptr && !is_same(mimic, read_mimic(*drakes))) {
      xml_.fail(*drakes, "it contradicts the <mimic> beside it; keep one");
    }
    joint_.mimic = mimic;
  }

  [[nodiscard]] Mimic read_mimic(const XmlElement& element) const {
    return {.joint = xml_.text(element, "joint"),
            .multiplier = xml_.optional_number(element, "multiplier").value_or(1.0),
            .offset = xml_.optional_number(element, "offset").value_or(0.0)};
  }

  static bool is_same(const Mimic& a, const Mimic& b) {
    return a.joint == b.joint && a.multiplier == b.multiplier && a.offset == b.offset;
  }

  void read_dynamics() {
    if (const XmlElement* dynamics = xml_.child(element_, "dynamics")) {
      context_.names.check(*dynamics, urdf_names().dynamics);
      joint_.damping = xml_.optional_number(*dynamics, "damping").value_or(0.0);
      joint_.friction = xml_.optional_number(*dynamics, "friction").value_or(0.0);
    }
  }

  const XmlElement& element_;
  const UrdfContext& context_;
  const XmlReader& xml_;
  Joint joint_;
};

}  // namespace

std::optional<Joint> read_joint(const XmlElement& element, const UrdfContext& context) {
  return JointReader(element, context).read();
}

}  // namespace firstcontact::detail
