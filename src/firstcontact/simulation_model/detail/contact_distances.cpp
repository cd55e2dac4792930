#include <firstcontact/simulation_model/detail/contact_distances.h>

#include <firstcontact/simulation_model/detail/constants.h>

namespace firstcontact::detail {

HeldDistance held_distance(const ContactDistances& distances, double pair_margin, double gap) {
  if (gap > distances.least + distances.tolerance) {
    return {pair_margin + distances.least, distances.tolerance};
  }
  const double share = gap > kJammedOfDistance * distances.least ? kHeldShare : kHeldShareOfJammed;
  return {pair_margin + share * gap, 0.5 * (1.0 - share) * gap};
}

}  // namespace firstcontact::detail
