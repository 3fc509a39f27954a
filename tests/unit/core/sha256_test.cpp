#include "polar/core/sha256.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace polar {
namespace {

TEST(Sha256, OfTheStandardsExamples) {  // FIPS 180-4, appendix B
  EXPECT_EQ(sha256("abc", 3), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("", 0), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  const std::string two_blocks = "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq";
  EXPECT_EQ(sha256(two_blocks.data(), two_blocks.size()),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST(Sha256, GoesOnAfterItsDigitsWereAskedFor) {
  Sha256 hash;
  hash.add("a", 1);
  EXPECT_EQ(hash.digits(), sha256("a", 1));
  hash.add("bc", 2);
  EXPECT_EQ(hash.digits(), sha256("abc", 3));
}

TEST(Sha256, DoesNotDependOnHowBytesArrive) {
  std::string bytes;
  for (int i = 0; i < 500; ++i) bytes += static_cast<char>(i * 7);
  const std::string whole = sha256(bytes.data(), bytes.size());
  for (const std::size_t step : {1u, 7u, 63u, 64u, 65u, 200u}) {
    Sha256 hash;
    for (std::size_t i = 0; i < bytes.size(); i += step)
      hash.add(bytes.data() + i, std::min<std::size_t>(step, bytes.size() - i));
    EXPECT_EQ(hash.digits(), whole) << step;
  }
}

}  // namespace
}  // namespace polar
