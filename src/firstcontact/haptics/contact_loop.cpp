#include <firstcontact/haptics/contact_loop.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include <firstcontact/geometry/shape_bounds.h>
#include <firstcontact/haptics/detail/constants.h>
#include <firstcontact/haptics/detail/contact_finder.h>
#include <firstcontact/haptics/detail/contact_listing.h>
#include <firstcontact/haptics/detail/contact_reduction.h>
#include <firstcontact/haptics/detail/god_object_plan.h>
#include <firstcontact/haptics/detail/haptic_scene_check.h>
#include <firstcontact/haptics/detail/pair_proof.h>
#include <firstcontact/query/distance.h>

namespace firstcontact {
namespace detail {
namespace {

using Eigen::Vector3d;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

double reach_of(const Shape& shape) {
  const ShapeBounds& bounds = shape.bounds();
  return bounds.reach + shape.radius();
}

/// [m]  How far the points of a body get in a displacement, at most, about.
double extent_of(const Displacement& way, double reach) {
  return way.translation.norm() + way.rotation_vector.norm() * reach;
}

Vector3d moved_by(const Displacement& way, const Vector3d& arm) {
  return way.translation + way.rotation_vector.cross(arm);
}

}  // namespace
}  // namespace detail

class ContactLoop::Implementation {
 public:
  Implementation(HapticScene scene, const ContactLoopOptions& options);

  const HapticCycle& advance(std::span<const Pose> targets, double dt, std::int64_t stamp_ns,
                             const std::optional<Deadline>& deadline);

  HapticScene scene_;
  double distance_ = 0.0;  // [m]
  double time_ = 0.0;      // [s]
  std::vector<Pose> poses_;
  HapticContactSet set_;

 private:
  using Vector3d = Eigen::Vector3d;
  using Displacement = detail::Displacement;

  [[nodiscard]] std::size_t tools() const { return scene_.tools.size(); }
  [[nodiscard]] const HapticBody& body_of(std::size_t member) const {
    return scene_.bodies[member - tools()];
  }
  [[nodiscard]] bool has_course(std::size_t member) const {
    return member >= tools() && body_of(member).course.has_value();
  }
  [[nodiscard]] Pose on_course(std::size_t member, double time) const {
    return body_of(member).course->pose(std::min(1.0, time / scene_.duration));
  }
  [[nodiscard]] Vector3d centre(std::size_t tool) const {
    return poses_[tool].position + poses_[tool].rotation.normalized() * scene_.tools[tool].p_BC;
  }

  void begin_members();
  void require_start();
  [[nodiscard]] std::string name_of(std::size_t member) const {
    return member < tools() ? scene_.tools[member].name : body_of(member).name;
  }
  void find_contacts();
  void set_frames();
  void begin_cycle(double dt);
  [[nodiscard]] detail::ToolDisplacements wanted(std::span<const Pose> targets) const;
  [[nodiscard]] double gain_of(const detail::ToolDisplacements& ways) const;
  void set_courses(double slot);
  [[nodiscard]] detail::GodObjectPlan plan(const detail::ToolDisplacements& wanted);
  [[nodiscard]] detail::GodObjectPlan plan_within_turn(detail::ToolDisplacements wanted);
  double execute(const detail::GodObjectPlan& plan, double slot, double dt,
                 const std::optional<Deadline>& deadline);
  void append_piece(std::size_t member, const Displacement& way, double part, double to);
  void rest_until(double dt);
  void end_cycle(double dt, std::int64_t stamp_ns);
  void publish(std::int64_t stamp_ns);
  [[nodiscard]] double size_of_cycle() const;

