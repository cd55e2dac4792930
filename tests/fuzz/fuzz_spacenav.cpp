#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <firstcontact/haptic_devices/detail/space_mouse_rates.h>
#include <firstcontact/haptic_devices/detail/spacenav_protocol.h>

#include "fuzz/fuzz_reader.h"

namespace {

using namespace firstcontact;
using test::require;

/// Feeds the bytes in chunks, and gives what came out.
detail::SpaceMouseSample follow(std::string_view bytes, std::size_t chunk,
                                std::uint64_t& malformed) {
  const SpaceMouseOptions options;
  detail::SpacenavDecoder decoder;
  detail::SpaceMouseRates rates(options);
  std::int64_t now_ns = 0;
  while (!bytes.empty()) {
    decoder.add(bytes.substr(0, chunk));
    bytes.remove_prefix(std::min(chunk, bytes.size()));
    while (const auto event = decoder.next()) {
      rates.take(*event, ++now_ns);
      const DeviceState state = detail::state_at(rates.sample(), now_ns, options);
      require(state.linear_rate.cwiseAbs().maxCoeff() <= options.max_linear_rate);
      require(state.angular_rate.cwiseAbs().maxCoeff() <= options.max_angular_rate);
      require(state.status == DeviceStatus::live || state.linear_rate.isZero(0.0));
    }
  }
  malformed = decoder.malformed();
  return rates.sample();
}

}  // namespace

/// Any bytes give rates within the limits, however they arrive. The first byte is the chunk.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  std::uint64_t at_once = 0;
  std::uint64_t in_parts = 0;
  const auto a = follow(bytes, std::max<std::size_t>(bytes.size(), 1), at_once);
  const auto b = follow(bytes, std::size_t{1} + data[0], in_parts);
  require(at_once == in_parts);
  require(a.state.sequence == b.state.sequence && a.state.buttons == b.state.buttons);
  require(a.state.linear_rate == b.state.linear_rate);
  return 0;
}
