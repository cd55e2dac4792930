/// @file
/// Queries of two links that share scratch memory with others.

#pragma once

#include <firstcontact/query/detail/pair_query.h>
#include <firstcontact/robot/link_path.h>
#include <firstcontact/robot_check/detail/hull_approach.h>
#include <firstcontact/robot_check/link_contact.h>

namespace firstcontact::detail {

/// Memory that queries of links reuse; each thread needs its own.
struct LinkWorkspace {
  Workspace queries;
  LinkScratch places;
};

void first_contact(const MovingLink& A, const MovingLink& B, const TimeWindow& window,
                   LinkWorkspace& workspace, const FirstContactOptions& options,
                   FirstContactResult& result);

/// Finds the first contact as detail::first_contact_early() of a pair of shapes, from where their
/// hulls come near.
///
/// It sets the verdict, the reason and the times, but no contacts.
void first_contact_early(const MovingLink& A, const MovingLink& B, const ShapeHull& hull_A,
                         const ShapeHull& hull_B, const TimeWindow& window, double early,
                         LinkWorkspace& workspace, const FirstContactOptions& options,
                         FirstContactResult& result);

/// Whether one of the two is provably in the other at t: see has_vertex_inside().
[[nodiscard]] bool has_vertex_inside(const MovingLink& A, const MovingLink& B,
                                     const ShapeHull& hull_A, const ShapeHull& hull_B, double t,
                                     LinkWorkspace& workspace);

/// Finds the first contact as detail::first_contact_held() of a pair of shapes.
void first_contact_held(const MovingLink& A, const MovingLink& B, const TimeWindow& window,
                        const Hold& hold, LinkWorkspace& workspace,
                        const FirstContactOptions& options, FirstContactResult& result);

/// Finds the gap as detail::start_gap() of a pair of shapes.
[[nodiscard]] StartGap start_gap(const MovingLink& A, const MovingLink& B, double t,
                                 LinkWorkspace& workspace, const FirstContactOptions& options,
                                 WorkCount& work);

[[nodiscard]] DistanceResult distance(const MovingLink& A, const MovingLink& B, double t,
                                      LinkWorkspace& workspace);

}  // namespace firstcontact::detail
