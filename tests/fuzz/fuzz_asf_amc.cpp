#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include <firstcontact/robot_files/read_amc.h>
#include <firstcontact/robot_files/read_asf.h>
#include <firstcontact/text/parse_error.h>

#include "fuzz/fuzz_capture.h"

/// Any bytes, an ASF and an AMC file with a line `%%` between them, give a captured motion, or a
/// ParseError of one line.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t cut = text.find("\n%%\n");
  try {
    const firstcontact::AsfSkeleton skeleton =
        firstcontact::parse_asf(text.substr(0, cut), "fuzz.asf");
    const std::string_view motion =
        cut == std::string_view::npos ? std::string_view() : text.substr(cut + 4);
    firstcontact::test::require_sound(firstcontact::parse_amc(motion, "fuzz.amc", skeleton));
  } catch (const firstcontact::ParseError& error) {
    firstcontact::test::require(std::strchr(error.what(), '\n') == nullptr);
  }
  return 0;
}
