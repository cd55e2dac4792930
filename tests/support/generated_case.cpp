#include "support/generated_case.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "support/portable_random.h"

namespace firstcontact::oracle {
namespace {

using Vec = Vector3<double>;

// No expression below draws twice, but for those in braces: only they have an order.

// ---- Soups ----

void add_triangle(MovingSoup& soup, const Vec& a, const Vec& b, const Vec& c) {
  const std::size_t n = soup.vertices.size();
  soup.vertices.insert(soup.vertices.end(), {a, b, c});
  soup.triangles.push_back({n, n + 1, n + 2});
}

MovingSoup one_triangle(const Vec& a, const Vec& b, const Vec& c) {
  MovingSoup soup;
  add_triangle(soup, a, b, c);
  return soup;
}

MovingSoup box(const Vec& center, const Vec& half) {
  MovingSoup soup;
  for (int k = 0; k < 8; ++k) {
    soup.vertices.push_back({center.x + (k & 1 ? half.x : -half.x),
                             center.y + (k & 2 ? half.y : -half.y),
                             center.z + (k & 4 ? half.z : -half.z)});
  }
  soup.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return soup;
}

/// A rectangle in the plane z = height.
MovingSoup plate(double half_x, double half_y, double height) {
  MovingSoup soup;
  soup.vertices = {{-half_x, -half_y, height},
                   {half_x, -half_y, height},
                   {half_x, half_y, height},
                   {-half_x, half_y, height}};
  soup.triangles = {{0, 1, 2}, {0, 2, 3}};
  return soup;
}

/// A tetrahedron that stands on its tip, which is at the origin.
MovingSoup top(PortableRandom& random) {
  MovingSoup soup;
  soup.vertices = {
      {0.0, 0.0, 0.0},
      {random.uniform(0.1, 0.5), random.uniform(-0.1, 0.1), random.uniform(0.3, 1.0)},
      {random.uniform(-0.4, -0.1), random.uniform(0.1, 0.4), random.uniform(0.3, 1.0)},
      {random.uniform(-0.4, -0.1), random.uniform(-0.4, -0.1), random.uniform(0.3, 1.0)}};
  soup.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  return soup;
}

MovingSoup random_soup(PortableRandom& random, int most, double spread) {
  MovingSoup soup;
  const int count = random.integer(1, most);
  const double half = spread / std::sqrt(static_cast<double>(count));
  for (int i = 0; i < count; ++i) {
    const Vec middle = random.in_box(0.5 * spread);
    const Vec a = middle + random.in_box(half);
    const Vec b = middle + random.in_box(half);
    add_triangle(soup, a, b, middle + random.in_box(half));
  }
  return soup;
}

// ---- Motions ----

MotionInput constant_velocity(const PoseInput& start, const Vec& translation, const Vec& spin) {
  MotionInput m;
  m.kind = MotionKind::constant_velocity;
  m.poses = {start};
  m.translation = translation;
  m.rotation_vector = spin;
  return m;
}

MotionInput between(const PoseInput& from, const PoseInput& to, bool screw) {
  MotionInput m;
  m.kind = screw ? MotionKind::screw_between : MotionKind::constant_velocity_between;
  m.poses = {from, to};
  return m;
}

MotionInput at_rest(const Vec& position) {
  MotionInput m;
  m.poses = {{position, {}}};
  return m;
}

/// Through `middle`, with no rotation, at t = 1/2 exactly: from -travel and conj(q) to travel and
/// q.
MotionInput through_middle(const Vec& middle, const Vec& travel, const Vec& half_turn, bool screw) {
  const Quaternion q{1.0, half_turn.x, half_turn.y, half_turn.z};
  const Quaternion conjugate{1.0, -q.x, -q.y, -q.z};
  return between({middle - travel, conjugate}, {middle + travel, q}, screw);
}

MotionInput random_motion(PortableRandom& random, const Vec& from, const Vec& to, double angle) {
  const int kind = random.integer(0, 3);
  const PoseInput start{from, random.rotation()};
  if (kind <= 1) {
    return between(start, {to, random.rotation()}, kind == 1);
  }
  return constant_velocity(start, to - from, angle * random.unit());
}

MotionInput random_screw(PortableRandom& random, const Vec& from, double angle) {
  MotionInput m;
  m.kind = MotionKind::screw;
  m.poses = {{from, random.rotation()}};
  m.axis_point = random.in_box(2.0);
  const double length = random.power_of_ten(-2, 2);
  m.axis_direction = length * random.unit();
  m.angle = random.chance(0.5) ? angle : -angle;
  m.along = random.uniform(-3.0, 3.0);
  return m;
}

MotionInput random_waypoints(PortableRandom& random) {
  MotionInput m;
  m.kind = random.chance(0.5) ? MotionKind::waypoints : MotionKind::screw_waypoints;
  m.poses.clear();
  double t = random.chance(0.5) ? 0.0 : random.uniform(0.0, 0.3);
  const int count = random.integer(2, 5);
  for (int i = 0; i < count && (i == 0 || m.times.back() < 1.0); ++i) {
    m.times.push_back(t);
    m.poses.push_back({random.in_box(2.0), random.rotation()});
    t = std::min(1.0, t + random.uniform(0.01, 0.99 / count));
  }
  return m;
}

/// [rad]  0.01 to ten turns.
double random_angle(PortableRandom& random) { return std::min(63.0, random.power_of_ten(-2, 1)); }

Vec random_spin(PortableRandom& random) {
  const double angle = random_angle(random);
  return angle * random.unit();
}

/// A gap between 1e-10 and 1e-2, above or below zero.
double random_gap(PortableRandom& random) {
  const double gap = random.power_of_ten(-10, -3);
  return random.chance(0.5) ? gap : -gap;
}

// ---- Families ----

/// A case of size 1 near the origin; `gap` is set where the least distance is designed.
struct Draft {
  MovingSoup A, B;
  double gap = 0.0;
};

Draft plane_drop(PortableRandom& random) {
  Draft d{plate(4.0, 4.0, 0.0), top(random)};
  const double height = random.uniform(0.1, 2.0);
  const Vec travel{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), -random.uniform(0.5, 3.0)};
  const Vec spin = random.chance(0.5) ? Vec{} : Vec{0.0, 0.0, random.uniform(-60.0, 60.0)};
  d.B.motion = constant_velocity({{0.0, 0.0, height}, {}}, travel, spin);
  return d;
}

Draft needle_swing(PortableRandom& random) {
  const double reach = random.uniform(0.5, 2.0);
  const double thickness = random.chance(0.5) ? 0.0 : random.power_of_ten(-8, -2);
  Draft d{plate(4.0, 4.0, 0.0),
          one_triangle({0.0, 0.0, 0.0}, {reach, 0.0, 0.0}, {0.5 * reach, 0.0, thickness})};
  const double depth = random.uniform(0.05, 1.1) * reach;
  d.B.motion = constant_velocity({{0.0, 0.0, depth}, {}}, {}, {0.0, random.uniform(0.5, 3.0), 0.0});
  return d;
}

Draft random_pair(PortableRandom& random, double angle_A, double angle_B) {
  Draft d{random_soup(random, 12, 1.0), random_soup(random, 12, 1.0)};
  const Vec away = random.vector(0.5, 2.5);
  const Vec aim = random.in_box(0.7);
  d.A.motion =
      random.chance(0.3) ? at_rest({}) : random_motion(random, {}, random.in_box(0.5), angle_A);
  d.B.motion = random_motion(random, away, aim - random.uniform(0.0, 1.0) * away, angle_B);
  return d;
}

Draft random_slow(PortableRandom& random) {
  const double angle_A = random.power_of_ten(-2, -1);
  return random_pair(random, angle_A, random.power_of_ten(-2, -1));
}

Draft random_turning(PortableRandom& random) {
  const double angle_A = random_angle(random);
  return random_pair(random, angle_A, random_angle(random));
}

Draft random_screws(PortableRandom& random) {
  Draft d = random_pair(random, 1.0, 1.0);
  const double angle = random_angle(random);
  d.B.motion = random_screw(random, 2.0 * random.unit(), angle);
  if (random.chance(0.5)) {
    const double angle_A = random_angle(random);
    d.A.motion = random_screw(random, random.in_box(0.3), angle_A);
  }
  return d;
}

Draft random_waypoint_pair(PortableRandom& random) {
  Draft d = random_pair(random, 1.0, 1.0);
  d.B.motion = random_waypoints(random);
  if (random.chance(0.5)) {
    d.A.motion = random_waypoints(random);
  }
  return d;
}

Draft tumbling_boxes(PortableRandom& random) {
  const auto half = [&] { return random.uniform(0.1, 0.6); };
  const Vec half_A{half(), half(), half()};
  const Vec half_B{half(), half(), half()};
  Draft d = random_turning(random);
  const MotionInput motion_A = d.A.motion;
  const MotionInput motion_B = d.B.motion;
  d.A = box(random.in_box(0.3), half_A);
  d.B = box(random.in_box(0.3), half_B);
  d.A.motion = motion_A;
  d.B.motion = motion_B;
  return d;
}

Draft tip_swing(PortableRandom& random) {
  const double reach = random.uniform(0.5, 1.5);
  const double gap = random_gap(random);
  Draft d{plate(3.0, 3.0, 0.0), one_triangle({0.0, -0.1, 0.0}, {0.0, 0.1, 0.0}, {reach, 0.0, 0.0}),
          gap};
  const double drift = random.chance(0.5) ? 0.0 : random.uniform(-1.0, 1.0);
  d.B.motion = constant_velocity({{0.0, 0.0, reach + gap}, {}}, {0.0, drift, 0.0},
                                 {0.0, random.uniform(2.0, 20.0), 0.0});
  return d;
}

Draft rocking(PortableRandom& random) {
  Draft d{plate(3.0, 3.0, 0.0), top(random), random_gap(random)};
  const Vec travel{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 0.0};
  const Vec half_turn{random.uniform(-0.15, 0.15), random.uniform(-0.15, 0.15),
                      random.uniform(-1.0, 1.0)};
  // Turning about a point above the tip, the tip dips to the gap at t = 1/2.
  const double pivot = random.chance(0.3) ? 0.0 : random.uniform(0.0, 1.0);
  for (Vec& v : d.B.vertices) {
    v.z -= pivot;
  }
  d.B.motion = through_middle({0.0, 0.0, pivot + d.gap}, travel, half_turn, random.chance(0.5));
  return d;
}

Draft passing_edges(PortableRandom& random) {
  const double gap = random_gap(random);
  Draft d{one_triangle({-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.1, 0.2, -0.8}),
          one_triangle({0.0, -1.0, 0.0}, {0.0, 1.0, 0.0}, {0.2, 0.1, 0.9}), gap};
  const double yaw = random.chance(0.5) ? 0.0 : random.uniform(-0.3, 0.3);
  const Vec travel{random.uniform(0.5, 3.0), random.uniform(-3.0, 3.0), 0.0};
  d.B.motion = through_middle({0.0, 0.0, gap}, travel, {0.0, 0.0, yaw}, random.chance(0.5));
  return d;
}

Draft bounce(PortableRandom& random) {
  Draft d{plate(3.0, 3.0, 0.0), top(random), random_gap(random)};
  MotionInput& m = d.B.motion;
  m.kind = random.chance(0.5) ? MotionKind::waypoints : MotionKind::screw_waypoints;
  const auto tilt = [&] { return random.uniform(-0.1, 0.1); };
  const Quaternion q0{1.0, tilt(), tilt(), random.uniform(-2.0, 2.0)};
  const Quaternion q1{1.0, tilt(), tilt(), random.uniform(-2.0, 2.0)};
  m.times = {0.0, random.uniform(0.1, 0.9), 1.0};
  m.poses = {{{random.uniform(-1.0, 1.0), 0.3, random.uniform(0.5, 2.0)}, q0},
             {{0.0, 0.0, d.gap}, {}},
             {{0.2, random.uniform(-1.0, 1.0), random.uniform(0.5, 2.0)}, q1}};
  return d;
}

Draft peg_in_hole(PortableRandom& random) {
  const double gap = random_gap(random);
  MovingSoup tube = box({}, {0.5, 0.5, 1.0});
  tube.triangles.erase(tube.triangles.begin(), tube.triangles.begin() + 4);  // Its two ends.
  Draft d{tube, box({}, {0.5 - gap, random.uniform(0.2, 0.5) - std::abs(gap), 0.4}), gap};
  const Vec travel{0.0, 0.0, -random.uniform(1.2, 3.0)};
  const double tilt = random.chance(0.7) ? 0.0 : random.power_of_ten(-6, -2);
  const Vec middle{0.0, 0.0, random.uniform(-0.5, 0.5)};
  d.B.motion = through_middle(middle, travel, {0.0, tilt, 0.0}, random.chance(0.5));
  return d;
}

Draft sliding_faces(PortableRandom& random) {
  Draft d{plate(0.6, 0.7, 0.0), plate(0.5, 0.3, 0.0)};
  if (random.chance(0.5)) {
    d.gap = random_gap(random);
  }
  const Vec start{random.uniform(-2.0, -1.3), random.uniform(-0.5, 0.5), d.gap};
  const Vec spin{0.0, 0.0, random.chance(0.5) ? 0.0 : random.uniform(-20.0, 20.0)};
  d.B.motion = constant_velocity({start, {}}, {random.uniform(0.2, 3.0), 0.0, 0.0}, spin);
  return d;
}

Draft planar(PortableRandom& random) {
  const auto soup = [&] {
    MovingSoup s = random_soup(random, 6, 1.0);
    for (Vec& v : s.vertices) {
      v.z = 0.0;
    }
    return s;
  };
  Draft d;
  d.A = soup();
  d.B = soup();
  const Vec start{random.uniform(-3.0, -1.0), random.uniform(-1.0, 1.0), 0.0};
  const Vec travel{random.uniform(0.5, 4.0), random.uniform(-1.0, 1.0), 0.0};
  d.A.motion = constant_velocity({}, {}, {0.0, 0.0, random.uniform(-6.0, 6.0)});
  d.B.motion = constant_velocity({start, {}}, travel, {0.0, 0.0, random.uniform(-6.0, 6.0)});
  return d;
}

Draft parallel_edges(PortableRandom& random) {
  Draft d{box({}, {0.5, 0.5, 0.5}), box({}, {random.uniform(0.1, 0.6), 0.5, 0.3})};
  const double shift_y = static_cast<double>(random.integer(-2, 2)) * 0.5;
  const double shift_z = random.chance(0.5) ? 0.0 : 0.8;
  const Vec travel{random.uniform(0.5, 4.0), 0.0, 0.0};
  const Vec spin{random.chance(0.5) ? 0.0 : random.uniform(-9.0, 9.0), 0.0, 0.0};
  d.B.motion = constant_velocity({{-2.0, shift_y, shift_z}, {}}, travel, spin);
  return d;
}

Draft needles(PortableRandom& random) {
  const auto soup = [&] {
    MovingSoup s;
    const int count = random.integer(1, 5);
    for (int i = 0; i < count; ++i) {
      const Vec a = random.in_box(0.5);
      const Vec along = random.unit();
      const Vec b = a + random.uniform(0.3, 1.0) * along;
      const double s_c = random.uniform(-0.2, 1.2);
      const double width = random.power_of_ten(-8, -3);
      add_triangle(s, a, b, a + s_c * (b - a) + width * random.unit());
    }
    return s;
  };
  Draft d = random_turning(random);
  const MotionInput motion = d.B.motion;
  d.B = soup();
  d.B.motion = motion;
  if (random.chance(0.5)) {
    const MotionInput motion_A = d.A.motion;
    d.A = soup();
    d.A.motion = motion_A;
  }
  return d;
}

Draft points(PortableRandom& random) {
  Draft d{box({}, {0.5, 0.4, 0.3}), {}};
  const int count = random.integer(1, 6);
  for (int i = 0; i < count; ++i) {
    const Vec p = random.in_box(0.4);
    const Vec q = random.chance(0.5) ? p : random.in_box(0.4);
    add_triangle(d.B, p, q, random.chance(0.5) ? p : q);
  }
  const Vec away = random.vector(0.8, 2.0);
  const double angle = random_angle(random);
  d.B.motion = random_motion(random, away, random.in_box(0.5), angle);
  d.A.motion = random_motion(random, {}, {}, random_angle(random));
  return d;
}

Draft start_contact(PortableRandom& random) {
  Draft d{plate(3.0, 3.0, 0.0), top(random)};
  switch (random.integer(0, 2)) {
    case 0:
      d.gap = random_gap(random);
      break;
    case 1:
      d.gap = 0.0;
      break;
    default:
      d.gap = -random.uniform(0.0, 0.3);
  }
  const Vec travel{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-0.5, 2.0)};
  d.B.motion =
      constant_velocity({{0.0, 0.0, d.gap}, {}}, travel, {0.0, 0.0, random.uniform(-6.0, 6.0)});
  return d;
}

