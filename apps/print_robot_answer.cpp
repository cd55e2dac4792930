#include "print_robot_answer.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/core.h>

#include "contact_text.h"
#include "print_result.h"
#include "quantity_text.h"
#include "terminal_text.h"

#include <firstcontact/robot_check/robot_scene.h>

namespace firstcontact::app {
namespace {

constexpr std::size_t kMostContacts = 6;

class RobotAnswerText {
 public:
  explicit RobotAnswerText(const SceneAnswer& answer)
      : answer_(answer), loaded_(answer.loaded), result_(*answer.result.robots) {}

  std::string write(bool all_pairs) {
    if (result_.first) {
      line("links", names(result_.pairs[*result_.first].members));
    }
    contacts();
    if (std::isfinite(result_.clearance) && result_.clearance > 0.0) {
      line("clearance", fmt::format("more than {}{}", lower_bound_text(result_.clearance),
                                    result_.verdict == Verdict::free ? "" : " before"));
    }
    turns();
    closest();
    if (result_.tolerance_used > loaded_.scene.options.tolerance) {
      line("tolerance", length_text(result_.tolerance_used) + ": f64 resolves no less here");
    }
    if (result_.enclosure_error > 0.0) {
      line("enclosure",
           "curved surfaces stand out by up to " + length_text(result_.enclosure_error));
    }
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

  void line(const char* label, const std::string& value) {
    print("  {:<10} {}\n", label, visible(value));
  }

  [[nodiscard]] std::string name(std::size_t member) const {
    return visible(loaded_.robots->name(member));
  }

  [[nodiscard]] std::string seconds(double t) const {
    return time_text(t * loaded_.scene.duration);
  }

  [[nodiscard]] std::string names(const BodyPair& members) const {
    return name(members[0]) + " and " + name(members[1]);
  }

  /// "triangle 7", and of which geometry where a link has several.
  [[nodiscard]] std::string place(const RobotContact& found, std::size_t side) const {
    const Feature& feature = side == 0 ? found.contact.feature_A : found.contact.feature_B;
    const std::size_t member = found.members[side];
    const std::string text = name(member) + ": " + feature_text(feature);
    return loaded_.robots->geometries(member).size() > 1
               ? text + fmt::format(" of geometry {}", found.geometries[side])
               : text;
  }

  void contact(const RobotContact& found) {
    print("    {}; {}\n", place(found, 0), place(found, 1));
    print("      {}\n", contact_text(found.contact, loaded_.scene.duration));
  }

  /// Those of every pair that touches at the scene's time.
  void contacts() {
    std::vector<const RobotContact*> found;
    ContactCount all{0, true};
    for (const RobotPairAnswer& pair : result_.pairs) {
      if (result_.first && pair.t == result_.t) {
        all += pair.contact_count;
      }
      for (const RobotContact& contact : pair.contacts) {
        if (result_.first && pair.t == result_.t) {
          found.push_back(&contact);
        }
      }
    }
    if (found.empty()) {
      return;
    }
    line("contacts", contact_count_text(all, found.size()));
    for (std::size_t k = 0; k < std::min(found.size(), kMostContacts); ++k) {
      contact(*found[k]);
    }
    if (found.size() > kMostContacts) {
      print("    and {} more\n", found.size() - kMostContacts);
    }
  }

  /// Of continuous joints, whose numbers leave it open which way they go.
  void turns() {
    for (const SceneRobot& robot : loaded_.scene.robots) {
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
    const RobotPairAnswer& pair = result_.pairs[*result_.closest];
    const LeastClearance& found = *pair.least_clearance;
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
    for (const RobotPairAnswer& pair : result_.pairs) {
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
    for (const RobotPairAnswer& pair : result_.pairs) {
      print("    {:<40} {:<16}", names(pair.members), word(pair.verdict));
      if (pair.verdict != Verdict::free) {
        print(" {}", seconds(pair.t));
      }
      if (pair.least_clearance) {
        print(" closest {} at {}", length_text(pair.least_clearance->distance),
              seconds(pair.least_clearance->t));
      }
      print("\n");
    }
  }

  const SceneAnswer& answer_;
  const LoadedScene& loaded_;
  const RobotCheckResult& result_;
  std::string text_;
};

}  // namespace

std::string describe_robots(const SceneAnswer& answer, bool all_pairs) {
  return RobotAnswerText(answer).write(all_pairs);
}

}  // namespace firstcontact::app
