#include <firstcontact/articulated/robot_motion.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include <firstcontact/articulated/precise_transform.h>
#include <firstcontact/math/sine_cosine.h>

namespace firstcontact {
namespace {

using AnyMotion = std::variant<std::monostate, CoordinatePath, PlanarPath, Motion>;

[[noreturn]] void refuse(const std::string& joint, const std::string& why) {
  throw std::invalid_argument("RobotMotion: joint '" + joint + "' " + why);
}

bool is_at_origin(const Motion& motion) {
  for (std::size_t k = 0; k + 1 < motion.breaks().size(); ++k) {
    const ConstantRatePath path = motion.path(k, Eigen::Vector3d::Zero());
    const bool rests = path.pivot_begin().value().isZero(0.0) && path.lever_length() == 0.0 &&
                       path.pivot_velocity().value().isZero(0.0);
    if (!rests) {
      return false;
    }
  }
  return true;
}

/// Refuses a motion that is not one of the joint's type.
void require_match(const Joint& joint, const JointMotion& motion) {
  if (joint.type == JointType::fixed) {
    refuse(joint.name, "is fixed; leave out its motion");
  }
  if (joint.mimic) {
    refuse(joint.name, "mimics '" + joint.mimic->joint + "'; leave out its motion");
  }
  const bool posed = joint.type == JointType::floating || joint.type == JointType::ball;
  const bool planar = joint.type == JointType::planar;
  const std::size_t expected = posed ? 2 : planar ? 1 : 0;
  if (motion.index() != expected) {
    refuse(joint.name, "is " + std::string(to_string(joint.type)) + "; give it " +
                           (posed    ? "a Motion"
                            : planar ? "three coordinates"
                                     : "one coordinate"));
  }
  if (joint.type == JointType::ball && !is_at_origin(std::get<Motion>(motion))) {
    refuse(joint.name, "is a ball; its motion must not move the origin");
  }
  const auto* coordinate = std::get_if<CoordinatePath>(&motion);
  if (coordinate != nullptr && coordinate->turning() == Turning::shortest &&
      joint.type != JointType::continuous) {
    refuse(joint.name, "is not continuous; it cannot take the shortest way round");
  }
}

/// A planar joint's x and y direction: those of J, turned by the shortest rotation from z to n.
std::array<DoubleDoubleVector3, 2> planar_directions(const DoubleDoubleVector3& n) {
  const DoubleDoubleVector3 x(1.0, 0.0, 0.0);
  const DoubleDoubleVector3 y(0.0, 1.0, 0.0);
  const DoubleDouble across = n.c[0] * n.c[0] + n.c[1] * n.c[1];
  if (across.hi == 0.0) {
    return {x, n.c[2].hi > 0.0 ? y : DoubleDouble(-1.0) * y};
  }
  // R e = e - (n . e) / (1 + n_z) (z + n) for e across z, with 1 + n_z = across / (1 - n_z) where
  // the sum would cancel.
  const DoubleDouble sum =
      n.c[2].hi > 0.0 ? DoubleDouble(1.0) + n.c[2] : across / (DoubleDouble(1.0) - n.c[2]);
  const DoubleDoubleVector3 z_n = DoubleDoubleVector3(0.0, 0.0, 1.0) + n;
  const DoubleDoubleVector3 halfway{z_n.c[0], z_n.c[1], sum};
  return {x - (n.c[0] / sum) * halfway, y - (n.c[1] / sum) * halfway};
}

const CoordinateSegment& segment_of(const CoordinatePath& path, double t_begin, double t_end) {
  const auto holds = [&](const CoordinateSegment& s) {
    return s.t_begin <= t_begin && t_end <= s.t_end;
  };
  const auto found = std::find_if(path.segments().begin(), path.segments().end(), holds);
  assert(found != path.segments().end());
  return *found;
}

/// The joints of a chain over one piece of time; what is rigid goes to its neighbours.
class ChainBuilder {
 public:
  void add_rigid(const PreciseTransform& X) { tail_ = tail_ ? *tail_ * X : X; }

  void add_polynomial(const PreciseTransform& X_PJ, const DoubleDoubleVector3& axis,
                      std::optional<CoordinateSegment> angle,
                      std::vector<JointPath::Slide> slides) {
    const PreciseTransform X = close(X_PJ);
    open_ = Open{X, axis, std::move(angle), std::move(slides)};
  }

  void add_motion(const PreciseTransform& X_PJ, const ConstantRatePath& X_JL) {
    const PreciseTransform X = close(X_PJ);
    joints_.push_back(JointPath::of_motion(X, X_JL));
  }

  std::vector<JointPath> finish() {
    const bool has_open = open_.has_value();
    const PreciseTransform rest = close({});
    if (!has_open && tail_was_rigid_) {
      joints_.push_back(JointPath::polynomial(rest, {}, {}, {}, {}));
    }
    return std::move(joints_);
  }