  ContactLoopOptions options_;
  std::vector<detail::HapticMember> members_;
  std::vector<std::optional<PlacedShape>> placed_;
  std::vector<detail::HapticPair> pairs_;
  std::vector<Displacement> courses_;  // Of members, over the next plan.
  std::vector<Motion> motions_;
  detail::ContactFinder finder_{0.0};
  Workspace workspace_;
  FirstContactResult scratch_;
  bool is_found_ = false;  // The contacts are those of the poses.
  std::vector<HapticTouch> touches_;
  std::vector<detail::PlannedTouch> planned_;
  detail::ToolFrames frames_;
  double rest_clearance_ = 0.0;  // [m]  Proven where the members are.
  bool are_courses_moving_ = false;
  double now_ = 0.0;  // [s]  Since the cycle began.
  HapticCycle cycle_;
};

ContactLoop::Implementation::Implementation(HapticScene scene, const ContactLoopOptions& options)
    : scene_(std::move(scene)), options_(options) {
  detail::check_haptic_scene(scene_);
  detail::require_haptic(options.rounds > 0, "ContactLoopOptions::rounds must be > 0");
  detail::require_haptic(options.angle > 0.0 && options.angle < 1.0,
                         "ContactLoopOptions::angle must be in (0, 1)");
  detail::require_haptic(options.most_contacts > 0 && options.most_contacts <= kMostHapticContacts,
                         "ContactLoopOptions::most_contacts must be in 1 to 128");
  begin_members();
  require_start();
  set_frames();
  find_contacts();
  publish(0);
}

void ContactLoop::Implementation::begin_members() {
  double least_reach = detail::kInfinite;
  double extent = 0.0;
  const auto add = [&](const Shape& given, const Pose& pose, double friction) {
    const Shape shape = given.as_triangles();
    const double reach = detail::reach_of(shape);
    extent = std::max(extent, pose.position.cwiseAbs().maxCoeff() + reach);
    members_.push_back({.shape = shape, .reach = reach, .friction = friction});
    poses_.push_back(pose);
    placed_.emplace_back();
    motions_.push_back(Motion::fixed(pose));
    return reach;
  };
  for (const HapticTool& tool : scene_.tools) {
    least_reach = std::min(least_reach, add(tool.shape, tool.X_WB, tool.friction));
  }
  for (const HapticBody& body : scene_.bodies) {
    add(body.shape, body.course ? body.course->pose(0.0) : body.X_WB, body.friction);
  }
  distance_ = scene_.contact_distance.value_or(detail::kContactDistanceOfReach * least_reach);
  detail::require_haptic(distance_ >= detail::kLeastContactDistanceOfExtent * extent,
                         "the contact distance is too small to be proven at coordinates of " +
                             std::to_string(extent) + " m");
  finder_ = detail::ContactFinder(distance_);
  courses_.resize(members_.size());
  for (detail::HapticMember& member : members_) {
    member.neighbours = std::make_shared<const detail::SurfaceNeighbours>(
        member.shape, detail::kSlackOfNeighbours * distance_);
  }
  for (std::size_t tool = 0; tool < tools(); ++tool) {
    for (std::size_t other = tool + 1; other < members_.size(); ++other) {
      const auto is_this = [&](const std::array<std::size_t, 2>& pair) {
        return std::minmax(pair[0], pair[1]) == std::minmax(tool, other);
      };
      if (std::ranges::any_of(scene_.ignored_pairs, is_this)) {
        continue;
      }
      // The first tool is the other member of a pair of tools.
      pairs_.push_back({.members = {other < tools() ? tool : other, other < tools() ? other : tool},
                        .gap = 0.0});
    }
  }
}

void ContactLoop::Implementation::require_start() {
  rest_clearance_ = detail::kInfinite;
  for (const detail::HapticPair& pair : pairs_) {
    const auto [other, tool] = pair.members;
    const MovingShape A{members_[other].shape, motions_[other]};
    const MovingShape B{members_[tool].shape, motions_[tool]};
    const std::string names = "\"" + name_of(tool) + "\" and \"" + name_of(other) + "\"";
    const FirstContactResult start =
        first_contact(A, B, workspace_, {.tolerance = 1e-3 * distance_});
    detail::require_haptic(start.verdict == Verdict::free, names + " meet at the start");
    const double gap = distance(A, B, 0.0, workspace_).lower_bound;
    detail::require_haptic(gap >= 0.1 * distance_,
                           names +
                               " start nearer to each other than a tenth of the contact "
                               "distance: choose a smaller one, or part them");
    rest_clearance_ = std::min(rest_clearance_, gap);
  }
}

void ContactLoop::Implementation::set_frames() {
  for (std::size_t k = 0; k < tools(); ++k) {
    const HapticCoupling& coupling = scene_.tools[k].coupling;
    frames_.p_WC[k] = centre(k);
    frames_.lengths[k] = std::sqrt(coupling.angular_stiffness / coupling.stiffness);
    frames_.weights[k] = std::sqrt(coupling.stiffness / scene_.tools[0].coupling.stiffness);
  }
}

void ContactLoop::Implementation::find_contacts() {
  if (is_found_) {
    return;
  }
  touches_.clear();
  for (std::size_t m = 0; m < members_.size(); ++m) {
    if (!placed_[m]) {
      placed_[m].emplace(members_[m].shape, poses_[m]);
    }
  }
  for (detail::HapticPair& pair : pairs_) {
    const auto [other, tool] = pair.members;
    const std::size_t first = touches_.size();
    pair.gap =
        finder_.find(members_[other], *placed_[other], members_[tool], *placed_[tool], touches_);
    for (std::size_t k = first; k < touches_.size(); ++k) {
      HapticContact& contact = touches_[k].contact;
      contact.tool = static_cast<std::int32_t>(tool);
      contact.other = other < tools() ? static_cast<std::int32_t>(other) : -1;
      contact.body = other < tools() ? -1 : static_cast<std::int32_t>(other - tools());
      contact.way = std::max(0.0, contact.gap - detail::kRestGap * distance_);
    }
  }
  is_found_ = true;
}

detail::ToolDisplacements ContactLoop::Implementation::wanted(std::span<const Pose> targets) const {
  detail::ToolDisplacements ways;
  for (std::size_t k = 0; k < tools(); ++k) {
    const Eigen::Quaterniond R_WB = targets[k].rotation.normalized();
    ways[k].translation = targets[k].position + R_WB * scene_.tools[k].p_BC - centre(k);
    ways[k].rotation_vector = detail::shortest_turn(poses_[k].rotation, R_WB);
  }
  return ways;
}

double ContactLoop::Implementation::gain_of(const detail::ToolDisplacements& ways) const {
  double gain = 0.0;
  for (std::size_t k = 0; k < tools(); ++k) {
    gain = std::max(gain, detail::extent_of(ways[k], members_[k].reach));
  }
  return gain;
}

/// Sets how far the bodies with courses go in a part of the cycle: from where they are to where
/// their courses are then.
void ContactLoop::Implementation::set_courses(double slot) {
  for (std::size_t m = tools(); m < members_.size(); ++m) {
    courses_[m] = {};
    if (has_course(m)) {
      const Pose to = on_course(m, time_ + now_ + slot);
      courses_[m].translation = to.position - poses_[m].position;
      courses_[m].rotation_vector = detail::shortest_turn(poses_[m].rotation, to.rotation);
    }
  }
}

detail::GodObjectPlan ContactLoop::Implementation::plan(const detail::ToolDisplacements& wanted) {
  std::vector<std::size_t> chosen;
  if (touches_.size() > detail::kMostProjected) {
    std::vector<HapticContact> contacts;
    for (const HapticTouch& touch : touches_) {
      contacts.push_back(touch.contact);
    }
    chosen =
        detail::reduce_contacts(contacts, frames_, tools(), options_.angle, detail::kMostProjected)
            .kept;
  } else {
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      chosen.push_back(k);
    }
  }
  planned_.clear();
  for (const std::size_t k : chosen) {
    const HapticContact& contact = touches_[k].contact;
    detail::PlannedTouch touch{.contact = &contact,
                               .way = contact.gap - detail::kRestGap * distance_};
    if (contact.body >= 0) {
      const std::size_t member = tools() + static_cast<std::size_t>(contact.body);
      touch.surface = detail::moved_by(courses_[member], contact.point - poses_[member].position);
    }
    planned_.push_back(touch);
  }
  detail::GodObjectPlan plan =
      detail::plan_god_objects(wanted, frames_, tools(), planned_, detail::kSolvedTo * distance_);
  for (Displacement& way : plan.displacements) {
    if (!way.translation.allFinite() || !way.rotation_vector.allFinite()) {
      way = {};
    }
  }
  cycle_.residual = std::max(cycle_.residual, plan.residual);
  return plan;
}

