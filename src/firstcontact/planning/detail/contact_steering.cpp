#include <firstcontact/planning/detail/contact_steering.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <firstcontact/planning/detail/contact_motion.h>
#include <firstcontact/planning/detail/loose_motions.h>

namespace firstcontact::detail {
namespace {

constexpr double kHover = 0.01;      // [-]  The gap that is kept, by the reach of the mover.
constexpr double kFirstStep = 0.1;   // [-]  By the reach.
constexpr double kBand = 0.04;       // [-]  By the reach; contacts that are farther do not steer.
constexpr double kLeastStep = 1e-5;  // [-]  By the reach.
constexpr double kTaken = 0.9;       // [-]  Part of the proven part of a blocked step.
constexpr double kStuck = 0.02;  // [-]  Projected steps shorter than this part of the wanted one
                                 // are stuck.
constexpr std::size_t kMostSteps = 400;
constexpr std::size_t kStepsToGain = 12;  // Number of steps after which something has to be gained.
constexpr double kGain = 0.02;            // [-]  Part of the way of these steps.
constexpr double kMostTurn = 2.5;         // [rad]  Greatest turn of one edge.
constexpr double kRangesOfPush = 20.0;    // [-]  The longest push, in ranges.
constexpr std::size_t kFewContacts = 6;   // Number of contacts from which on ways_out() leaves some
                                          // out.
constexpr double kLooseBand = 4.0;        // [-]  Band of ways_out(), by the hover gap.
constexpr std::size_t kLongestWait = 16;
constexpr std::size_t kLookEvery = 8;  // Number of steps of a screw between two looks.
constexpr int kMostCentres = 32;
constexpr double kSureTurn = 1.0;    // [rad]  A screw is known well enough after this turn.
constexpr double kTurns = 0.05;      // [-]  A motion that turns less, with the reach, slides.
constexpr double kLeastTurn = 0.05;  // [rad]  Least turn of a screw, from the middle of the play to
                                     // the middle.

}  // namespace

/// One way, step by step.
class ContactSteering::Way {
 public:
  Way(ContactSteering& steering, const Configuration& from, Aim aim)
      : s_(steering),
        t_(steering.tangents_),
        aim_(std::move(aim)),
        q_(from),
        step_(kFirstStep * t_.reach()),
        trail_{from},
        screw_(Eigen::VectorXd::Zero(t_.size())),
        screw_before_(screw_) {
    if (aim_.target != nullptr) {
      before_ = t_.length(t_.difference(q_, *aim_.target));
    }
  }

  ContactWay run() {
    if (aim_.target == nullptr) {
      begin_push();
    }
    for (std::size_t k = 0; k < kMostSteps && !s_.work_.is_over(); ++k) {
      const Eigen::VectorXd wanted = wanted_motion();
      const double length = t_.length(wanted);
      if (aim_.target != nullptr && is_free_to(*aim_.target, k)) {
        take(*aim_.target);
        way_.reaches_target = true;
        break;
      }
      if (!(length > least_step()) || travelled_ >= aim_.most) {
        break;
      }
      if (!contact_step(wanted * std::min(1.0, step_ / length), std::min(step_, length))) {
        break;
      }
      repeat_trail();
      if (!gains() || (aim_.target == nullptr && free_way_ > s_.range_)) {
        break;
      }
    }
    return std::move(way_);
  }

 private:
  [[nodiscard]] double least_step() const { return kLeastStep * t_.reach(); }

  [[nodiscard]] Eigen::VectorXd wanted_motion() const {
    return aim_.target != nullptr ? t_.difference(q_, *aim_.target) : t_.in_world(q_, aim_.in_body);
  }

  /// Whether the straight way to the target is free; rarely checked again where it was blocked near
  /// by.
  bool is_free_to(const Configuration& target, std::size_t k) {
    if (k > 0 && held_back_ && k % 4 != 0) {
      return false;
    }
    return s_.work_.is_free(q_, target);
  }

  void take(Configuration to) {
    const Eigen::VectorXd dq = t_.difference(q_, to);
    travelled_ += t_.length(dq);
    screw_ += t_.twist(q_, to);
    q_ = std::move(to);
    looked_within_ = -1.0;
    way_.places.push_back(q_);
    trail_.push_back(q_);
  }

  /// The contacts at the place; not looked for again as long as the place is the same.
  const ContactsAt& contacts_within(double band) {
    if (!(band <= looked_within_)) {
      at_ = s_.finder_.near(q_, band);
      looked_within_ = band;
    }
    return at_;
  }

