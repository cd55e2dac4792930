#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include <firstcontact/geometry/mesh_defects.h>
#include <firstcontact/geometry/weld.h>
#include <firstcontact/mesh_files/detail/parse_dae.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/reading_log.h>

#include "fuzz/fuzz_reader.h"
#include "fuzz/small_stack.h"
#include "fuzz/xml_mutation.h"

namespace {

using firstcontact::test::require;

/// Any bytes give a body of finite coordinates, or a ParseError of one line. Lenient or not.
void fuzz_dae(std::string_view bytes, bool lenient) {
  try {
    firstcontact::detail::ReadingLog log("fuzz.dae", "DAE", {.lenient = lenient});
    firstcontact::Mesh mesh = firstcontact::detail::parse_dae(bytes, log);
    require(!mesh.triangles.empty());
    firstcontact::weld(mesh);
    require(firstcontact::inspect(mesh).nonfinite_vertices == 0);
    require(!log.finish().unit.empty());
  } catch (const firstcontact::ParseError& error) {
    require(std::strchr(error.what(), '\n') == nullptr);
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

/// Mostly whole elements, references and numbers; sometimes bytes.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned int seed) {
  if (seed % 16 == 0) {
    return LLVMFuzzerMutate(data, size, most);
  }
  std::string text(reinterpret_cast<const char*>(data), size);
  for (unsigned i = 0; i <= seed % 3; ++i) {
    text = firstcontact::test::XmlMutation(std::move(text), seed + i).changed();
  }
  if (text.empty() || text.size() > most) {
    return LLVMFuzzerMutate(data, size, most);
  }
  std::memcpy(data, text.data(), text.size());
  return text.size();
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz_dae({reinterpret_cast<const char*>(data), size}, size % 2 == 0);
  return 0;
}