/// Plans with a shorter way where contacts would turn a tool so far that its straight constraints
/// do not hold.
detail::GodObjectPlan ContactLoop::Implementation::plan_within_turn(
    detail::ToolDisplacements wanted) {
  detail::GodObjectPlan found = plan(wanted);
  double part = 1.0;
  for (std::size_t k = 0; k < tools() && found.is_pressed; ++k) {
    // A point at the reach sinks by half of reach times the square of the angle.
    const double most = std::sqrt(2.0 * detail::kSinkOfTurn * distance_ / members_[k].reach);
    part = std::min(part, most / found.displacements[k].rotation_vector.norm());
  }
  if (!(part < 1.0)) {
    return found;
  }
  if (are_courses_moving_) {
    for (Displacement& way : wanted) {
      way.translation *= part;
      way.rotation_vector *= part;
    }
    found = plan(wanted);
  } else {
    for (Displacement& way : found.displacements) {
      way.translation *= part;
      way.rotation_vector *= part;
    }
  }
  found.is_shortened = true;
  return found;
}

void ContactLoop::Implementation::append_piece(std::size_t member, const Displacement& way,
                                               double part, double to) {
  for (HapticMemberMotion& motion : cycle_.members) {
    if (motion.member == member) {
      motion.pieces.push_back({.to = to,
                               .X_WB = poses_[member],
                               .translation = part * way.translation,
                               .rotation_vector = part * way.rotation_vector});
    }
  }
}

