// SPDX-License-Identifier: MIT
#include "papilla/cache/stage_cache.hpp"

#include <mutex>
#include <utility>

#include "papilla/core/error.hpp"

namespace papilla {

struct StageCache::Counts {
  std::mutex mutex;
  CacheCounts of_stage;
  std::vector<std::pair<std::string, Digest>> results;
  std::string problem;
};

StageCache::StageCache(ContentStore store, const StageCache* shared)
    : store_(std::move(store)), shared_(shared), counts_(std::make_unique<Counts>()) {}
StageCache::~StageCache() = default;

std::unique_ptr<StageCache> StageCache::for_child() const {
  auto own_shared = shared_ != nullptr ? std::make_unique<StageCache>(shared_->store_) : nullptr;
  auto own = std::make_unique<StageCache>(store_, own_shared.get());
  own->own_shared_ = std::move(own_shared);
  return own;
}

CacheCounts StageCache::counts() const {
  const std::scoped_lock lock(counts_->mutex);
  return counts_->of_stage;
}

std::string StageCache::problem() const {
  const std::scoped_lock lock(counts_->mutex);
  return counts_->problem;
}

void StageCache::add(const std::string& stage, const CacheCount& count) const {
  const std::scoped_lock lock(counts_->mutex);
  CacheCount& sum = counts_->of_stage[stage];
  sum.found += count.found, sum.made += count.made;
  sum.bytes_read += count.bytes_read, sum.bytes_written += count.bytes_written;
  sum.taken += count.taken, sum.bytes_taken += count.bytes_taken;
}

void StageCache::report_to_shared() const {
  if (shared_ == nullptr) return;
  for (const auto& [stage, count] : counts())
    shared_->add(stage, {.found = count.taken,
                         .made = count.made,
                         .bytes_read = count.bytes_taken,
                         .bytes_written = count.bytes_written});
}

std::vector<std::pair<std::string, Digest>> StageCache::results() const {
  const std::scoped_lock lock(counts_->mutex);
  return counts_->results;
}

void StageCache::note(std::string_view stage, const Digest& key, const CacheCount& count) const {
  add(std::string(stage), count);
  const std::scoped_lock lock(counts_->mutex);
  counts_->results.emplace_back(stage, key);
}

std::uint64_t StageCache::write(std::string_view stage, const Digest& key,
                                const std::function<void(EntrySink&)>& give) const try {
  if (!problem().empty()) return 0;
  const std::uint64_t bytes = store_.write(stage, key, give);
  if (shared_ != nullptr) hand_on(stage, key);
  return bytes;
} catch (const IoError& error) {
  refused(error.what());
  return 0;
}

bool StageCache::take_over(std::string_view stage, const Digest& key) const try {
  if (shared_ == nullptr) return false;
  const std::optional<std::uint64_t> bytes = store_.adopt(shared_->store_, stage, key);
  if (bytes) add(std::string(stage), {.taken = 1, .bytes_taken = *bytes});
  return bytes.has_value();
} catch (const IoError& error) {
  refused(error.what());
  return false;
}

void StageCache::hand_on(std::string_view stage, const Digest& key) const try {
  if (shared_->problem().empty()) shared_->store_.adopt(store_, stage, key);
} catch (const IoError& error) {
  shared_->refused(error.what());
}

void StageCache::refused(const char* reason) const {
  const std::scoped_lock lock(counts_->mutex);
  counts_->problem = reason;
}

}  // namespace papilla
