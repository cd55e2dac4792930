#include <firstcontact/haptic_devices/mail_slot.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

#include <gtest/gtest.h>

#include "support/rounds.h"

namespace firstcontact {
namespace {

/// A message that shows whether it is whole.
struct Message {
  std::uint64_t number = 0;
  std::array<std::uint64_t, 30> words{};
  std::uint64_t checksum = 0;

  [[nodiscard]] std::uint64_t sum() const {
    std::uint64_t result = number;
    for (const std::uint64_t word : words) {
      result = 31 * result + word;
    }
    return result;
  }
};

Message message_of(std::uint64_t number) {
  Message message;
  message.number = number;
  for (std::size_t i = 0; i < message.words.size(); ++i) {
    message.words[i] = number * 2'654'435'761 + i;
  }
  message.checksum = message.sum();
  return message;
}

TEST(MailSlot, GivesTheNewestValue) {
  MailSlot<int> slot;
  EXPECT_EQ(slot.newest(), 0);
  slot.put(1);
  slot.put(2);
  EXPECT_EQ(slot.newest(), 2);
  EXPECT_EQ(slot.newest(), 2);
  slot.put(3);
  EXPECT_EQ(slot.newest(), 3);
}

TEST(MailSlot, GivesWholeValuesInOrder) {
  const std::uint64_t count = static_cast<std::uint64_t>(test::rounds(300'000, 20'000));
  MailSlot<Message> slot;
  slot.put(message_of(0));
  std::thread writer([&] {
    for (std::uint64_t number = 1; number <= count; ++number) {
      slot.put(message_of(number));
    }
  });
  std::uint64_t last = 0;
  while (last < count) {
    const Message& message = slot.newest();
    const bool whole = message.checksum == message.sum();
    const bool in_order = message.number >= last;
    last = message.number;
    if (!whole || !in_order) {
      ADD_FAILURE() << "message " << last << (whole ? " goes back" : " is torn");
      break;
    }
  }
  writer.join();
}

}  // namespace
}  // namespace firstcontact
