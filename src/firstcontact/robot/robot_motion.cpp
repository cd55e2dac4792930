#include <firstcontact/robot/robot_motion.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/math/number_text.h>
#include <firstcontact/math/sine_cosine.h>
#include <firstcontact/robot/detail/joint_frame.h>
#include <firstcontact/robot/precise_transform.h>

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
  const auto* three = std::get_if<PlanarPath>(&motion);
  if (three != nullptr &&
      ((*three)[0].turning() == Turning::shortest || (*three)[1].turning() == Turning::shortest)) {
    refuse(joint.name, "slides along x and y; only its angle can take the shortest way round");
  }
}

/// The segment that holds a window of time, inside of which no segment ends.
const CoordinateSegment& segment_of(const CoordinatePath& path, [[maybe_unused]] double t_begin,
                                    double t_end) {
  const auto ends_before = [](const CoordinateSegment& s, double t) { return s.t_end < t; };
  const auto found =
      std::lower_bound(path.segments().begin(), path.segments().end(), t_end, ends_before);
  assert(found != path.segments().end() && found->t_begin <= t_begin);
  return *found;
}

/// The joint itself, or the one that it mimics in the end.
std::size_t source_of(const RobotModel& model, std::size_t joint) {
  while (model.joints()[joint].mimic) {
    joint = model.find_joint(model.joints()[joint].mimic->joint).value();
  }
  return joint;
}

