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

StageCache::StageCache(ContentStore store) : store_(std::move(store)), counts_(std::make_unique<Counts>()) {}
StageCache::~StageCache() = default;

CacheCounts StageCache::counts() const {
  const std::scoped_lock lock(counts_->mutex);
  return counts_->of_stage;
}

CacheCounts StageCache::take_counts() const {
  const std::scoped_lock lock(counts_->mutex);
  return std::exchange(counts_->of_stage, {});
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
  return store_.write(stage, key, give);
} catch (const IoError& error) {
  const std::scoped_lock lock(counts_->mutex);
  counts_->problem = error.what();
  return 0;
}

}  // namespace papilla
