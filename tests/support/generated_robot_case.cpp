#include "support/generated_robot_case.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <utility>

#include "support/exact_link_path.h"
#include "support/portable_random.h"

namespace firstcontact::oracle {
namespace {

using Vec = Vector3<double>;

// No expression below draws twice, but for those in braces: only they have an order.

constexpr std::array<JointKind, 8> kAllKinds = {
    JointKind::revolute, JointKind::continuous, JointKind::prismatic, JointKind::screw,
    JointKind::planar,   JointKind::floating,   JointKind::ball,      JointKind::fixed};

double length(const Vec& v) { return std::sqrt(dot(v, v)); }
Vec normalised(const Vec& v) { return (1.0 / length(v)) * v; }

/// A mesh's place, seen from the other link at one time.
struct Sight {
  ExactLinkState A, B;

  /// A point of A, in the frame of B.
  [[nodiscard]] Vec in_B(const Vec& p_AP) const {
    const Vector3<Wide> p = A.place(p_AP) - B.origin;
    return {dot(B.R.column[0], p).nearest(), dot(B.R.column[1], p).nearest(),
            dot(B.R.column[2], p).nearest()};
  }
  /// A direction of B, in the frame of A.
  [[nodiscard]] Vec in_A(const Vec& direction) const {
    const Vector3<Wide> d = B.R * exact(direction);
    return {dot(A.R.column[0], d).nearest(), dot(A.R.column[1], d).nearest(),
            dot(A.R.column[2], d).nearest()};
  }
};

Sight sight(const RobotCase& c, double t) {
  const std::vector<double> breaks = break_times(c);
  const auto next = std::upper_bound(breaks.begin(), breaks.end() - 1, t);
  const auto paths = exact_link_paths(c, *std::prev(next));
  return {paths[0].state(Wide(t)), paths[1].state(Wide(t))};
}

class Generator {
 public:
  Generator(RobotFamily family, std::uint64_t index)
      : family_(family),
        random_(0x9b97c0de00000000u + (static_cast<std::uint64_t>(family) << 48) + index) {}

  RobotCase run() {
    if (random_.chance(0.3)) {
      scale_ = random_.power_of_ten(-2, 1);
    }
    RobotCase c;
    c.tolerance = scale_ * random_.power_of_ten(-8, -4);
    c.margin = random_.chance(0.3) ? 0.0 : scale_ * random_.power_of_ten(-4, -3);
    c.robots = {robot(joint_count())};
    add_second(c);
    c.A.soup = mesh();
    c.B.soup = mesh();
    if (c.margin == 0.0) {
      c.A.soup.radius = scale_ * random_.power_of_ten(-4, -3);
    }
    if (family_ == RobotFamily::far_away) {
      move_far(c);
    }
    if (family_ == RobotFamily::grazing) {
      graze(c);
    } else if (family_ == RobotFamily::ends) {
      touch_at_end(c);
    } else if (family_ == RobotFamily::link_and_cloth) {
      deform(c);
    } else {
      meet(c);
    }
    return c;
  }

 private:
  int joint_count() {
    return family_ == RobotFamily::many_turns ? random_.integer(1, 4) : random_.integer(1, 12);
  }

  // ---- Robots ----

  JointKind kind() {
    switch (family_) {
      case RobotFamily::poses:
        return std::array{JointKind::floating, JointKind::ball,
                          JointKind::planar}[static_cast<std::size_t>(random_.integer(0, 2))];
      case RobotFamily::many_turns:
        return std::array{JointKind::revolute, JointKind::continuous,
                          JointKind::screw}[static_cast<std::size_t>(random_.integer(0, 2))];
      case RobotFamily::mimics:
      case RobotFamily::high_polynomials:
        return kAllKinds[static_cast<std::size_t>(random_.integer(0, 4))];
      default:
        return kAllKinds[static_cast<std::size_t>(random_.integer(0, 7))];
    }
  }

  std::vector<double> numbers(std::size_t count, double size) {
    std::vector<double> result;
    for (std::size_t k = 0; k < count; ++k) {
      result.push_back(random_.uniform(-size, size));
    }
    return result;
  }

