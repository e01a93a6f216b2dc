#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <string>

#include "online/math/sha256.h"

using namespace railstep;

namespace {

std::string hex(const std::uint8_t* digest) {
  std::string out;
  for (int i = 0; i < 32; ++i) {
    char two[3];
    std::snprintf(two, sizeof two, "%02x", digest[i]);
    out += two;
  }
  return out;
}

std::string digest_of(const std::string& text) {
  std::uint8_t digest[32];
  sha256(text.data(), text.size(), digest);
  return hex(digest);
}

}  // namespace

TEST_CASE("SHA-256 gives the digests of FIPS 180-4's examples", "[sha256]") {
  CHECK(digest_of("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(digest_of("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(digest_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  CHECK(digest_of("abcdefghbcdefghicdefghijdefghijkefghijklfghijklmghijklmn"
                  "hijklmnoijklmnopjklmnopqklmnopqrlmnopqrsmnopqrstnopqrstu") ==
        "cf5b16a778af8380036ce59e7b0492370b249b11e8f07a51afac45037afee9d1");
  CHECK(digest_of(std::string(1000000, 'a')) ==
        "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("the pieces of a text do not matter, and a finished hash starts again", "[sha256]") {
  std::string text;
  for (int i = 0; i < 300; ++i) text += static_cast<char>(i * 37);
  Sha256 hash;
  for (std::size_t length : {0u, 1u, 55u, 56u, 57u, 63u, 64u, 65u, 119u, 120u, 128u, 300u})
    for (std::size_t piece : {1u, 7u, 64u, 100u}) {
      for (std::size_t at = 0; at < length; at += piece)
        hash.add(text.data() + at, std::min(piece, length - at));
      std::uint8_t digest[32];
      hash.finish(digest);
      CHECK(hex(digest) == digest_of(text.substr(0, length)));
    }
}
