#include <firstcontact/robot_files/read_asf.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <stdexcept>
#include <utility>

#include <firstcontact/robot_files/detail/asf_angles.h>
#include <firstcontact/text/read_file.h>
#include <firstcontact/text/word_reader.h>

namespace firstcontact {
namespace {

using detail::kDegree;
using detail::same_word;
using detail::turned_xyz;
using detail::WordReader;

/// A bone of the file: directions are in the frame of the whole figure at zero.
struct AsfBone {
  std::string name;
  Eigen::Vector3d reach = Eigen::Vector3d::Zero();  // [m]  Vector from its origin to its end.
  Eigen::Quaterniond axis = Eigen::Quaterniond::Identity();
  std::vector<std::size_t> dof;
};

class AsfReader {
 public:
  AsfReader(std::string_view text, const std::string& source, const AsfOptions& options)
      : words_(text, source, "()") {
    if (!(options.unit_length > 0.0 && options.unit_length <= 1e6)) {
      throw std::invalid_argument("AsfOptions::unit_length must be in (0, 1e6]");
    }
    skeleton_.unit_length = options.unit_length;
    skeleton_.figure.name = "figure";
  }

  AsfSkeleton run() {
    while (!words_.at_end()) {
      read_section();
    }
    if (!placed_) {
      words_.fail_expected("a section :hierarchy");
    }
    return std::move(skeleton_);
  }

 private:
  void read_section() {
    const std::string_view section = words_.peek();
    if (same_word(section, ":units")) {
      words_.expect(":units");
      read_units();
    } else if (same_word(section, ":root")) {
      words_.expect(":root");
      read_root();
    } else if (same_word(section, ":bonedata")) {
      words_.expect(":bonedata");
      while (same_word(words_.peek(), "begin")) {
        read_bone();
      }
    } else if (same_word(section, ":hierarchy")) {
      words_.expect(":hierarchy");
      read_hierarchy();
    } else if (same_word(section, ":version") || same_word(section, ":name") ||
               same_word(section, ":documentation") || same_word(section, ":skin")) {
      pass_over();
    } else {
      words_.fail_expected("a section, such as :bonedata");
    }
  }

  [[nodiscard]] bool at_section() const { return words_.at_end() || words_.peek().front() == ':'; }

  /// Passes over free text, up to the next section.
  void pass_over() {
    do {
      (void)words_.word("");
    } while (!at_section());
  }

  void read_units() {
    while (!at_section()) {
      const std::string unit(words_.word("a unit"));
      if (same_word(unit, "mass")) {
        (void)words_.number("a unit of mass");
      } else if (same_word(unit, "length")) {
        const double length = words_.number("a unit of length");
        if (!(length > 1e-6 && length < 1e6)) {
          words_.fail("expected a unit of length between 1e-6 and 1e6");
        }
        skeleton_.unit_length /= length;
      } else if (same_word(unit, "angle")) {
        skeleton_.degrees = same_word(words_.peek(), "deg");
        words_.expect(skeleton_.degrees ? "deg" : "rad");
      } else {
        words_.fail("expected a unit of mass, length or angle, got '" + unit.substr(0, 40) + "'");
      }
    }
  }

  /// Reads three angles and the order of their axes.
  Eigen::Quaterniond read_axis() {
    const Eigen::Vector3d angles = words_.vector("an angle of the axis");
    words_.expect("XYZ");
    return turned_xyz((skeleton_.degrees ? kDegree : 1.0) * angles);
  }

  void read_root() {
    if (!skeleton_.channels.empty()) {
      words_.fail("a second section :root");
    }
    skeleton_.channels.emplace_back();
    while (!at_section()) {
      const std::string key(words_.word("a line of the root"));
      if (same_word(key, "order")) {
        read_root_order();
      } else if (same_word(key, "axis")) {
        words_.expect("XYZ");
      } else if (same_word(key, "position")) {
        skeleton_.root.position = skeleton_.unit_length * words_.vector("a position");
      } else if (same_word(key, "orientation")) {
        skeleton_.root.rotation =
            turned_xyz((skeleton_.degrees ? kDegree : 1.0) * words_.vector("an orientation"));
      } else {
        words_.fail("expected order, axis, position or orientation of the root, got '" +
                    key.substr(0, 40) + "'");
      }
    }
    if (skeleton_.channels[0].size() != 6) {
      words_.fail("the root has no line `order` of six channels");
    }
  }

  void read_root_order() {
    constexpr std::array<const char*, 6> kOrder = {"TX", "TY", "TZ", "RX", "RY", "RZ"};
    std::vector<std::size_t>& channels = skeleton_.channels[0];
    for (std::size_t k = 0; k < 6; ++k) {
      const auto found = std::find_if(kOrder.begin(), kOrder.end(), [&](const char* name) {
        return same_word(words_.peek(), name);
      });
      const auto channel = static_cast<std::size_t>(found - kOrder.begin());
      if (found == kOrder.end() ||
          std::find(channels.begin(), channels.end(), channel) != channels.end()) {
        words_.fail_expected("each of TX TY TZ RX RY RZ once");
      }
      (void)words_.word("");
      channels.push_back(channel);
    }
  }

