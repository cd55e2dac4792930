/// @file
/// Whether two shapes have met, by a few of their triangles near a known direction.

#pragma once

#include <firstcontact/motion/relative_state.h>
#include <firstcontact/narrowphase/convex_closest.h>
#include <firstcontact/robot_check/detail/hull_approach.h>

namespace firstcontact::detail {

/// Whether two shapes, of which one is a convex set, have provably met until a state.
///
/// The hulls were farther apart than the threshold some time before. Then the shapes are no farther
/// apart than threshold + tolerance at the state, or were so in between. False says nothing.
///
/// Derivation: take a triangle of the one shape, or its set, and the set of the other. Their
/// distance changes continuously, and was above the threshold. At the state two points of them are
/// within threshold + tolerance. So at some time until then the distance was positive and no more
/// than that, or it was 0 for the first time. The nearest point of the set is then on its boundary,
/// which is the surface of that shape.
///
/// @param near       the end of the last search for closest points of both hulls
/// @param threshold  [m]  thickenings of the shapes included
[[nodiscard]] bool have_met(const ShapeHull& A, const ShapeHull& B, const RelativeState& state,
                            const ConvexGuess& near, double threshold, double tolerance);

/// Whether a vertex of one shape is provably inside of the other, a solid box or cylinder. False
/// says nothing.
[[nodiscard]] bool has_vertex_inside(const ShapeHull& A, const ShapeHull& B,
                                     const RelativeState& state);

}  // namespace firstcontact::detail