Draft end_contact(PortableRandom& random) {
  Draft d{plate(3.0, 3.0, 0.0), top(random)};
  if (random.chance(0.5)) {
    d.gap = random_gap(random);
  }
  const auto tilt = [&] { return random.uniform(-0.1, 0.1); };
  const Quaternion q{1.0, tilt(), tilt(), random.uniform(-2.0, 2.0)};
  const Vec start{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(0.5, 2.0)};
  d.B.motion = between({start, q}, {{0.0, 0.0, d.gap}, {}}, random.chance(0.5));
  return d;
}

Draft bullets(PortableRandom& random) {
  Draft d{box({}, {0.5, 0.5, random.power_of_ten(-6, -2)}), {}};
  d.B = random.chance(0.5) ? top(random) : random_soup(random, 4, 0.2);
  const Vec at{random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6), 0.0};
  const double speed = random.power_of_ten(4, 5);
  const Vec down{0.0, 0.0, random.chance(0.5) ? 1.5 : -1.5};
  const Vec direction = down + random.unit();
  const double hit = random.uniform(0.05, 0.95);
  const Vec travel = speed * direction;
  const PoseInput start{at - hit * travel, random.rotation()};
  d.B.motion = constant_velocity(start, travel, random_spin(random));
  if (random.chance(0.3)) {
    d.A.motion = constant_velocity({}, {}, random_spin(random));
  }
  return d;
}

