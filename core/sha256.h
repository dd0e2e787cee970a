#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace heddle {

/// SHA-256 of bytes that come in pieces (FIPS 180-4, sections 4.1.2, 5 and 6.2).
class Sha256 {
 public:
  void add(std::string_view bytes);
  /// 64 hexadecimal digits of everything added. The object is used up by it.
  std::string hex();

 private:
  void compress(const unsigned char* block);
  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, 64> block_{};
  std::size_t filled_ = 0;    ///< bytes waiting in the block
  std::uint64_t length_ = 0;  ///< bytes added so far
};

/// SHA-256 of one piece, 64 hexadecimal digits.
std::string sha256(std::string_view bytes);

}  // namespace heddle
