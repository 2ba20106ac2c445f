// SPDX-License-Identifier: GPL-3.0-or-later
#include "verb.hpp"

#include <fmt/core.h>
#include <oneapi/tbb/global_control.h>
#include <unistd.h>

#include <memory>
#include <new>
#include <optional>

#include "file_options.hpp"
#include "option_checks.hpp"
#include "options/cache_option.hpp"
#include "options/config_option.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/io/picture_memory.hpp"
#include "parsing_only.hpp"
#include "progress_printer.hpp"
#include "standard_output.hpp"

namespace papilla::app {
namespace {

constexpr double k_more_for_reading_s = 60;

int g_exit_code = 0;
std::function<void(const Json&)> g_publish;  ///< Of the verb that runs.
bool g_parsing_only = false;

struct CommonOptions {
  std::string json;
  std::string progress = "auto";
  bool quiet = false;
  int threads = 0;
  std::uint64_t seed = 1;
  std::uint64_t max_memory = 0;
  std::optional<double> time_limit_s;
  CacheOption cache;
};

/// What a run did with its cache, for JSON and people; then the cache is brought within its limit.
void close_cache(const StageCache& cache, std::uint64_t limit, const Console& console, Json& result) {
  result["cache"] = cache_json(cache);
  console.print(cache_line(cache));
  std::uint64_t written = 0;
  for (const auto& [stage, count] : cache.counts()) written += count.bytes_written;
  if (written > 0) cache.store().evict(limit);
}

/// The values of the options that name files to read, separated by commas.
std::string inputs_of(const CLI::App& verb) {
  std::string names;
  for (const CLI::Option* option : verb.get_options()) {
    const auto known = file_options().find(option);
    if (known == file_options().end() || known->second.use != FileOption::Use::input) continue;
    for (const std::string& value : option->results()) names += (names.empty() ? "" : ", ") + value;
  }
  return names;
}

void run_verb(const CLI::App& verb, const CommonOptions& common, const VerbInfo& info, const VerbBody& body) {
  const bool json_on_stdout = common.json == "-";
  std::optional<oneapi::tbb::global_control> limit;
  if (common.threads > 0)
    limit.emplace(oneapi::tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(common.threads));

  VerbContext context{Console(common.quiet || json_on_stdout), {}, common.threads, {}, {}, common.seed, nullptr, 0};
  if (common.time_limit_s) {
    context.deadline = Deadline(*common.time_limit_s);
    context.read_deadline = Deadline(2 * *common.time_limit_s + k_more_for_reading_s);
  }
  const bool wants_json = common.progress == "json";
  std::shared_ptr<ProgressPrinter> printer;
  if (wants_json || (common.progress == "auto" && !common.quiet && ::isatty(STDERR_FILENO)))
    printer = std::make_shared<ProgressPrinter>(wants_json ? ProgressPrinter::Form::json : ProgressPrinter::Form::line);
  std::string stage = "reading";
  const bool remembers = info.remembers == VerbInfo::Remembers::yes;
  const std::uint64_t cache_limit = remembers ? common.cache.limit() : 0;
  const std::unique_ptr<StageCache> cache = remembers ? common.cache.open() : nullptr;
  context.cache = cache.get();
  const bool cancels = info.at_deadline == VerbInfo::AtDeadline::is_cancelled;
  context.progress = [printer, &stage, cancels, deadline = context.deadline](const Progress& done) {
    if (stage != done.stage) stage = done.stage;
    if (printer) printer->report(done.stage, done.fraction);
    return !cancels || !deadline.passed();
  };
  set_picture_memory(common.max_memory);
  const auto write_json = [&](const Json& json) {
    if (json_on_stdout)
      print_out(json_text(json));
    else if (!common.json.empty())
      write_atomically(common.json, json_text(json));
  };
  bool is_published = false;
  g_publish = [&](const Json& json) { write_json(json), is_published = true; };
  Json result;
  try {
    result = body(context);
    if (context.cache != nullptr) close_cache(*context.cache, cache_limit, context.console, result);
  } catch (const Cancelled&) {
    throw SolverFailure(
        fmt::format("the time limit of {:g} s is reached, at '{}': no result", *common.time_limit_s, stage));
  } catch (const std::bad_alloc&) {
    const std::string inputs = inputs_of(verb);
    throw InvalidInput((inputs.empty() ? verb.get_name() : inputs) + ": no memory is left, at '" + stage + "'");
  }
  context.progress = {};
  printer.reset();
  if (!is_published) write_json(result);
  g_exit_code = context.exit_code;
}

}  // namespace

void Console::print(const std::string& text) const {
  if (!silent_) print_out(text);
}

void publish_result(const Json& result) { g_publish(result); }

CLI::App* add_verb(CLI::App& program, const VerbInfo& info, VerbBody body) {
  CLI::App* verb = program.add_subcommand(info.name, info.summary);
  verb->footer("Example:\n  " + info.example);
  auto common = std::make_shared<CommonOptions>();
  add_config(*verb);
  writes(verb->add_option("--json", common->json, "Write the machine-readable result to FILE, or to stdout with -"))
      ->type_name("FILE|-")
      ->group("Common");
  verb->add_flag("-q,--quiet", common->quiet, "Print nothing but errors")->group("Common");
  verb->add_option("--threads", common->threads, "Use N threads; 0 takes all cores")
      ->type_name("N")
      ->check(in_range(0, 1024))
      ->group("Common");
  verb->add_option("--seed", common->seed, "Seed of everything random")
      ->type_name("N")
      ->capture_default_str()
      ->group("Common");
  verb->add_option("--max-memory", common->max_memory,
                   "What a picture may take, like 512M or 2G; default: half of the machine's memory. Larger ones are "
                   "read in bands or refused")
      ->transform(CLI::AsSizeValue(false))
      ->check(positive())
      ->type_name("SIZE")
      ->group("Common");
  verb->add_option("--progress", common->progress, "auto (a line on a terminal), json (a JSON object a line), none")
      ->transform(one_of({"auto", "json", "none"}))
      ->capture_default_str()
      ->group("Common");
  verb->add_option("--time-limit,--timeout", common->time_limit_s,
                   info.at_deadline == VerbInfo::AtDeadline::ends
                       ? "End after so long, with the best valid result so far"
                       : "End after so long, with exit code 4 and no result when it is not done")
      ->check(not_negative())
      ->type_name("S")
      ->group("Common");
  if (info.remembers == VerbInfo::Remembers::yes) common->cache.add_to(*verb);
  verb->callback([verb, common, info, body = std::move(body)] {
    if (g_parsing_only) return;
    declare_files(*verb);
    require_outputs(*verb);
    run_verb(*verb, *common, info, body);
  });
  return verb;
}

ParsingOnly::ParsingOnly() noexcept { g_parsing_only = true; }
ParsingOnly::~ParsingOnly() { g_parsing_only = false; }

int verb_exit_code() noexcept { return g_exit_code; }

}  // namespace papilla::app