  CoordinateInput coordinate(double size, bool may_wrap) {
    const bool high = family_ == RobotFamily::high_polynomials;
    CoordinateInput q;
    const int kind = random_.integer(high ? 2 : 0, 3);
    if (kind == 3) {
      q.kind = CoordinateKind::polynomial;
      q.coefficients = numbers(static_cast<std::size_t>(random_.integer(high ? 6 : 1, 8)),
                               size / (high ? 2.0 : 1.0));
      q.times = {0.0, 1.0};
      return q;
    }
    q.kind = static_cast<CoordinateKind>(kind);
    q.times = {0.0, random_.uniform(0.2, 0.8), 1.0};
    if (random_.chance(0.3)) {
      q.times = {random_.uniform(0.0, 0.3), random_.uniform(0.6, 1.0)};
    }
    q.shortest = may_wrap && random_.chance(0.5);
    q.positions = numbers(q.times.size(), q.shortest ? 3.0 * size : size);
    if (kind > 0) {
      q.velocities = numbers(q.times.size(), size);
    }
    if (kind > 1) {
      q.accelerations = numbers(q.times.size(), 4.0 * size);
    }
    return q;
  }

  /// Makes the motion of a base or of a joint with a pose; one at the origin turns only.
  MotionInput motion(bool at_origin, double most_angle) {
    MotionInput m;
    const double size = at_origin ? 0.0 : scale_;
    const Vec start = random_.vector(0.0, size);
    m.poses = {{start, random_.rotation()}};
    const int kind = random_.integer(0, at_origin ? 1 : 2);
    if (kind == 2) {
      m.kind = MotionKind::screw;
      m.axis_point = random_.vector(0.0, size);
      m.axis_direction = random_.vector(0.5, 2.0);
      m.angle = random_.uniform(-most_angle, most_angle);
      m.along = random_.uniform(-size, size);
      return m;
    }
    if (kind == 1) {
      m.kind =
          random_.chance(0.5) || at_origin ? MotionKind::waypoints : MotionKind::screw_waypoints;
      m.times = {random_.uniform(0.0, 0.3), random_.uniform(0.4, 0.6), random_.uniform(0.7, 1.0)};
      while (m.poses.size() < 3) {
        const Vec position = random_.vector(0.0, size);
        m.poses.push_back({position, random_.rotation()});
      }
      return m;
    }
    m.kind = MotionKind::constant_velocity;
    m.translation = random_.vector(0.0, size);
    m.rotation_vector = random_.vector(0.0, most_angle);
    return m;
  }

  JointInput joint(std::size_t index, std::size_t parent) {
    JointInput j;
    j.kind = kind();
    j.parent = parent;
    const Vec position = random_.vector(0.05 * scale_, 0.4 * scale_);
    j.X_PJ = {position, random_.rotation()};
    j.axis = random_.vector(0.5, 2.0);
    const double turn = family_ == RobotFamily::many_turns ? 180.0 : 2.0;
    switch (j.kind) {
      case JointKind::floating:
      case JointKind::ball:
        j.motion = motion(j.kind == JointKind::ball, 2.0);
        return j;
      case JointKind::planar:
        j.coordinates = {coordinate(0.3 * scale_, false), coordinate(0.3 * scale_, false),
                         coordinate(turn, false)};
        return j;
      case JointKind::fixed:
        return j;
      default:
        break;
    }
    if (index > 0 && random_.chance(family_ == RobotFamily::mimics ? 0.8 : 0.15)) {
      j.mimic = MimicInput{0, random_.uniform(-1.0, 1.0), random_.uniform(-0.5, 0.5)};
      j.kind = j.kind == JointKind::prismatic ? JointKind::revolute : j.kind;
      j.kind = j.kind == JointKind::continuous ? JointKind::revolute : j.kind;
    } else if (j.kind == JointKind::prismatic) {
      j.coordinates = {coordinate(0.3 * scale_, false)};
    } else {
      j.coordinates = {coordinate(turn, j.kind == JointKind::continuous)};
    }
    if (j.kind == JointKind::screw) {
      j.pitch = random_.uniform(-0.1, 0.1) * scale_ * 2.0 / turn;
    }
    return j;
  }

  /// The first joint has a coordinate that others can mimic.
  RobotInput robot(int joints) {
    RobotInput r;
    if (random_.chance(0.5)) {
      r.base = motion(false, 2.0);
    }
    const std::size_t fork = static_cast<std::size_t>(random_.integer(0, joints / 2));
    for (int k = 0; k < joints; ++k) {
      const auto index = static_cast<std::size_t>(k);
      const bool forks = family_ == RobotFamily::own_links && k == joints / 2 + 1;
      r.joints.push_back(joint(index, forks ? fork : index));
      if (k == 0) {
        give_coordinate(r.joints[0]);
      }
    }
    return r;
  }

  void give_coordinate(JointInput& j) {
    if (family_ == RobotFamily::poses) {
      return;
    }
    const double turn = family_ == RobotFamily::many_turns ? 180.0 : 2.0;
    j.kind = JointKind::revolute;
    j.coordinates = {coordinate(turn, false)};
    j.motion = {};
    j.pitch = 0.0;
  }