struct FamilyEntry {
  const char* name;
  Draft (*draft)(PortableRandom&);
};

constexpr std::array<FamilyEntry, kFamilyCount> kFamilies{{
    {"plane_drop", plane_drop},
    {"needle_swing", needle_swing},
    {"random_slow", random_slow},
    {"random_turning", random_turning},
    {"random_screws", random_screws},
    {"random_waypoints", random_waypoint_pair},
    {"tumbling_boxes", tumbling_boxes},
    {"tip_swing", tip_swing},
    {"rocking", rocking},
    {"passing_edges", passing_edges},
    {"bounce", bounce},
    {"peg_in_hole", peg_in_hole},
    {"sliding_faces", sliding_faces},
    {"planar", planar},
    {"parallel_edges", parallel_edges},
    {"needles", needles},
    {"points", points},
    {"start_contact", start_contact},
    {"end_contact", end_contact},
    {"bullets", bullets},
}};

// ---- Variations ----

Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

Vec rotated(const Quaternion& q, const Vec& p) {
  const Vec v{q.x, q.y, q.z};
  const Vec v_p = cross(v, p);
  return p + (2.0 / (q.w * q.w + dot(v, v))) * (q.w * v_p + cross(v, v_p));
}

/// Moves a motion rigidly, up to rounding.
void turn_world(MotionInput& m, const Quaternion& q) {
  for (PoseInput& pose : m.poses) {
    pose = {rotated(q, pose.position), product(q, pose.rotation)};
  }
  for (Vec* v : {&m.translation, &m.rotation_vector, &m.axis_point, &m.axis_direction}) {
    *v = rotated(q, *v);
  }
}

