#include "support/narrow_passages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/robot_check/robot_scene.h>

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;

constexpr double kWide = 0.1;  // [m]  Of the bodies, where they are narrowest.
constexpr double kSide = 0.8;  // [m]  From the axis to the sides of what is sampled.
constexpr double kWall = 1.2;  // [m]  From the axis to the ends of walls: nothing gets around.
constexpr double kRoomInside =
    0.01;  // [m]  Of a slide in its channel, before a gate it cannot pass.

constexpr std::array<const char*, 11> kFamilies = {"window",   "peg",     "tunnel", "trap",
                                                   "dovetail", "bayonet", "links",  "maze",
                                                   "tubes",    "key",     "screw"};

/// Walls, numbered as they come.
class Walls {
 public:
  void box(const Vector3d& low, const Vector3d& high) {
    add(make_box(high - low), 0.5 * (low + high));
  }

  void add(Shape shape, const Vector3d& place = Vector3d::Zero()) {
    const std::string name = "wall" + std::to_string(scene_.size());
    scene_.add_body(name, std::move(shape), Motion::fixed({place, Eigen::Quaterniond::Identity()}));
  }

  /// A plate across x, with a window.
  void plate(double x0, double x1, const std::array<double, 2>& y, const std::array<double, 2>& z) {
    box({x0, -kWall, -kWall}, {x1, y[0], kWall});
    box({x0, y[1], -kWall}, {x1, kWall, kWall});
    box({x0, y[0], -kWall}, {x1, y[1], z[0]});
    box({x0, y[0], z[1]}, {x1, y[1], kWall});
  }

  RobotScene take() { return std::move(scene_); }

 private:
  RobotScene scene_;
};

/// A convex prism along x over a polygon in y and z that turns from y to z.
Mesh prism(double x0, double x1, const std::vector<std::array<double, 2>>& polygon) {
  Mesh mesh;
  const auto n = static_cast<std::uint32_t>(polygon.size());
  for (const double x : {x0, x1}) {
    for (const auto& [y, z] : polygon) {
      mesh.vertices.emplace_back(x, y, z);
    }
  }
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t next = (k + 1) % n;
    mesh.triangles.push_back({k, next, n + next});
    mesh.triangles.push_back({k, n + next, n + k});
    if (k > 0 && k + 1 < n) {
      mesh.triangles.push_back({0, next, k});
      mesh.triangles.push_back({n, n + k, n + next});
    }
  }
  return mesh;
}

void append(const Mesh& part, Mesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const auto& [a, b, c] : part.triangles) {
    mesh.triangles.push_back({first + a, first + b, first + c});
  }
}

Mesh block(const Vector3d& low, const Vector3d& high) {
  return prism(
      low.x(), high.x(),
      {{low.y(), low.z()}, {high.y(), low.z()}, {high.y(), high.z()}, {low.y(), high.z()}});
}

Shape solid(Mesh mesh) { return Shape(std::move(mesh), 0.0, Filling::solid); }

Configuration pose(const Vector3d& place,
                   const Eigen::Quaterniond& r = Eigen::Quaterniond::Identity()) {
  return {place.x(), place.y(), place.z(), r.w(), r.x(), r.y(), r.z()};
}

Eigen::Quaterniond turn(double angle, const Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized()));
}

NarrowPassage passage(Walls walls, const Shape& mover, const Vector3d& low, const Vector3d& high,
                      Configuration start, Configuration goal) {
  ConfigurationSpace space = ConfigurationSpace::of_body("mover", mover, low, high);
  RobotScene scene = walls.take();
  const std::size_t robot = scene.add_robot("mover", space.motion(start, start));
  return {.scene = {.scene = std::move(scene), .robots = {robot}, .space = std::move(space)},
          .start = std::move(start),
          .goal = std::move(goal)};
}

NarrowPassage window(double s) {
  Walls walls;
  walls.plate(-0.025, 0.025, {-s / 2, s / 2}, {-s / 2, s / 2});
  return passage(std::move(walls), make_box({0.5, kWide, kWide}), {-0.9, -kSide, -kSide},
                 {0.9, kSide, kSide}, pose({-0.6, 0.1, 0.2}, turn(1.5, Vector3d::UnitY())),
                 pose({0.6, -0.2, 0.1}, turn(1.4, Vector3d::UnitZ())));
}

