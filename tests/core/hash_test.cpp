#include <catch2/catch.hpp>

#include <string>

#include "core/sha256.h"

using heddle::sha256;

TEST_CASE("SHA-256 gives the digests that NIST publishes", "[core][hash]") {
  // FIPS 180-4 examples (csrc.nist.gov, "Cryptographic Standards and Guidelines: Example Values", SHA256).
  CHECK(sha256("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  CHECK(sha256(std::string(1000000, 'a')) ==
        "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("a text hashes alike in one piece and in any pieces, at every length about a block's end",
          "[core][hash]") {
  for (std::size_t length : {0, 1, 55, 56, 57, 63, 64, 65, 119, 120, 121, 127, 128, 129, 300}) {
    std::string text;
    for (std::size_t i = 0; i < length; ++i) text += static_cast<char>(i * 7 + 3);
    for (std::size_t piece : {1, 3, 64, 65}) {
      heddle::Sha256 hash;
      for (std::size_t at = 0; at < length; at += piece) hash.add(std::string_view(text).substr(at, piece));
      CHECK(hash.hex() == sha256(text));
    }
  }
}