  /// Takes one step that contacts constrain; returns whether it led anywhere.
  bool contact_step(const Eigen::VectorXd& wanted, double length) {
    const ContactsAt& at =
        contacts_within(std::min(2.0 * length, kBand * t_.reach()) + 2.0 * s_.hover_);
    const ContactMotion motion = contact_motion(t_, at, wanted, s_.hover_);
    way_.active = motion.active;
    way_.is_near = !at.contacts.empty() && at.contacts.front().gap <= s_.hover_;
    held_back_ = motion.active > 0;
    free_way_ = at.contacts.empty() ? free_way_ + length : 0.0;
    Eigen::VectorXd dq = motion.dq;
    const double longest = 2.0 * length + s_.hover_;
    const double found = t_.length(dq);
    if (found > longest) {
      dq *= longest / found;
    }
    if (std::min(found, longest) < std::max(least_step(), kStuck * length)) {
      return false;
    }
    Configuration to = t_.moved(q_, dq);
    if (t_.length(t_.difference(q_, to)) < least_step() || !s_.work_.space().holds(to)) {
      return false;
    }
    if (std::optional<Configuration> near = t_.screwed(q_, dq);
        near && s_.work_.is_free(q_, *near)) {
      take(*std::move(near));
      is_screw_ = t_.size() == 6;
      step_ = std::min(2.0 * step_, s_.range_);
      return true;
    }
    was_screw_ = std::exchange(is_screw_, false);
    if (screw_on()) {
      return true;
    }
    was_screw_ = false;
    const EdgeAnswer answer = s_.work_.check(q_, to);
    if (answer.verdict == EdgeVerdict::free) {
      take(std::move(to));
      step_ = std::min(2.0 * step_, s_.range_);
      return true;
    }
    const double share = kTaken * answer.fraction;
    if (share * t_.length(dq) >= least_step()) {
      take(s_.work_.space().interpolate(q_, to, share));
    }
    step_ = 0.5 * std::min(step_, length);
    return step_ >= least_step();
  }

  /// Begins in the middle of the play, by a screw about an axis of the mover if one is near.
  void begin_push() {
    if (const auto screw = t_.about_an_axis(aim_.in_body)) {
      aim_.in_body = *screw;
    }
    if (centre()) {
      trail_ = {q_};
      screw_.setZero();
    }
  }

  /// Goes to the middle between contacts along the axis about which the mover turns.
  ///
  /// The play of a fit would otherwise lead repeated steps astray.
  bool centre() {
    if (!s_.work_.space().is_body() || s_.work_.is_over()) {
      return false;
    }
    const Eigen::VectorXd& way = screw_.isZero(0.0) ? aim_.in_body : screw_;
    const Eigen::Vector3d turn = way.tail<3>();
    if (!(t_.reach() * turn.norm() > kTurns * way.head<3>().norm())) {
      return false;
    }
    Eigen::Index axis = 0;
    turn.cwiseAbs().maxCoeff(&axis);
    const Eigen::VectorXd along = 2.0 * s_.hover_ * Eigen::VectorXd::Unit(6, axis);
    const double middle = 0.5 * (free_share(along) - free_share(-along));
    if (!(std::abs(middle) * t_.length(along) > 0.1 * least_step())) {
      return false;
    }
    Configuration to = t_.moved(q_, t_.in_world(q_, middle * along));
    if (!s_.work_.space().holds(to) || !s_.work_.is_free(q_, to)) {
      return false;
    }
    take(std::move(to));
    return true;
  }

  /// [-]  The proven part of a motion from here.
  double free_share(const Eigen::VectorXd& in_body) {
    return s_.work_.check(q_, t_.moved(q_, t_.in_world(q_, in_body))).fraction;
  }

  /// Goes on by the screw of all steps so far, from the middle of the play.
  ///
  /// A longer way gives a more accurate pitch.
  bool screw_on() {
    if (aim_.target != nullptr || !was_screw_ || !(screw_.tail<3>().norm() > kLeastTurn)) {
      return false;
    }
    (void)centre();
    const Eigen::VectorXd better = screw_ * (t_.length(aim_.in_body) / t_.length(screw_));
    const bool leads_on = t_.product(t_.in_world(q_, better), t_.in_world(q_, aim_.in_body)) > 0.0;
    const Eigen::VectorXd before = std::exchange(aim_.in_body, better);
    is_screw_ = true;
    if (leads_on && repeat_screw()) {
      return true;
    }
    is_screw_ = false;
    aim_.in_body = before;
    return false;
  }