NarrowPassage peg(double s) {
  Walls walls;
  walls.plate(-0.125, 0.125, {-s / 2, s / 2}, {-s / 2, s / 2});
  return passage(std::move(walls), make_box({0.3, kWide, kWide}), {-0.9, -kSide, -kSide},
                 {0.9, kSide, kSide}, pose({-0.5, 0.1, 0.1}, turn(0.6, {1.0, 1.0, 0.0})),
                 pose({0.5, 0.0, 0.0}));
}

NarrowPassage tunnel(double s) {
  Walls walls;
  walls.box({0.0, -kWall, -s / 2}, {0.4, 0.0, s / 2});
  walls.box({0.0, s, -s / 2}, {0.4 - s, kWall, s / 2});
  walls.box({0.4, -kWall, -s / 2}, {0.8, 0.4 - s, s / 2});
  walls.box({0.4 - s, 0.4, -s / 2}, {0.8, kWall, s / 2});
  walls.box({0.0, -kWall, s / 2}, {0.8, kWall, kWall});
  walls.box({0.0, -kWall, -kWall}, {0.8, kWall, -s / 2});
  return passage(std::move(walls), make_box({kWide, kWide, kWide}), {-0.4, -kSide, -kSide},
                 {1.2, kSide, kSide}, pose({-0.3, 0.2, 0.1}, turn(0.5, {1.0, 2.0, 3.0})),
                 pose({1.1, 0.2, 0.0}));
}

NarrowPassage trap(double s) {
  Walls walls;
  const double in = 0.4;
  const double out = 0.45;
  walls.box({-out, -out, -out}, {-in, out, out});
  walls.box({-in, -out, -out}, {out, -in, out});
  walls.box({-in, in, -out}, {out, out, out});
  walls.box({-in, -in, -out}, {out, in, -in});
  walls.box({-in, -in, in}, {out, in, out});
  // The side with the tube.
  const double h = s / 2;
  const double rim = h + 0.03;
  for (const auto& [x0, x1, r] : {std::array{in, out, in}, std::array{0.1, in, rim}}) {
    walls.box({x0, -r, -r}, {x1, -h, r});
    walls.box({x0, h, -r}, {x1, r, r});
    walls.box({x0, -h, -r}, {x1, h, -h});
    walls.box({x0, -h, h}, {x1, h, r});
  }
  return passage(std::move(walls), make_box({0.25, kWide, kWide}), {-0.6, -kSide, -kSide},
                 {1.0, kSide, kSide}, pose({-0.2, 0.2, 0.1}, turn(1.0, {0.0, 1.0, 1.0})),
                 pose({0.8, 0.1, -0.2}, turn(0.4, {1.0, 0.0, 0.0})));
}

/// The section of the slide, wider all around by a gap.
std::array<std::array<double, 2>, 4> dovetail_section(double gap) {
  // Normal of the wedge's flank.
  const Vector3d side = Vector3d(0.0, kWide, 0.5 * kWide).normalized();
  const double out = gap / side.y();
  const double slope = side.z() / side.y();
  const auto half = [&](double z) { return kWide - slope * z + out; };
  const double low = -gap;
  const double high = kWide + gap;
  return {{{-half(low), low}, {half(low), low}, {half(high), high}, {-half(high), high}}};
}

/// A channel of that section from x0 to x1, closed on all sides but its ends.
void add_channel(Walls& walls, double x0, double x1, double gap) {
  const auto section = dovetail_section(gap);
  const double low = section[0][1];
  const double high = section[2][1];
  walls.box({x0, -kWall, -kWall}, {x1, kWall, low});
  walls.box({x0, -kWall, high}, {x1, kWall, kWall});
  walls.add(solid(
      prism(x0, x1, {{section[1][0], low}, {kWall, low}, {kWall, high}, {section[2][0], high}})));
  walls.add(solid(
      prism(x0, x1, {{section[0][0], low}, {section[3][0], high}, {-kWall, high}, {-kWall, low}})));
}

