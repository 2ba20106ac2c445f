// SPDX-License-Identifier: MIT
#include "papilla/core/value_stream.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

namespace papilla {
namespace {

struct Bytes {
  void write(const void* data, std::size_t size) {
    const char* from = static_cast<const char*>(data);
    text.append(from, from + size);
  }
  void read(void* data, std::size_t size) {
    if (size > text.size() - at) throw IoError("ended");
    std::copy_n(text.data() + at, size, static_cast<char*>(data));
    at += size;
  }
  std::uint64_t most_bytes() const { return text.size() - at; }

  std::string text;
  std::size_t at = 0;
};

template <class T>
std::string bytes_of(const T& value) {
  Bytes bytes;
  ValueWriter{bytes}(value);
  return bytes.text;
}

template <class T>
T through(const T& value) {
  Bytes bytes;
  ValueWriter{bytes}(value);
  T result{};
  ValueReader{bytes}(result);
  EXPECT_EQ(bytes.most_bytes(), 0u);
  return result;
}

enum class Colour : std::uint8_t { red, green };

struct Inner {
  double x = 0;
  bool on = false;
  bool operator==(const Inner&) const = default;
};

/// One field of every kind.
struct Outer {
  bool flag = false;
  Colour colour = Colour::red;
  std::int16_t small = 0;
  double number = 0;
  std::string text;
  std::filesystem::path path;
  std::optional<Inner> none, some;
  std::vector<Vec3> points;
  std::vector<Inner> inners;
  std::vector<std::string> names;
  std::array<std::optional<int>, 3> slots;
  std::map<std::string, std::vector<int>> lists;
  std::set<std::uint32_t> numbers;
  std::pair<int, std::string> pair;
  std::variant<int, std::string> choice;
  bool operator==(const Outer&) const = default;
};

Outer example() {
  return {true,
          Colour::green,
          -300,
          0.1,
          std::string("a\0b", 3),
          "some/where",
          {},
          Inner{2.5, true},
          {{1, 2, 3}, {4, 5, 6}},
          {{1, false}, {2, true}},
          {"", "x"},
          {1, std::nullopt, 3},
          {{"", {}}, {"k", {7, 8}}},
          {3, 1, 2},
          {-1, "p"},
          std::string("second")};
}

TEST(ValueStream, EveryKindOfFieldComesBack) {
  static_assert(k_field_count<Outer> == 16);
  EXPECT_EQ(through(example()), example());
  EXPECT_EQ(through(Outer{}), Outer{});
}

TEST(ValueStream, EveryFieldChangesTheBytes) {
  const std::string original = bytes_of(example());
  std::size_t changed = 0;
  const auto differs = [&](auto change) {
    Outer other = example();
    change(other);
    EXPECT_NE(bytes_of(other), original) << "field " << changed;
    ++changed;
  };
  differs([](Outer& o) { o.flag = false; });
  differs([](Outer& o) { o.colour = Colour::red; });
  differs([](Outer& o) { o.small = 3; });
  differs([](Outer& o) { o.number = -0.1; });
  differs([](Outer& o) { o.text = "ab"; });
  differs([](Outer& o) { o.path = "some/here"; });
  differs([](Outer& o) { o.none = Inner{}; });
  differs([](Outer& o) { o.some->on = false; });
  differs([](Outer& o) { o.points[1].z = 7; });
  differs([](Outer& o) { o.inners.pop_back(); });
  differs([](Outer& o) { o.names[0] = "y"; });
  differs([](Outer& o) { o.slots[1] = 0; });
  differs([](Outer& o) { o.lists["k"][0] = 9; });
  differs([](Outer& o) { o.numbers.insert(9); });
  differs([](Outer& o) { o.pair.second = "q"; });
  differs([](Outer& o) { o.choice = 5; });
  EXPECT_EQ(changed, k_field_count<Outer>);
}

TEST(ValueStream, NothingOfAValueIsAmbiguous) {
  // The same letters, divided in another way.
  EXPECT_NE(bytes_of(std::vector<std::string>{"ab", "c"}), bytes_of(std::vector<std::string>{"a", "bc"}));
  EXPECT_NE(bytes_of(std::pair<std::optional<int>, std::optional<int>>{1, {}}),
            bytes_of(std::pair<std::optional<int>, std::optional<int>>{{}, 1}));
}

TEST(ValueStream, GapsBetweenFieldsAreNoPartOfAValue) {
  Inner one, other;
  std::memset(static_cast<void*>(&one), 0xff, sizeof one);
  std::memset(static_cast<void*>(&other), 0, sizeof other);
  one.x = other.x = 1, one.on = other.on = true;
  EXPECT_EQ(bytes_of(one), bytes_of(other));
}

TEST(ValueStream, ListsLongerThanTheSourceAreRefused) {
  Bytes bytes;
  ValueWriter{bytes}(std::uint64_t{1} << 60);
  std::vector<double> numbers;
  EXPECT_THROW(ValueReader{bytes}(numbers), IoError);
  bytes.at = 0;
  std::vector<std::string> texts;
  EXPECT_THROW(ValueReader{bytes}(texts), IoError);
}

TEST(ValueStream, TruthIsNoughtOrOne) {
  Bytes bytes{"\x02", 0};
  bool value = false;
  EXPECT_THROW(ValueReader{bytes}(value), IoError);
}

}  // namespace
}  // namespace papilla