  /// Repeats the whole trail, if that is proven, and again.
  void repeat_trail() {
    if (trail_.size() < 2 || waits_ > 0) {
      waits_ -= waits_ > 0 ? 1 : 0;
      return;
    }
    bool any = repeat_while_free();
    for (int k = 0; k < kMostCentres && is_screw_ && screw_.tail<3>().norm() > kSureTurn; ++k) {
      (void)centre();
      if (!repeat_screw()) {
        break;
      }
      any = true;
      if (free_way_ > s_.range_) {
        break;
      }
    }
    wait_ = any ? 0 : std::min(2 * wait_ + 1, kLongestWait);
    waits_ = wait_;
    if (!any && trail_.size() > 8) {
      trail_.erase(trail_.begin(), trail_.begin() + static_cast<std::ptrdiff_t>(trail_.size() / 2));
    }
  }

  /// Goes on by the screw that all steps since the middle of the contacts make, where these are all
  /// about one axis.
  bool repeat_screw() {
    bool any = false;
    double share = 1.0;  // Part of the screw.
    for (int halvings = 0; halvings <= 4 && !s_.work_.is_over();) {
      const double turn = screw_.tail<3>().norm();
      if (!(turn > 0.0) || !is_screw_) {
        break;
      }
      const Eigen::VectorXd dq =
          t_.in_world(q_, screw_ * (share * std::min(1.0, kMostTurn / turn)));
      if (!(t_.product(dq, wanted_motion()) > 0.0)) {
        break;
      }
      Configuration to = t_.screwed(q_, dq).value_or(t_.moved(q_, dq));
      if (!s_.work_.space().holds(to) || !s_.work_.is_free(q_, to)) {
        if (any) {
          break;
        }
        share *= 0.5;
        ++halvings;
        continue;
      }
      take(std::move(to));
      any = true;
      if (is_out()) {
        break;
      }
    }
    return any;
  }

  /// Whether a push is out of contact, so that repeating is useless; checked now and then.
  bool is_out() {
    if (aim_.target != nullptr || way_.places.size() % kLookEvery != 0 ||
        !contacts_within(kBand * t_.reach()).contacts.empty()) {
      return false;
    }
    way_.is_near = false;
    free_way_ = std::numeric_limits<double>::infinity();
    return true;
  }

  bool repeat_while_free() {
    bool any = false;
    while (!s_.work_.is_over() && travelled_ < aim_.most) {
      shorten_trail();
      Eigen::VectorXd dq = t_.difference(trail_.front(), q_);
      dq = t_.in_world(q_, t_.in_body(trail_.front(), dq));
      const Eigen::VectorXd wanted = wanted_motion();
      const double along = t_.product(dq, wanted);
      if (!(along > 0.0)) {
        break;
      }
      if (aim_.target != nullptr) {
        dq *= std::min(1.0, along / t_.product(dq, dq));
      }
      if (t_.length(dq) < least_step()) {
        break;
      }
      Configuration to = t_.moved(q_, dq);
      // At the limits of all joints nothing moves any more.
      if (t_.length(t_.difference(q_, to)) < least_step() || !s_.work_.space().holds(to) ||
          !s_.work_.is_free(q_, to)) {
        break;
      }
      take(std::move(to));
      any = true;
      if (is_out()) {
        break;
      }
    }
    return any;
  }

  /// Drops places that are too far back: an edge turns by less than half a turn.
  void shorten_trail() {
    if (!s_.work_.space().is_body()) {
      return;
    }
    const auto turn = [&](std::size_t from, const Configuration& to) {
      return t_.difference(trail_[from], to).tail<3>().norm();
    };
    std::size_t first = trail_.size() - 1;
    double turned = 0.0;
    while (first > 0) {
      turned += turn(first - 1, trail_[first]);
      if (turned > kMostTurn) {
        break;
      }
      --first;
    }
    first = std::min(first, trail_.size() - 2);
    trail_.erase(trail_.begin(), trail_.begin() + static_cast<std::ptrdiff_t>(first));
  }

  /// Whether the last steps have gained anything.
  bool gains() {
    if (way_.places.size() < looked_at_ + kStepsToGain) {
      return true;
    }
    const double way = travelled_ - travelled_before_;
    const double gain = aim_.target != nullptr
                            ? before_ - t_.length(t_.difference(q_, *aim_.target))
                            : t_.length(screw_ - screw_before_);
    const bool leads_on = gain > kGain * way;
    looked_at_ = way_.places.size();
    travelled_before_ = travelled_;
    screw_before_ = screw_;
    if (aim_.target != nullptr) {
      before_ = t_.length(t_.difference(q_, *aim_.target));
    }
    return leads_on;
  }

