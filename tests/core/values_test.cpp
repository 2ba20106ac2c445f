// SPDX-License-Identifier: MIT
#include "papilla/core/values.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <type_traits>
#include <utility>
#include <vector>

#include "papilla/core/vec.hpp"

using namespace papilla;

namespace {

/// Memory of another owner, which tells whether somebody keeps it.
class Lender {
 public:
  Lender() { std::iota(memory_->begin(), memory_->end(), 1.0); }

  Values<double> lend() {
    std::shared_ptr<void> keeper(nullptr, [memory = memory_, kept = kept_](void*) { --*kept; });
    ++*kept_;
    return borrowed_values(std::move(keeper), memory_->data(), memory_->size());
  }
  int kept() const { return *kept_; }
  double* memory() { return memory_->data(); }
  const std::array<double, 4>& now() const { return *memory_; }

 private:
  std::shared_ptr<std::array<double, 4>> memory_ = std::make_shared<std::array<double, 4>>();
  std::shared_ptr<int> kept_ = std::make_shared<int>(0);
};

constexpr std::array<double, 4> k_lent{1, 2, 3, 4};

}  // namespace

TEST(Values, AreAVectorOfZeros) {
  Values<Vec3> values(3);
  EXPECT_EQ(values, (Values<Vec3>{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}));
  values.assign(3, {1, 2, 3});
  values.resize(1);
  values.resize(3);
  EXPECT_EQ(values, (Values<Vec3>{{1, 2, 3}, {0, 0, 0}, {0, 0, 0}}));
  Values<unsigned char> bytes(1000, 255);
  bytes.clear();
  bytes.resize(1000);
  EXPECT_EQ(std::count(bytes.begin(), bytes.end(), 0), 1000);
}

TEST(Values, MoveWithoutACopyAndWithoutThrowing) {
  static_assert(std::is_nothrow_move_constructible_v<Values<double>>);
  static_assert(std::is_nothrow_move_assignable_v<Values<double>>);
  Values<double> from{1, 2, 3};
  const double* memory = from.data();
  Values<double> to = std::move(from);
  EXPECT_EQ(to.data(), memory);
  Values<double> again{7};
  again = std::move(to);
  EXPECT_EQ(again.data(), memory);
}

TEST(Values, LookAtWhatTheyBorrow) {
  Lender lender;
  Values<double> values = lender.lend();
  EXPECT_EQ(values.data(), lender.memory());
  EXPECT_EQ(values, (Values<double>{1, 2, 3, 4}));
  values[1] = 20;
  lender.memory()[2] = 30;
  EXPECT_EQ(lender.now()[1], 20);
  EXPECT_EQ(values[2], 30);
}

TEST(Values, KeepWhatTheyBorrowUntilTheyEnd) {
  Lender lender;
  {
    const Values<double> values = lender.lend();
    EXPECT_EQ(lender.kept(), 1);
  }
  EXPECT_EQ(lender.kept(), 0);
  EXPECT_EQ(lender.now(), k_lent);
}

TEST(Values, ACopyHasMemoryOfItsOwn) {
  Lender lender;
  const Values<double> values = lender.lend();
  Values<double> copy = values;
  EXPECT_NE(copy.data(), values.data());
  EXPECT_EQ(lender.kept(), 1);
  copy.assign(4, 0);
  copy.resize(100);
  EXPECT_EQ(lender.now(), k_lent);
  EXPECT_TRUE(copy.get_allocator() == ValueAllocator<double>());
  EXPECT_FALSE(values.get_allocator() == copy.get_allocator());
}

