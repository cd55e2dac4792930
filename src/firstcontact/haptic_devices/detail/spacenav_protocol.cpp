#include <firstcontact/haptic_devices/detail/spacenav_protocol.h>

#include <cstdlib>
#include <cstring>

namespace firstcontact::detail {
namespace {

constexpr std::size_t kRecordBytes = 32;
constexpr std::uint32_t kRequestTag = 0x7faa0000;
constexpr std::uint32_t kChangeProtocol = 0x5500;
constexpr std::int32_t kMostCounts = 100'000;  // Devices give some hundreds.
constexpr std::int32_t kMostButtons = 1024;

template <class Value>
std::string bytes_of(Value value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

}  // namespace

std::string spacenav_protocol_request() {
  return bytes_of(kRequestTag | kChangeProtocol | std::uint32_t{1});
}

std::string spacenav_sensitivity_one() { return bytes_of(1.0F); }

std::int32_t SpacenavDecoder::integer(std::size_t index) const {
  std::int32_t value = 0;
  std::memcpy(&value, bytes_.data() + at_ + 4 * index, sizeof value);
  return value;
}

std::optional<SpacenavEvent> SpacenavDecoder::event_of_record() const {
  SpacenavEvent event;
  const std::int32_t type = integer(0);
  switch (type) {
    case 0:
      event.type = SpacenavEventType::motion;
      for (std::size_t axis = 0; axis < event.axes.size(); ++axis) {
        event.axes[axis] = integer(axis + 1);
        if (event.axes[axis] < -kMostCounts || event.axes[axis] > kMostCounts) {
          return std::nullopt;
        }
      }
      return event;
    case 1:
    case 2:
      event.type = type == 1 ? SpacenavEventType::press : SpacenavEventType::release;
      event.value = integer(1);
      if (event.value < 0 || event.value >= kMostButtons) {
        return std::nullopt;
      }
      return event;
    case 3:
      if (integer(1) != 0 && integer(1) != 1) {
        return std::nullopt;
      }
      event.type =
          integer(1) == 0 ? SpacenavEventType::device_added : SpacenavEventType::device_removed;
      return event;
    case 4:
    case 5:
    case 6:
      return event;
    default:
      // Answers carry the tag of requests.
      return (static_cast<std::uint32_t>(type) & 0xffff0000) == kRequestTag ? std::optional(event)
                                                                            : std::nullopt;
  }
}

std::optional<SpacenavEvent> SpacenavDecoder::next() {
  std::optional<SpacenavEvent> event;
  while (!event && bytes_.size() - at_ >= 4) {
    const auto first = static_cast<std::uint32_t>(integer(0));
    if (!agreed_ && (first & 0xffffff00) == (kRequestTag | kChangeProtocol)) {
      agreed_ = true;
      event = SpacenavEvent{SpacenavEventType::protocol, {}, static_cast<int>(first & 0xff)};
      at_ += 4;
    } else if (bytes_.size() - at_ >= kRecordBytes) {
      event = event_of_record();
      malformed_ += event ? 0 : 1;
      at_ += kRecordBytes;
    } else {
      break;
    }
  }
  if (at_ == bytes_.size() || at_ > 4096) {
    bytes_.erase(0, at_);
    at_ = 0;
  }
  return event;
}

}  // namespace firstcontact::detail