  void add_second(RobotCase& c) {
    c.A.link = c.robots[0].joints.size();
    if (family_ == RobotFamily::own_links) {
      c.robots[0].base.kind = MotionKind::constant_velocity;
      c.robots[0].base.translation = random_.vector(0.0, 1e3 * scale_);
      c.robots[0].base.rotation_vector = random_.vector(0.0, 300.0);
      c.robots[0].base.poses.resize(1);
      c.B.link = c.robots[0].joints.size() / 2;
      return;
    }
    c.B.robot = 1;
    if (family_ == RobotFamily::two_robots) {
      c.robots.push_back(robot(random_.integer(1, 6)));
      c.B.link = c.robots[1].joints.size();
      return;
    }
    RobotInput body;
    const bool moves = family_ == RobotFamily::link_and_body || random_.chance(0.2);
    if (moves && family_ != RobotFamily::link_and_rest && family_ != RobotFamily::link_and_cloth) {
      body.base = motion(false, 4.0);
    }
    c.robots.push_back(std::move(body));
  }

  void move_far(RobotCase& c) {
    const Vec far = 1e6 * scale_ * random_.unit();
    for (RobotInput& robot : c.robots) {
      robot.base.axis_point = robot.base.axis_point + far;
      for (PoseInput& pose : robot.base.poses) {
        pose.position = pose.position + far;
      }
    }
  }

  // ---- Meshes ----

  MovingSoup mesh() {
    MovingSoup soup;
    const int count = random_.integer(1, 4);
    const double size = scale_ * random_.uniform(0.05, 0.2);
    for (int i = 0; i < count; ++i) {
      const std::size_t n = soup.vertices.size();
      const Vec middle = random_.in_box(0.5 * size);
      for (int k = 0; k < 3; ++k) {
        soup.vertices.push_back(middle + random_.in_box(size));
      }
      soup.triangles.push_back({n, n + 1, n + 2});
    }
    if (random_.chance(0.5)) {
      soup.radius = scale_ * random_.power_of_ten(-4, -3);
    }
    return soup;
  }

  /// Moves B's mesh in its link, so that it may meet A's.
  void meet(RobotCase& c) {
    const Vec offset = random_.vector(0.0, 0.5 * scale_);
    const Vec by = sight(c, random_.uniform(0.2, 1.0)).in_B(c.A.soup.vertices[0]) + offset;
    for (Vec& v : c.B.soup.vertices) {
      v = v + by;
    }
  }

  /// A needle-like triangle of A with its corner at `apex`, away from n; a face of B across n at
  /// the limit and `gap` from it.
  void corner_and_face(RobotCase& c, double t, const Vec& apex, const Vec& n, double gap) {
    const Vec back = sight(c, t).in_A(n);
    const auto behind = [&] {
      return apex + (-0.2 * scale_) * back + random_.in_box(0.05 * scale_);
    };
    c.A.soup.vertices = {apex, behind(), behind()};
    c.A.soup.triangles = {{0, 1, 2}};
    const double limit = c.margin + c.A.soup.radius + c.B.soup.radius;
    const Vec middle = sight(c, t).in_B(apex) + (limit + gap) * n;
    const Vec u = normalised(cross(n, random_.unit()));
    const Vec v = cross(n, u);
    const double half = 0.1 * scale_;
    c.B.soup.vertices = {middle + half * u, middle + (-half) * u + half * v,
                         middle + (-half) * u + (-half) * v};
    c.B.soup.triangles = {{0, 1, 2}};
  }

  double small_gap() {
    const double size = scale_ * random_.power_of_ten(-10, -3);
    return random_.chance(0.5) ? size : -size;
  }

  void graze(RobotCase& c) {
    const double t = random_.uniform(0.3, 0.9);
    const Vec apex = random_.in_box(0.3 * scale_);
    constexpr double dt = 0x1p-12;
    const Vec before = sight(c, t - dt).in_B(apex);
    const Vec now = sight(c, t).in_B(apex);
    const Vec after = sight(c, t + dt).in_B(apex);
    const Vec velocity = (0.5 / dt) * (after - before);
    const Vec bend = before + after - 2.0 * now;
    Vec n = random_.unit();
    if (length(velocity) > 1e-6 * scale_) {
      n = normalised(cross(velocity, n));
    }
    // The corner comes nearest, and leaves.
    n = dot(n, bend) > 0.0 ? -1.0 * n : n;
    corner_and_face(c, t, apex, n, small_gap());
  }