void shift_world(MotionInput& m, const Vec& by) {
  for (PoseInput& pose : m.poses) {
    pose.position = pose.position + by;
  }
  m.axis_point = m.axis_point + by;
}

/// Moves the vertices away from the body origin, and the motion back.
void shift_body(MovingSoup& s, const Vec& by) {
  if (s.motion.kind != MotionKind::fixed) {
    return;
  }
  for (Vec& v : s.vertices) {
    v = v + by;
  }
  s.motion.poses[0].position = s.motion.poses[0].position - rotated(s.motion.poses[0].rotation, by);
}

void scale(MovingSoup& s, double factor) {
  for (Vec& v : s.vertices) {
    v = factor * v;
  }
  s.radius *= factor;
  for (PoseInput& pose : s.motion.poses) {
    pose.position = factor * pose.position;
  }
  s.motion.translation = factor * s.motion.translation;
  s.motion.axis_point = factor * s.motion.axis_point;
  s.motion.along *= factor;
}

/// Moves the designed gap out by what margin and radii add: the whole of B's path, along z.
void make_room(Draft& d, double room) {
  if (d.gap != 0.0) {
    shift_world(d.B.motion, {0.0, 0.0, room});
  }
}

void vary_thickness(PortableRandom& random, Draft& d, GeneratedCase& c) {
  if (random.chance(0.25)) {
    c.margin = random.power_of_ten(-4, -2);
  }
  if (random.chance(0.25)) {
    d.A.radius = random.power_of_ten(-4, -2);
  }
  if (random.chance(0.25)) {
    d.B.radius = random.power_of_ten(-4, -2);
  }
  make_room(d, c.margin + d.A.radius + d.B.radius);
}

