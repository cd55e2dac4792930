#include "print_result.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include <firstcontact/robot_check/robot_scene.h>

#include "contact_text.h"
#include "file_text.h"
#include "quantity_text.h"
#include "terminal_text.h"

namespace firstcontact::app {
namespace {

constexpr std::size_t kMostContacts = 6;

/// Writes the lines of one answer.
class Description {
 public:
  explicit Description(const SceneAnswer& answer)
      : scene_(answer.loaded.scene), answer_(answer), result_(answer.result) {}

  std::string write(std::string_view title, bool all_pairs) {
    print("{}: {}\n", visible(title), describe_verdict(answer_));
    if (result_.first) {
      line("bodies", names(result_.pairs[*result_.first].members));
    }
    contacts();
    if (std::isfinite(result_.clearance) && result_.clearance > 0.0) {
      line("clearance", fmt::format("more than {}{}", lower_bound_text(result_.clearance),
                                    result_.verdict == Verdict::free ? "" : " before"));
    }
    turns();
    closest();
    if (result_.tolerance_used > scene_.options.tolerance) {
      line("tolerance", length_text(result_.tolerance_used) + ": f64 resolves no less here");
    }
    enclosure();
    if (const std::string text = describe_sampling(answer_); !text.empty()) {
      line("sampling", text);
    }
    intervals();
    if (all_pairs) {
      pairs();
    }
    for (const auto& [label, value] : last_lines(answer_)) {
      line(label, value);
    }
    return text_;
  }

 private:
  template <typename... T>
  void print(fmt::format_string<T...> format, T&&... values) {
    text_ += fmt::format(format, std::forward<T>(values)...);
  }

  void line(const char* label, const std::string& value) { text_ += answer_line(label, value); }

  [[nodiscard]] std::string name(std::size_t member) const {
    return visible(member_name(scene_, member));
  }

  [[nodiscard]] std::string names(const BodyPair& members) const {
    return name(members[0]) + " and " + name(members[1]);
  }

  [[nodiscard]] std::string seconds(double t) const { return time_text(t * scene_.duration); }

  /// The place of a feature: "arm/tip: triangle 7", with the geometry where a link has several.
  [[nodiscard]] std::string place(std::size_t member, const Feature& feature,
                                  std::size_t geometry) const {
    const std::string text = name(member) + ": " + feature_text(feature);
    const auto& robots = answer_.loaded.robots;
    return robots && robots->geometries(member).size() > 1
               ? text + fmt::format(" of geometry {}", geometry)
               : text;
  }

  void contact(const BodyPair& members, const Contact& found) {
    print("    {}; {}\n", place(members[0], found.feature_A, found.geometries[0]),
          place(members[1], found.feature_B, found.geometries[1]));
    print("      {}\n", contact_text(found, scene_.duration));
  }

  /// Writes the contacts of every pair that touches at the scene's time.
  void contacts() {
    std::size_t count = 0;
    ContactCount all{0, true};
    for (const PairAnswer& pair : result_.pairs) {
      if (result_.first && pair.t == result_.t) {
        count += pair.contacts.size();
        all += pair.contact_count;
      }
    }
    if (count == 0) {
      return;
    }
    line("contacts", contact_count_text(all, count));
    std::size_t left = std::min(count, kMostContacts);
    for (const PairAnswer& pair : result_.pairs) {
      for (const Contact& found : pair.contacts) {
        if (left > 0 && pair.t == result_.t) {
          contact(pair.members, found);
          --left;
        }
      }
    }
    if (count > kMostContacts) {
      print("    and {} more\n", count - kMostContacts);
    }
  }

  /// Writes the enclosure error of the pair that decides, or else of all.
  void enclosure() {
    const double error =
        result_.first ? result_.pairs[*result_.first].enclosure_error : result_.enclosure_error;
    if (error > 0.0) {
      line("enclosure", "curved surfaces stand out by up to " + length_text(error));
    }
  }

  /// Writes the turns of continuous joints, as their numbers leave the way open.
  void turns() {
    for (const SceneRobot& robot : scene_.robots) {
      for (const JointTurn& turn : joint_turns(robot.model, robot.trajectory)) {
        const bool is_short = turn.turning == Turning::shortest;
        const std::string way = !turn.differs ? ""
                                : is_short    ? ", the short way"
                                              : ", the long way, as the numbers say";
        line("turn", fmt::format("{}/{} by {:.6g} rad{}, from {:.6g} to {:.6g} rad", robot.name,
                                 turn.joint, turn.turned, way, turn.from, turn.to));
      }
    }
  }