  ContactSteering& s_;
  const TangentSpace& t_;
  Aim aim_;
  Configuration q_;
  double step_;
  std::vector<Configuration> trail_;
  Eigen::VectorXd screw_;  // Sum of all steps, in axes of the mover.
  ContactWay way_;
  double travelled_ = 0.0;
  bool held_back_ = false;
  ContactsAt at_;
  double looked_within_ = -1.0;  // [m]  Band of the contacts; below 0 where there are none yet.
  double free_way_ = 0.0;        // [m]  Length of the way since the last contact.
  bool is_screw_ = false;        // Whether the last step was a screw about an axis of the mover.
  bool was_screw_ = false;       // Likewise before a step that was blocked.
  std::size_t wait_ = 0;         // Number of steps between two tries to repeat the trail.
  std::size_t waits_ = 0;        // Number of steps until the next try.
  std::size_t looked_at_ = 0;
  double travelled_before_ = 0.0;
  double before_ = 0.0;
  Eigen::VectorXd screw_before_;
};

ContactSteering::ContactSteering(PlanWork& work, const PlanScene& scene, double range)
    : work_(work),
      tangents_(scene),
      finder_(scene, tangents_, work.kept()),
      range_(range),
      hover_(kHover * tangents_.reach()) {}

ContactWay ContactSteering::slide(const Configuration& from, const Configuration& target) {
  const double most = 4.0 * tangents_.length(tangents_.difference(from, target));
  return Way(*this, from, {&target, {}, most}).run();
}

ContactWay ContactSteering::push(const Configuration& from, const Eigen::VectorXd& in_body) {
  return Way(*this, from, {nullptr, in_body, kRangesOfPush * range_}).run();
}

ContactWay ContactSteering::lift(const Configuration& from) {
  ContactWay way;
  Configuration q = from;
  for (int k = 0; k < 3; ++k) {
    const ContactsAt at = finder_.near(q, 4.0 * hover_);
    way.is_near = !at.contacts.empty() && at.contacts.front().gap <= hover_;
    const ContactMotion motion =
        contact_motion(tangents_, at, Eigen::VectorXd::Zero(tangents_.size()), hover_);
    way.active = motion.active;
    if (tangents_.length(motion.dq) < kLeastStep * tangents_.reach()) {
      break;
    }
    Configuration to = tangents_.moved(q, motion.dq);
    if (!work_.space().holds(to) || !work_.is_free(q, to)) {
      break;
    }
    q = std::move(to);
    way.places.push_back(q);
  }
  return way;
}

Eigen::VectorXd ContactSteering::direction(RandomNumbers& random) const {
  Eigen::VectorXd dq = Eigen::VectorXd::Zero(tangents_.size());
  if (work_.space().is_body()) {
    const std::size_t kind = random.below(3);
    if (kind != 1) {
      dq.head<3>() = random.direction();
    }
    if (kind != 0) {
      dq.tail<3>() = random.direction() / tangents_.reach();
    }
  } else {
    for (Eigen::Index k = 0; k < dq.size(); ++k) {
      dq[k] = random.uniform(-1.0, 1.0);
    }
  }
  const double length = tangents_.length(dq);
  return length > 0.0 ? Eigen::VectorXd(dq * (range_ / length)) : dq;
}

bool ContactSteering::is_near(const Configuration& q) {
  return !finder_.near(q, kLooseBand * hover_).contacts.empty();
}

std::vector<std::array<Eigen::VectorXd, 2>> ContactSteering::ways_out(const Configuration& from) {
  if (!work_.space().is_body()) {
    return {};
  }
  ContactsAt at = finder_.near(from, kLooseBand * hover_);
  if (at.contacts.empty()) {
    return {};
  }
  // Most features that are not the nearest of their region are among the farther ones.
  at.contacts.resize(
      std::max((at.contacts.size() + 1) / 2, std::min(at.contacts.size(), kFewContacts)));
  std::vector<std::array<Eigen::VectorXd, 2>> ways;
  const auto add = [&](const Eigen::VectorXd& way) { ways.push_back({way, -way}); };
  for (const Eigen::VectorXd& loose : loose_motions(tangents_, at)) {
    add(tangents_.in_body(from, range_ * loose));
  }
  for (Eigen::Index k = 0; k < tangents_.size(); ++k) {
    const double length = k < 3 ? range_ : range_ / tangents_.reach();
    add(length * Eigen::VectorXd::Unit(tangents_.size(), k));
  }
  return ways;
}

}  // namespace firstcontact::detail