NarrowPassage dovetail(double clearance) {
  Walls walls;
  const double gap = 0.5 * clearance;
  add_channel(walls, 0.0, 0.3, clearance > 0.0 ? gap : kRoomInside);
  add_channel(walls, 0.3, 0.35, gap);
  walls.box({-0.05, -kWall, -kWall}, {0.0, kWall, kWall});
  const auto section = dovetail_section(0.0);
  const Shape slide = solid(prism(-0.1, 0.1, {section.begin(), section.end()}));
  return passage(std::move(walls), slide, {0.0, -kSide, -kSide}, {1.0, kSide, kSide},
                 pose({0.15, 0.0, 0.0}), pose({0.8, 0.2, 0.1}, turn(1.0, {0.0, 1.0, 1.0})));
}

NarrowPassage bayonet(double clearance) {
  Walls walls;
  const double length = 0.5 * (0.3 + std::max(clearance, 0.0));
  const double h = 0.5 * (kWide + clearance);
  walls.plate(0.0, 0.05, {-length, length}, {-h, h});
  walls.plate(0.25, 0.3, {-h, h}, {-length, length});
  return passage(std::move(walls), make_box({0.16, 0.3, kWide}), {-0.5, -kSide, -kSide},
                 {0.8, kSide, kSide}, pose({-0.4, 0.1, 0.1}, turn(0.5, {1.0, 1.0, 0.0})),
                 pose({0.7, 0.1, 0.0}, turn(1.2, {1.0, 0.0, 0.0})));
}

/// A square frame in the x-y plane from bars, the one at +x with a gap in its middle.
std::vector<std::array<Vector3d, 2>> frame(double outer, double wire, double gap) {
  const double in = outer - wire;
  const double h = wire / 2;
  std::vector<std::array<Vector3d, 2>> bars = {{{{-outer, -outer, -h}, {-in, outer, h}}},
                                               {{{-in, -outer, -h}, {in, -in, h}}},
                                               {{{-in, in, -h}, {in, outer, h}}}};
  if (gap > 0.0) {
    bars.push_back({{{in, -outer, -h}, {outer, -gap / 2, h}}});
    bars.push_back({{{in, gap / 2, -h}, {outer, outer, h}}});
  } else {
    bars.push_back({{{in, -outer, -h}, {outer, outer, h}}});
  }
  return bars;
}

/// The two cores are linked until the core of the link crosses the gap.
NarrowPassage links(double s) {
  Walls walls;
  for (const auto& [low, high] : frame(0.4, kWide, s)) {
    walls.box(low, high);
  }
  Mesh link;
  for (const auto& [low, high] : frame(0.4, kWide, 0.0)) {
    append(block(low, high), link);
  }
  return passage(std::move(walls), solid(std::move(link)), {-1.2, -1.0, -1.0}, {1.6, 1.0, 1.0},
                 pose({-0.4, 0.0, 0.05}, turn(0.5 * std::numbers::pi, Vector3d::UnitX())),
                 pose({1.4, 0.2, 0.1}, turn(1.0, {1.0, 1.0, 0.0})));
}

void add_edge(const Vector3d& from, const Vector3d& to, Mesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {from, to});
  mesh.triangles.push_back({first, first + 1, first + 1});
}

/// Half the width of the tubes' and the key's round parts.
constexpr double kRound = 0.5 * kWide;  // [m]

/// A bent tube in the x-z plane. Its ends face each other along x, `span` apart at their cores.
Shape bent_tube(double span) {
  std::vector<Vector3d> core = {{0.5 * span, 0.0, -0.3},
                                {0.3, 0.0, -0.3},
                                {0.45, 0.0, -0.15},
                                {0.45, 0.0, 0.15},
                                {0.3, 0.0, 0.3}};
  for (std::size_t k = core.size(); k-- > 0;) {
    core.emplace_back(-core[k].x(), 0.0, core[k].z());
  }
  Mesh mesh;
  for (std::size_t k = 0; k + 1 < core.size(); ++k) {
    add_edge(core[k], core[k + 1], mesh);
  }
  return Shape(std::move(mesh), kRound);
}

