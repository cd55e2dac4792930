#include "benchmarks/query/hard_cases.h"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "benchmarks/support/normalised_mesh.h"
#include "benchmarks/support/torus_knot.h"

namespace firstcontact::benchmarks {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using std::numbers::pi;

/// Makes a sphere of radius 1 m by circles of latitude; its poles are fans of thin triangles.
Shape needle_sphere() {
  constexpr std::uint32_t kStacks = 71;
  constexpr std::uint32_t kSlices = 71;
  Mesh mesh;
  mesh.vertices.emplace_back(0.0, 0.0, 1.0);
  for (std::uint32_t i = 1; i < kStacks; ++i) {
    const double polar = pi * i / kStacks;
    for (std::uint32_t j = 0; j < kSlices; ++j) {
      const double angle = 2.0 * pi * j / kSlices;
      mesh.vertices.emplace_back(std::sin(polar) * std::cos(angle),
                                 std::sin(polar) * std::sin(angle), std::cos(polar));
    }
  }
  mesh.vertices.emplace_back(0.0, 0.0, -1.0);
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  const std::uint32_t last_ring = last - kSlices;
  for (std::uint32_t j = 0; j < kSlices; ++j) {
    const std::uint32_t k = (j + 1) % kSlices;
    mesh.triangles.push_back({0, 1 + j, 1 + k});
    mesh.triangles.push_back({last, last_ring + k, last_ring + j});
    for (std::uint32_t ring = 1; ring < last_ring; ring += kSlices) {
      mesh.triangles.push_back({ring + j, ring + kSlices + j, ring + k});
      mesh.triangles.push_back({ring + k, ring + kSlices + j, ring + kSlices + k});
    }
  }
  return Shape(std::move(mesh));
}

/// Makes a square in the plane z = 0, of 2 cells^2 triangles.
///
/// @param half_width  [m]
Shape grid(std::uint32_t cells, double half_width) {
  Mesh mesh;
  for (std::uint32_t i = 0; i <= cells; ++i) {
    for (std::uint32_t j = 0; j <= cells; ++j) {
      mesh.vertices.emplace_back(half_width * (2.0 * i / cells - 1.0),
                                 half_width * (2.0 * j / cells - 1.0), 0.0);
    }
  }
  for (std::uint32_t i = 0; i < cells; ++i) {
    for (std::uint32_t j = 0; j < cells; ++j) {
      const std::uint32_t corner = i * (cells + 1) + j;
      const std::uint32_t next = corner + cells + 1;
      mesh.triangles.push_back({corner, next, corner + 1});
      mesh.triangles.push_back({corner + 1, next, next + 1});
    }
  }
  return Shape(std::move(mesh));
}

/// Makes a box of twelve triangles.
///
/// @param half  [m]  half the size in x, y, z
Shape box(const Vector3d& centre, const Vector3d& half) {
  Mesh mesh;
  for (int k = 0; k < 8; ++k) {
    const Vector3d corner((k & 1) != 0 ? 1.0 : -1.0, (k & 2) != 0 ? 1.0 : -1.0,
                          (k & 4) != 0 ? 1.0 : -1.0);
    mesh.vertices.emplace_back(centre + half.cwiseProduct(corner));
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return Shape(std::move(mesh));
}

Shape triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return Shape(Mesh{{a, b, c}, {{0, 1, 2}}});
}

std::string short_number(double x) {
  char text[16];
  std::snprintf(text, sizeof text, "%.0e", x);
  return text;
}

std::string in_metres(double x) { return short_number(x) + " m"; }

/// The shapes that several cases share.
struct Shapes {
  Shape sphere = needle_sphere();
  Shape fine_grid = grid(150, 1.0);  // 45,000 triangles
  Shape grid_7k = grid(60, 0.4);     // 7,200 triangles
  Shape box_on_floor = box({0.0, 0.0, 0.1}, {0.3, 0.2, 0.1});
  Shape cube = box(Vector3d::Zero(), Vector3d::Constant(0.5));
  Shape knot = Shape(normalised(torus_knot(10'000)));
};

/// Makes a case in which B's south pole passes `height` above A's north pole at t = 0.5.
///
/// @param spin  [rad]  rotation of A over the step, in world axes; B's is reversed
HardCase grazing(const Shapes& shapes, std::string name, double height, const Vector3d& spin,
                 Verdict verdict) {
  const Quaterniond half_back(Eigen::AngleAxisd(-0.5 * spin.norm(), spin.stableNormalized()));
  return {.name = std::move(name),
          .A = shapes.sphere,
          .B = shapes.sphere,
          .motion_A = Motion::constant_velocity({.rotation = half_back}, Vector3d::Zero(), spin),
          .motion_B = Motion::constant_velocity(
              {.position = {-2.5, 0.0, 2.0 + height}, .rotation = half_back.conjugate()},
              {5.0, 0.0, 0.0}, -spin),
          .verdict = verdict};
}

void add_grazing(const Shapes& shapes, std::vector<HardCase>& cases) {
  const Vector3d no_spin = Vector3d::Zero();
  const Vector3d spin(0.3, 1.2, 0.7);
  for (const double miss : {1e-2, 1e-3, 1e-4, 1e-5}) {
    cases.push_back(
        grazing(shapes, "spheres 10K miss by " + in_metres(miss), miss, no_spin, Verdict::free));
    cases.push_back(grazing(shapes, "spheres 10K miss by " + in_metres(miss) + ", both spin", miss,
                            spin, Verdict::free));
  }
  cases.push_back(grazing(shapes, "spheres 10K touch", 0.0, no_spin, Verdict::contact));
  for (const double overlap : {1e-6, 1e-5, 1e-4}) {
    cases.push_back(grazing(shapes, "spheres 10K overlap by " + in_metres(overlap), -overlap,
                            no_spin, Verdict::contact));
    cases.push_back(grazing(shapes, "spheres 10K overlap by " + in_metres(overlap) + ", both spin",
                            -overlap, spin, Verdict::contact));
  }
}

/// Makes a case in which B slides over the grid at a constant height.
HardCase sliding(const Shapes& shapes, std::string name, const Shape& B, double gap, double spin) {
  return {.name = std::move(name),
          .A = shapes.fine_grid,
          .B = B,
          .motion_A = Motion::fixed(),
          .motion_B = Motion::constant_velocity({.position = {-0.4, -0.2, gap}}, {0.8, 0.4, 0.0},
                                                {0.0, 0.0, spin}),
          .verdict = Verdict::free};
}

void add_sliding(const Shapes& shapes, std::vector<HardCase>& cases) {
  for (const double gap : {1e-2, 1e-3, 1e-4, 1e-5, 2e-6}) {
    for (const double spin : {0.0, 3.0}) {
      const std::string how = " slides " + in_metres(gap) + " above 45K grid" +
                              (spin > 0.0 ? ", spins about the normal" : "");
      cases.push_back(sliding(shapes, "box" + how, shapes.box_on_floor, gap, spin));
      cases.push_back(sliding(shapes, "7K grid" + how, shapes.grid_7k, gap, spin));
    }
  }
}

/// Makes a case in which B comes down flat on A from 0.5 m, and passes through it to 0.5 m below.
HardCase landing(std::string name, const Shape& A, const Shape& B, double spin) {
  return {.name = std::move(name),
          .A = A,
          .B = B,
          .motion_A = Motion::fixed(),
          .motion_B = Motion::constant_velocity({.position = {0.05, 0.03, 0.5}}, {0.0, 0.0, -1.0},
                                                {0.0, 0.0, spin}),
          .verdict = Verdict::contact,
          .t = 0.5};
}

void add_landing(const Shapes& shapes, std::vector<HardCase>& cases) {
  const Shape plate = grid(1, 0.5);
  for (const double spin : {0.0, 1.0}) {
    const std::string how = spin > 0.0 ? ", spins about the normal" : "";
    cases.push_back(
        landing("7K grid lands flat on 45K grid" + how, shapes.fine_grid, shapes.grid_7k, spin));
    cases.push_back(
        landing("box lands flat on 45K grid" + how, shapes.fine_grid, shapes.box_on_floor, spin));
    cases.push_back(landing("plate lands flat on plate" + how, plate, plate, spin));
  }
  HardCase everything = landing("box lands flat on 45K grid, all contacts listed", shapes.fine_grid,
                                shapes.box_on_floor, 0.0);
  everything.options.contacts = ContactState::all;
  cases.push_back(std::move(everything));
}

/// Makes a case in which B leaves A upwards from a height at the start.
HardCase leaving(std::string name, const Shapes& shapes, const Shape& B, double height,
                 StartContacts start_contacts, Verdict verdict) {
  return {
      .name = std::move(name),
      .A = shapes.fine_grid,
      .B = B,
      .motion_A = Motion::fixed(),
      .motion_B = Motion::constant_velocity({.position = {0.05, 0.03, height}}, {0.0, 0.0, 0.5}),
      .verdict = verdict,
      .t = verdict == Verdict::free ? std::nullopt : std::optional(0.0),
      .options = {.start_contacts = start_contacts, .contacts = ContactState::first}};
}

void add_leaving(const Shapes& shapes, std::vector<HardCase>& cases) {
  constexpr double kInBand = 5e-7;  // [m]  Half the tolerance.
  cases.push_back(leaving("box touches 45K grid, leaves", shapes, shapes.box_on_floor, 0.0,
                          StartContacts::report, Verdict::contact_at_start));
  cases.push_back(leaving("7K grid touches 45K grid, leaves", shapes, shapes.grid_7k, 0.0,
                          StartContacts::report, Verdict::contact_at_start));
  cases.push_back(leaving("box in the band above 45K grid, kept, leaves", shapes,
                          shapes.box_on_floor, kInBand, StartContacts::keep_half, Verdict::free));
}

void add_turning(const Shapes& shapes, std::vector<HardCase>& cases) {
  const Vector3d axis_A = Vector3d(1.0, 2.0, 3.0).normalized();
  const Vector3d axis_B = Vector3d(-2.0, 1.0, 0.5).normalized();
  for (const double degrees : {0.0, 90.0, 180.0, 360.0, 1440.0, 3600.0}) {
    const double angle = degrees / 180.0 * pi;
    const std::string turn = " turn by " + std::to_string(std::lround(degrees)) + " degrees";
    const auto cubes = [&](const std::string& how, const Vector3d& start, const Vector3d& way,
                           Verdict verdict) {
      cases.push_back(
          {.name = "cubes" + turn + ", " + how,
           .A = shapes.cube,
           .B = shapes.cube,
           .motion_A = Motion::constant_velocity({}, Vector3d::Zero(), angle * axis_A),
           .motion_B = Motion::constant_velocity({.position = start}, way, angle * axis_B),
           .verdict = verdict});
    };
    cubes("hit", {2.0, 0.3, 0.2}, {-2.0, 0.0, 0.0}, Verdict::contact);
    // The corners of each cube reach sqrt(3) / 2.
    cubes("pass", {-2.0, 1.74, 0.0}, {4.0, 0.0, 0.0}, Verdict::free);
  }
  for (const double degrees : {90.0, 180.0, 720.0}) {
    const double angle = degrees / 180.0 * pi;
    cases.push_back(
        {.name = "knots 10K turn by " + std::to_string(std::lround(degrees)) + " degrees",
         .A = shapes.knot,
         .B = shapes.knot,
         .motion_A = Motion::constant_velocity({}, Vector3d::Zero(), angle * axis_A),
         .motion_B = Motion::constant_velocity({.position = {1.7, 0.0, 0.0}}, Vector3d::Zero(),
                                               angle * axis_B),
         .verdict = degrees < 180.0 ? Verdict::free : Verdict::contact});
  }
}

/// Makes a case in which B comes down 1 m and meets A at t = 0.5: needles, points, nearly parallel
/// edges.
HardCase meeting(std::string name, Shape A, Shape B) {
  return {.name = std::move(name),
          .A = std::move(A),
          .B = std::move(B),
          .motion_A = Motion::fixed(),
          .motion_B = Motion::constant_velocity({.position = {0.0, 0.0, 0.5}}, {0.0, 0.0, -1.0}),
          .verdict = Verdict::contact,
          .t = 0.5};
}

void add_degenerate(std::vector<HardCase>& cases) {
  const Shape needle = triangle({-1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0});
  const Shape point = triangle(Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero());
  const Shape floor = triangle({-1.0, -1.0, 0.0}, {1.0, -1.0, 0.0}, {0.0, 2.0, 0.0});
  cases.push_back(meeting("point meets point", point, point));
  cases.push_back(meeting("point meets needle", needle, point));
  cases.push_back(meeting("needle meets triangle", floor, needle));
  for (const double angle : {0.0, 1e-12, 1e-8, 1e-4}) {
    const Vector3d end(std::cos(angle), std::sin(angle), 0.0);
    cases.push_back(meeting("needles meet at an angle of " + short_number(angle), needle,
                            triangle(-end, Vector3d::Zero(), end)));
    cases.push_back(meeting("edges meet at an angle of " + short_number(angle),
                            triangle({-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, -1.0}),
                            triangle(-end, end, {0.0, 0.0, 1.0})));
  }
}

}  // namespace

std::vector<HardCase> hard_cases() {
  const Shapes shapes;
  std::vector<HardCase> cases;
  add_grazing(shapes, cases);
  add_sliding(shapes, cases);
  add_landing(shapes, cases);
  add_leaving(shapes, cases);
  add_turning(shapes, cases);
  add_degenerate(cases);
  return cases;
}

}  // namespace firstcontact::benchmarks
