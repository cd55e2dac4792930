/// @file
/// First contact of many moving bodies.

#pragma once

#include <functional>
#include <memory>
#include <vector>

#include <firstcontact/many_bodies/body_set.h>
#include <firstcontact/many_bodies/scene_result.h>
#include <firstcontact/math/export.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact {

/// The options of queries of many bodies.
struct ManyBodiesOptions {
  FirstContactOptions pair;  ///< Options of every pair; `margin` is not used, as the rules have it.
  int threads = 0;           ///< Most threads; 0 for one on each core. Answers do not depend on it.
  bool closest = false;  ///< Also finds the closest approach of each pair; for answer_each_pair().
  /// Also finds every interval of contact of each pair; for answer_each_pair().
  bool all_contacts_in_time = false;
  /// [-]  Resolution of the intervals, see ContactInterval; in (0, 1].
  double time_resolution = 1e-3;
  /// Called now and then from the calling thread with the fraction that is done, in [0, 1]. For
  /// first_contact that is the time proven free so far. May be empty.
  std::function<void(double)> progress = {};
};

/// Scratch memory of the many-body queries, for all their threads.
class FIRSTCONTACT_API ManyBodiesWorkspace {
 public:
  ManyBodiesWorkspace();
  ~ManyBodiesWorkspace();
  ManyBodiesWorkspace(ManyBodiesWorkspace&&) noexcept;
  ManyBodiesWorkspace& operator=(ManyBodiesWorkspace&&) noexcept;

  struct Data;
  [[nodiscard]] Data& data() { return *data_; }

 private:
  std::unique_ptr<Data> data_;
};

/// Finds the first contact of all pairs of bodies that the rules do not ignore.
///
/// Before t every pair is farther apart than its margin: proven, as by first_contact() of two
/// bodies. The result is the same on every run and for every number of threads. The budget holds
/// for each pair.
///
/// Method: first_contact() of two bodies answers for the pairs that balls around the bodies cannot
/// prove free. The time is walked in intervals, halved where the bodies sweep over many others.
/// Within an interval, pairs come in the order of the times until which they are proven free. The
/// first contact found ends the search of pairs that cannot touch before it.
///
/// @returns the pairs that determine t; all but their contacts holds for all pairs
/// @throws std::invalid_argument if an option is outside its documented range.
[[nodiscard]] FIRSTCONTACT_API SceneResult first_contact(const BodySet& bodies,
                                                         ManyBodiesWorkspace& workspace,
                                                         const ManyBodiesOptions& options = {});

/// Answers every pair that the rules do not ignore, over the whole step, in their order.
///
/// Each answer is as if that pair were queried alone.
[[nodiscard]] FIRSTCONTACT_API std::vector<PairAnswer> answer_each_pair(
    const BodySet& bodies, ManyBodiesWorkspace& workspace, const ManyBodiesOptions& options = {});

}  // namespace firstcontact