/// The cores, closed by the straight segments between their ends, are linked until two of these
/// four curves cross.
///
/// Where two segments cross, they are the diagonals of a convex quadrilateral. One of its angles is
/// at least a right angle. So one of the two sides there is at most span / sqrt(2) = s long. Where
/// a core crosses a segment, it is at most span / 2 < s from an end of the other core.
NarrowPassage tubes(double s) {
  const Shape tube = bent_tube(std::numbers::sqrt2 * s);
  Walls walls;
  walls.add(tube);
  const Eigen::Quaterniond across = turn(0.5 * std::numbers::pi, Vector3d::UnitZ());
  const Eigen::Quaterniond facing = turn(std::numbers::pi, Vector3d::UnitX()) * across;
  const Eigen::Quaterniond half_way = turn(0.5 * std::numbers::pi, Vector3d::UnitX()) * across;
  NarrowPassage made =
      passage(std::move(walls), tube, {-1.4, -1.4, -1.4}, {1.4, 1.4, 1.4},
              pose({0.0, 0.0, -0.3}, across), pose({0.2, 0.3, -1.3}, turn(1.0, {1.0, 1.0, 0.0})));
  made.way = {made.start,
              pose({0.0, 0.0, -0.3}, half_way),
              pose({0.0, 0.0, -0.3}, facing),
              pose({0.0, 0.0, -0.6}, facing),
              pose({0.0, 0.0, -1.3}, facing),
              made.goal};
  return made;
}

/// A key of two bits on a round shaft, through two plates whose keyholes are turned against each
/// other: each bit is turned between the plates while the shaft is in the keyholes.
///
/// The shaft and the bits are as thick as the keyholes are wide, but for the clearance.
NarrowPassage key(double clearance) {
  constexpr double kPlate = 0.05;
  constexpr double kBit = 0.15;           // Of a bit along the shaft.
  constexpr double kHigh = 0.25;          // Of a bit, from the middle of the shaft.
  constexpr double kPlay = 0.1;           // Along the shaft, where a bit is turned.
  constexpr double kRoom = kBit + kPlay;  // Between the plates.
  constexpr double kApart = 2.0 * kPlate + kRoom + kPlay;  // Between the bits.
  const double h = 0.5 * (kWide + clearance);
  const double high = kHigh + 0.5 * std::max(clearance, 0.0);
  const double ends = 0.5 * kApart + kBit - kRound;  // Of the core, from the middle of the key.
  Walls walls;
  walls.plate(0.0, kPlate, {-h, high}, {-h, h});
  walls.plate(kPlate + kRoom, 2.0 * kPlate + kRoom, {-h, h}, {-h, high});
  Mesh core;
  add_edge({-ends, 0.0, 0.0}, {ends, 0.0, 0.0}, core);
  for (const double sign : {-1.0, 1.0}) {
    const double x0 = sign * (0.5 * kApart + kRound);
    const double x1 = sign * ends;
    const double y = kHigh - kRound;
    append({.vertices = {{x0, 0.0, 0.0}, {x1, 0.0, 0.0}, {x1, y, 0.0}, {x0, y, 0.0}},
            .triangles = {{0, 1, 2}, {0, 2, 3}}},
           core);
  }
  const double end = 2.0 * kPlate + kRoom;
  NarrowPassage made =
      passage(std::move(walls), Shape(std::move(core), kRound), {-0.9, -kSide, -kSide},
              {end + 0.9, kSide, kSide}, pose({-0.6, 0.1, 0.1}, turn(0.5, {1.0, 1.0, 0.0})),
              pose({end + 0.6, 0.1, 0.0}, turn(1.2, {1.0, 0.0, 0.0})));
  // The middle of the key when a bit is between the plates, and when both are outside.
  const double in = kPlate + 0.5 * kRoom;
  const double to_bit = 0.5 * (kApart + kBit);
  const auto at = [](double x, double angle) {
    return pose({x, 0.0, 0.0}, turn(angle, Vector3d::UnitX()));
  };
  const double right = 0.5 * std::numbers::pi;
  made.way = {made.start,           at(-0.6, 0.0), at(in - to_bit, 0.0), at(in - to_bit, right),
              at(in, right),        at(in, 0.0),   at(in + to_bit, 0.0), at(in + to_bit, right),
              at(end + 0.6, right), made.goal};
  return made;
}

