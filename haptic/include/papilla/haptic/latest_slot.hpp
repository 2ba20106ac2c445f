// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace papilla {

/// One value that a thread overwrites and others look at: the newest wins, the ones between may never be seen.
///
/// store() is wait-free, allocates nothing and makes no system call, so that it fits into a tick. load() gives a value
/// that was stored as a whole, never parts of two. One thread stores; any number load.
/// Source: a sequence lock over atomic words, as in H.-J. Boehm, "Can seqlocks get along with programming language
/// memory models?", MSPC 2012.
template <class T>
class LatestSlot {
  static_assert(std::is_trivially_copyable_v<T>);
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

 public:
  void store(const T& value) noexcept {
    Words words{};
    std::memcpy(words.data(), static_cast<const void*>(&value), sizeof value);
    const std::uint64_t turn = turn_.load(std::memory_order_relaxed);
    turn_.store(turn + 1, std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_release);
    for (std::size_t i = 0; i < k_words; ++i) words_[i].store(words[i], std::memory_order_relaxed);
    turn_.store(turn + 2, std::memory_order_release);
  }

  /// @param value gets the newest; stays as it is when nothing was stored yet.
  /// @returns how many values have been stored up to this one.
  std::uint64_t load(T& value) const noexcept {
    Words words{};
    for (;;) {
      const std::uint64_t turn = turn_.load(std::memory_order_acquire);
      if (turn == 0) return 0;
      if (turn % 2 != 0) continue;
      for (std::size_t i = 0; i < k_words; ++i) words[i] = words_[i].load(std::memory_order_relaxed);
      std::atomic_thread_fence(std::memory_order_acquire);
      if (turn_.load(std::memory_order_relaxed) != turn) continue;
      std::memcpy(static_cast<void*>(&value), words.data(), sizeof value);
      return turn / 2;
    }
  }

 private:
  static constexpr std::size_t k_words = (sizeof(T) + 7) / 8;
  using Words = std::array<std::uint64_t, k_words>;

  std::atomic<std::uint64_t> turn_{0};  ///< Odd while a value is being stored.
  std::array<std::atomic<std::uint64_t>, k_words> words_{};
};

}  // namespace papilla
