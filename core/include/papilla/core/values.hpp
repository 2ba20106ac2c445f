// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <iterator>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace papilla {

namespace detail {

/// Memory of another owner, on its way into a vector or in one.
struct Loan {
  std::shared_ptr<void> keeper;  ///< Keeps the memory until the vector gives it back.
  void* memory = nullptr;        ///< Null when it was given back.
  std::size_t bytes = 0;
  bool is_taken = false;
};

/// Stands for "the value that is there".
struct InPlace {};

/// As many of these as a range has elements.
struct InPlaceIterator {
  using iterator_category = std::random_access_iterator_tag;
  using value_type = InPlace;
  using difference_type = std::ptrdiff_t;
  using pointer = const InPlace*;
  using reference = InPlace;

  difference_type at = 0;
  InPlace operator*() const noexcept { return {}; }
  InPlaceIterator& operator++() noexcept { return ++at, *this; }
  InPlaceIterator operator++(int) noexcept { return {at++}; }
  InPlaceIterator& operator+=(difference_type step) noexcept { return at += step, *this; }
  friend InPlaceIterator operator+(InPlaceIterator a, difference_type step) noexcept { return {a.at + step}; }
  friend difference_type operator-(InPlaceIterator a, InPlaceIterator b) noexcept { return a.at - b.at; }
  friend bool operator==(InPlaceIterator, InPlaceIterator) = default;
};

}  // namespace detail

/// The allocator of Values: std::allocator, but for vectors of borrowed_values(), whose first memory is another's.
///
/// Two are equal when they are of the same loan or of none. A copy of a vector is made with the plain one, a vector
/// that is moved or swapped takes its memory along, and one that is assigned a copy keeps its own.
template <class T>
class ValueAllocator {
 public:
  using value_type = T;
  using propagate_on_container_copy_assignment = std::false_type;
  using propagate_on_container_move_assignment = std::true_type;
  using propagate_on_container_swap = std::true_type;
  using is_always_equal = std::false_type;

  ValueAllocator() noexcept = default;
  explicit ValueAllocator(std::shared_ptr<detail::Loan> loan) noexcept : loan_(std::move(loan)) {}
  // Copies even when moved from: an allocator that is moved from stays equal to the new one.
  ValueAllocator(const ValueAllocator&) noexcept = default;
  ValueAllocator& operator=(const ValueAllocator&) noexcept = default;
  template <class U>
  ValueAllocator(const ValueAllocator<U>& other) noexcept : loan_(other.loan_) {}
  ~ValueAllocator() = default;

  T* allocate(std::size_t count) {
    if (loan_ && !loan_->is_taken && count * sizeof(T) == loan_->bytes) {
      loan_->is_taken = true;
      return static_cast<T*>(loan_->memory);
    }
    return std::allocator<T>().allocate(count);
  }
  void deallocate(T* memory, std::size_t count) noexcept {
    if (loan_ && memory == loan_->memory) {
      loan_->memory = nullptr;
      loan_->keeper.reset();
    } else {
      std::allocator<T>().deallocate(memory, count);
    }
  }

  template <class U>
  void construct(U*, detail::InPlace) const noexcept {}

  ValueAllocator select_on_container_copy_construction() const noexcept { return {}; }

  template <class U>
  friend bool operator==(const ValueAllocator& a, const ValueAllocator<U>& b) noexcept {
    return a.loan_ == b.loan_;
  }

 private:
  template <class>
  friend class ValueAllocator;

  std::shared_ptr<detail::Loan> loan_;
};

/// A std::vector of the numbers of a mesh or picture, which may also look at memory of another owner.
///
/// By itself it is a vector like any other: resize() makes zeros, a copy has memory of its own. One of
/// borrowed_values() reads and writes what it borrowed, until it is destroyed, assigned by a move, or grows beyond it;
/// then its values are in memory of its own, and what was borrowed stays as it was last. Assigning a *copy* to it
/// writes into what it borrowed as long as that is large enough.
template <class T>
using Values = std::vector<T, ValueAllocator<T>>;

/// A vector of the `count` values at `memory`, looked at in place.
///
/// @param keeper  keeps the memory; may be empty where the memory outlives the vector and whatever it is moved to. Let
///                go as soon as no vector looks at the memory, by the thread that makes it so.
/// @param memory  aligned, initialised; written through the vector, and nothing hinders others to write it meanwhile.
/// Cost: O(1), whatever `count` is, and one small allocation.
template <class T>
Values<T> borrowed_values(std::shared_ptr<void> keeper, T* memory, std::size_t count) {
  static_assert(std::is_trivially_copyable_v<T>, "nobody destroys what is borrowed");
  if (count == 0) return {};
  auto loan = std::make_shared<detail::Loan>(detail::Loan{std::move(keeper), memory, count * sizeof(T), false});
  return Values<T>(detail::InPlaceIterator{0}, detail::InPlaceIterator{static_cast<std::ptrdiff_t>(count)},
                   ValueAllocator<T>(std::move(loan)));
}

/// The values of a plain vector, without a copy: its memory is borrowed and kept.
template <class T>
Values<T> adopted_values(std::vector<T>&& values) {
  const auto kept = std::make_shared<std::vector<T>>(std::move(values));
  return borrowed_values(std::shared_ptr<void>(kept), kept->data(), kept->size());
}

}  // namespace papilla
