#include <firstcontact/planning/detail/contact_steering.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <firstcontact/planning/detail/contact_motion.h>

namespace firstcontact::detail {
namespace {

constexpr double kHover = 0.01;      // [-]  Of the reach of the mover: the gap that is kept.
constexpr double kFirstStep = 0.1;   // [-]  Of the reach.
constexpr double kBand = 0.04;       // [-]  Of the reach: contacts that are farther do not steer.
constexpr double kLeastStep = 1e-5;  // [-]  Of the reach.
constexpr double kTaken = 0.9;       // [-]  Of what is proven of a blocked step.
constexpr double kStuck = 0.02;      // [-]  A projected step that is shorter, of the wanted one.
constexpr std::size_t kMostSteps = 400;
constexpr std::size_t kStepsToGain = 12;  // Steps after which something has to be gained.
constexpr double kGain = 0.02;            // [-]  Of the way of these steps.
constexpr double kMostTurn = 2.5;         // [rad]  Of one edge.
constexpr double kRangesOfPush = 20.0;    // [-]  The longest push, in ranges.
constexpr std::size_t kLongestWait = 16;
constexpr int kMostCentres = 32;
constexpr double kSureTurn = 1.0;  // [rad]  After which a screw is known well enough.

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
        place_before_(from) {
    if (aim_.target != nullptr) {
      before_ = t_.length(t_.difference(q_, *aim_.target));
    }
  }

  ContactWay run() {
    if (aim_.target == nullptr && centre()) {
      trail_ = {q_};
      screw_.setZero();
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

  /// Whether the straight way to the target is free; not asked again where it was blocked near by.
  bool is_free_to(const Configuration& target, std::size_t k) {
    if (k > 0 && held_back_ && k % 4 != 0) {
      return false;
    }
    return s_.work_.is_free(q_, target);
  }

  void take(Configuration to) {
    const Eigen::VectorXd dq = t_.difference(q_, to);
    travelled_ += t_.length(dq);
    screw_ += t_.in_body(q_, dq);
    q_ = std::move(to);
    looked_within_ = -1.0;
    way_.places.push_back(q_);
    trail_.push_back(q_);
  }

  /// The contacts at the place; not looked for again as long as it is the same.
  const ContactsAt& contacts_within(double band) {
    if (!(band <= looked_within_)) {
      at_ = s_.finder_.near(q_, band);
      looked_within_ = band;
    }
    return at_;
  }

  /// One step that contacts constrain. Whether it led anywhere.
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
    is_screw_ = false;
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

  /// [m]  The way along a direction behind which the least gap is the greatest, to first order.
  [[nodiscard]] double middle_along(const Eigen::Vector3d& along, const ContactsAt& at) const {
    const auto least_gap = [&](double way) {
      double least = s_.hover_;
      for (const NearContact& contact : at.contacts) {
        const double sign = at.members[contact.members[1]].J.cols() > 0 ? 1.0 : -1.0;
        least = std::min(least, contact.gap + sign * contact.n_AB_W.dot(along) * way);
      }
      return least;
    };
    double low = -2.0 * s_.hover_;
    double high = 2.0 * s_.hover_;
    for (int k = 0; k < 40; ++k) {  // A concave function.
      const double a = low + (high - low) / 3.0;
      const double b = high - (high - low) / 3.0;
      const bool rises = least_gap(a) < least_gap(b);
      (rises ? low : high) = rises ? a : b;
    }
    return 0.5 * (low + high);
  }

  /// Goes to the middle between contacts along one axis of the mover, so that what is repeated
  /// from there is not led astray by the play of a fit.
  bool centre() {
    if (!s_.work_.space().is_body()) {
      return false;
    }
    const Eigen::VectorXd turn = screw_.isZero(0.0) ? aim_.in_body : screw_;
    Eigen::Index axis = 0;
    const bool turns = turn.size() == 6 && !turn.tail<3>().isZero(0.0);
    if (!turns) {
      return false;
    }
    turn.tail<3>().cwiseAbs().maxCoeff(&axis);
    Eigen::VectorXd in_body = Eigen::VectorXd::Unit(6, axis);
    const double along =
        middle_along(t_.in_world(q_, in_body).head<3>(), contacts_within(2.0 * s_.hover_));
    in_body *= along;
    if (!(std::abs(along) > 0.1 * least_step())) {
      return false;
    }
    Configuration to = t_.moved(q_, t_.in_world(q_, in_body));
    if (!s_.work_.space().holds(to) || !s_.work_.is_free(q_, to)) {
      return false;
    }
    take(std::move(to));
    return true;
  }

  /// Takes all that the trail has led to once more, if that is proven, and again.
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
    }
    wait_ = any ? 0 : std::min(2 * wait_ + 1, kLongestWait);
    waits_ = wait_;
    if (!any && trail_.size() > 8) {
      trail_.erase(trail_.begin(), trail_.begin() + static_cast<std::ptrdiff_t>(trail_.size() / 2));
    }
  }

  /// Goes on by the screw that all steps since the middle of the contacts make, where they are all
  /// about one axis.
  bool repeat_screw() {
    bool any = false;
    const double turn = screw_.tail<3>().norm();
    if (!(turn > 0.0) || !is_screw_) {
      return false;
    }
    Eigen::VectorXd in_body = screw_ * std::min(1.0, kMostTurn / turn);
    int halvings = 0;
    while (!s_.work_.is_over() && travelled_ < aim_.most) {
      const Eigen::VectorXd dq = t_.in_world(q_, in_body);
      if (!(t_.product(dq, wanted_motion()) > 0.0)) {
        break;
      }
      Configuration to = t_.moved(q_, dq);
      if (!s_.work_.space().holds(to) || !s_.work_.is_free(q_, to)) {
        if (any || ++halvings > 4) {
          break;
        }
        in_body *= 0.5;
        continue;
      }
      take(std::move(to));
      any = true;
    }
    return any;
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
    }
    return any;
  }

  /// Drops what is too far back: an edge turns by less than half a turn.
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

  /// Whether the last steps have led on.
  bool gains() {
    if (way_.places.size() < looked_at_ + kStepsToGain) {
      return true;
    }
    const double way = travelled_ - travelled_before_;
    const double gain = aim_.target != nullptr
                            ? before_ - t_.length(t_.difference(q_, *aim_.target))
                            : t_.length(t_.difference(place_before_, q_));
    const bool leads_on = gain > kGain * way;
    looked_at_ = way_.places.size();
    travelled_before_ = travelled_;
    place_before_ = q_;
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
  Eigen::VectorXd screw_;  // The sum of all steps, in axes of the mover.
  ContactWay way_;
  double travelled_ = 0.0;
  bool held_back_ = false;
  ContactsAt at_;
  double looked_within_ = -1.0;  // [m]  Of the contacts; below 0 where there are none yet.
  double free_way_ = 0.0;        // [m]  Since the last contact.
  bool is_screw_ = false;        // The last step was one about an axis of it.
  std::size_t wait_ = 0;         // Steps between two tries to repeat the trail.
  std::size_t waits_ = 0;        // Steps that are left until the next try.
  std::size_t looked_at_ = 0;
  double travelled_before_ = 0.0;
  double before_ = 0.0;
  Configuration place_before_;
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

}  // namespace firstcontact::detail