 private:
  struct Open {
    PreciseTransform X_PJ;
    DoubleDoubleVector3 axis;
    std::optional<CoordinateSegment> angle;
    std::vector<JointPath::Slide> slides;
  };

  /// Gives the rigid transforms so far to the joint before them, or else to the next one: returned
  /// is what that starts with.
  PreciseTransform close(const PreciseTransform& X_PJ) {
    tail_was_rigid_ = tail_.has_value();
    const PreciseTransform tail = tail_.value_or(PreciseTransform{});
    tail_.reset();
    if (!open_) {
      return tail_was_rigid_ ? tail * X_PJ : X_PJ;
    }
    joints_.push_back(
        JointPath::polynomial(open_->X_PJ, open_->axis, open_->angle, open_->slides, tail));
    open_.reset();
    return X_PJ;
  }

  std::vector<JointPath> joints_;
  std::optional<Open> open_;
  std::optional<PreciseTransform> tail_;
  bool tail_was_rigid_ = false;
};

/// A joint's coordinate, through those that it mimics.
const CoordinatePath& source_path(const RobotModel& model, const std::vector<AnyMotion>& motions,
                                  std::size_t joint) {
  while (model.joints()[joint].mimic) {
    joint = model.find_joint(model.joints()[joint].mimic->joint).value();
  }
  return std::get<CoordinatePath>(motions[joint]);
}

CoordinateSegment coordinate(const RobotModel& model, const std::vector<AnyMotion>& motions,
                             std::size_t joint, double t_begin, double t_end) {
  const std::optional<Mimic>& mimic = model.joints()[joint].mimic;
  if (!mimic) {
    return segment_of(std::get<CoordinatePath>(motions[joint]), t_begin, t_end);
  }
  const std::size_t source = model.find_joint(mimic->joint).value();
  return coordinate(model, motions, source, t_begin, t_end)
      .mimicked(mimic->multiplier, mimic->offset);
}

std::size_t piece_of(const Motion& motion, double t_begin) {
  const auto breaks = motion.breaks();
  const auto next = std::upper_bound(breaks.begin(), breaks.end() - 1, t_begin);
  return static_cast<std::size_t>(next - breaks.begin()) - 1;
}

void add_joint(ChainBuilder& chain, const RobotModel& model, const std::vector<AnyMotion>& motions,
               std::size_t index, double t_begin, double t_end) {
  const Joint& joint = model.joints()[index];
  const PreciseTransform X_PJ = precise(joint.X_PJ);
  const DoubleDoubleVector3 axis = precise_direction(joint.axis);
  switch (joint.type) {
    case JointType::fixed:
      chain.add_rigid(X_PJ);
      return;
    case JointType::revolute:
    case JointType::continuous:
      chain.add_polynomial(X_PJ, axis, coordinate(model, motions, index, t_begin, t_end), {});
      return;
    case JointType::prismatic:
      chain.add_polynomial(X_PJ, axis, {},
                           {{axis, coordinate(model, motions, index, t_begin, t_end)}});
      return;
    case JointType::screw: {
      const CoordinateSegment q = coordinate(model, motions, index, t_begin, t_end);
      chain.add_polynomial(X_PJ, axis, q, {{axis, q.mimicked(joint.pitch, 0.0)}});
      return;
    }
    case JointType::planar: {
      const auto& path = std::get<PlanarPath>(motions[index]);
      const auto [x, y] = planar_directions(axis);
      chain.add_polynomial(
          X_PJ, axis, segment_of(path[2], t_begin, t_end),
          {{x, segment_of(path[0], t_begin, t_end)}, {y, segment_of(path[1], t_begin, t_end)}});
      return;
    }
    case JointType::floating:
    case JointType::ball: {
      const auto& motion = std::get<Motion>(motions[index]);
      chain.add_motion(X_PJ, motion.path(piece_of(motion, t_begin), Eigen::Vector3d::Zero()));
      return;
    }
  }
}

/// Refuses coordinates that run so far between what was given, or by a mimic's multiplier, that
/// sines lose their error bounds.
void require_sizes(const Joint& joint, const CoordinatePath& path, double multiplier,
                   double offset) {
  for (const CoordinateSegment& segment : path.segments()) {
    const double size = std::abs(multiplier) * segment.size_bound() + std::abs(offset);
    if (!(size <= kMaximumAngle)) {
      refuse(joint.name,
             "may run beyond 1e8 at times between " + std::to_string(segment.t_begin) + " and " +
                 std::to_string(segment.t_end) +
                 "; give it smaller positions, velocities, accelerations or multiplier");
    }
  }
}

void require_sizes(const RobotModel& model, const std::vector<AnyMotion>& motions,
                   std::size_t index) {
  const Joint& joint = model.joints()[index];
  if (const auto* planar = std::get_if<PlanarPath>(&motions[index])) {
    for (const CoordinatePath& path : *planar) {
      require_sizes(joint, path, 1.0, 0.0);
    }
    return;
  }
  double multiplier = 1.0;
  double offset = 0.0;
  std::size_t source = index;
  while (model.joints()[source].mimic) {
    const Mimic& mimic = *model.joints()[source].mimic;
    offset += std::abs(multiplier * mimic.offset);
    multiplier *= mimic.multiplier;
    source = model.find_joint(mimic.joint).value();
  }
  if (const auto* path = std::get_if<CoordinatePath>(&motions[source])) {
    require_sizes(joint, *path, multiplier, offset);
  }
}

void add_breaks(std::set<double>& breaks, const CoordinatePath& path) {
  for (const CoordinateSegment& segment : path.segments()) {
    breaks.insert(segment.t_end);
  }
}

void add_breaks(std::set<double>& breaks, const Motion& motion) {
  breaks.insert(motion.breaks().begin(), motion.breaks().end());
}

void add_breaks(std::set<double>& breaks, const PlanarPath& path) {
  for (const CoordinatePath& coordinate_path : path) {
    add_breaks(breaks, coordinate_path);
  }
}

void add_breaks(std::set<double>&, std::monostate) {}

}  // namespace

LinkMotion::LinkMotion(std::vector<LinkPath> pieces) : pieces_(std::move(pieces)) {}

LinkMotion::LinkMotion(const Motion& X_WB) {
  for (std::size_t k = 0; k + 1 < X_WB.breaks().size(); ++k) {
    pieces_.emplace_back(
        X_WB.breaks()[k], X_WB.breaks()[k + 1],
        std::vector{JointPath::of_motion({}, X_WB.path(k, Eigen::Vector3d::Zero()))});
  }
}

LinkMotion LinkMotion::then(const PreciseTransform& X_LG) const {
  std::vector<LinkPath> pieces;
  for (const LinkPath& piece : pieces_) {
    pieces.push_back(piece.then(X_LG));
  }
  return LinkMotion(std::move(pieces));
}

const LinkPath& LinkMotion::at(double t) const {
  const auto ends_before = [](const LinkPath& piece, double time) { return piece.t_end() < time; };
  const auto found = std::lower_bound(pieces_.begin(), pieces_.end() - 1, t, ends_before);
  return *found;
}

RobotMotion::RobotMotion(RobotModel model, const std::map<std::string, JointMotion>& joints,
                         Motion base)
    : model_(std::move(model)), joints_(model_.joints().size()), base_(std::move(base)) {
  for (const auto& [name, motion] : joints) {
    const std::optional<std::size_t> index = model_.find_joint(name);
    if (!index) {
      refuse(name, "is not a joint of the robot '" + model_.name() + "'");
    }
    require_match(model_.joints()[*index], motion);
    std::visit([&](const auto& kind) { joints_[*index] = kind; }, motion);
  }
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const Joint& joint = model_.joints()[j];
    const bool moves = joint.type != JointType::fixed && !joint.mimic;
    if (moves && std::holds_alternative<std::monostate>(joints_[j])) {
      refuse(joint.name, "has no motion; hold it still by a constant one");
    }
  }
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    require_sizes(model_, joints_, j);
  }
}

