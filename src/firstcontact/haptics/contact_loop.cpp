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
#include <firstcontact/haptics/detail/contact_loop_implementation.h>
#include <firstcontact/haptics/detail/haptic_scene_check.h>
#include <firstcontact/haptics/detail/hull_proof.h>
#include <firstcontact/math/number_text.h>
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

}  // namespace
}  // namespace detail

ContactLoop::Implementation::Implementation(HapticScene scene, const ContactLoopOptions& options)
    : scene_(std::move(scene)), options_(options) {
  detail::check_haptic_scene(scene_);
  detail::require_haptic(options.rounds > 0, "ContactLoopOptions::rounds must be > 0");
  detail::require_haptic(options.least_gain >= 0.0 && options.least_gain < 1.0,
                         "ContactLoopOptions::least_gain must be in [0, 1)");
  detail::require_haptic(options.angle > 0.0 && options.angle < 1.0,
                         "ContactLoopOptions::angle must be in (0, 1)");
  detail::require_haptic(options.most_contacts > 0 && options.most_contacts <= kMostHapticContacts,
                         "ContactLoopOptions::most_contacts must be in 1 to 128");
  begin_members();
  begin_links();
  begin_pairs();
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
    const Eigen::Vector3d middle =
        pose.position + pose.rotation.normalized() * shape.bounds().centre;
    extent = std::max({extent, pose.position.norm(), middle.norm() + reach});
    members_.push_back({.shape = shape, .reach = reach, .friction = friction});
    poses_.push_back(pose);
    placed_.emplace_back();
    motions_.push_back(Motion::fixed(pose));
    return reach;
  };
  for (const HapticTool& tool : scene_.tools) {
    least_reach = std::min(least_reach, add(tool.shape, tool.X_WB, tool.friction));
    const Eigen::Vector3d centre = tool.X_WB.position + tool.X_WB.rotation.normalized() * tool.p_BC;
    extent = std::max({extent, tool.p_BC.norm(), centre.norm()});
  }
  for (const HapticBody& body : scene_.bodies) {
    const double reach =
        add(body.shape, body.course ? body.course->pose(0.0) : body.X_WB, body.friction);
    if (body.course) {
      bends_.push_back({*body.course, reach + members_.back().shape.bounds().centre.norm()});
    }
  }
  distance_ = scene_.contact_distance.value_or(detail::kContactDistanceOfReach * least_reach);
  detail::require_haptic(
      scene_.contact_distance || least_reach > 0.0,
      "a tool of one point has no default of \"contact_distance\": give it in metres");
  detail::require_haptic(distance_ >= detail::kLeastContactDistanceOfExtent * extent,
                         "\"contact_distance\" is too small to be proven at coordinates of " +
                             detail::shortest(extent) +
                             " m, of poses or of a tool's centre: give a larger one");
  farthest_ = distance_ / detail::kLeastContactDistanceOfExtent;
  finder_ = detail::ContactFinder(distance_);
}

/// [m]  The least reach of a tool or one of its links.
double ContactLoop::Implementation::least_reach() const {
  double least = detail::kInfinite;
  for (std::size_t m = 0; m < members_.size(); ++m) {
    least = is_body(m) ? least : std::min(least, members_[m].reach);
  }
  return least;
}