/// Makes the plan as far as it is proven.
///
/// @returns  [-]  the part of it that was made
double ContactLoop::Implementation::execute(const detail::GodObjectPlan& plan, double slot,
                                            double dt, const std::optional<Deadline>& deadline) {
  for (std::size_t m = 0; m < members_.size(); ++m) {
    if (m >= tools() && !has_course(m)) {
      continue;
    }
    const Displacement& way = m < tools() ? plan.displacements[m] : courses_[m];
    const ConstantRatePiece piece{
        .X_WB = poses_[m], .translation = way.translation, .rotation_vector = way.rotation_vector};
    motions_[m] = Motion::constant_rates(std::span(&piece, 1),
                                         m < tools() ? scene_.tools[m].p_BC : Vector3d::Zero());
  }
  const detail::ProvenPart proven =
      detail::prove_plan(members_, motions_, pairs_, distance_, deadline, workspace_, scratch_);
  cycle_.is_late = cycle_.is_late || proven.is_late;
  const double to = proven.t == 1.0 && slot == dt - now_ ? dt : now_ + proven.t * slot;
  if (!(to > now_)) {
    return 0.0;
  }
  for (std::size_t m = 0; m < members_.size(); ++m) {
    if (m >= tools() && !has_course(m)) {
      continue;
    }
    append_piece(m, m < tools() ? plan.displacements[m] : courses_[m], proven.t, to);
    poses_[m] = has_course(m) && proven.t == 1.0 ? on_course(m, time_ + now_ + slot)
                                                 : motions_[m].pose(proven.t);
    placed_[m].reset();
  }
  rest_clearance_ = proven.clearance;
  cycle_.clearance = std::min(cycle_.clearance, proven.clearance);
  now_ = to;
  is_found_ = false;
  set_frames();
  return proven.t;
}

void ContactLoop::Implementation::begin_cycle(double dt) {
  now_ = 0.0;
  cycle_.index += 1;
  cycle_.asked = dt;
  cycle_.lasted = 0.0;
  cycle_.clearance = rest_clearance_;
  cycle_.rounds = 0;
  cycle_.is_converged = false;
  cycle_.is_late = false;
  cycle_.residual = 0.0;
  cycle_.members.clear();
  are_courses_moving_ = false;
  for (std::size_t m = 0; m < members_.size(); ++m) {
    if (m < tools() || has_course(m)) {
      cycle_.members.push_back({.member = m});
    }
    are_courses_moving_ = are_courses_moving_ || (has_course(m) && time_ < scene_.duration);
  }
}

/// All members rest until the end of the cycle.
void ContactLoop::Implementation::rest_until(double dt) {
  if (now_ < dt) {
    for (const HapticMemberMotion& motion : cycle_.members) {
      append_piece(motion.member, {}, 0.0, dt);
    }
    now_ = dt;
  }
}

/// [m]  What the rounding of pieces is a part of.
double ContactLoop::Implementation::size_of_cycle() const {
  double size = 0.0;
  for (const HapticMemberMotion& motion : cycle_.members) {
    for (const HapticPiece& piece : motion.pieces) {
      size = std::max(size, piece.X_WB.position.norm() + piece.translation.norm() +
                                (1.0 + piece.rotation_vector.norm()) *
                                    (members_[motion.member].reach +
                                     members_[motion.member].shape.bounds().centre.norm()));
    }
  }
  return size;
}

