// Chains that a script pulls taut: what jams loses time, and is proven none the less.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "simulation/simulated_run.h"

#include <firstcontact/record/run_step.h>
#include <firstcontact/verification/verify_run.h>

namespace firstcontact {
namespace {

using test::numbers;
using test::simulator;

constexpr double kRadius = 0.05;  // [m]  Of the middle line of a ring.
constexpr double kThick = 0.01;   // [m]  Half of what its wire is thick.
constexpr double kPitch = 0.07;   // [m]  From ring to ring: 1 cm of play.
constexpr double kContactDistance = 6e-5;

/// A ring about the z axis, as the shape of a body.
std::string ring(int around, int section) {
  std::string vertices;
  std::string triangles;
  for (int i = 0; i < around; ++i) {
    const double a = 2.0 * std::numbers::pi * i / around;
    for (int j = 0; j < section; ++j) {
      const double b = 2.0 * std::numbers::pi * j / section;
      const double r = kRadius + kThick * std::cos(b);
      vertices += (vertices.empty() ? "" : ", ") +
                  numbers({r * std::cos(a), r * std::sin(a), kThick * std::sin(b)});
      const auto at = [&](int k, int l) {
        return static_cast<double>((k % around) * section + l % section);
      };
      triangles += (triangles.empty() ? "" : ", ") +
                   numbers({at(i, j), at(i + 1, j), at(i + 1, j + 1)}) + ", " +
                   numbers({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return R"({"vertices": [)" + vertices + R"(], "triangles": [)" + triangles + "]}";
}

struct Chain {
  int rings = 4;
  int around = 24;
  int section = 10;
  double speed = 0.05;  // [m/s]  Of the last ring; the first one is fixed.
  double pitch = kPitch;
  double aside = 0.0;  // [m]  The second ring is so far from the middle.
};

std::string bodies_of(const Chain& chain) {
  std::string bodies;
  for (int k = 0; k < chain.rings; ++k) {
    const double s = std::sqrt(0.5);
    const std::string turn = k % 2 == 0 ? "[1, 0, 0, 0]" : numbers({s, s, 0.0, 0.0});
    const auto pose_at = [&](double x) {
      return R"({"position": )" + numbers({x, k == 1 ? chain.aside : 0.0, 0.0}) +
             R"(, "quaternion_wxyz": )" + turn + "}";
    };
    const double x = k * chain.pitch;
    const std::string pose =
        k + 1 < chain.rings
            ? R"("pose": )" + pose_at(x) + (k == 0 ? "" : R"(, "dynamics": {"density": 7800})")
            : R"("motion": {"type": "waypoints", "times": [0, 1], "poses": [)" + pose_at(x) + ", " +
                  pose_at(x + chain.speed) + "]}";
    bodies += std::string(k == 0 ? "" : ", ") + R"({"name": "ring)" + std::to_string(k) +
              R"(", "shape": )" + ring(chain.around, chain.section) + ", " + pose + "}";
  }
  return bodies;
}

/// [m]  How far any body is moved, at most, in pieces of less than a microsecond.
double farthest_at_once(const std::vector<RunStep>& steps) {
  double farthest = 0.0;
  for (const RunStep& step : steps) {
    for (const RunBody& body : step.bodies) {
      double begin = 0.0;
      for (const RunPiece& piece : body.pieces) {
        if (piece.to - begin < 1e-6) {
          farthest = std::max(farthest, piece.translation.norm() +
                                            (kRadius + kThick) * piece.rotation_vector.norm());
        }
        begin = piece.to;
      }
    }
  }
  return farthest;
}

TEST(Jam, AChainPulledTautLosesTimeAndIsProven) {
  for (const Chain& chain : {Chain{.around = 16, .section = 8, .speed = 0.2},
                             Chain{.around = 32, .section = 12, .speed = 0.2}}) {
    const double taut = 4e-2 / chain.speed;  // [s]  Later than that it cannot go on.
    Simulator s = simulator(bodies_of(chain),
                            R"("duration": 1, )" + test::settings(0.01, 0.3, kContactDistance));
    std::vector<RunStep> steps;
    double lost = 0.0;
    for (int k = 0; k < static_cast<int>(taut / 0.01) + 1; ++k) {
      steps.push_back(s.step().value());
      lost += steps.back().time_lost;
    }
    EXPECT_GT(lost, 0.0);
    EXPECT_LT(steps.back().time, taut);
    EXPECT_LE(farthest_at_once(steps), 1.1 * kContactDistance);
    for (std::size_t k = 1; k < steps.size(); ++k) {
      if (steps[k - 1].lasted < 0.1 * steps[k - 1].time_lost) {
        EXPECT_LE(steps[k].events, 1u) << "the jam is known at step " << k;
      }
    }
    EXPECT_EQ(test::verify(s.header(), steps).verdict, ProofVerdict::proven) << chain.around;
  }
}

// By friction rings would wedge in one another up to a fifth earlier: contacts slip instead.
TEST(Jam, AChainIsNotWedgedByFriction) {
  for (const double aside : {0.0, 1e-6, -2e-6, 3e-6}) {
    const Chain chain{.around = 12, .section = 6, .speed = 0.01, .pitch = 0.075, .aside = aside};
    const double inner = 2.0 * (kRadius - kThick);
    const double taut = 3.0 * (inner - chain.pitch - kContactDistance) / chain.speed;  // [s]
    Simulator s = simulator(bodies_of(chain),
                            R"("duration": 1, )" + test::settings(0.01, 0.3, kContactDistance));
    for (int k = 0; k < static_cast<int>(0.97 * taut / 0.01); ++k) {
      ASSERT_EQ(s.step().value().time_lost, 0.0) << aside << " " << k;
    }
  }
}

}  // namespace
}  // namespace firstcontact
