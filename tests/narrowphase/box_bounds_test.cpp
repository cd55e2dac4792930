// The bounds of boxes in single precision, for every instruction set that this processor has,
// against where the boxes really are.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/motion/constant_rate_pair.h>
#include <firstcontact/moving_pairs/detail/moving_pair.h>
#include <firstcontact/narrowphase/detail/box_bounds.h>

#include "query/moving_boxes.h"
#include "support/instruction_sets.h"

namespace firstcontact::detail {
namespace {

using test::Approach;
using test::MovingBoxes;
using test::Random;
using test::random_deforming_boxes;
using test::random_drifting_boxes;
using test::random_moving_boxes;
using test::Real;
using test::real_box;
using test::RealBox;
using test::RealVector;

/// By how much the motion of boxes may depart from its model.
struct Departure {
  double drift = 0.0;                         // [m per step]
  double bend = 0.0;                          // [m per step^2]
  std::array<double, 2> bend_per_metre = {};  // [per step^2]  From the pivots of A and B.
};

BoxFrame frame_of(const MovingBoxes& c, const Departure& departure = {}) {
  const Motion A = c.A.motion();
  const Motion B = c.B.motion();
  ConstantRatePair motion(A, B, c.A.hierarchy.centre, c.B.hierarchy.centre, 1e-6);
  motion.enter(c.t);
  const MovingPair pair(c.A.hierarchy, c.B.hierarchy, motion);
  RelativeState state = motion.state(c.t);
  state.drift += departure.drift;
  state.bend += departure.bend;
  state.bend_A += departure.bend_per_metre[0];
  state.bend_B += departure.bend_per_metre[1];
  BoxFrame frame = pair.box_frame();
  pair.place(state, c.threshold + pair.gap_error(state), frame);
  frame.horizon = static_cast<float>(1.0 - c.t);
  return frame;
}

struct Bounds : BoxBounds {
  double unit = 1.0;  // [m]
};

Bounds bounds_of(const MovingBoxes& c) {
  Bounds bounds;
  bounds.unit = std::max(c.A.hierarchy.unit, c.B.hierarchy.unit);
  if (c.A.hierarchy.deforms() || c.B.hierarchy.deforms()) {
    bound_deforming_boxes(frame_of(c), c.A.node(), c.A.node_to(), c.B.node(), c.B.node_to(),
                          bounds);
  } else {
    bound_boxes(frame_of(c), c.A.node(), c.B.node(), bounds);
  }
  return bounds;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

using BoxBoundsOn = test::OnInstructionSet;

// Sound: until the bound has passed, the boxes are farther apart than the threshold.
template <class Cases>
void expect_never_late(Random random, const Cases& cases) {
  for (int trial = 0; trial < 1500; ++trial) {
    const MovingBoxes c = cases(random);
    const Bounds bounds = bounds_of(c);
    for (int lane = 0; lane < 16; ++lane) {
      const Real proven = std::min<Real>(bounds.time[lane], 1.0L - c.t);
      if (!(proven > 0.0L)) {
        continue;
      }
      for (const double part : {1.0, random.uniform(0.0, 1.0), random.uniform(0.9, 1.0)}) {
        ASSERT_GT(c.distance(lane / 4, lane % 4, c.t + part * proven), c.threshold)
            << "trial " << trial << ", lane " << lane << ", part " << part;
      }
    }
  }
}

TEST_P(BoxBoundsOn, TimeIsNeverLate) {
  expect_never_late(Random(1), [](Random& random) { return random_moving_boxes(random); });
}

TEST_P(BoxBoundsOn, TimeIsNeverLateForBoxesThatDeform) {
  expect_never_late(Random(11), random_deforming_boxes);
  expect_never_late(Random(15), random_drifting_boxes);
}

TEST_P(BoxBoundsOn, GapIsNeverAboveTheDistance) {
  Random random(2);
  for (int trial = 0; trial < 3000; ++trial) {
    const MovingBoxes c = random_moving_boxes(random);
    const Bounds bounds = bounds_of(c);
    for (int lane = 0; lane < 16; ++lane) {
      ASSERT_LE(bounds.gap[lane] * Real{bounds.unit}, c.distance(lane / 4, lane % 4, c.t))
          << "trial " << trial << ", lane " << lane;
    }
  }
}

TEST_P(BoxBoundsOn, GapIsNeverAboveTheDistanceOfBoxesThatDeform) {
  Random random(12);
  for (int trial = 0; trial < 3000; ++trial) {
    const MovingBoxes c = random_deforming_boxes(random);
    const Bounds bounds = bounds_of(c);
    for (int lane = 0; lane < 16; ++lane) {
      ASSERT_LE(bounds.gap[lane] * Real{bounds.unit}, c.distance(lane / 4, lane % 4, c.t))
          << "trial " << trial << ", lane " << lane;
    }
  }
}

/// Boxes whose motion may depart from its model.
struct Departing {
  MovingBoxes boxes;
  Departure by;

  /// [m]  From the body's pivot to the corner that is farthest from it: the place on its axis
  /// beside its centre, or its centre where it does not turn.
  [[nodiscard]] Real reach(const test::Body& body, int slot) const {
    const bool turns = !body.rotation_vector.isZero(0.0);
    const RealVector axis = body.rotation_vector.cast<Real>().normalized();
    const RealVector lever = (body.rotation.normalized() * body.hierarchy.centre).cast<Real>();
    const RealVector pivot = body.position.cast<Real>() + boxes.t * body.translation.cast<Real>() +
                             (turns ? RealVector(axis.dot(lever) * axis) : lever);
    const RealBox box = real_box(body, slot, boxes.t, pivot);
    Real most = 0.0L;
    for (int corner = 0; corner < 8; ++corner) {
      const RealVector sign((corner & 1) != 0 ? 1.0L : -1.0L, (corner & 2) != 0 ? 1.0L : -1.0L,
                            (corner & 4) != 0 ? 1.0L : -1.0L);
      most = std::max(most, (box.centre + box.axes * box.extent.cwiseProduct(sign)).norm());
    }
    return most;
  }

  [[nodiscard]] Real bend_of(int i, int j) const {
    return by.bend + by.bend_per_metre[0] * reach(boxes.A, i) +
           by.bend_per_metre[1] * reach(boxes.B, j);
  }

  /// The least distance that is left of that of the model, tau after the case's time.
  [[nodiscard]] Real distance(int i, int j, Real tau) const {
    return boxes.distance(i, j, boxes.t + tau) - by.drift * tau - 0.5L * bend_of(i, j) * tau * tau;
  }
};

/// Departures that close the gap of the first boxes in about the time left, some sooner.
Departing departing(Random& random, const MovingBoxes& boxes) {
  const auto gap = static_cast<double>(boxes.distance(0, 0, boxes.t)) - boxes.threshold;
  const double left = std::max(1.0 - boxes.t, 1e-3);
  const double scale = std::max(gap, 0.0) / left;
  Departing c{
      boxes,
      {scale * random.logarithmic(0.01, 10.0), scale / left * random.logarithmic(0.01, 10.0)}};
  const test::Body* const bodies[] = {&boxes.A, &boxes.B};
  for (std::size_t k = 0; k < 2; ++k) {
    c.by.bend_per_metre[k] = scale / left * random.logarithmic(0.01, 10.0) /
                             std::max(static_cast<double>(c.reach(*bodies[k], 0)), 1e-300);
  }
  return c;
}

Bounds bounds_departing(const Departing& c) {
  Bounds bounds;
  bounds.unit = std::max(c.boxes.A.hierarchy.unit, c.boxes.B.hierarchy.unit);
  const BoxFrame frame = frame_of(c.boxes, c.by);
  bound_boxes(frame, c.boxes.A.node(), c.boxes.B.node(), bounds);
  return bounds;
}

// Sound: nothing that the motion may depart by from its model brings the boxes together.
TEST_P(BoxBoundsOn, TimeIsNeverLateForMotionsThatDepartFromTheirModels) {
  Random random(21);
  for (int trial = 0; trial < 1500; ++trial) {
    const Departing c = departing(random, random_moving_boxes(random));
    const Bounds bounds = bounds_departing(c);
    for (int lane = 0; lane < 16; ++lane) {
      const Real proven = std::min<Real>(bounds.time[lane], 1.0L - c.boxes.t);
      if (!(proven > 0.0L)) {
        continue;
      }
      for (const double part : {1.0, random.uniform(0.0, 1.0), random.uniform(0.9, 1.0)}) {
        ASSERT_GT(c.distance(lane / 4, lane % 4, part * proven), c.boxes.threshold)
            << "trial " << trial << ", lane " << lane << ", part " << part;
      }
    }
  }
}

// Tight: without turning, most pairs are let go for nearly as long as departures leave them.
TEST_P(BoxBoundsOn, TimeIsMostOfWhatDeparturesLeave) {
  Random random(22);
  std::vector<double> ratios;
  for (int trial = 0; trial < 3000; ++trial) {
    const Departing c = departing(random, random_moving_boxes(random, Approach::straight));
    const Real gap = c.distance(0, 0, 0.0L) - c.boxes.threshold;
    const Real most = (c.boxes.B.translation - c.boxes.A.translation).cast<Real>().norm() +
                      c.by.drift + c.bend_of(0, 0) * (1.0L - c.boxes.t);
    Real tau = 0.0L;
    for (int i = 0; i < 2000 && gap > 0.0L && c.boxes.t + tau < 1.0L; ++i) {
      const Real left = c.distance(0, 0, tau) - c.boxes.threshold;
      if (left <= 1e-3L * gap) {
        ratios.push_back(static_cast<double>(bounds_departing(c).time[0] / tau));
        break;
      }
      tau += left / most;
    }
  }
  ASSERT_GT(ratios.size(), 500u);
  RecordProperty("median_ratio", std::to_string(median(ratios)));
  EXPECT_GT(median(ratios), 0.6);
}

// A law: boxes that stay as they are do not deform.
TEST_P(BoxBoundsOn, BoxesThatDeformByNothingAreRigid) {
  Random random(13);
  for (int trial = 0; trial < 1000; ++trial) {
    const MovingBoxes c = random_moving_boxes(random);
    BoxBounds rigid;
    BoxBounds bounds;
    bound_boxes(frame_of(c), c.A.node(), c.B.node(), rigid);
    bound_deforming_boxes(frame_of(c), c.A.node(), c.A.node(), c.B.node(), c.B.node(), bounds);
    for (int lane = 0; lane < 16; ++lane) {
      ASSERT_NEAR(bounds.gap[lane], rigid.gap[lane], 1e-5) << trial << ", " << lane;
    }
  }
}

// A law: two pairs of nodes at once are bounded as they are one by one, bit for bit, as a search
// must not depend on what happened to be bounded along with a pair.
TEST_P(BoxBoundsOn, TwoAtOnceAreAsOneByOne) {
  Random random(29);
  for (int trial = 0; trial < 1000; ++trial) {
    const MovingBoxes c = random_moving_boxes(random);
    const MovingBoxes other = random_moving_boxes(random);
    const BoxFrame frame = frame_of(c);
    const auto compare = [&](const BoxBounds& x, const BoxBounds& y) {
      for (int lane = 0; lane < 16; ++lane) {
        ASSERT_EQ(x.time[lane], y.time[lane]) << trial << ", " << lane;
        ASSERT_EQ(x.gap[lane], y.gap[lane]) << trial << ", " << lane;
      }
      ASSERT_EQ(x.live, y.live) << trial;
      ASSERT_EQ(x.far, y.far) << trial;
      ASSERT_EQ(x.larger_a, y.larger_a) << trial;
      ASSERT_EQ(x.larger_b, y.larger_b) << trial;
      ASSERT_EQ(x.unsure, y.unsure) << trial;
    };
    BoxBounds first;
    BoxBounds second;
    bound_boxes(frame, c.A.node(), c.B.node(), first);
    bound_boxes(frame, other.A.node(), other.B.node(), second);
    BoxBounds first_of_two;
    BoxBounds second_of_two;
    bound_boxes(frame, c.A.node(), c.B.node(), first_of_two, other.A.node(), other.B.node(),
                second_of_two);
    compare(first_of_two, first);
    compare(second_of_two, second);
  }
}

// Sound: also where only a part of the step is asked about, and extents are followed for that.
TEST_P(BoxBoundsOn, TimeIsNeverLateWithinAShorterHorizon) {
  Random random(23);
  for (int trial = 0; trial < 1500; ++trial) {
    const MovingBoxes c = random_moving_boxes(random);
    BoxFrame frame = frame_of(c);
    frame.horizon *= static_cast<float>(random.logarithmic(1e-6, 1.0));
    BoxBounds bounds;
    bound_boxes(frame, c.A.node(), c.B.node(), bounds);
    for (int lane = 0; lane < 16; ++lane) {
      ASSERT_LE(bounds.time[lane], frame.horizon) << "trial " << trial << ", lane " << lane;
      const Real proven = std::min<Real>(bounds.time[lane], 1.0L - c.t);
      for (const double part : {1.0, random.uniform(0.0, 1.0)}) {
        ASSERT_TRUE(proven == 0.0L ||
                    c.distance(lane / 4, lane % 4, c.t + part * proven) > c.threshold)
            << "trial " << trial << ", lane " << lane << ", part " << part;
      }
    }
  }
}

/// A box that tilts above a wide face, in closed form: its lowest corner is as near as its extent
/// along the face's normal says.
struct Tilting {
  MovingBoxes boxes;

  [[nodiscard]] const test::Body& body() const {
    return boxes.A.rotation_vector.isZero(0.0) ? boxes.B : boxes.A;
  }
  /// [m per step]  No corner is faster.
  [[nodiscard]] Real speed() const {
    const Real extent = real_box(body(), 0, boxes.t, RealVector::Zero()).extent.norm();
    return body().rotation_vector.norm() * extent;
  }
  /// [m]  That is left above the threshold.
  [[nodiscard]] Real left(Real at) const {
    const RealVector origin = boxes.A.position.cast<Real>();
    const RealBox box = real_box(body(), 0, at, origin);
    const RealBox face = real_box(&body() == &boxes.A ? boxes.B : boxes.A, 0, at, origin);
    const RealVector n = face.axes.col(0);
    const Real extent = box.extent.dot((box.axes.transpose() * n).cwiseAbs());
    return std::abs(n.dot(box.centre - face.centre)) - face.extent[0] - extent - boxes.threshold;
  }
};

// Sound, with no room to spare: where only the time that a box has is asked about, the chord to
// there is nearly its extent.
TEST_P(BoxBoundsOn, TimeIsNeverLateForBoxesThatTilt) {
  Random random(24);
  for (int trial = 0; trial < 3000; ++trial) {
    const Tilting c{random_moving_boxes(random, Approach::tilting)};
    BoxFrame frame = frame_of(c.boxes);
    BoxBounds bounds;
    bound_boxes(frame, c.boxes.A.node(), c.boxes.B.node(), bounds);
    for (int round = 0; round < 3; ++round) {
      const Real proven = std::min<Real>(bounds.time[0], 1.0L - c.boxes.t);
      ASSERT_TRUE(proven == 0.0L || c.left(c.boxes.t + proven) > 0.0L)
          << "trial " << trial << ", round " << round;
      frame.horizon = std::min(frame.horizon, 1.2f * bounds.time[0] + 1e-6f);
      bound_boxes(frame, c.boxes.A.node(), c.boxes.B.node(), bounds);
    }
  }
}

// Tight: boxes that are asked about for twice the time that they have are let go for most of it;
// taken for their balls, as those of bodies that deform are, for less.
TEST_P(BoxBoundsOn, TimeIsMostOfTheTimeToContactOfBoxesThatTilt) {
  Random random(25);
  std::vector<double> boxes;
  std::vector<double> balls;
  for (int trial = 0; trial < 9000; ++trial) {
    const Tilting c{random_moving_boxes(random, Approach::tilting)};
    const auto& [A, B, t, threshold] = c.boxes;
    const Real open = c.left(t);
    const Real most = 0.2L / c.body().rotation_vector.norm();  // A fifth of a radian.
    Real tau = 0.0L;
    for (int i = 0; i < 1000 && tau < most && c.left(t + tau) > 1e-3L * open; ++i) {
      tau += c.left(t + tau) / c.speed();
    }
    // That the gap is wide enough to be seen in single precision.
    const Bounds seen = bounds_of(c.boxes);
    const bool is_seen = seen.gap[0] * Real{seen.unit} - threshold > 0.9L * open;
    if (!is_seen || tau > std::min(most, 1.0L - t)) {
      continue;
    }
    BoxFrame frame = frame_of(c.boxes);
    frame.horizon = std::min(frame.horizon, static_cast<float>(2.0L * tau));
    BoxBounds bounds;
    bound_boxes(frame, A.node(), B.node(), bounds);
    boxes.push_back(static_cast<double>(bounds.time[0] / tau));
    bound_deforming_boxes(frame, A.node(), A.node(), B.node(), B.node(), bounds);
    balls.push_back(static_cast<double>(bounds.time[0] / tau));
  }
  ASSERT_GT(boxes.size(), 300u);
  RecordProperty("median_ratio", std::to_string(median(boxes)));
  RecordProperty("median_ratio_of_balls", std::to_string(median(balls)));
  EXPECT_GT(median(boxes), 0.6);
  EXPECT_GT(median(boxes), 1.2 * median(balls));
}

// Tight: where nothing turns, boxes that deform are let go for most of the time that they have.
TEST_P(BoxBoundsOn, TimeIsMostOfTheTimeToContactOfBoxesThatDeform) {
  Random random(14);
  std::vector<double> ratios;
  for (int trial = 0; trial < 3000; ++trial) {
    MovingBoxes c = random_deforming_boxes(random);
    c.A.rotation_vector.setZero();
    c.B.rotation_vector.setZero();
    const Real enough = c.threshold + 1e-4L * (c.distance(0, 0, c.t) - c.threshold);
    Real speed = (c.B.translation - c.A.translation).cast<Real>().norm();
    speed += c.A.hierarchy.deformation_speed + c.B.hierarchy.deformation_speed;
    Real at = c.t;
    for (int i = 0; i < 1000 && at < 1.0L && enough > c.threshold; ++i) {
      const Real distance = c.distance(0, 0, at);
      if (distance <= enough) {
        ratios.push_back(static_cast<double>(bounds_of(c).time[0] / (at - c.t)));
        break;
      }
      at += (distance - c.threshold) / speed;
    }
  }
  ASSERT_GT(ratios.size(), 200u);
  RecordProperty("median_ratio", std::to_string(median(ratios)));
  EXPECT_GT(median(ratios), 0.6);
}

// Tight: without turning, most pairs are let go for nearly as long as they have.
TEST_P(BoxBoundsOn, TimeIsMostOfTheTimeToContact) {
  Random random(3);
  std::vector<double> ratios;
  for (int trial = 0; trial < 3000; ++trial) {
    const MovingBoxes c = random_moving_boxes(random, Approach::straight);
    const Real speed = (c.B.translation - c.A.translation).cast<Real>().norm();
    // Conservative advancement, until the gap no longer matters.
    Real at = c.t;
    const Real enough = c.threshold + 1e-4L * (c.distance(0, 0, at) - c.threshold);
    if (!(enough > c.threshold)) {
      continue;  // In contact from the start.
    }
    for (int i = 0; i < 1000 && at < 1.0L; ++i) {
      const Real distance = c.distance(0, 0, at);
      if (distance <= enough) {
        ratios.push_back(static_cast<double>(bounds_of(c).time[0] / (at - c.t)));
        break;
      }
      at += (distance - c.threshold) / speed;
    }
  }
  ASSERT_GT(ratios.size(), 500u);
  RecordProperty("median_ratio", std::to_string(median(ratios)));
  EXPECT_GT(median(ratios), 0.6);
}

TEST_P(BoxBoundsOn, GapIsMostOfTheDistance) {
  Random random(4);
  std::vector<double> ratios;
  for (int trial = 0; trial < 3000; ++trial) {
    const MovingBoxes c = random_moving_boxes(random);
    const Real distance = c.distance(0, 0, c.t);
    const Bounds bounds = bounds_of(c);
    if (distance > 0.0L) {
      ratios.push_back(static_cast<double>(bounds.gap[0] * Real{bounds.unit} / distance));
    }
  }
  RecordProperty("median_ratio", std::to_string(median(ratios)));
  EXPECT_GT(median(ratios), 0.6);
}

// A law, up to rounding: each pair of boxes, whichever body is named first.
TEST_P(BoxBoundsOn, IsTheSameForSwappedBodies) {
  Random random(5);
  for (int trial = 0; trial < 1000; ++trial) {
    const MovingBoxes c = random_moving_boxes(random);
    const Bounds bounds = bounds_of(c);
    const Bounds swapped = bounds_of({c.B, c.A, c.t, c.threshold});
    const RealVector origin = c.A.position.cast<Real>();
    const RealVector first_A = real_box(c.A, 0, c.t, origin).centre;
    const RealVector first_B = real_box(c.B, 0, c.t, origin).centre;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        const RealBox a = real_box(c.A, i, c.t, origin);
        const RealBox b = real_box(c.B, j, c.t, origin);
        const Real length = (a.centre - first_A).norm() + (b.centre - first_B).norm() +
                            (a.centre - b.centre).norm() + a.extent.norm() + b.extent.norm();
        ASSERT_NEAR(bounds.gap[4 * i + j], swapped.gap[4 * j + i],
                    0x1p-11 * static_cast<double>(length / bounds.unit))
            << "trial " << trial << ", boxes " << i << ", " << j;
      }
    }
  }
}

TEST_P(BoxBoundsOn, FlagsSayWhatTheNumbersSay) {
  Random random(6);
  for (int trial = 0; trial < 1000; ++trial) {
    const MovingBoxes c = random_moving_boxes(random);
    const Bounds bounds = bounds_of(c);
    const float horizon = frame_of(c).horizon;
    for (int lane = 0; lane < 16; ++lane) {
      const auto flag = [lane](std::uint16_t bits) { return (bits >> lane & 1) != 0; };
      const Real a = real_box(c.A, lane / 4, c.t, RealVector::Zero()).extent.norm();
      const Real b = real_box(c.B, lane % 4, c.t, RealVector::Zero()).extent.norm();
      ASSERT_TRUE(flag(bounds.live) || bounds.time[lane] >= horizon) << trial << ", " << lane;
      ASSERT_FALSE(flag(bounds.larger_a) && flag(bounds.larger_b)) << trial << ", " << lane;
      ASSERT_TRUE(flag(bounds.larger_a) || a < 1.51L * b) << trial << ", " << lane;
      ASSERT_TRUE(flag(bounds.larger_b) || b < 1.51L * a) << trial << ", " << lane;
    }
  }
}

// A number that is NaN proves nothing.
TEST_P(BoxBoundsOn, NothingIsProvenOfNaN) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  Random random(7);
  for (int field = 0; field < 11; ++field) {
    const MovingBoxes c = random_moving_boxes(random, Approach::any);
    BoxFrame frame = frame_of(c);
    double* const doubles[] = {&frame.rotation[1][4], &frame.origin[1][0], &frame.ratio[0]};
    float* const floats[] = {
        &frame.spin[1][1], &frame.rate[0], &frame.velocity[1][2],      &frame.threshold,
        &frame.drift,      &frame.bend,    &frame.bend_by_distance[0], &frame.bend_by_distance[1]};
    if (field < 3) {
      *doubles[field] = kNaN;
    } else {
      *floats[field - 3] = static_cast<float>(kNaN);
    }
    BoxBounds bounds;
    bound_boxes(frame, c.A.node(), c.B.node(), bounds);
    EXPECT_EQ(bounds.live, 0xffff) << "field " << field;
    for (int lane = 0; lane < 16; ++lane) {
      EXPECT_EQ(bounds.time[lane], 0.0f) << "field " << field << ", lane " << lane;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, BoxBoundsOn, testing::ValuesIn(test::instruction_sets()),
                         test::instruction_set_name);

}  // namespace
}  // namespace firstcontact::detail
