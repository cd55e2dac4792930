// Exchanges contact sets between two threads, and reports how many were torn or out of order.
//
//     haptics_hand_over [EXCHANGES [short]]     1e8 by default
//
// One exchange puts one set. Each set has a checksum of its content, which the other thread
// computes again. The exit status is 1 where a checksum does not agree. A contact set has 20 kB. A
// short set has the same slot and 128 bytes: a thread sanitizer is slow with 20 kB.

#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

#include <firstcontact/haptic_devices/mail_slot.h>
#include <firstcontact/haptics/contact_set.h>

namespace firstcontact {
namespace {

struct ShortSet {
  std::uint64_t sequence = 0;
  std::array<double, 14> values{};
  std::uint64_t checksum = 0;
};

std::uint64_t checksum_of(const ShortSet& set) noexcept {
  std::uint64_t sum = set.sequence;
  for (const double value : set.values) {
    sum = (sum ^ std::bit_cast<std::uint64_t>(value)) * 0x9e3779b97f4a7c15U;
    sum ^= sum >> 29;
  }
  return sum;
}

void fill(std::uint64_t k, ShortSet& set) {
  for (std::size_t c = 0; c < set.values.size(); ++c) {
    set.values[c] = static_cast<double>(k + c);
  }
}

void fill(std::uint64_t k, HapticContactSet& set) {
  set.tools = 1;
  set.count = static_cast<std::uint32_t>(k % 5);
  set.p_WC[0].setConstant(static_cast<double>(k));
  for (std::size_t c = 0; c < set.count; ++c) {
    set.contacts[c].point.setConstant(static_cast<double>(k + c));
  }
}

template <class Set>
int exchange(std::uint64_t count) {
  MailSlot<Set> slot;
  std::thread producer([&slot, count] {
    Set set;
    for (std::uint64_t k = 1; k <= count; ++k) {
      set.sequence = k;
      fill(k, set);
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
    const Set& set = slot.newest();
    if (set.sequence == 0) {
      continue;
    }
    torn += set.checksum != checksum_of(set) ? 1U : 0U;
    older += set.sequence < last ? 1U : 0U;
    seen += set.sequence > last ? 1U : 0U;
    last = set.sequence;
  }
  producer.join();
  std::printf("%llu sets of %zu bytes were put, %llu of them seen: %llu torn, %llu out of order\n",
              static_cast<unsigned long long>(count), sizeof(Set),
              static_cast<unsigned long long>(seen), static_cast<unsigned long long>(torn),
              static_cast<unsigned long long>(older));
  return torn + older > 0 ? 1 : 0;
}

}  // namespace
}  // namespace firstcontact

int main(int argc, char** argv) {
  const double count = argc > 1 ? std::atof(argv[1]) : 1e8;
  const auto exchanges = static_cast<std::uint64_t>(count);
  return argc > 2 && std::strcmp(argv[2], "short") == 0
             ? firstcontact::exchange<firstcontact::ShortSet>(exchanges)
             : firstcontact::exchange<firstcontact::HapticContactSet>(exchanges);
}