  void touch_at_end(RobotCase& c) {
    const bool at_start = random_.chance(0.5);
    const Vec apex = random_.in_box(0.3 * scale_);
    constexpr double dt = 0x1p-12;
    const double t = at_start ? 0.0 : 1.0;
    // Away from what follows, or towards what came before.
    const Vec there = sight(c, t).in_B(apex);
    const Vec way = there - sight(c, at_start ? dt : 1.0 - dt).in_B(apex);
    const Vec aside = random_.vector(0.0, 0.5);
    const bool moves = length(way) > 1e-9 * scale_;
    const Vec n = normalised((moves ? normalised(way) : random_.unit()) + aside);
    corner_and_face(c, t, apex, n, small_gap());
  }

  /// Lets the vertices of B go ways of their own, so that it may meet A; or so that a face turns
  /// while a corner of A slides along it, at the margin.
  void deform(RobotCase& c) {
    const double t = random_.uniform(0.2, 1.0);
    const Vec n = random_.unit();
    const bool slides = random_.chance(0.4);
    Vec shared{};
    if (slides) {
      const Vec apex = random_.in_box(0.3 * scale_);
      constexpr double dt = 0x1p-12;
      shared = (0.5 / dt) * (sight(c, t + dt).in_B(apex) - sight(c, t - dt).in_B(apex));
      corner_and_face(c, t, apex, n, small_gap());
    } else {
      const Vec offset = random_.vector(0.0, 0.5 * scale_);
      const Vec by = sight(c, t).in_B(c.A.soup.vertices[0]) + offset;
      for (Vec& v : c.B.soup.vertices) {
        v = v + by;
      }
    }
    for (Vec& v : c.B.soup.vertices) {
      Vec way = shared + random_.vector(0.0, scale_);
      if (slides) {
        way = way + (dot(n, shared) - dot(n, way)) * n;
      }
      c.B.soup.to.push_back(v + (1.0 - t) * way);
      v = v + (-t) * way;
    }
  }

  RobotFamily family_;
  PortableRandom random_;
  double scale_ = 1.0;
};

/// FNV-1a, a word at a time.
class Digest {
 public:
  void add(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    hash_ = (hash_ ^ bits) * 0x100000001b3u;
    hash_ ^= hash_ >> 29;
  }
  void add(std::size_t value) { add(static_cast<double>(value)); }
  void add(const Vec& v) {
    add(v.x);
    add(v.y);
    add(v.z);
  }
  void add(const PoseInput& pose) {
    add(pose.position);
    add(pose.rotation.w);
    add(Vec{pose.rotation.x, pose.rotation.y, pose.rotation.z});
  }
  template <class T>
  void add(const std::vector<T>& all) {
    add(all.size());
    for (const T& one : all) {
      add(one);
    }
  }
  void add(const MotionInput& m) {
    add(static_cast<std::size_t>(m.kind));
    add(m.poses);
    add(m.times);
    for (const Vec& v : {m.translation, m.rotation_vector, m.axis_point, m.axis_direction}) {
      add(v);
    }
    add(m.angle);
    add(m.along);
  }
  void add(const CoordinateInput& q) {
    add(static_cast<std::size_t>(q.kind));
    add(static_cast<std::size_t>(q.shortest));
    for (const auto* all :
         {&q.times, &q.positions, &q.velocities, &q.accelerations, &q.coefficients}) {
      add(*all);
    }
  }
  void add(const JointInput& j) {
    add(static_cast<std::size_t>(j.kind));
    add(j.parent);
    add(j.X_PJ);
    add(j.axis);
    add(j.pitch);
    add(j.coordinates);
    add(j.motion);
    if (j.mimic) {
      add(j.mimic->joint);
      add(j.mimic->multiplier);
      add(j.mimic->offset);
    }
  }
  void add(const RobotInput& r) {
    add(r.base);
    add(r.joints);
  }
  void add(const LinkInput& link) {
    add(link.robot);
    add(link.link);
    add(link.soup.vertices);
    add(link.soup.radius);
    if (!link.soup.to.empty()) {
      add(link.soup.to);
    }
  }

  [[nodiscard]] std::uint32_t value() const { return static_cast<std::uint32_t>(hash_ >> 16); }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

}  // namespace

std::string name(RobotFamily family) {
  constexpr std::array<const char*, kRobotFamilyCount> kNames = {
      "link_and_rest",    "link_and_body", "own_links", "two_robots",
      "high_polynomials", "mimics",        "poses",     "many_turns",
      "far_away",         "grazing",       "ends",      "link_and_cloth"};
  return kNames.at(static_cast<std::size_t>(family));
}

RobotCase generate(RobotFamily family, std::uint64_t index) {
  return Generator(family, index).run();
}

std::uint32_t digest(const RobotCase& c) {
  Digest digest;
  digest.add(c.robots);
  digest.add(c.A);
  digest.add(c.B);
  digest.add(c.margin);
  digest.add(c.tolerance);
  return digest.value();
}

}  // namespace firstcontact::oracle
