#include <firstcontact/haptics/detail/contact_listing.h>

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <numeric>

#include <firstcontact/haptics/detail/contact_reduction.h>

namespace firstcontact::detail {

void list_contacts(const std::vector<HapticTouch>& touches, const ReducedContacts& projected,
                   const ToolFrames& frames, std::size_t tools, const ContactLoopOptions& options,
                   HapticContactSet& set, std::vector<HapticTouch>& listed) {
  ReducedContacts reduced = projected;
  if (touches.size() <= options.most_contacts) {
    reduced = {};
    reduced.kept.resize(touches.size());
    std::iota(reduced.kept.begin(), reduced.kept.end(), std::size_t{0});
  } else if (reduced.kept.size() > options.most_contacts) {
    std::vector<HapticContact> contacts;
    for (const std::size_t k : projected.kept) {
      contacts.push_back(touches[k].contact);
    }
    reduced = reduce_contacts(contacts, frames, tools, options.angle, options.most_contacts);
    for (std::size_t& k : reduced.kept) {
      k = projected.kept[k];
    }
    // Angles to cones add up.
    reduced.angle = std::min(std::numbers::pi, reduced.angle + projected.angle);
  }
  set.count = static_cast<std::uint32_t>(reduced.kept.size());
  set.full_count = static_cast<std::uint32_t>(touches.size());
  set.angle = reduced.angle;
  listed.clear();
  for (std::size_t k = 0; k < reduced.kept.size(); ++k) {
    const HapticTouch& touch = touches[reduced.kept[k]];
    set.contacts[k] = touch.contact;
    listed.push_back(touch);
  }
}

}  // namespace firstcontact::detail