/// Places of an eye along a coil: its y axis across the narrow direction, its z axis along the
/// wire.
class EyeOnCoil {
 public:
  static constexpr std::size_t kSegments = 10;

  EyeOnCoil() {
    constexpr double kRadius = 0.3;
    constexpr double kPitch = 0.5;
    constexpr double kSegmentsOfTurn = 8.0;
    for (std::size_t k = 0; k <= kSegments; ++k) {
      const double turns = static_cast<double>(k) / kSegmentsOfTurn;
      const double angle = 2.0 * std::numbers::pi * turns;
      points_.emplace_back(kRadius * std::cos(angle), kRadius * std::sin(angle), kPitch * turns);
    }
  }

  [[nodiscard]] const std::vector<Vector3d>& points() const { return points_; }

  /// In the middle of a segment, its x axis straight away from the axis of the coil.
  [[nodiscard]] Configuration middle(std::size_t k) const {
    const Vector3d p = 0.5 * (points_[k] + points_[k + 1]);
    return placed(p, along(k), Vector3d(p.x(), p.y(), 0.0));
  }

  /// At a place of segment k, its y axis along the normal of the corner's plane.
  [[nodiscard]] Configuration at_corner(const Vector3d& p, std::size_t k,
                                        std::size_t corner) const {
    const Vector3d normal = along(corner - 1).cross(along(corner));
    return placed(p, along(k), normal.cross(along(k)));
  }

  /// Off the start, along all segments, and past the end of the coil.
  [[nodiscard]] std::vector<Configuration> way() const {
    std::vector<Configuration> way = {middle(0)};
    for (std::size_t k = 1; k < kSegments; ++k) {
      const Vector3d before = 0.5 * (points_[k - 1] + points_[k]);
      const Vector3d after = 0.5 * (points_[k] + points_[k + 1]);
      way.push_back(at_corner(before, k - 1, k));
      way.push_back(at_corner(points_[k], k - 1, k));
      way.push_back(at_corner(points_[k], k, k));
      way.push_back(at_corner(after, k, k));
      way.push_back(middle(k));
    }
    const Vector3d last = points_.back() + 0.3 * along(kSegments - 1);
    way.push_back(way.back());
    for (int k = 0; k < 3; ++k) {
      way.back()[static_cast<std::size_t>(k)] = last[k];
    }
    return way;
  }

 private:
  [[nodiscard]] Vector3d along(std::size_t k) const {
    return (points_[k + 1] - points_[k]).normalized();
  }
  static Configuration placed(const Vector3d& p, const Vector3d& z, const Vector3d& x) {
    Eigen::Matrix3d axes;
    axes.col(0) = x.normalized();
    axes.col(1) = z.cross(axes.col(0));
    axes.col(2) = z;
    return pose(p, Eigen::Quaterniond(axes));
  }

  std::vector<Vector3d> points_;
};

/// An eye off a coil of round wire that stands on a wall: it has to be screwed along the wire.
///
/// The core of the wire, closed below the wall, and the core of the eye are linked until the end of
/// the wire crosses the eye, between its two long bars. The bars are the two faces. In the twin
/// only the end of the wire is too thick.
NarrowPassage screw(double clearance) {
  constexpr double kBar = 0.03;   // [m]  Radius of the eye's bars.
  constexpr double kLong = 0.15;  // [m]  Half the length of its opening, at the cores.
  const EyeOnCoil coil;
  const std::vector<Vector3d>& points = coil.points();
  Mesh thin;
  add_edge(points[0] - Vector3d(0.0, 0.0, 0.4), points[0], thin);
  for (std::size_t k = 0; k + 2 < points.size(); ++k) {
    add_edge(points[k], points[k + 1], thin);
  }
  Mesh end;
  add_edge(points[points.size() - 2], points.back(), end);
  const double inside =
      clearance > 0.0 ? kRound : std::max(kRound + 0.5 * clearance - kRoomInside, 0.1 * kRound);
  Walls walls;
  walls.add(Shape(std::move(thin), inside));
  walls.add(Shape(std::move(end), kRound));
  walls.box({-kWall, -kWall, -0.45}, {kWall, kWall, -0.4});
  const double h = 0.5 * (kWide + clearance) + kBar;
  const std::array<Vector3d, 4> corners = {Vector3d(-kLong, -h, 0.0), Vector3d(kLong, -h, 0.0),
                                           Vector3d(kLong, h, 0.0), Vector3d(-kLong, h, 0.0)};
  Mesh eye;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    add_edge(corners[k], corners[(k + 1) % corners.size()], eye);
  }
  NarrowPassage made = passage(std::move(walls), Shape(std::move(eye), kBar),
                               {-kSide, -kSide, -0.3}, {kSide, kSide, 1.3}, coil.middle(0),
                               pose({0.2, -0.1, 1.2}, turn(1.0, {0.0, 1.0, 1.0})));
  made.way = coil.way();
  made.way.push_back(made.goal);
  return made;
}

