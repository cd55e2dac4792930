/// @file
/// Many redundant contacts, of which a few decide the answer.

#pragma once

#include <firstcontact/dynamics/contact_problem.h>
#include <firstcontact/dynamics/detail/contact_rows.h>

namespace firstcontact::detail {

/// A nut lies on its thread in thousands of contacts, and has six velocities. The laws are solved
/// for those with an impulse; of the rest, those that the answer violates most join them, until
/// none is violated: a contact without impulse that does not close meets all laws. So the answer is
/// one of the whole problem, friction included (a cutting-plane method: J. E. Kelley, Journal of
/// SIAM 8 (1960)).
///
/// @param rows        of the problem
/// @param projection  where to start from; afterwards nearer to the laws, if it changed
/// @return whether the laws are met, within the tolerance or what is enough
[[nodiscard]] bool project_by_deciding_contacts(const ContactProblem& problem,
                                                const ContactRows& rows,
                                                const ProjectionOptions& options,
                                                Projection& projection);

}  // namespace firstcontact::detail