/// The path of a joint's coordinate, through those that it mimics.
const CoordinatePath& source_path(const RobotModel& model, const std::vector<AnyMotion>& motions,
                                  std::size_t joint) {
  return std::get<CoordinatePath>(motions[source_of(model, joint)]);
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

/// The path of a joint that moves, over one of its pieces.
JointPath path_of(const RobotModel& model, const std::vector<AnyMotion>& motions, std::size_t index,
                  double t_begin, double t_end) {
  const detail::JointFrame& frame = model.frame(index);
  const Joint& joint = model.joints()[index];
  if (const auto* motion = std::get_if<Motion>(&motions[index])) {
    return JointPath::of_motion(frame.X_RJ,
                                motion->path(piece_of(*motion, t_begin), Eigen::Vector3d::Zero()));
  }
  if (const auto* path = std::get_if<PlanarPath>(&motions[index])) {
    const std::array<CoordinateSegment, 2> slides = {segment_of((*path)[0], t_begin, t_end),
                                                     segment_of((*path)[1], t_begin, t_end)};
    return frame.path->moved(segment_of((*path)[2], t_begin, t_end), slides);
  }
  const CoordinateSegment q = coordinate(model, motions, index, t_begin, t_end);
  if (joint.type == JointType::prismatic) {
    return frame.path->moved({}, {&q, 1});
  }
  if (joint.type == JointType::screw) {
    const CoordinateSegment slide = q.mimicked(joint.pitch, 0.0);
    return frame.path->moved(q, {&slide, 1});
  }
  return frame.path->moved(q, {});
}

/// Refuses coordinates so large that sines lose their error bounds.
///
/// They may grow between given points, or by a mimic's multiplier.
void require_sizes(const Joint& joint, const CoordinatePath& path, double multiplier,
                   double offset) {
  for (const CoordinateSegment& segment : path.segments()) {
    const double size = std::abs(multiplier) * segment.size_bound() + std::abs(offset);
    if (!(size <= kMaximumAngle)) {
      refuse(joint.name,
             "may run beyond 1e8 at times between " + detail::shortest(segment.t_begin) + " and " +
                 detail::shortest(segment.t_end) +
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

/// Adds the times at which pieces end, in any order and with repetitions.
void add_ends(std::vector<double>& ends, const CoordinatePath& path) {
  for (const CoordinateSegment& segment : path.segments()) {
    ends.push_back(segment.t_end);
  }
}

void add_ends(std::vector<double>& ends, const Motion& motion) {
  ends.insert(ends.end(), motion.breaks().begin() + 1, motion.breaks().end());
}

void add_ends(std::vector<double>& ends, const PlanarPath& path) {
  for (const CoordinatePath& coordinate_path : path) {
    add_ends(ends, coordinate_path);
  }
}

void add_ends(std::vector<double>& ends, std::monostate) { ends.push_back(1.0); }

void sort_times(std::vector<double>& times) {
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
}

/// Takes the motion of a joint, which has to be one of its type.
void set(const Joint& joint, JointMotion&& motion, AnyMotion& own) {
  require_match(joint, motion);
  std::visit([&](auto& kind) { own = std::move(kind); }, motion);
}

std::vector<AnyMotion> checked_motions(const RobotModel& model,
                                       std::map<std::string, JointMotion>&& joints) {
  std::vector<AnyMotion> motions(model.joints().size());
  for (auto& [name, motion] : joints) {
    const std::optional<std::size_t> index = model.find_joint(name);
    if (!index) {
      refuse(name, "is not a joint of the robot '" + model.name() + "'");
    }
    set(model.joints()[*index], std::move(motion), motions[*index]);
  }
  for (std::size_t j = 0; j < motions.size(); ++j) {
    const Joint& joint = model.joints()[j];
    const bool moves = joint.type != JointType::fixed && !joint.mimic;
    if (moves && std::holds_alternative<std::monostate>(motions[j])) {
      refuse(joint.name, "has no motion; hold it still by a constant one");
    }
  }
  for (std::size_t j = 0; j < motions.size(); ++j) {
    require_sizes(model, motions, j);
  }
  return motions;
}

/// The paths of one joint, or of the base: path k ends at ends[k].
struct Pieces {
  std::vector<double> ends;
  std::vector<std::shared_ptr<const JointPath>> paths;

  /// The piece that holds t, the earlier one at a break.
  [[nodiscard]] std::size_t at(double t) const {
    return static_cast<std::size_t>(std::lower_bound(ends.begin(), ends.end() - 1, t) -
                                    ends.begin());
  }
  [[nodiscard]] const JointPath& path_at(double t) const { return *paths[at(t)]; }
};

Pieces pieces_of(const RobotModel& model, const std::vector<AnyMotion>& motions,
                 std::size_t joint) {
  Pieces pieces;
  if (model.joints()[joint].mimic) {
    add_ends(pieces.ends, source_path(model, motions, joint));
  } else {
    std::visit([&](const auto& kind) { add_ends(pieces.ends, kind); }, motions[joint]);
  }
  sort_times(pieces.ends);
  pieces.paths.reserve(pieces.ends.size());
  double t_begin = 0.0;
  for (const double t_end : pieces.ends) {
    pieces.paths.push_back(
        std::make_shared<const JointPath>(path_of(model, motions, joint, t_begin, t_end)));
    t_begin = t_end;
  }
  return pieces;
}

Pieces pieces_of(const Motion& motion) {
  Pieces pieces;
  add_ends(pieces.ends, motion);
  for (std::size_t k = 0; k < pieces.ends.size(); ++k) {
    pieces.paths.push_back(std::make_shared<const JointPath>(
        JointPath::of_motion({}, motion.path(k, Eigen::Vector3d::Zero()))));
  }
  return pieces;
}

}  // namespace

/// The data of a motion.
///
/// Paths of joints lead from the link that moves before them to their child. Fixed joints beyond
/// that have a path of their own.
struct RobotMotion::Data {
  std::vector<AnyMotion> motions;
  Motion base;
  Pieces base_pieces;
  std::vector<Pieces> joint_pieces;  // Empty for fixed joints.
  std::vector<double> breaks;

  void find_breaks() {
    breaks = {0.0};
    add_ends(breaks, base);
    for (const Pieces& pieces : joint_pieces) {
      breaks.insert(breaks.end(), pieces.ends.begin(), pieces.ends.end());
    }
    sort_times(breaks);
  }
};

LinkMotion::LinkMotion(std::vector<LinkPath> pieces) : pieces_(std::move(pieces)) {}

LinkMotion::LinkMotion(const Motion& X_WB) {
  for (std::size_t k = 0; k + 1 < X_WB.breaks().size(); ++k) {
    pieces_.emplace_back(X_WB.breaks()[k], X_WB.breaks()[k + 1],
                         std::vector{std::make_shared<const JointPath>(
                             JointPath::of_motion({}, X_WB.path(k, Eigen::Vector3d::Zero())))});
  }
}

LinkMotion LinkMotion::then(const PreciseTransform& X_LG) const {
  const auto rigid = std::make_shared<const JointPath>(JointPath::rigid(X_LG));
  std::vector<LinkPath> pieces;
  pieces.reserve(pieces_.size());
  for (const LinkPath& piece : pieces_) {
    pieces.push_back(piece.then(rigid));
  }
  return LinkMotion(std::move(pieces));
}

const LinkPath& LinkMotion::at(double t) const {
  const auto ends_before = [](const LinkPath& piece, double time) { return piece.t_end() < time; };
  const auto found = std::lower_bound(pieces_.begin(), pieces_.end() - 1, t, ends_before);
  return *found;
}

RobotMotion::RobotMotion(RobotModel model, std::map<std::string, JointMotion> joints, Motion base)
    : model_(std::move(model)) {
  const FloatEnvironmentGuard guard;
  Pieces base_pieces = pieces_of(base);
  auto data = std::make_shared<Data>(Data{.motions = checked_motions(model_, std::move(joints)),
                                          .base = std::move(base),
                                          .base_pieces = std::move(base_pieces),
                                          .joint_pieces = {},
                                          .breaks = {}});
  data->joint_pieces.reserve(model_.joints().size());
  for (std::size_t j = 0; j < model_.joints().size(); ++j) {
    const bool moves = model_.joints()[j].type != JointType::fixed;
    data->joint_pieces.push_back(moves ? pieces_of(model_, data->motions, j) : Pieces{});
  }
  data->find_breaks();
  data_ = std::move(data);
}

RobotMotion RobotMotion::with(std::vector<std::pair<std::size_t, JointMotion>> joints) const {
  const FloatEnvironmentGuard guard;
  std::vector<bool> is_given(model_.joints().size(), false);
  for (const auto& [joint, motion] : joints) {
    is_given[joint] = true;
  }
  auto data = std::make_shared<Data>(Data{.motions = std::vector<AnyMotion>(is_given.size()),
                                          .base = data_->base,
                                          .base_pieces = data_->base_pieces,
                                          .joint_pieces = std::vector<Pieces>(is_given.size()),
                                          .breaks = {}});
  for (std::size_t j = 0; j < is_given.size(); ++j) {
    if (!is_given[j]) {
      data->motions[j] = data_->motions[j];
    }
  }
  for (auto& [joint, motion] : joints) {
    set(model_.joints()[joint], std::move(motion), data->motions[joint]);
  }
  for (std::size_t j = 0; j < is_given.size(); ++j) {
    if (is_given[source_of(model_, j)]) {
      require_sizes(model_, data->motions, j);
      data->joint_pieces[j] = pieces_of(model_, data->motions, j);
    } else {
      data->joint_pieces[j] = data_->joint_pieces[j];
    }
  }
  data->find_breaks();
  RobotMotion changed = *this;
  changed.data_ = std::move(data);
  return changed;
}

std::span<const double> RobotMotion::breaks() const { return data_->breaks; }
const Motion& RobotMotion::base() const { return data_->base; }

std::vector<CoordinateSegment> RobotMotion::coordinate(std::size_t joint) const {
  if (coordinate_count(model_.joints()[joint].type) != 1) {
    return {};
  }
  const CoordinatePath& source = source_path(model_, data_->motions, joint);
  std::vector<CoordinateSegment> segments;
  for (const CoordinateSegment& segment : source.segments()) {
    segments.push_back(
        firstcontact::coordinate(model_, data_->motions, joint, segment.t_begin, segment.t_end));
  }
  return segments;
}

std::optional<JointMotion> RobotMotion::given(std::size_t joint) const {
  const auto as_given = [](const auto& motion) -> std::optional<JointMotion> {
    if constexpr (std::is_same_v<std::decay_t<decltype(motion)>, std::monostate>) {
      return std::nullopt;
    } else {
      return motion;
    }
  };
  return std::visit(as_given, data_->motions[joint]);
}

LinkMotion RobotMotion::link(std::size_t link) const {
  return all_along(model_.root(), link, true);
}

LinkMotion RobotMotion::link(std::size_t ancestor, std::size_t link) const {
  return all_along(ancestor, link, false);
}

RelativeLinkMotion RobotMotion::relative(std::size_t A, std::size_t B) const {
  const std::size_t ancestor = model_.last_common_ancestor(A, B);
  return {link(ancestor, A), link(ancestor, B)};
}

LinkPath RobotMotion::path(std::size_t link, double t) const {
  return along(model_.root(), link, t, true);
}

LinkPath RobotMotion::path(std::size_t ancestor, std::size_t link, double t) const {
  return along(ancestor, link, t, false);
}

const JointPath* RobotMotion::joint_path(std::size_t joint, double t) const {
  const Pieces& pieces = data_->joint_pieces[joint];
  return pieces.paths.empty() ? nullptr : &pieces.path_at(t);
}

const JointPath& RobotMotion::base_path(double t) const { return data_->base_pieces.path_at(t); }

LinkPath RobotMotion::along(std::size_t frame, std::size_t link, double t, bool from_world) const {
  double t_begin = 0.0;
  double t_end = 1.0;
  std::vector<std::shared_ptr<const JointPath>> joints;
  const auto add = [&](const Pieces& pieces) {
    const std::size_t k = pieces.at(t);
    t_begin = std::max(t_begin, k == 0 ? 0.0 : pieces.ends[k - 1]);
    t_end = std::min(t_end, pieces.ends[k]);
    joints.push_back(pieces.paths[k]);
  };
  const std::vector<std::size_t> chain = model_.chain(frame, link);
  joints.reserve(chain.size() + 2);
  if (from_world) {
    add(data_->base_pieces);
  } else if (model_.tail(frame) && !chain.empty()) {
    // Paths of joints start where the last joint before them moved.
    joints.push_back(std::make_shared<const JointPath>(
        JointPath::rigid(inverse(model_.from_rigid_root(frame)))));
  }
  for (const std::size_t joint : chain) {
    if (model_.joints()[joint].type != JointType::fixed) {
      add(data_->joint_pieces[joint]);
    }
  }
  if (model_.tail(link) && (from_world || !chain.empty())) {
    joints.push_back(model_.tail(link));
  }
  return {t_begin, t_end, std::move(joints)};
}

LinkMotion RobotMotion::all_along(std::size_t frame, std::size_t link, bool from_world) const {
  std::vector<LinkPath> pieces;
  double t = 0.0;
  while (t < 1.0) {
    // The piece that begins at t is the one that holds the next number.
    pieces.push_back(along(frame, link, std::nextafter(t, 1.0), from_world));
    t = pieces.back().t_end();
  }
  return LinkMotion(std::move(pieces));
}

}  // namespace firstcontact
