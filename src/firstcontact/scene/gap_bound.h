/// @file
/// A proven lower bound of a scene's gap at all times, from samples of it.

#pragma once

#include <span>
#include <vector>

#include <firstcontact/math/export.h>

namespace firstcontact {

class BodySet;
struct GapSample;
struct LoadedScene;
struct SceneResult;

/// A corner of a polyline over time.
struct GapPoint {
  double t = 0.0;         ///< [-]  Normalised to the scene's duration.
  double distance = 0.0;  ///< [m]
};

/// [m per step]  A bound of the rate at which any distance of two bodies of the set changes.
///
/// It is the sum of the two greatest speeds of any of their points.
[[nodiscard]] FIRSTCONTACT_API double greatest_gap_rate(const BodySet& bodies);

/// Bounds the gap of the scene by a polyline: proven, at no time is the gap below it.
///
/// Around each sample the gap is at least its lower bound less the greatest rate times the time
/// between (a Lipschitz bound). Before the result's t the gap is at least the result's clearance.
/// Samples that are close together make the bound tight. In a scene with robots the bound is the
/// clearance until the result's t, and 0 from then on.
///
/// @param samples  samples of this scene, at increasing times
/// @returns nothing where no pair is tested
[[nodiscard]] FIRSTCONTACT_API std::vector<GapPoint> gap_lower_bound(
    const LoadedScene& loaded, const SceneResult& result, std::span<const GapSample> samples);

}  // namespace firstcontact
