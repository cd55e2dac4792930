#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include <firstcontact/haptic_devices/detail/mouse_protocol.h>
#include <firstcontact/haptic_devices/detail/quiet_state.h>
#include <firstcontact/text/parse_error.h>

#include "fuzz/fuzz_reader.h"
#include "fuzz/text_mutator.h"

namespace {

using namespace firstcontact;
using test::require;

constexpr std::array<std::string_view, 5> kWords = {"position", "rotation", "grip", "[1, 0, 0, 0]",
                                                    "1e6"};

bool are_same(const DeviceState& a, const DeviceState& b) {
  return a.X_DH.position == b.X_DH.position &&
         a.X_DH.rotation.coeffs() == b.X_DH.rotation.coeffs() && a.grips == b.grips;
}

}  // namespace

/// Any message gives a pose and grips of a device. Else the reason is one line, and the state stays
/// as it was.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  DeviceState state;
  state.X_DH.position = {1.0, 2.0, 3.0};
  state.grips.fill(0.5);
  const DeviceState before = state;
  try {
    detail::take_mouse_message(text, state);
    require(detail::makes_sense(state));
    require(std::abs(state.X_DH.rotation.norm() - 1.0) < 1e-9);
    require(state.grips.front() == state.grips.back());
  } catch (const ParseError& error) {
    require(std::strchr(error.what(), '\n') == nullptr);
    require(are_same(state, before));
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  return test::mutate_text(reinterpret_cast<char*>(data), size, most, seed, kWords);
}