void ContactLoop::Implementation::begin_pairs() {
  courses_.resize(members_.size());
  ways_.resize(members_.size());
  const detail::NeighbourSlack slack{.beside = detail::kSlackOfNeighbours * distance_,
                                     .far = detail::kSlackOfFarNeighbours * distance_,
                                     .far_from = detail::kFarNeighbour * least_reach()};
  for (detail::HapticMember& member : members_) {
    member.neighbours = std::make_shared<const detail::SurfaceNeighbours>(member.shape, slack);
    member.fills_hull = detail::fills_its_hull(member.shape, detail::kSlackOfConvex * distance_);
  }
  const auto add = [&](std::size_t other, std::size_t tool) {
    const auto is_this = [&](const std::array<std::size_t, 2>& pair) {
      return std::minmax(pair[0], pair[1]) == std::minmax(tool, other);
    };
    if (!std::ranges::any_of(scene_.ignored_pairs, is_this)) {
      pairs_.push_back({.members = {other, tool},
                        .gap = 0.0,
                        .may_be_far = std::max(tool, other) >= first_link()});
    }
  };
  for (std::size_t tool = 0; tool < tools(); ++tool) {
    for (std::size_t other = tool + 1; other < first_link(); ++other) {
      // In a pair of tools the first tool is the other member.
      add(other < tools() ? tool : other, other < tools() ? other : tool);
    }
  }
  for (std::size_t link = first_link(); link < members_.size(); ++link) {
    for (std::size_t other = 0; other < link; ++other) {
      const bool is_same = tool_of(other) == tool_of(link);
      if (!is_same || !links_.are_joined(link_of(other), link_of(link))) {
        add(other, link);
      }
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
    const std::string mend = tool_of(tool) == tool_of(other)
                                 ? "; links that overlap by design have to be ignored as a pair"
                                 : "; move one of them apart";
    const double gap = distance(A, B, 0.0, workspace_).lower_bound;
    detail::require_haptic(!(gap > 0.0 && gap < 0.1 * distance_),
                           names +
                               " start nearer to each other than a tenth of the contact "
                               "distance: choose a smaller one, or part them");
    const FirstContactResult start =
        first_contact(A, B, workspace_, {.tolerance = 1e-3 * distance_});
    detail::require_haptic(gap > 0.0 && start.verdict == Verdict::free,
                           names + " meet at the start" + mend);
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
  set_link_frames();
}

/// Sets the members of a touch.
void ContactLoop::Implementation::number(HapticTouch& touch, std::size_t other,
                                         std::size_t tool) const {
  touch.members = {other, tool};
  HapticContact& contact = touch.contact;
  contact.tool = static_cast<std::int32_t>(tool_of(tool));
  contact.link = static_cast<std::int32_t>(link_of(tool));
  contact.other = static_cast<std::int32_t>(tool_of(other));
  contact.other_link = static_cast<std::int32_t>(link_of(other));
  contact.body = is_body(other) ? static_cast<std::int32_t>(other - tools()) : -1;
}

void ContactLoop::Implementation::find_contacts() {
  if (is_found_) {
    return;
  }
  touches_.clear();
  reduced_.reset();
  for (std::size_t m = 0; m < members_.size(); ++m) {
    if (!placed_[m]) {
      placed_[m].emplace(members_[m].shape, poses_[m]);
    }
  }
  for (detail::HapticPair& pair : pairs_) {
    const auto [other, tool] = pair.members;
    if (pair.may_be_far && detail::are_far(members_[other], poses_[other], members_[tool],
                                           poses_[tool], detail::kContactBand * distance_)) {
      pair.gap = detail::kInfinite;
      continue;
    }
    const std::size_t first = touches_.size();
    pair.gap = finder_.find(members_[other], *placed_[other], members_[tool], *placed_[tool],
                            pair.front, touches_);
    for (std::size_t k = first; k < touches_.size(); ++k) {
      number(touches_[k], other, tool);
      HapticContact& contact = touches_[k].contact;
      contact.way = std::max(0.0, contact.gap - detail::kRestGap * distance_);
    }
  }
  is_found_ = true;
}

ContactLoop::ContactLoop(HapticScene scene, const ContactLoopOptions& options)
    : implementation_(std::make_unique<Implementation>(std::move(scene), options)) {}
ContactLoop::~ContactLoop() = default;
ContactLoop::ContactLoop(ContactLoop&&) noexcept = default;
ContactLoop& ContactLoop::operator=(ContactLoop&&) noexcept = default;

const HapticScene& ContactLoop::scene() const { return implementation_->scene_; }
double ContactLoop::contact_distance() const { return implementation_->distance_; }
double ContactLoop::time() const { return implementation_->time_; }
std::span<const double> ContactLoop::joints() const { return implementation_->joints_; }
const Pose& ContactLoop::pose(std::size_t member) const {
  return implementation_->poses_.at(member);
}
const HapticCycle& ContactLoop::advance(const HapticTargets& targets, double dt,
                                        std::int64_t stamp_ns,
                                        const std::optional<Deadline>& deadline) {
  return implementation_->advance(targets, dt, stamp_ns, deadline);
}
const HapticContactSet& ContactLoop::contact_set() const { return implementation_->set_; }

}  // namespace firstcontact