  void read_bone() {
    words_.expect("begin");
    AsfBone bone;
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    double length = 0.0;
    while (!same_word(words_.peek(), "end")) {
      const std::string key(words_.word("a line of a bone, or end"));
      if (same_word(key, "id")) {
        (void)words_.word("an id");
      } else if (same_word(key, "name")) {
        bone.name = words_.word("a name");
      } else if (same_word(key, "direction")) {
        direction = words_.vector("a direction");
      } else if (same_word(key, "length")) {
        length = words_.number("a length");
      } else if (same_word(key, "axis")) {
        bone.axis = read_axis();
      } else if (same_word(key, "dof")) {
        read_dof(bone);
      } else if (same_word(key, "limits") || same_word(key, "bodymass") ||
                 same_word(key, "cofmass")) {
        pass_over_numbers();
      } else {
        words_.fail("expected a line of a bone, such as direction, got '" + key.substr(0, 40) +
                    "'");
      }
    }
    finish_bone(bone, direction, length);
    words_.expect("end");
  }

  void finish_bone(AsfBone& bone, const Eigen::Vector3d& direction, double length) {
    if (bone.name.empty() || same_word(bone.name, "root") || bones_.contains(bone.name)) {
      words_.fail("expected a bone of a name of its own, got '" + bone.name.substr(0, 40) + "'");
    }
    if (!(length >= 0.0) || (length > 0.0 && !(direction.norm() > 1e-6))) {
      words_.fail("bone '" + bone.name + "' needs a length >= 0 and a direction");
    }
    if (length > 0.0) {
      bone.reach = skeleton_.unit_length * length * direction.normalized();
    }
    bones_.emplace(bone.name, bone);
  }

  void read_dof(AsfBone& bone) {
    constexpr std::array<const char*, 3> kTurns = {"rx", "ry", "rz"};
    while (words_.peek().size() == 2 && (words_.peek().front() | 0x20) == 'r') {
      const auto found = std::find_if(kTurns.begin(), kTurns.end(), [&](const char* name) {
        return same_word(words_.peek(), name);
      });
      const auto axis = static_cast<std::size_t>(found - kTurns.begin());
      if (found == kTurns.end() ||
          std::find(bone.dof.begin(), bone.dof.end(), axis) != bone.dof.end()) {
        words_.fail_expected("each of rx, ry and rz at most once");
      }
      (void)words_.word("");
      bone.dof.push_back(axis);
    }
    if (bone.dof.empty()) {
      words_.fail_expected("rx, ry or rz: bones turn only");
    }
  }

  /// Passes over limits, which may be `-inf` and `inf`.
  void pass_over_numbers() {
    const auto is_number = [](std::string_view word) {
      return !word.empty() &&
             (same_word(word, "inf") || !std::isalpha(static_cast<unsigned char>(word.front())));
    };
    while (is_number(words_.peek())) {
      (void)words_.word("");
    }
  }

  void read_hierarchy() {
    if (skeleton_.channels.empty()) {
      words_.fail("the section :root comes before :hierarchy");
    }
    if (placed_) {
      words_.fail("a second section :hierarchy");
    }
    placed_ = true;
    words_.expect("begin");
    place_root();
    while (!same_word(words_.peek(), "end")) {
      const std::string parent(words_.word("a bone, or end"));
      const auto found = placed_as_.find(parent);
      if (found == placed_as_.end()) {
        words_.fail("bone '" + parent.substr(0, 40) + "' has children before it is a child itself");
      }
      for (const std::string& child : rest_of_line()) {
        place(child, found->second);
      }
    }
    words_.expect("end");
    if (placed_as_.size() != bones_.size() + 1) {
      words_.fail("only " + std::to_string(placed_as_.size() - 1) + " of " +
                  std::to_string(bones_.size()) + " bones are in the hierarchy");
    }
  }

  std::vector<std::string> rest_of_line() {
    std::vector<std::string> words;
    while (!words_.at_end() && words_.on_line_of_last()) {
      words.emplace_back(words_.word(""));
    }
    return words;
  }

  void place_root() {
    Bone root;
    root.name = "root";
    skeleton_.figure.bones.push_back(root);
    axes_.push_back(Eigen::Quaterniond::Identity());
    reaches_.emplace_back(Eigen::Vector3d::Zero());
    placed_as_.emplace("root", 0);
  }

  /// Places a bone in its own frame, which the axis turns against that of the figure.
  void place(const std::string& name, std::size_t parent) {
    const auto found = bones_.find(name);
    if (found == bones_.end()) {
      words_.fail("the hierarchy names an unknown bone '" + name.substr(0, 40) + "'");
    }
    const AsfBone& bone = found->second;
    if (!placed_as_.emplace(name, skeleton_.figure.bones.size()).second) {
      words_.fail("bone '" + name.substr(0, 40) + "' is in the hierarchy twice");
    }
    Bone placed;
    placed.name = name;
    placed.parent = parent;
    placed.X_PB = {axes_[parent].conjugate() * reaches_[parent],
                   axes_[parent].conjugate() * bone.axis};
    placed.turns = !bone.dof.empty();
    if (!bone.reach.isZero(0.0)) {
      placed.ends = {bone.axis.conjugate() * bone.reach};
    }
    skeleton_.figure.bones.push_back(std::move(placed));
    skeleton_.channels.push_back(bone.dof);
    axes_.push_back(bone.axis);
    reaches_.push_back(bone.reach);
  }

  WordReader words_;
  AsfSkeleton skeleton_;
  std::map<std::string, AsfBone> bones_;
  std::map<std::string, std::size_t> placed_as_;
  std::vector<Eigen::Quaterniond> axes_;  // Axes of the placed bones.
  std::vector<Eigen::Vector3d> reaches_;
  bool placed_ = false;
};

}  // namespace

AsfSkeleton parse_asf(std::string_view text, const std::string& source, const AsfOptions& options) {
  return AsfReader(text, source, options).run();
}

AsfSkeleton read_asf(const std::filesystem::path& path, const AsfOptions& options) {
  return parse_asf(detail::read_file(path, "an ASF file"), path.string(), options);
}

}  // namespace firstcontact
