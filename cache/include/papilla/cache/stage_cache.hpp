// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "papilla/cache/content_store.hpp"
#include "papilla/cache/stage_key.hpp"
#include "papilla/core/value_stream.hpp"

namespace papilla {

/// What a run had to do with the entries of one stage.
struct CacheCount {
  std::size_t found = 0, made = 0;
  std::uintmax_t bytes_read = 0, bytes_written = 0;
  std::size_t taken = 0;  ///< Of those found the ones that only the shared cache had.
  std::uintmax_t bytes_taken = 0;
};

using CacheCounts = std::map<std::string, CacheCount>;  ///< By stage.

/// Whether results may become entries. A result that a time limit cut short must not.
enum class CacheUse { read_only, read_write };

/// Of stages that `deadline` may cut short.
inline CacheUse use_until(const Deadline& deadline) {
  return deadline.never() ? CacheUse::read_write : CacheUse::read_only;
}

/// Remembers what the stages of a pipeline made, by the digest of all that went into it (key_of()). May be used from
/// any number of threads. A store that can't be written to is no error: the first refusal is kept as problem(), and
/// nothing is written from then on.
class StageCache {
 public:
  /// @param shared  a cache that others use, too, behind `store`: what only it has is taken over, and what is made here
  ///                becomes an entry of both. Null: there is none.
  explicit StageCache(ContentStore store, const StageCache* shared = nullptr);
  ~StageCache();
  /// The same stores, nothing counted: for a forked child, where this one may stay locked by a thread that is not
  /// there.
  std::unique_ptr<StageCache> for_child() const;
  StageCache(const StageCache&) = delete;
  StageCache& operator=(const StageCache&) = delete;

  const ContentStore& store() const noexcept { return store_; }
  CacheCounts counts() const;  ///< Of all calls so far.
  std::string problem() const;
  /// Stage and key of every result that was found or put, in no order.
  std::vector<std::pair<std::string, Digest>> results() const;
  /// Adds to the shared cache's counts what was taken from it, and what was made and it lacked.
  void report_to_shared() const;
  /// Adds what a child process did.
  void add(const std::string& stage, const CacheCount& count) const;

  /// The stored result of a stage.
  template <class Value>
  std::optional<Value> find(std::string_view stage, const Digest& key) const {
    std::optional<Value> value;
    CacheCount count{.found = 1};
    const auto take = [&](EntrySource& source) {
      count.bytes_read = source.most_bytes();
      ValueReader{source}(value.emplace());
    };
    const bool found = store_.read(stage, key, take) || (take_over(stage, key) && store_.read(stage, key, take));
    if (found)
      note(stage, key, count);
    else
      value.reset();
    return value;
  }
  /// Makes a result one that find() finds. Without `use` of writing it is only counted.
  template <class Value>
  void put(std::string_view stage, const Digest& key, CacheUse use, const Value& value) const {
    CacheCount count{.made = 1};
    if (use == CacheUse::read_write)
      count.bytes_written = write(stage, key, [&](EntrySink& sink) { ValueWriter{sink}(value); });
    note(stage, key, count);
  }

 private:
  void note(std::string_view stage, const Digest& key, const CacheCount& count) const;
  std::uint64_t write(std::string_view stage, const Digest& key, const std::function<void(EntrySink&)>& give) const;
  /// Of the shared cache's entry. @return whether there is one now in the own store.
  bool take_over(std::string_view stage, const Digest& key) const;
  /// An entry of the own store into the shared cache.
  void hand_on(std::string_view stage, const Digest& key) const;
  void refused(const char* reason) const;

  ContentStore store_;
  std::unique_ptr<StageCache> own_shared_;  ///< Of for_child().
  const StageCache* shared_;
  struct Counts;
  std::unique_ptr<Counts> counts_;
};

/// A stage's result, and whether it was there before.
template <class Value>
struct Remembered {
  Value value;
  bool found = false;
};

/// The result of a stage: `make()`, or what it gave before for the same key.
template <class Make>
auto remembered_by(const Digest& key, const StageCache& cache, std::string_view stage, CacheUse use, const Make& make)
    -> Remembered<decltype(make())> {
  if (auto found = cache.find<decltype(make())>(stage, key)) return {std::move(*found), true};
  auto value = make();
  cache.put(stage, key, use, value);
  return {std::move(value)};
}

/// The same by the key of `inputs`, all that the result depends on. Without a cache no key is computed.
template <class Make, class... Inputs>
auto remembered(const StageCache* cache, std::string_view stage, CacheUse use, const Make& make,
                const Inputs&... inputs) -> Remembered<decltype(make())> {
  if (cache == nullptr) return {make()};
  return remembered_by(key_of(stage, inputs...), *cache, stage, use, make);
}

}  // namespace papilla
