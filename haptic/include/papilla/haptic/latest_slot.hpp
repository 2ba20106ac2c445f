// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace papilla {

/// The newest value of one writer thread for any number of readers; older values may be skipped.
///
/// store() is wait-free, allocates nothing and makes no system call. load() never mixes two values.
/// Source: a sequence lock over atomic words, H.-J. Boehm, "Can seqlocks get along with programming language
/// memory models?", MSPC 2012.
template <class T>
class LatestSlot {
  static_assert(std::is_trivially_copyable_v<T>);
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

 public:
  void store(const T& value) noexcept {
    Words words{};
    std::memcpy(words.data(), static_cast<const void*>(&value), sizeof value);
    const std::uint64_t sequence = sequence_.load(std::memory_order_relaxed);
    sequence_.store(sequence + 1, std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_release);
    for (std::size_t i = 0; i < k_words; ++i) words_[i].store(words[i], std::memory_order_relaxed);
    sequence_.store(sequence + 2, std::memory_order_release);
  }

  /// @param value becomes the newest value; unchanged when nothing was stored yet.
  /// @returns the number of stores up to that value.
  std::uint64_t load(T& value) const noexcept {
    Words words{};
    for (;;) {
      const std::uint64_t sequence = sequence_.load(std::memory_order_acquire);
      if (sequence == 0) return 0;
      if (sequence % 2 != 0) continue;
      for (std::size_t i = 0; i < k_words; ++i) words[i] = words_[i].load(std::memory_order_relaxed);
      std::atomic_thread_fence(std::memory_order_acquire);
      if (sequence_.load(std::memory_order_relaxed) != sequence) continue;
      std::memcpy(static_cast<void*>(&value), words.data(), sizeof value);
      return sequence / 2;
    }
  }

 private:
  static constexpr std::size_t k_words = (sizeof(T) + 7) / 8;
  using Words = std::array<std::uint64_t, k_words>;

  std::atomic<std::uint64_t> sequence_{0};  ///< Odd while a value is being stored.
  std::array<std::atomic<std::uint64_t>, k_words> words_{};
};

}  // namespace papilla
