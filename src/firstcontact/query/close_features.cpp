#include <firstcontact/query/close_features.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/query/detail/contact_state.h>
#include <firstcontact/query/detail/order.h>
#include <firstcontact/query/detail/pair_query.h>

namespace firstcontact {
namespace {

void require(bool condition, const char* what, double value) {
  if (!condition) {
    throw std::invalid_argument(std::string("close_features: ") + what + ", got " +
                                std::to_string(value));
  }
}

}  // namespace

void close_features(const MovingShape& A, const MovingShape& B, double t, double band,
                    Workspace& workspace, std::vector<Contact>& contacts, double beside) {
  require(t >= 0.0 && t <= 1.0, "t must lie in [0, 1]", t);
  require(band >= 0.0 && std::isfinite(band), "band must be finite and >= 0", band);
  require(beside >= 0.0 && std::isfinite(beside), "beside must be finite and >= 0", beside);
  const FloatEnvironmentGuard guard;
  contacts.clear();
  const auto collect = [&](const MovingShape& first, const MovingShape& second) {
    const double radii = first.shape.radius() + second.shape.radius();
    const double resolution =
        1e-14 * (first.shape.hierarchy().radius + second.shape.hierarchy().radius);
    ConstantRatePair motion = detail::motion_of(first, second, resolution);
    motion.enter(t);
    const detail::MovingPair pair(first.shape.hierarchy(), second.shape.hierarchy(), motion);
    const detail::ContactFrame frame{first.shape, second.shape, pair, t, motion.origin(t), beside};
    detail::collect_contacts(frame, radii + band, workspace.data(), contacts);
  };
  if (detail::in_order(A, B)) {
    collect(A, B);
    return;
  }
  collect(B, A);
  for (Contact& contact : contacts) {
    swap_bodies(contact);
  }
}

}  // namespace firstcontact
