/// @file
/// SHA-256, the digest that identifies inputs.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <firstcontact/math/export.h>

namespace firstcontact::detail {

/// Digests bytes that come in pieces.
///
/// Source: NIST FIPS 180-4, "Secure Hash Standard", 2015, sections 5 and 6.2.
class FIRSTCONTACT_API Sha256 {
 public:
  void add(std::string_view bytes);

  /// The digest of all that was added, 64 hexadecimal digits.
  [[nodiscard]] std::string hexadecimal() const;

 private:
  void take_block();
  void pad();

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, 64> block_{};
  std::size_t filled_ = 0;    // Number of bytes in block_.
  std::uint64_t length_ = 0;  // Number of bytes added.
};

/// The digest of one piece.
[[nodiscard]] FIRSTCONTACT_API std::string sha256(std::string_view bytes);

}  // namespace firstcontact::detail
