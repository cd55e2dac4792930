#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include <firstcontact/haptic_devices/recorded_device.h>
#include <firstcontact/haptic_devices/recording.h>
#include <firstcontact/text/parse_error.h>

#include "fuzz/fuzz_reader.h"
#include "fuzz/text_mutator.h"

namespace {

using firstcontact::test::require;

bool is_finite(const firstcontact::DeviceState& state) {
  return state.X_DH.position.allFinite() && state.X_DH.rotation.coeffs().allFinite() &&
         state.linear_rate.allFinite() && state.angular_rate.allFinite();
}

}  // namespace

constexpr std::array<std::string_view, 20> kWords = {"# firstcontact recording: 1",
                                                     "# device",
                                                     "# kind: rate",
                                                     "# sensed: 111000",
                                                     "# calibration_scale",
                                                     "# calibration_quaternion",
                                                     "# silent_after_ns",
                                                     "time_ns",
                                                     "sequence",
                                                     "buttons",
                                                     "status",
                                                     "live",
                                                     "lost",
                                                     "qw",
                                                     "vx",
                                                     "wz",
                                                     "##",
                                                     "inf",
                                                     "9223372036854775807",
                                                     "-9223372036854775808"};

/// Any bytes give a recording that is written, read and played, or a ParseError of one line.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const firstcontact::Recording recording = firstcontact::parse_recording(text, "f.csv");
    const std::string written = firstcontact::write_recording(recording);
    const firstcontact::Recording again = firstcontact::parse_recording(written, "g.csv");
    require(again.samples.size() == recording.samples.size());
    require(firstcontact::write_recording(again) == written);
    firstcontact::RecordedDevice device(recording);
    std::int64_t now_ns = -5;
    for (int tick = 0; tick < 50; ++tick) {
      require(is_finite(device.read(now_ns)));
      now_ns += device.duration_ns() / 40 + 1;
    }
  } catch (const firstcontact::ParseError& error) {
    require(std::strchr(error.what(), '\n') == nullptr);
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  return firstcontact::test::mutate_text(reinterpret_cast<char*>(data), size, most, seed, kWords);
}