  void closest() {
    if (!result_.closest) {
      return;
    }
    const PairAnswer& pair = result_.pairs[*result_.closest];
    const ClosestApproach& found = *pair.closest;
    std::string text = fmt::format("{} at {}: {}", length_text(found.distance), seconds(found.t),
                                   names(pair.members));
    if (found.closest) {
      text += fmt::format(", between {} and {} m", point_text(found.closest->p_WA),
                          point_text(found.closest->p_WB));
    }
    if (found.reason != UndecidedReason::none) {
      text += fmt::format("; at least {} ({})", length_text(found.lower_bound), word(found.reason));
    }
    line("closest", text);
  }

  void intervals() {
    for (const PairAnswer& pair : result_.pairs) {
      for (const ContactInterval& interval : pair.intervals) {
        line("contact", fmt::format("from {} to {}: {}{}", seconds(interval.enter),
                                    seconds(interval.leave), names(pair.members),
                                    interval.reason == UndecidedReason::none
                                        ? ""
                                        : fmt::format(" (not searched to its end: {})",
                                                      word(interval.reason))));
      }
    }
  }

  void pairs() {
    line("pairs", std::to_string(result_.pairs.size()));
    for (const PairAnswer& pair : result_.pairs) {
      print("    {:<40} {:<16}", names(pair.members), word(pair.verdict));
      if (pair.verdict != Verdict::free) {
        print(" {}", seconds(pair.t));
      }
      if (pair.closest) {
        print(" closest {} at {}", length_text(pair.closest->distance), seconds(pair.closest->t));
      }
      print("\n");
    }
  }

  const Scene& scene_;
  const SceneAnswer& answer_;
  const SceneResult& result_;
  std::string text_;
};

}  // namespace

std::string describe(std::string_view title, const SceneAnswer& answer,
                     const DescribeOptions& options) {
  std::string text = Description(answer).write(title, options.all_pairs);
  if (options.explain) {
    text += "  files\n" + describe_files(answer.loaded.files);
  }
  return text;
}

std::vector<LabelledLine> last_lines(const SceneAnswer& answer) {
  std::vector<LabelledLine> lines = pair_lines(answer.loaded.pair_counts);
  for (std::string& warning : told_warnings(answer.loaded)) {
    lines.push_back({"warning", std::move(warning)});
  }
  return lines;
}

std::vector<std::string> told_warnings(const LoadedScene& loaded) {
  constexpr std::size_t kMost = 12;
  std::vector<std::string> told = check_warnings(loaded);
  if (told.size() > kMost) {
    const std::size_t others = told.size() - kMost;
    told.resize(kMost);
    told.push_back(fmt::format("and {} more", others));
  }
  return told;
}

std::string describe_verdict(const SceneAnswer& answer) {
  const SceneResult& result = answer.result;
  const double duration = answer.loaded.scene.duration;
  const std::string when = fmt::format("t = {:.9g} ({})", result.t, time_text(result.t * duration));
  switch (result.verdict) {
    case Verdict::free:
      return fmt::format("free for the whole step of {}{}", time_text(duration),
                         answer.loaded.pair_counts.tested == 0 ? ", but no pair is tested" : "");
    case Verdict::contact:
      return "contact at " + when;
    case Verdict::contact_at_start:
      return "in contact from the start";
    case Verdict::undecided:
      break;
  }
  return fmt::format("undecided after {} ({}), free before", when, word(result.reason));
}

std::string describe_sampling(const SceneAnswer& answer) {
  if (!answer.sampling || !answer.sampling->least) {
    return "";
  }
  const SamplingReport& seen = *answer.sampling;
  return fmt::format("{:g} times a second: {} of {} samples in contact, least gap {} at {}{}",
                     seen.rate, seen.in_contact, seen.samples, length_text(seen.least->distance),
                     time_text(seen.least->t * answer.loaded.scene.duration),
                     is_contact(answer.result.verdict) && seen.in_contact == 0
                         ? ": sampling misses this contact"
                         : "");
}

}  // namespace firstcontact::app