void vary_place(PortableRandom& random, Draft& d) {
  if (random.chance(0.4)) {
    const Quaternion q = random.rotation();
    turn_world(d.A.motion, q);
    turn_world(d.B.motion, q);
  }
  if (random.chance(0.2)) {
    const Vec by = 1e6 * random.unit();
    shift_world(d.A.motion, by);
    shift_world(d.B.motion, by);
  }
  if (random.chance(0.1)) {
    shift_body(d.A, 1e6 * random.unit());
  }
}

}  // namespace

std::string name(Family family) { return kFamilies[static_cast<std::size_t>(family)].name; }

GeneratedCase generate(Family family, std::uint64_t index) {
  PortableRandom random(0x2545f4914f6cdd1du * (index + 1) + static_cast<std::uint64_t>(family));
  random.bits();
  Draft d = kFamilies[static_cast<std::size_t>(family)].draft(random);
  GeneratedCase c;
  vary_thickness(random, d, c);
  c.tolerance = random.power_of_ten(-10, -3, false);
  if (d.gap > 0.0 && random.chance(0.6)) {
    c.tolerance = 0.25 * d.gap;
  }
  vary_place(random, d);
  const double size = random.chance(0.5) ? 1.0 : random.power_of_ten(-6, 5);
  scale(d.A, size);
  scale(d.B, size);
  c.margin *= size;
  c.tolerance *= size;
  c.A = std::move(d.A);
  c.B = std::move(d.B);
  if (random.chance(0.5)) {
    std::swap(c.A, c.B);
  }
  return c;
}

std::uint32_t digest(const GeneratedCase& c) {
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a, a word at a time.
  const auto add = [&](double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 0x100000001b3u;
    hash ^= hash >> 29;
  };
  const auto add_vector = [&](const Vec& v) {
    add(v.x);
    add(v.y);
    add(v.z);
  };
  for (const MovingSoup* soup : {&c.A, &c.B}) {
    std::for_each(soup->vertices.begin(), soup->vertices.end(), add_vector);
    for (const PoseInput& pose : soup->motion.poses) {
      add_vector(pose.position);
      const Quaternion& q = pose.rotation;
      add(q.w);
      add_vector({q.x, q.y, q.z});
    }
    std::for_each(soup->motion.times.begin(), soup->motion.times.end(), add);
    add_vector(soup->motion.translation);
    add_vector(soup->motion.rotation_vector);
    add_vector(soup->motion.axis_point);
    add_vector(soup->motion.axis_direction);
    add_vector({soup->motion.angle, soup->motion.along, soup->radius});
  }
  add(c.margin);
  add(c.tolerance);
  return static_cast<std::uint32_t>(hash >> 16);
}

}  // namespace firstcontact::oracle
