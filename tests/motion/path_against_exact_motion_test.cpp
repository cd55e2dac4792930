// The library's paths against the exact motions of the oracle, 256 bits, for every kind of motion.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include <firstcontact/motion/motion.h>

#include "support/exact_motion.h"
#include "support/exact_state.h"
#include "support/generated_case.h"
#include "support/library_case.h"

namespace firstcontact::oracle {
namespace {

Wide wide(const DoubleDouble& d) { return Wide(d.hi) + Wide(d.lo); }

Vector3<Wide> wide(const DoubleDoubleVector3& v) {
  return {wide(v.c[0]), wide(v.c[1]), wide(v.c[2])};
}

void expect_agreement(const MotionPiece& piece, const ConstantRatePath& path, double t) {
  const ExactState exact_state(piece, t);
  const Vector3<Wide> center = wide(path.pivot(t) + path.precise_lever(t));
  const double size =
      norm(exact_state.center()).upper() + norm(piece.lever).upper() + norm(piece.travel).upper();
  const double error = norm(center - exact_state.center()).upper();
  // The stated bounds, and the roundings of pivot(t) and of the sum.
  EXPECT_LE(error, path.position_error() + 0x1p-94 * path.lever_length() + 0x1p-100 * size);
  const Eigen::Matrix3d R_WB = path.state(t).R_WB;
  for (int j = 0; j < 3; ++j) {
    const Vector3<double> column{R_WB(0, j), R_WB(1, j), R_WB(2, j)};
    const Wide difference = norm(exact(column) - exact_state.column(static_cast<std::size_t>(j)));
    EXPECT_LE(difference.upper(), 22.0 * 0x1p-53 + path.rotation_error());
  }
}

TEST(ConstantRatePath, StaysWithinItsErrorsOfTheExactMotion) {
  for (int f = 0; f < kFamilyCount; ++f) {
    for (std::uint64_t i = 0; i < 50; ++i) {
      const GeneratedCase c = generate(static_cast<Family>(f), i);
      for (const MovingSoup* soup : {&c.A, &c.B}) {
        const Vector3<double>& p = soup->vertices[0];
        const std::vector<MotionPiece> pieces = motion_pieces(soup->motion, p);
        const Motion motion = to_motion(soup->motion);
        ASSERT_EQ(motion.breaks().size(), pieces.size() + 1);
        for (std::size_t k = 0; k < pieces.size(); ++k) {
          const ConstantRatePath path = motion.path(k, {p.x, p.y, p.z});
          const double begin = pieces[k].t_begin;
          const double end = pieces[k].t_end;
          for (const double t : {begin, begin + 0.3 * (end - begin), end}) {
            SCOPED_TRACE(name(static_cast<Family>(f)) + " " + std::to_string(i));
            expect_agreement(pieces[k], path, t);
          }
        }
      }
    }
  }
}

Pose pose(const PoseInput& p) {
  return {{p.position.x, p.position.y, p.position.z},
          {p.rotation.w, p.rotation.x, p.rotation.y, p.rotation.z}};
}

Eigen::Vector3d plain(const Vector3<double>& v) { return {v.x, v.y, v.z}; }

/// The exact motion of P while the body turns about Q, which the translation moves.
MotionPiece about_pivot(const MotionInput& input, const Vector3<double>& p_BQ,
                        const Vector3<double>& p_BP, double t_begin, double t_end) {
  const MotionPiece of_pivot = motion_pieces(input, p_BQ).at(0);
  MotionPiece piece = motion_pieces(input, p_BP).at(0);
  piece.pivot = piece.pivot + of_pivot.lever;
  piece.lever = piece.lever - of_pivot.lever;
  piece.t_begin = t_begin;
  piece.t_end = t_end;
  return piece;
}

TEST(ConstantRatePath, TurnsAboutAnyPointOfTheBody) {
  std::size_t tested = 0;
  for (int f = 0; f < kFamilyCount; ++f) {
    for (std::uint64_t i = 0; i < 50; ++i) {
      const GeneratedCase c = generate(static_cast<Family>(f), i);
      if (c.A.motion.kind != MotionKind::constant_velocity ||
          c.B.motion.kind != MotionKind::constant_velocity) {
        continue;
      }
      ++tested;
      const Vector3<double>& p_BQ = c.A.vertices[1];
      const Vector3<double>& p_BP = c.A.vertices[0];
      const auto piece = [](const MotionInput& m, double t_end) {
        return ConstantRatePiece{t_end, pose(m.poses[0]), plain(m.translation),
                                 plain(m.rotation_vector)};
      };
      const std::vector<ConstantRatePiece> pieces{piece(c.A.motion, 0.3), piece(c.B.motion, 1.0)};
      const Motion motion = Motion::constant_rates(pieces, plain(p_BQ));
      for (const double t : {0.0, 0.1, 0.3}) {
        expect_agreement(about_pivot(c.A.motion, p_BQ, p_BP, 0.0, 0.3), motion.path(0, plain(p_BP)),
                         t);
      }
      for (const double t : {0.3, 0.7, 1.0}) {
        expect_agreement(about_pivot(c.B.motion, p_BQ, p_BP, 0.3, 1.0), motion.path(1, plain(p_BP)),
                         t);
      }
    }
  }
  EXPECT_GT(tested, 50u);
}

TEST(Motion, RefusesPiecesThatDoNotFollowEachOther) {
  const auto until = [](double t_end) { return ConstantRatePiece{t_end, {}}; };
  const auto make = [](const std::vector<ConstantRatePiece>& pieces) {
    return Motion::constant_rates(pieces);
  };
  EXPECT_THROW(make({}), std::invalid_argument);
  EXPECT_THROW(make({until(0.5)}), std::invalid_argument);
  EXPECT_THROW(make({until(0.5), until(0.5), until(1.0)}), std::invalid_argument);
  EXPECT_THROW(make({{1.0, {}, {0.0, std::nan(""), 0.0}}}), std::invalid_argument);
  EXPECT_NO_THROW(make({until(0.5), until(1.0)}));
}

/// Else an error of infinity would pass.
TEST(ConstantRatePath, StatesSmallErrors) {
  Motion motion = Motion::screw({{1.0, 2.0, 3.0}, {0.5, 0.5, 0.1, 0.2}},
                                {{2.0, 1.0, 0.0}, {0.1, 0.9, 0.3, 0.4}});
  const ConstantRatePath path = motion.path(0, {0.3, 0.2, 0.1});
  EXPECT_LE(path.position_error(), 1e-26);
  EXPECT_LE(path.rotation_error(), 1e-26);
}

}  // namespace
}  // namespace firstcontact::oracle