void ContactLoop::Implementation::end_cycle(double dt, std::int64_t stamp_ns) {
  find_contacts();
  for (HapticTouch& touch : touches_) {
    HapticContact& contact = touch.contact;
    if (contact.body >= 0 && now_ > 0.0) {
      const std::size_t member = tools() + static_cast<std::size_t>(contact.body);
      contact.surface_velocity.setZero();
      for (const HapticMemberMotion& motion : cycle_.members) {
        if (motion.member == member && !motion.pieces.empty()) {
          // How fast it went in this cycle, waiting included.
          const HapticPiece& first = motion.pieces.front();
          const Displacement way{
              poses_[member].position - first.X_WB.position,
              detail::shortest_turn(first.X_WB.rotation, poses_[member].rotation)};
          contact.surface_velocity =
              detail::moved_by(way, contact.point - poses_[member].position) / dt;
        }
      }
    }
  }
  cycle_.lasted = now_;
  time_ += now_;
  for (HapticMemberMotion& motion : cycle_.members) {
    motion.X_WB = poses_[motion.member];
  }
  cycle_.clearance = std::max(0.0, cycle_.clearance - detail::kRoundingOfPieces * size_of_cycle());
  cycle_.contacts = touches_.size();
  publish(stamp_ns);
}

const HapticCycle& ContactLoop::Implementation::advance(std::span<const Pose> targets, double dt,
                                                        std::int64_t stamp_ns,
                                                        const std::optional<Deadline>& deadline) {
  detail::require_haptic(targets.size() == tools(), "a target for each tool was expected");
  detail::require_haptic(dt > 0.0 && dt < detail::kInfinite, "dt must be > 0 s");
  for (const Pose& target : targets) {
    detail::require_haptic(detail::is_finite_pose(target), "a target is not finite");
  }
  begin_cycle(dt);
  const double least_gain = detail::kLeastGain * distance_;
  bool goes_on = true;
  for (std::size_t round = 0; round < options_.rounds && now_ < dt && goes_on; ++round) {
    if (deadline && round > 0 && std::chrono::steady_clock::now() >= *deadline) {
      cycle_.is_late = true;
      break;
    }
    const double left = dt - now_;
    find_contacts();
    const bool is_last = round + 1 == options_.rounds;
    double slot = touches_.empty() || is_last ? left : 0.5 * left;
    set_courses(slot);
    const detail::ToolDisplacements ways = wanted(targets);
    detail::GodObjectPlan plan = plan_within_turn(ways);
    ++cycle_.rounds;
    const bool gains = gain_of(plan.displacements) > least_gain;
    if (!gains && !are_courses_moving_) {
      cycle_.is_converged = true;
      break;
    }
    if (!gains && slot < left) {  // Only the courses are left: all of them.
      slot = left;
      set_courses(slot);
      plan = plan_within_turn(ways);
    }
    const double made = execute(plan, slot, dt, deadline);
    const bool is_there = made == 1.0 && !plan.is_pressed && !plan.is_shortened;
    cycle_.is_converged = is_there;
    goes_on = made * gain_of(plan.displacements) > 1e-3 * least_gain ||
              (are_courses_moving_ && made > 0.0);
    goes_on = goes_on && !(is_there && !are_courses_moving_);
  }
  if (!are_courses_moving_) {
    rest_until(dt);
  }
  end_cycle(dt, stamp_ns);
  return cycle_;
}

void ContactLoop::Implementation::publish(std::int64_t stamp_ns) {
  set_.sequence += 1;
  set_.stamp_ns = stamp_ns;
  set_.tools = static_cast<std::uint32_t>(tools());
  detail::list_contacts(touches_, frames_, tools(), options_, set_, cycle_.touches);
  for (std::size_t k = 0; k < tools(); ++k) {
    set_.X_WB[k] = poses_[k];
    set_.p_WC[k] = frames_.p_WC[k];
  }
  set_.checksum = checksum_of(set_);
}

ContactLoop::ContactLoop(HapticScene scene, const ContactLoopOptions& options)
    : implementation_(std::make_unique<Implementation>(std::move(scene), options)) {}
ContactLoop::~ContactLoop() = default;
ContactLoop::ContactLoop(ContactLoop&&) noexcept = default;
ContactLoop& ContactLoop::operator=(ContactLoop&&) noexcept = default;

const HapticScene& ContactLoop::scene() const { return implementation_->scene_; }
double ContactLoop::contact_distance() const { return implementation_->distance_; }
double ContactLoop::time() const { return implementation_->time_; }
const Pose& ContactLoop::pose(std::size_t member) const {
  return implementation_->poses_.at(member);
}
const HapticCycle& ContactLoop::advance(std::span<const Pose> targets, double dt,
                                        std::int64_t stamp_ns,
                                        const std::optional<Deadline>& deadline) {
  return implementation_->advance(targets, dt, stamp_ns, deadline);
}
const HapticContactSet& ContactLoop::contact_set() const { return implementation_->set_; }

}  // namespace firstcontact
