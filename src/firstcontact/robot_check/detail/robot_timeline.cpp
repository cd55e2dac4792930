#include <firstcontact/robot_check/detail/robot_timeline.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/shape_bounds.h>

namespace firstcontact::detail {
namespace {

constexpr double kUp = 1.0 + 0x1p-44;

RoundedBox ball_around(const Shape& shape) {
  const Hierarchy& hierarchy = shape.hierarchy();
  return {.centre = hierarchy.centre, .radius = (hierarchy.radius + shape.radius()) * kUp};
}

RoundedBox core_ball(const Shape& shape) {
  return {.centre = shape.hierarchy().centre, .radius = shape.hierarchy().radius * kUp};
}

RoundedBox box_around(const Shape& shape) {
  const ShapeBounds& bounds = shape.bounds();
  return {bounds.centre, bounds.axes, bounds.half_extents, shape.radius() * kUp};
}

/// The error of each joint; a screw slides, too. Empty if all are zero.
std::vector<TrackingError> errors_of(const RobotScene& scene, std::size_t robot) {
  std::vector<TrackingError> errors = scene.tracking_errors(robot);
  const auto joints = scene.robot_motion(robot).model().joints();
  bool any = false;
  for (std::size_t j = 0; j < errors.size(); ++j) {
    if (joints[j].type == JointType::screw) {
      errors[j].distance = std::abs(joints[j].pitch) * errors[j].angle * kUp;
    }
    any = any || errors[j].angle > 0.0 || errors[j].distance > 0.0;
  }
  return any ? errors : std::vector<TrackingError>();
}

bool is_at_rest(const std::vector<std::shared_ptr<const JointPath>>& pieces) {
  if (pieces.size() != 1) {
    return false;
  }
  const JointBounds bounds = pieces[0]->bounds(0.0, 1.0);
  return bounds.angle.rate == 0.0 && bounds.pivot.rate == 0.0;
}

}  // namespace

double GeometryPath::tracking_bound(const RoundedBox& ball, const TimeWindow& window,
                                    LinkScratch& scratch) const {
  if (errors.empty()) {
    return rest_error;
  }
  const double middle = 0.5 * (window.begin + window.end);
  return rest_error + X_FS.tracking_bound(middle, window.begin, window.end, ball, errors, scratch);
}

double PairPaths::tracking_bound(const BoundedGeometry& a, const BoundedGeometry& b,
                                 const TimeWindow& window, LinkScratch& scratch) const {
  return (A.tracking_bound(a.core, window, scratch) + B.tracking_bound(b.core, window, scratch)) *
         kUp;
}

RobotTimeline::RobotTimeline(const RobotScene& scene) : scene_(scene) {
  for (std::size_t robot = 0; robot < scene.robot_count(); ++robot) {
    joint_errors_.push_back(errors_of(scene, robot));
  }
  for (std::size_t member = 0; member < scene.size(); ++member) {
    first_geometry_.push_back(geometries_.size());
    add_geometries(member);
  }
  first_geometry_.push_back(geometries_.size());
  add_pairs();
  find_breaks();
  for (const TestedPair& pair : pairs_) {
    if (is_tested(pair)) {
      least_margin_ = std::min(least_margin_, pair.margin);
    }
  }
}

void RobotTimeline::follow_motions() {
  for (const Attachment& attachment : scene_.attachments()) {
    for (std::size_t geometry = first_geometry_[attachment.body];
         geometry < first_geometry_[attachment.body + 1]; ++geometry) {
      seats_[geometry] = seats_of_body(attachment.body);
    }
  }
  find_breaks();
}

void RobotTimeline::add_geometries(std::size_t member) {
  const std::optional<RobotLink> link = scene_.robot_link(member);
  const auto geometries = scene_.geometries(member);
  for (std::size_t g = 0; g < geometries.size(); ++g) {
    BoundedGeometry geometry{
        member,
        g,
        &geometries[g].shape,
        ball_around(geometries[g].shape),
        core_ball(geometries[g].shape),
        box_around(geometries[g].shape),
        (geometries[g].shape.bounds().reach + geometries[g].shape.radius()) * kUp};
    geometry.bounds = &geometries[g].shape.bounds();
    geometry.corners = hull_corners(geometries[g].shape);
    if (link) {
      seats_.push_back({seat_on_link(*link, scene_.paths(member)[g], 1.0)});
    } else {
      seats_.push_back(seats_of_body(member));
      const std::vector<Seat>& seats = seats_.back();
      geometry.rests = seats.size() == 1 && !seats[0].link && is_at_rest(seats[0].pieces);
    }
    geometries_.push_back(std::move(geometry));
  }
}

RobotTimeline::Seat RobotTimeline::seat_on_link(const RobotLink& link,
                                                std::shared_ptr<const JointPath> X_RS,
                                                double t_end) const {
  const RobotModel& model = scene_.robot_motion(link.robot).model();
  Seat seat;
  seat.t_end = t_end;
  seat.link = RobotLink{link.robot, model.rigid_root(link.link)};
  seat.X_LS = std::move(X_RS);
  return seat;
}

RobotTimeline::Seat RobotTimeline::carried_seat(const BodyStretch::Carried& carried,
                                                double t_end) const {
  const RobotModel& model = scene_.robot_motion(carried.link.robot).model();
  const PreciseTransform X_RB = model.from_rigid_root(carried.link.link) * precise(carried.X_LB);
  return seat_on_link(carried.link, std::make_shared<const JointPath>(JointPath::rigid(X_RB)),
                      t_end);
}

std::vector<RobotTimeline::Seat> RobotTimeline::seats_of_body(std::size_t member) const {
  const RoundedBox ball = core_ball(scene_.geometries(member)[0].shape);
  std::vector<Seat> seats;
  for (const BodyStretch& stretch : scene_.stretches(member)) {
    Seat seat;
    seat.t_end = stretch.t_end;
    if (const auto* carried = std::get_if<BodyStretch::Carried>(&stretch.how)) {
      seat = carried_seat(*carried, stretch.t_end);
    } else if (const auto* resting = std::get_if<BodyStretch::Resting>(&stretch.how)) {
      const Motion rest = Motion::fixed(resting->X_WB);
      seat.ends = {1.0};
      seat.pieces = {std::make_shared<const JointPath>(
          JointPath::of_motion({}, rest.path(0, Eigen::Vector3d::Zero())))};
      // The body was put down with the error with which it was carried.
      const double t = stretch.t_begin;
      LinkScratch scratch;
      seat.rest_error = path(seats.back(), t, std::nullopt).tracking_bound(ball, {t, t}, scratch);
    } else {
      const std::span<const double> breaks = scene_.body_motion(member).breaks();
      seat.ends.assign(breaks.begin() + 1, breaks.end());
      const auto paths = scene_.paths(member);
      seat.pieces.assign(paths.begin(), paths.end());
    }
    seats.push_back(std::move(seat));
  }
  return seats;
}

void RobotTimeline::add_pairs() {
  for (std::size_t first = 0; first < scene_.size(); ++first) {
    for (std::size_t second = first + 1; second < scene_.size(); ++second) {
      const auto is_empty = [&](std::size_t m) {
        return first_geometry_[m] == first_geometry_[m + 1];
      };
      if (is_empty(first) || is_empty(second)) {
        continue;
      }
      if (const std::optional<double> margin = scene_.margin({first, second})) {
        pairs_.push_back({{first, second}, *margin});
      }
    }
  }
  for (const Attachment& attachment : scene_.attachments()) {
    std::vector<std::size_t> untested = attachment.touch_links;
    untested.push_back(attachment.link);
    for (const std::size_t other : untested) {
      const BodyPair members = {std::min(attachment.body, other), std::max(attachment.body, other)};
      const auto before = [](const TestedPair& pair, const BodyPair& key) {
        return pair.members < key;
      };
      const auto found = std::lower_bound(pairs_.begin(), pairs_.end(), members, before);
      if (found != pairs_.end() && found->members == members) {
        found->pauses.push_back({attachment.t_from, attachment.t_to});
      }
    }
  }
}

void RobotTimeline::find_breaks() {
  breaks_ = {0.0};
  const auto add = [&](std::span<const double> times) {
    for (const double t : times) {
      if (t != breaks_.back()) {  // Most are equal.
        breaks_.push_back(t);
      }
    }
  };
  for (std::size_t robot = 0; robot < scene_.robot_count(); ++robot) {
    add(scene_.robot_motion(robot).breaks());
  }
  for (const std::vector<Seat>& seats : seats_) {
    for (const Seat& seat : seats) {
      add(seat.ends);
      add({&seat.t_end, 1});
    }
  }
  std::sort(breaks_.begin(), breaks_.end());
  breaks_.erase(std::unique(breaks_.begin(), breaks_.end()), breaks_.end());
}

bool RobotTimeline::has_tracking_errors() const {
  return std::any_of(joint_errors_.begin(), joint_errors_.end(),
                     [](const auto& errors) { return !errors.empty(); });
}

bool RobotTimeline::is_tested(const TestedPair& pair, std::size_t piece) const {
  if (pair.pauses.empty()) {
    return true;
  }
  const double middle = 0.5 * (breaks_[piece] + breaks_[piece + 1]);
  return std::none_of(pair.pauses.begin(), pair.pauses.end(), [&](const TimeWindow& pause) {
    return pause.begin <= middle && middle <= pause.end;
  });
}

bool RobotTimeline::is_tested(const TestedPair& pair) const {
  bool is_any = pair.pauses.empty();
  for (std::size_t piece = 0; piece < piece_count() && !is_any; ++piece) {
    is_any = is_tested(pair, piece);
  }
  return is_any;
}

std::size_t RobotTimeline::Seat::piece(double t) const {
  return static_cast<std::size_t>(std::lower_bound(ends.begin(), ends.end() - 1, t) - ends.begin());
}

const RobotTimeline::Seat& RobotTimeline::seat(std::size_t geometry, double t) const {
  const std::vector<Seat>& seats = seats_[geometry];
  const auto ends_before = [](const Seat& seat, double time) { return seat.t_end < time; };
  return *std::lower_bound(seats.begin(), seats.end() - 1, t, ends_before);
}

std::vector<TrackingError> RobotTimeline::errors_along(const RobotLink& link,
                                                       std::size_t frame) const {
  const std::vector<TrackingError>& errors = joint_errors_[link.robot];
  const RobotModel& model = scene_.robot_motion(link.robot).model();
  std::vector<TrackingError> along;
  for (const std::size_t joint : model.chain(frame, link.link)) {
    if (model.joints()[joint].type != JointType::fixed) {
      along.push_back(errors[joint]);
    }
  }
  return along;
}

GeometryPath RobotTimeline::path(const Seat& seat, double t,
                                 std::optional<std::size_t> frame) const {
  if (!seat.link) {
    const std::size_t k = seat.piece(t);
    const double t_begin = k == 0 ? 0.0 : seat.ends[k - 1];
    return {{t_begin, seat.ends[k], {seat.pieces[k]}}, {}, seat.rest_error};
  }
  const RobotMotion& motion = scene_.robot_motion(seat.link->robot);
  const std::size_t link = seat.link->link;
  GeometryPath path{
      (frame ? motion.path(*frame, link, t) : motion.path(link, t)).then(seat.X_LS), {}, 0.0};
  if (!joint_errors_[seat.link->robot].empty()) {
    path.errors = errors_along(*seat.link, frame.value_or(motion.model().root()));
    if (!frame) {
      path.errors.insert(path.errors.begin(), TrackingError{});  // Error of the base.
    }
    path.errors.push_back({});  // Error of the geometry in the link.
  }
  return path;
}

GeometryPath RobotTimeline::path(std::size_t geometry, double t) const {
  return path(seat(geometry, t), t, std::nullopt);
}

GeometryPath RobotTimeline::path(std::size_t geometry, double t,
                                 const std::optional<RobotLink>& frame) const {
  return path(seat(geometry, t), t, frame ? std::optional(frame->link) : std::nullopt);
}

GeometryCarrier RobotTimeline::seat_of(std::size_t geometry, double t) const {
  const Seat& at = seat(geometry, t);
  return {at.link, at.link ? at.X_LS.get() : at.pieces[at.piece(t)].get()};
}

PairPaths RobotTimeline::paths(std::size_t a, std::size_t b, double t) const {
  const Seat& seat_a = seat(a, t);
  const Seat& seat_b = seat(b, t);
  std::optional<std::size_t> frame;
  if (seat_a.link && seat_b.link && seat_a.link->robot == seat_b.link->robot) {
    const RobotModel& model = scene_.robot_motion(seat_a.link->robot).model();
    frame = model.rigid_root(model.last_common_ancestor(seat_a.link->link, seat_b.link->link));
  }
  PairPaths paths{path(seat_a, t, frame), path(seat_b, t, frame), std::nullopt};
  if (frame) {
    paths.frame = RobotLink{seat_a.link->robot, *frame};
  }
  return paths;
}

}  // namespace firstcontact::detail
