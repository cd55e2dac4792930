#include <firstcontact/mesh_files/detail/lzf.h>

namespace firstcontact::detail {

std::optional<std::string> expand_lzf(std::string_view data, std::size_t size) {
  // A byte pair expands to 264 bytes at most: no memory is reserved that the data cannot fill.
  if (size / 132 > data.size()) {
    return {};
  }
  std::string result;
  result.reserve(size);
  std::size_t next = 0;
  const auto byte = [&] { return static_cast<unsigned char>(data[next++]); };
  while (next < data.size()) {
    const unsigned control = byte();
    if (control < 32) {
      const std::size_t count = control + 1;
      if (count > data.size() - next || count > size - result.size()) {
        return {};
      }
      result.append(data.substr(next, count));
      next += count;
      continue;
    }
    std::size_t count = (control >> 5) + 2;
    if (data.size() - next < (count == 9 ? 2u : 1u)) {
      return {};
    }
    if (count == 9) {
      count += byte();
    }
    const std::size_t distance = ((control & 31u) << 8 | byte()) + std::size_t{1};
    if (distance > result.size() || count > size - result.size()) {
      return {};
    }
    for (std::size_t k = 0; k < count; ++k) {
      result.push_back(result[result.size() - distance]);  // The two may overlap.
    }
  }
  return result.size() == size ? std::optional(std::move(result)) : std::nullopt;
}

}  // namespace firstcontact::detail
