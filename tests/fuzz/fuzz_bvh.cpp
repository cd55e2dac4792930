#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include <firstcontact/robot_files/read_bvh.h>
#include <firstcontact/text/parse_error.h>

#include "fuzz/fuzz_capture.h"

/// Any bytes give a captured motion, or a ParseError of one line.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    firstcontact::test::require_sound(
        firstcontact::parse_bvh({reinterpret_cast<const char*>(data), size}, "fuzz.bvh"));
  } catch (const firstcontact::ParseError& error) {
    firstcontact::test::require(std::strchr(error.what(), '\n') == nullptr);
  }
  return 0;
}