/// Between cells (i, j) and (i + 1, j), and between (i, j) and (i, j + 1), of 3 times 3.
struct Maze {
  std::array<std::array<bool, 3>, 2> along_x;
  std::array<std::array<bool, 2>, 3> along_y;
};

/// From cell (0, 0) to cell (2, 2): up, right, down, right, up, up, with one dead end.
constexpr Maze kMaze = {
    {{{{false, true, true}}, {{true, false, false}}}},
    {{{{true, true}}, {{true, false}}, {{true, true}}}},
};

NarrowPassage maze(double s) {
  Walls walls;
  const double wall = 0.05;
  const double pitch = s + wall;
  const double h = s / 2;
  const auto at = [&](int k) { return pitch * k; };  // Where wall k begins; cells behind it.
  const double end = at(3) + wall;
  walls.box({0.0, -kWall, h}, {end, end + kWall, kWall});
  walls.box({0.0, -kWall, -kWall}, {end, end + kWall, -h});
  walls.box({0.0, -kWall, -h}, {end, wall, h});
  walls.box({0.0, at(3), -h}, {end, end + kWall, h});
  walls.box({0.0, at(1), -h}, {wall, at(3), h});         // The entrance is at (0, 0),
  walls.box({at(3), wall, -h}, {end, at(2) + wall, h});  // the exit at (2, 2).
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const auto a = static_cast<std::size_t>(i);
      const auto b = static_cast<std::size_t>(j);
      if (i < 2 && !kMaze.along_x[a][b]) {
        walls.box({at(i + 1), at(j), -h}, {at(i + 1) + wall, at(j + 1) + wall, h});
      }
      if (j < 2 && !kMaze.along_y[a][b]) {
        walls.box({at(i), at(j + 1), -h}, {at(i + 1) + wall, at(j + 1) + wall, h});
      }
      if (i < 2 && j < 2) {
        walls.box({at(i + 1), at(j + 1), -h}, {at(i + 1) + wall, at(j + 1) + wall, h});
      }
    }
  }
  return passage(std::move(walls), make_box({kWide, kWide, kWide}), {-0.4, -kSide, -kSide},
                 {end + 0.4, kSide + end, kSide},
                 pose({-0.3, 0.1, 0.1}, turn(0.4, {1.0, 1.0, 1.0})),
                 pose({end + 0.3, at(2) + wall + s / 2, 0.0}));
}

}  // namespace

std::span<const char* const> narrow_families() { return kFamilies; }

NarrowPassage narrow_passage(std::string_view family, double clearance) {
  if (clearance == 0.0 || !(std::abs(clearance) <= kWide)) {
    throw std::invalid_argument("a clearance other than 0, of at most 0.1 m");
  }
  const double s = kWide + clearance;
  NarrowPassage made = family == "window"     ? window(s)
                       : family == "peg"      ? peg(s)
                       : family == "tunnel"   ? tunnel(s)
                       : family == "trap"     ? trap(s)
                       : family == "dovetail" ? dovetail(clearance)
                       : family == "bayonet"  ? bayonet(clearance)
                       : family == "links"    ? links(s)
                       : family == "maze"     ? maze(s)
                       : family == "tubes"    ? tubes(s)
                       : family == "key"      ? key(clearance)
                       : family == "screw"    ? screw(clearance)
                                              : throw std::invalid_argument("an unknown family");
  made.width = kWide;
  made.clearance = clearance;
  return made;
}

}  // namespace firstcontact::test
