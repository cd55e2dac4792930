#include <firstcontact/robot_files/read_bvh.h>

#include <array>
#include <numbers>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include <firstcontact/text/read_file.h>
#include <firstcontact/text/word_reader.h>

namespace firstcontact {
namespace {

using detail::same_word;
using detail::WordReader;

constexpr double kDegree = std::numbers::pi / 180.0;  // [rad]

/// One column of a frame.
struct Channel {
  std::size_t bone = 0;
  std::size_t axis = 0;  // x, y, z
  bool turns = true;     // Whether it is an angle; else it is a position.
};

class BvhReader {
 public:
  BvhReader(std::string_view text, const std::string& source, const BvhOptions& options)
      : words_(text, source), unit_(options.unit_length) {
    if (!(unit_ > 0.0 && unit_ <= 1e6)) {
      throw std::invalid_argument("BvhOptions::unit_length must be in (0, 1e6]");
    }
    capture_.name = "figure";
  }

  MotionCapture run() {
    words_.expect("HIERARCHY");
    words_.expect("ROOT");
    open_bone(std::nullopt);
    while (!open_.empty()) {
      read_item();
    }
    read_motion();
    return std::move(capture_);
  }

 private:
  void open_bone(std::optional<std::size_t> parent) {
    const std::string name(words_.word("the name of a joint"));
    if (!names_.insert(name).second) {
      words_.fail("joint '" + name + "' is there twice");
    }
    Bone bone;
    bone.name = name;
    bone.parent = parent.value_or(0);
    bone.turns = false;
    capture_.bones.push_back(std::move(bone));
    open_.push_back(capture_.bones.size() - 1);
    words_.expect("{");
    words_.expect("OFFSET");
    const Eigen::Vector3d offset = unit_ * words_.vector("an offset");
    if (parent) {
      capture_.bones.back().X_PB.position = offset;
      capture_.bones[*parent].ends.push_back(offset);
    } else {
      root_offset_ = offset;
    }
  }

  /// Reads an item of a joint other than its offset.
  void read_item() {
    const std::size_t bone = open_.back();
    if (same_word(words_.peek(), "CHANNELS")) {
      words_.expect("CHANNELS");
      read_channels(bone);
    } else if (same_word(words_.peek(), "JOINT")) {
      words_.expect("JOINT");
      open_bone(bone);
    } else if (same_word(words_.peek(), "End")) {
      words_.expect("End");
      words_.expect("Site");
      words_.expect("{");
      words_.expect("OFFSET");
      capture_.bones[bone].ends.push_back(unit_ * words_.vector("an offset"));
      words_.expect("}");
    } else if (words_.peek() == "}") {
      words_.expect("}");
      open_.pop_back();
    } else {
      words_.fail_expected("CHANNELS, JOINT, End Site or }");
    }
  }

  void read_channels(std::size_t bone) {
    if (!with_channels_.insert(bone).second) {
      words_.fail("joint '" + capture_.bones[bone].name + "' has channels twice");
    }
    const std::size_t count = words_.count("a number of channels");
    if (count > 6) {
      words_.fail("expected at most 6 channels, got " + std::to_string(count));
    }
    std::set<std::pair<bool, std::size_t>> seen;
    for (std::size_t k = 0; k < count; ++k) {
      const Channel channel = read_channel(bone);
      if (!seen.insert({channel.turns, channel.axis}).second) {
        words_.fail("joint '" + capture_.bones[bone].name + "' has a channel twice");
      }
      channels_.push_back(channel);
    }
  }

  Channel read_channel(std::size_t bone) {
    constexpr std::array<const char*, 3> kRotations = {"Xrotation", "Yrotation", "Zrotation"};
    constexpr std::array<const char*, 3> kPositions = {"Xposition", "Yposition", "Zposition"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (same_word(words_.peek(), kRotations[axis])) {
        words_.expect(kRotations[axis]);
        capture_.bones[bone].turns = true;
        return {bone, axis, true};
      }
      if (same_word(words_.peek(), kPositions[axis])) {
        if (bone != 0) {
          words_.fail("joint '" + capture_.bones[bone].name +
                      "' has a position channel; only the root's are known");
        }
        words_.expect(kPositions[axis]);
        return {bone, axis, false};
      }
    }
    words_.fail_expected("a channel, such as Xrotation");
  }

  void read_motion() {
    words_.expect("MOTION");
    words_.expect("Frames:");
    const std::size_t count = words_.count("a number of frames");
    words_.expect("Frame");
    words_.expect("Time:");
    capture_.frame_time = words_.number("a frame time [s]");
    if (!(capture_.frame_time > 0.0)) {
      words_.fail("expected a frame time greater than 0");
    }
    if (channels_.empty() && count > 0) {
      words_.fail("no joint has channels, so that frames hold nothing");
    }
    for (std::size_t k = 0; k < count; ++k) {
      read_frame(k + 1);
    }
    if (!words_.at_end()) {
      words_.fail_expected("the end after " + std::to_string(count) + " frames");
    }
  }

  void read_frame(std::size_t number) {
    CaptureFrame frame;
    frame.root_position = root_offset_;
    frame.rotations.assign(capture_.bones.size(), Eigen::Quaterniond::Identity());
    for (const Channel& channel : channels_) {
      const double value = words_.number("a value of joint '" + capture_.bones[channel.bone].name +
                                         "' in frame " + std::to_string(number));
      const auto axis = static_cast<Eigen::Index>(channel.axis);
      if (channel.turns) {
        Eigen::Quaterniond& R = frame.rotations[channel.bone];
        R = R * Eigen::AngleAxisd(value * kDegree, Eigen::Vector3d::Unit(axis));
      } else {
        frame.root_position[axis] = unit_ * value;
      }
    }
    capture_.frames.push_back(std::move(frame));
  }

  WordReader words_;
  double unit_;
  MotionCapture capture_;
  std::vector<Channel> channels_;
  std::set<std::size_t> with_channels_;
  std::vector<std::size_t> open_;  // Bones whose } is to come.
  std::set<std::string> names_;
  Eigen::Vector3d root_offset_ = Eigen::Vector3d::Zero();
};

}  // namespace

MotionCapture parse_bvh(std::string_view text, const std::string& source,
                        const BvhOptions& options) {
  return BvhReader(text, source, options).run();
}

MotionCapture read_bvh(const std::filesystem::path& path, const BvhOptions& options) {
  return parse_bvh(detail::read_file(path, "a BVH file"), path.string(), options);
}

}  // namespace firstcontact
