// Exchanges contact sets between two threads, and reports how many were torn or out of order.
//
//     haptics_hand_over [EXCHANGES]     1e8 by default
//
// One exchange puts one set. Each set has a checksum of its content, which the other thread
// computes again. The exit status is 1 where a checksum does not agree.

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include <firstcontact/haptic_devices/mail_slot.h>
#include <firstcontact/haptics/contact_set.h>

namespace firstcontact {
namespace {

int exchange(std::uint64_t count) {
  MailSlot<HapticContactSet> slot;
  std::thread producer([&slot, count] {
    HapticContactSet set;
    for (std::uint64_t k = 1; k <= count; ++k) {
      set.sequence = k;
      set.tools = 1;
      set.count = static_cast<std::uint32_t>(k % 5);
      set.p_WC[0].setConstant(static_cast<double>(k));
      for (std::size_t c = 0; c < set.count; ++c) {
        set.contacts[c].point.setConstant(static_cast<double>(k + c));
      }
      // The values that change every time stand at both ends of the set.
      set.checksum = checksum_of(set);
      slot.put(set);
    }
  });
  std::uint64_t last = 0;
  std::uint64_t torn = 0;
  std::uint64_t older = 0;
  std::uint64_t seen = 0;
  while (last < count) {
    const HapticContactSet& set = slot.newest();
    if (set.sequence == 0) {
      continue;
    }
    torn += set.checksum != checksum_of(set) ? 1U : 0U;
    older += set.sequence < last ? 1U : 0U;
    seen += set.sequence > last ? 1U : 0U;
    last = set.sequence;
  }
  producer.join();
  std::printf("%llu sets were put, %llu of them seen: %llu torn, %llu out of order\n",
              static_cast<unsigned long long>(count), static_cast<unsigned long long>(seen),
              static_cast<unsigned long long>(torn), static_cast<unsigned long long>(older));
  return torn + older > 0 ? 1 : 0;
}

}  // namespace
}  // namespace firstcontact

int main(int argc, char** argv) {
  const double count = argc > 1 ? std::atof(argv[1]) : 1e8;
  return firstcontact::exchange(static_cast<std::uint64_t>(count));
}
