#include <cstddef>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>

#include <firstcontact/record/read_run.h>
#include <firstcontact/record/write_run.h>
#include <firstcontact/text/parse_error.h>

#include "fuzz/fuzz_reader.h"

namespace {

using firstcontact::ParseError;
using firstcontact::RunReader;
using firstcontact::test::require;

std::string read_and_write(const std::string& text) {
  std::istringstream stream(text);
  RunReader reader(stream, "fuzz");
  std::string written = write_run_header(reader.header());
  while (const auto step = reader.next()) {
    written += write_run_step(*step);
  }
  require(reader.size() <= text.size());
  require(reader.is_cut_off() == (reader.size() < text.size()));
  return written;
}

/// Any bytes give a run, or a ParseError of one line. A run that was read is written and read back
/// unchanged.
void fuzz_run(const std::string& text) {
  std::string written;
  try {
    written = read_and_write(text);
  } catch (const ParseError& error) {
    require(std::strchr(error.what(), '\n') == nullptr);
    return;
  }
  try {
    require(read_and_write(written) == written);
  } catch (const ParseError&) {
    require(false);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz_run({reinterpret_cast<const char*>(data), size});
  return 0;
}
