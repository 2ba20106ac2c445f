// SPDX-License-Identifier: GPL-3.0-or-later
#include <chrono>
#include <ctime>
#include <memory>
#include <string>

#include "exit_code.hpp"
#include "option_checks.hpp"
#include "options/cache_option.hpp"
#include "papilla/cache/content_store.hpp"
#include "shown_format.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Options {
  std::string what;
  CacheOption cache;
};

double megabytes(std::uintmax_t bytes) { return static_cast<double>(bytes) / 1e6; }

/// "2026-11-26T07:24:11Z".
std::string utc(std::chrono::system_clock::time_point time) {
  const std::time_t seconds = std::chrono::system_clock::to_time_t(time);
  std::tm parts{};
  ::gmtime_r(&seconds, &parts);
  char text[sizeof "2026-11-26T07:24:11Z"];
  std::strftime(text, sizeof text, "%FT%TZ", &parts);
  return text;
}

Json run_stats(const ContentStore& store, std::uint64_t limit, const VerbContext& context) {
  const StoreStatistics statistics = store.statistics();
  Json stages = Json::object();
  std::string text;
  for (const auto& [stage, count] : statistics.stages) {
    stages[stage] = {{"entries", count.entries}, {"bytes", count.bytes}};
    text += shown_format("{:<14} {:>8} entries {:>10.1f} MB\n", stage, count.entries, megabytes(count.bytes));
  }
  text += shown_format("{}: {} entries, {:.1f} of {:.0f} MB", store.folder().string(), statistics.total.entries,
                       megabytes(statistics.total.bytes), megabytes(limit));
  Json json = {{"folder", store.folder().string()},
               {"entries", statistics.total.entries},
               {"bytes", statistics.total.bytes},
               {"limit", limit},
               {"stages", stages}};
  if (statistics.total.entries > 0) {
    json["least_recent_use"] = utc(statistics.least_recent);
    json["most_recent_use"] = utc(statistics.most_recent);
    text += shown_format(", used between {} and {}", utc(statistics.least_recent), utc(statistics.most_recent));
  }
  context.console.print(text + "\n");
  return json;
}

Json run_verify(const ContentStore& store, VerbContext& context) {
  const StoreVerification verified = store.verify(context.progress);
  Json damaged = Json::array();
  for (const auto& path : verified.damaged) {
    damaged.push_back(path.string());
    context.console.print(shown_format("{}: damaged, removed\n", path.string()));
  }
  context.console.print(
      shown_format("{}: {} entries whole, {} damaged\n", store.folder().string(), verified.whole, damaged.size()));
  if (!damaged.empty()) context.exit_code = k_exit_input;
  return {{"folder", store.folder().string()}, {"whole", verified.whole}, {"damaged", damaged}};
}

Json run_clear(const ContentStore& store, const VerbContext& context) {
  const StoreCount removed = store.clear();
  context.console.print(shown_format("{}: {} entries removed, {:.1f} MB\n", store.folder().string(), removed.entries,
                                     megabytes(removed.bytes)));
  return {{"folder", store.folder().string()}, {"removed", removed.entries}, {"bytes", removed.bytes}};
}

Json run(const Options& options, VerbContext& context) {
  const std::uint64_t limit = options.cache.limit();
  const std::unique_ptr<StageCache> cache = options.cache.open();
  if (!cache) throw UsageError("there is no cache: --cache and PAPILLA_CACHE say none, or the user has no folder");
  if (options.what == "stats") return run_stats(cache->store(), limit, context);
  return options.what == "verify" ? run_verify(cache->store(), context) : run_clear(cache->store(), context);
}

}  // namespace

void add_cache(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = add_verb(program,
                            {"cache", "Shows, checks and empties what is remembered from run to run",
                             "papilla cache stats; papilla cache verify --cache /project/papilla-cache"},
                            [options](VerbContext& context) { return run(*options, context); });
  verb->add_option("what", options->what,
                   "stats, verify (reads all entries and removes damaged ones: exit code 3) or clear")
      ->required()
      ->transform(one_of({"stats", "verify", "clear"}));
  options->cache.add_to(*verb);
}

}  // namespace papilla::app
