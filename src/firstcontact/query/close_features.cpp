#include <firstcontact/query/close_features.h>

#include <cassert>
#include <cmath>
#include <stdexcept>
#include <string>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/math/number_text.h>
#include <firstcontact/query/detail/contact_state.h>
#include <firstcontact/query/detail/front_query.h>
#include <firstcontact/query/detail/order.h>
#include <firstcontact/query/detail/resting_pair.h>

namespace firstcontact {
namespace {

void require(bool condition, const char* what, double value) {
  if (!condition) {
    throw std::invalid_argument(std::string("close_features: ") + what + ", got " +
                                detail::shortest(value));
  }
}

void require_band(double band, double beside) {
  require(band >= 0.0 && std::isfinite(band), "band must be finite and >= 0", band);
  require(beside >= 0.0 && std::isfinite(beside), "beside must be finite and >= 0", beside);
}

/// The distance that is asked for, and the choice among many pairs.
struct Asked {
  double band;    // [m]
  double beside;  // [m]
};

/// Collects the close features of a pair at t.
///
/// @param pair  of the motion of the centres, entered at t
void collect(const Shape& A, const Shape& B, const detail::MovingPair& pair, double t,
             const Asked& asked, Workspace& workspace, std::vector<Contact>& contacts) {
  const detail::ContactFrame frame{A, B, pair, t, pair.motion().origin(t), asked.beside};
  detail::collect_contacts(frame, A.radius() + B.radius() + asked.band, ContactState::all.most,
                           workspace.data(), contacts);
}

/// Calls collect(first, second) in the order of the bodies' content.
template <class Body, class Collect>
void collect_in_order(const Body& A, const Body& B, bool in_order, std::vector<Contact>& contacts,
                      const Collect& collect) {
  contacts.clear();
  if (in_order) {
    collect(A, B);
    return;
  }
  collect(B, A);
  for (Contact& contact : contacts) {
    swap_bodies(contact);
  }
}

/// Collects the close features of two shapes at rest.
///
/// @param pair_of  makes the moving pair of two shapes and a motion
template <class PairOf>
void collect_at_rest(const PlacedShape& A, const PlacedShape& B, const Asked& asked,
                     Workspace& workspace, std::vector<Contact>& contacts, const PairOf& pair_of) {
  require_band(asked.band, asked.beside);
  assert(!A.shape().hierarchy().deforms() && !B.shape().hierarchy().deforms());
  const FloatEnvironmentGuard guard;
  const bool in_order = detail::in_order({A.shape(), A.motion()}, {B.shape(), B.motion()});
  collect_in_order(
      A, B, in_order, contacts, [&](const PlacedShape& first, const PlacedShape& second) {
        const detail::RestingPair motion(first.path(), second.path());
        collect(first.shape(), second.shape(), pair_of(first.shape(), second.shape(), motion), 0.0,
                asked, workspace, contacts);
      });
}

}  // namespace

void close_features(const MovingShape& A, const MovingShape& B, double t, double band,
                    Workspace& workspace, std::vector<Contact>& contacts, double beside) {
  require(t >= 0.0 && t <= 1.0, "t must lie in [0, 1]", t);
  require_band(band, beside);
  const FloatEnvironmentGuard guard;
  collect_in_order(
      A, B, detail::in_order(A, B), contacts,
      [&](const MovingShape& first, const MovingShape& second) {
        const double resolution =
            1e-14 * (first.shape.hierarchy().radius + second.shape.hierarchy().radius);
        ConstantRatePair motion = detail::motion_of(first, second, resolution);
        motion.enter(t);
        const detail::MovingPair pair(first.shape.hierarchy(), second.shape.hierarchy(), motion);
        collect(first.shape, second.shape, pair, t, {band, beside}, workspace, contacts);
      });
}

void close_features(const PlacedShape& A, const PlacedShape& B, double band, Workspace& workspace,
                    std::vector<Contact>& contacts, double beside) {
  collect_at_rest(A, B, {band, beside}, workspace, contacts,
                  [](const Shape& first, const Shape& second, const PairMotion& motion) {
                    return detail::MovingPair(first.hierarchy(), second.hierarchy(), motion);
                  });
}

void close_points_of_sets(const PlacedShape& A, const PlacedShape& B, double band,
                          Workspace& workspace, std::vector<Contact>& contacts) {
  collect_at_rest(A, B, {band, 0.0}, workspace, contacts,
                  [](const Shape& first, const Shape& second, const PairMotion& motion) {
                    return detail::MovingPair(first, second, motion);
                  });
}

void detail::close_features_by_front(const PlacedShape& A, const PlacedShape& B, double band,
                                     double beside, BoxFront& front, Workspace& workspace,
                                     std::vector<Contact>& contacts) {
  require_band(band, beside);
  const FloatEnvironmentGuard guard;
  contacts.clear();
  const RestingPair motion(A.path(), B.path());
  const MovingPair pair(A.shape().hierarchy(), B.shape().hierarchy(), motion);
  const ContactFrame frame{A.shape(), B.shape(), pair, 0.0, motion.origin(0.0), beside};
  const double radii = A.shape().radius() + B.shape().radius();
  collect_contacts_by_front(frame, radii + band, front, workspace.data(), contacts);
}

}  // namespace firstcontact
