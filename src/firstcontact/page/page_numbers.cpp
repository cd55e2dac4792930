#include <firstcontact/page/page_numbers.h>

#include <bit>

#include <firstcontact/text/base64.h>

namespace firstcontact {

void PageNumbers::add(float number) { add(std::bit_cast<std::uint32_t>(number), 4); }

void PageNumbers::add(double number) { add(std::bit_cast<std::uint64_t>(number), 8); }

void PageNumbers::add(const Eigen::Vector3d& v) {
  for (const double coordinate : v) {
    add(coordinate);
  }
}

void PageNumbers::add(std::uint64_t number, int size) {
  for (int k = 0; k < size; ++k) {
    bytes_.push_back(static_cast<std::uint8_t>(number >> (8 * k)));
  }
}

std::string PageNumbers::base64() const { return detail::base64(bytes_); }

}  // namespace firstcontact
