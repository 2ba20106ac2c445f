// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>
#include <string>

#include "json/json.hpp"
#include "papilla/cache/stage_cache.hpp"

namespace papilla::app {

/// Where results are remembered from one run to the next: --cache, PAPILLA_CACHE, or the user's cache folder.
struct CacheOption {
  std::string folder;            ///< Of --cache: a folder, "none", or empty when it is not given.
  std::uint64_t most_bytes = 0;  ///< Of --cache-limit; 0: not given.

  void add_to(CLI::App& verb);
  /// What the options and the environment name; null for none, and where the user has no folder.
  /// @throws InvalidInput when --cache or PAPILLA_CACHE name what is no folder.
  std::unique_ptr<StageCache> open() const;
  /// --cache-limit, PAPILLA_CACHE_LIMIT, or 10 GiB.
  std::uint64_t limit() const;
};

/// Whether --cache or PAPILLA_CACHE name the cache; else it is the user's.
bool is_cache_named(const CLI::App& verb);

/// {"folder": ..., "found": {"uv": 12, ...}, "made": {...}, "bytes_read": ..., "bytes_written": ..., "problem": ...}
Json cache_json(const StageCache& cache);

/// "cache: 31 of 33 results found in /home/ada/.cache/papilla"; empty when nothing was asked for.
std::string cache_line(const StageCache& cache);

}  // namespace papilla::app
