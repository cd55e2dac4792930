#include <firstcontact/robot_files/read_amc.h>

#include <cctype>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include <firstcontact/robot_files/detail/asf_angles.h>
#include <firstcontact/robot_files/read_asf.h>
#include <firstcontact/text/read_file.h>
#include <firstcontact/text/word_reader.h>

namespace firstcontact {
namespace {

using detail::kDegree;
using detail::same_word;
using detail::turned_xyz;
using detail::WordReader;

class AmcReader {
 public:
  AmcReader(std::string_view text, const std::string& source, const AsfSkeleton& skeleton,
            double frame_time)
      : words_(text, source), skeleton_(skeleton), capture_(skeleton.figure) {
    if (!(frame_time > 0.0 && frame_time <= 1e6)) {
      throw std::invalid_argument("read_amc: the frame time must be in (0, 1e6] s");
    }
    capture_.frame_time = frame_time;
    for (std::size_t b = 0; b < capture_.bones.size(); ++b) {
      index_of_.emplace(capture_.bones[b].name, b);
    }
    angle_unit_ = skeleton.degrees ? kDegree : 1.0;
  }

  MotionCapture run() {
    read_head();
    std::size_t number = 0;
    while (!words_.at_end()) {
      const bool first = capture_.frames.empty();
      const std::size_t next = words_.count("the number of a frame");
      if (!first && next != number + 1) {
        words_.fail("expected frame " + std::to_string(number + 1) + ", got " +
                    std::to_string(next));
      }
      number = next;
      read_frame(number);
    }
    return std::move(capture_);
  }

 private:
  void read_head() {
    while (!words_.at_end() && words_.peek().front() == ':') {
      const std::string word(words_.word(""));
      if (same_word(word, ":DEGREES")) {
        angle_unit_ = kDegree;
      } else if (same_word(word, ":RADIANS")) {
        angle_unit_ = 1.0;
      } else if (!same_word(word, ":FULLY-SPECIFIED")) {
        words_.fail("expected :FULLY-SPECIFIED, :DEGREES or :RADIANS, got '" + word.substr(0, 40) +
                    "'");
      }
    }
  }

  void read_frame(std::size_t number) {
    CaptureFrame frame;
    frame.rotations.assign(capture_.bones.size(), Eigen::Quaterniond::Identity());
    std::vector<bool> seen(capture_.bones.size());
    while (!words_.at_end() && index_of_.contains(std::string(words_.peek()))) {
      const std::string name(words_.word(""));
      const std::size_t bone = index_of_.at(name);
      if (seen[bone]) {
        words_.fail("bone '" + name + "' is in frame " + std::to_string(number) + " twice");
      }
      seen[bone] = true;
      bone == 0 ? read_root(frame) : read_turns(bone, frame);
    }
    if (!words_.at_end() && std::isalpha(static_cast<unsigned char>(words_.peek().front()))) {
      words_.fail_expected("a bone of the skeleton");
    }
    for (std::size_t b = 0; b < seen.size(); ++b) {
      if (!seen[b] && !skeleton_.channels[b].empty()) {
        words_.fail("bone '" + capture_.bones[b].name + "' is missing in frame " +
                    std::to_string(number));
      }
    }
    capture_.frames.push_back(std::move(frame));
  }

  double read_value(std::size_t bone) {
    return words_.number("a value of bone '" + capture_.bones[bone].name + "'");
  }

  void read_root(CaptureFrame& frame) {
    Eigen::Vector3d position;
    Eigen::Vector3d angles;
    for (const std::size_t channel : skeleton_.channels[0]) {
      const auto axis = static_cast<Eigen::Index>(channel % 3);
      (channel < 3 ? position : angles)[axis] = read_value(0);
    }
    frame.root_position = skeleton_.root.position + skeleton_.unit_length * position;
    frame.rotations[0] = turned_xyz(angle_unit_ * angles) * skeleton_.root.rotation;
  }

  void read_turns(std::size_t bone, CaptureFrame& frame) {
    Eigen::Quaterniond& R = frame.rotations[bone];
    for (const std::size_t axis : skeleton_.channels[bone]) {
      const double angle = angle_unit_ * read_value(bone);
      R = Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(static_cast<Eigen::Index>(axis))) * R;
    }
  }

  WordReader words_;
  const AsfSkeleton& skeleton_;
  MotionCapture capture_;
  std::map<std::string, std::size_t> index_of_;
  double angle_unit_ = 1.0;
};

}  // namespace

MotionCapture parse_amc(std::string_view text, const std::string& source,
                        const AsfSkeleton& skeleton, double frame_time) {
  return AmcReader(text, source, skeleton, frame_time).run();
}

MotionCapture read_amc(const std::filesystem::path& path, const AsfSkeleton& skeleton,
                       double frame_time) {
  return parse_amc(detail::read_file(path, "an AMC file"), path.string(), skeleton, frame_time);
}

}  // namespace firstcontact
