#include <cstddef>
#include <cstdint>

#include <firstcontact/mesh_files/read_mesh.h>

#include "fuzz/fuzz_reader.h"
#include "fuzz/small_stack.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  firstcontact::test::fuzz_reader(firstcontact::parse_obj, data, size);
  return 0;
}