TEST(Values, AMoveTakesTheLoanAlong) {
  Lender lender;
  Values<double> from = lender.lend();
  Values<double> built = std::move(from);
  EXPECT_EQ(built.data(), lender.memory());
  Values<double> assigned(100, 1.0);
  assigned = std::move(built);
  EXPECT_EQ(assigned.data(), lender.memory());
  EXPECT_EQ(lender.kept(), 1);
  built.assign(4, 9);  // What was moved from has nothing of it any more.
  from.resize(4);
  EXPECT_EQ(from, Values<double>(4));
  EXPECT_EQ(assigned, (Values<double>{1, 2, 3, 4}));
  assigned = Values<double>{5};
  EXPECT_EQ(lender.kept(), 0);
  EXPECT_EQ(lender.now(), k_lent);
  EXPECT_EQ(built, Values<double>(4, 9));
}

TEST(Values, ASwapExchangesTheLoans) {
  Lender lender, other;
  Values<double> a = lender.lend(), b = other.lend(), own{5, 6};
  a.swap(b);
  std::swap(b, own);
  EXPECT_EQ(a.data(), other.memory());
  EXPECT_EQ(own.data(), lender.memory());
  EXPECT_EQ(b, (Values<double>{5, 6}));
  b = Values<double>();
  own = Values<double>();
  EXPECT_EQ(lender.kept(), 0);
  EXPECT_EQ(other.kept(), 1);
}

TEST(Values, GrowBeyondWhatTheyBorrow) {
  Lender lender;
  Values<double> values = lender.lend();
  values.resize(2);
  values.resize(4);  // Within it, with zeros as ever.
  EXPECT_EQ(values.data(), lender.memory());
  EXPECT_EQ(lender.now(), (std::array<double, 4>{1, 2, 0, 0}));
  values.push_back(5);
  EXPECT_NE(values.data(), lender.memory());
  EXPECT_EQ(lender.kept(), 0);
  values[0] = 100;
  values.resize(7);
  EXPECT_EQ(values, (Values<double>{100, 2, 0, 0, 5, 0, 0}));
  EXPECT_EQ(lender.now(), (std::array<double, 4>{1, 2, 0, 0}));
}

TEST(Values, AnAssignedCopyIsWrittenInPlaceWhereItFits) {
  Lender lender;
  Values<double> values = lender.lend();
  const Values<double> few{7, 8}, many{1, 2, 3, 4, 5};
  values = few;
  EXPECT_EQ(lender.now(), (std::array<double, 4>{7, 8, 3, 4}));
  values = many;
  EXPECT_EQ(lender.kept(), 0);
  EXPECT_EQ(values, many);
  Values<double> own;
  own = lender.lend();
  const Values<double> borrowed = lender.lend();
  own = borrowed;  // Both of the same memory.
  EXPECT_EQ(own, (Values<double>{7, 8, 3, 4}));
}

TEST(Values, TwoLoansOfTheSameMemoryAreTwo) {
  Lender lender;
  Values<double> a = lender.lend(), b = lender.lend();
  EXPECT_FALSE(a.get_allocator() == b.get_allocator());
  EXPECT_EQ(lender.kept(), 2);
  a = Values<double>();
  EXPECT_EQ(lender.kept(), 1);
  EXPECT_EQ(b, (Values<double>{1, 2, 3, 4}));
}

TEST(Values, OfNothingBorrowNothing) {
  Lender lender;
  Values<double> values = borrowed_values<double>(nullptr, lender.memory(), 0);
  EXPECT_TRUE(values.empty());
  values.resize(4);
  EXPECT_EQ(lender.now(), k_lent);
}

TEST(Values, WithoutAKeeperMemoryIsTheCallers) {
  std::array<int, 3> memory{1, 2, 3};
  {
    Values<int> values = borrowed_values<int>(nullptr, memory.data(), memory.size());
    values.front() = 10;
  }
  EXPECT_EQ(memory, (std::array<int, 3>{10, 2, 3}));
}

TEST(Values, AdoptAPlainVector) {
  std::vector<Vec2> plain{{1, 2}, {3, 4}};
  const Vec2* memory = plain.data();
  Values<Vec2> values = adopted_values(std::move(plain));
  EXPECT_EQ(values.data(), memory);
  values.push_back({5, 6});
  EXPECT_EQ(values, (Values<Vec2>{{1, 2}, {3, 4}, {5, 6}}));
}