LinkMotion RobotMotion::link(std::size_t link) const {
  return along(model_.chain(model_.root(), link), true);
}

LinkMotion RobotMotion::link(std::size_t ancestor, std::size_t link) const {
  return along(model_.chain(ancestor, link), false);
}

LinkPath RobotMotion::path(std::size_t link, double t) const { return this->link(link).at(t); }

RelativeLinkMotion RobotMotion::relative(std::size_t A, std::size_t B) const {
  const std::size_t ancestor = model_.last_common_ancestor(A, B);
  return {link(ancestor, A), link(ancestor, B)};
}

LinkMotion RobotMotion::along(std::span<const std::size_t> joints, bool from_world) const {
  std::set<double> breaks = {0.0, 1.0};
  if (from_world) {
    add_breaks(breaks, base_);
  }
  for (const std::size_t joint : joints) {
    if (model_.joints()[joint].mimic) {
      add_breaks(breaks, source_path(model_, joints_, joint));
    } else {
      std::visit([&](const auto& kind) { add_breaks(breaks, kind); }, joints_[joint]);
    }
  }
  std::vector<LinkPath> pieces;
  for (auto begin = breaks.begin(); std::next(begin) != breaks.end(); ++begin) {
    const double t_begin = *begin;
    const double t_end = *std::next(begin);
    ChainBuilder chain;
    if (from_world) {
      chain.add_motion({}, base_.path(piece_of(base_, t_begin), Eigen::Vector3d::Zero()));
    }
    for (const std::size_t joint : joints) {
      add_joint(chain, model_, joints_, joint, t_begin, t_end);
    }
    pieces.emplace_back(t_begin, t_end, chain.finish());
  }
  return LinkMotion(std::move(pieces));
}

}  // namespace firstcontact
