// SPDX-License-Identifier: MIT
#include "papilla/core/base64.hpp"

#include <gtest/gtest.h>

#include <random>
#include <utility>

namespace papilla {
namespace {

std::string encoded(std::string_view text) { return encode_base64(std::as_bytes(std::span(text))); }

TEST(Base64, TestVectorsOfRfc4648) {
  for (const auto& [plain, code] : {std::pair<std::string, std::string>{"", ""},
                                    {"f", "Zg=="},
                                    {"fo", "Zm8="},
                                    {"foo", "Zm9v"},
                                    {"foob", "Zm9vYg=="},
                                    {"fooba", "Zm9vYmE="},
                                    {"foobar", "Zm9vYmFy"}}) {
    EXPECT_EQ(encoded(plain), code);
    EXPECT_EQ(decode_base64(code), plain);
  }
  EXPECT_EQ(encoded("\xfb\xff\xbf"), "+/+/");  // The two digits that are no letter or number.
}

TEST(Base64, RandomBytesComeBack) {
  std::mt19937 random(1);
  for (std::size_t size = 0; size < 200; ++size) {
    std::string bytes(size, '\0');
    for (char& c : bytes) c = static_cast<char>(random());
    const std::string code = encoded(bytes);
    EXPECT_EQ(code.size(), (size + 2) / 3 * 4);
    EXPECT_EQ(decode_base64(code), bytes);
  }
}

TEST(Base64, PaddingMayBeMissing) {
  EXPECT_EQ(decode_base64("Zg"), "f");
  EXPECT_EQ(decode_base64("Zm8"), "fo");
}

TEST(Base64, OtherCharactersAreRefused) {
  for (const char* text : {"Zm9v YmFy", "Zm9v\n", "Zg=v", "Zm9-", "Zm9_", "Z\xc3\xbc"})
    EXPECT_FALSE(decode_base64(text)) << text;
}

TEST(Base64, DataUri) {
  EXPECT_EQ(decode_data_uri("data:image/png;base64,Zm9v"), "foo");
  EXPECT_EQ(decode_data_uri("data:;base64,"), "");
  for (const char* uri : {"", "relief.png", "data:image/png,foo", "https://a/b;base64,Zm9v", "data:image/png;base64,?"})
    EXPECT_FALSE(decode_data_uri(uri)) << uri;
}

}  // namespace
}  // namespace papilla
