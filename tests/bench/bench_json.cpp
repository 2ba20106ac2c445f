// SPDX-License-Identifier: MIT
#include "bench_json.hpp"

#include <fmt/chrono.h>
#include <fmt/core.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <iostream>
#include <limits>

#include "exit_code.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/machine.hpp"
#include "papilla_bench_build.hpp"

namespace papilla::bench {
namespace {

double clock_seconds(clockid_t clock) {
  timespec time{};
  ::clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

Json machine_json() {
  const Machine machine = this_machine();
  return {
      {"cpu", machine.cpu}, {"cores", machine.cores}, {"memory_mib", machine.memory_mib}, {"kernel", machine.kernel}};
}

Json compiler_json() {
  return {{"name", PAPILLA_BENCH_COMPILER},
          {"version", PAPILLA_BENCH_COMPILER_VERSION},
          {"flags", PAPILLA_BENCH_FLAGS},
          {"build_type", PAPILLA_BENCH_BUILD_TYPE}};
}

Json trace_json(const Trace& trace) {
  Json samples = Json::array();
  for (const TraceSample& sample : trace) samples.push_back({{"seconds", sample.seconds}, {"error", sample.error}});
  return samples;
}

std::string label(const Subject& subject) {
  return subject.solver.empty() ? subject.method : subject.method + "/" + subject.solver;
}

/// Five significant digits, as the table shows them.
std::string number(double value) { return fmt::format("{:.5g}", value); }

/// Columns as wide as their widest cell; the first `left` ones are aligned to the left.
std::string aligned(const std::vector<std::vector<std::string>>& rows, std::size_t left) {
  std::vector<std::size_t> width;
  for (const auto& row : rows) {
    width.resize(std::max(width.size(), row.size()));
    for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c)
      line += c < left ? fmt::format("{:<{}}  ", row[c], width[c]) : fmt::format("{:>{}}  ", row[c], width[c]);
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

BenchOptions parse_options(CLI::App& program, int argc, char** argv) {
  BenchOptions options;
  program.add_option("--json", options.json, "Write the JSON to FILE, or to stdout with -")->type_name("FILE|-");
  program.add_option("--evidence", options.evidence, "Write a Markdown page of targets and rows to FILE")
      ->type_name("FILE");
  program.add_option("--repeats", options.repeats, "Timed runs of every method")->check(CLI::Range(1, 100000));
  program.add_option("--warm-up", options.warm_up, "Untimed runs before them")->check(CLI::Range(0, 1000));
  program.add_option("--threads", options.threads, "Use N threads; 0 takes all cores")->check(CLI::Range(0, 1024));
  program.add_flag("--quick", options.quick, "Small inputs: shows that the program works, measures nothing of use");
  program.add_option("INPUT", options.inputs, "Files to measure on, for benchmarks that take some");
  program.parse(argc, argv);
  return options;
}

/// As ./run takes it, without the files that a run writes.
std::string command_line(const std::string& name, int argc, char** argv) {
  std::string command = "./run bench " + name;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--json" || word == "--evidence")
      ++i;
    else
      command += " " + (word.starts_with('/') ? word.substr(word.find_last_of('/') + 1) : word);
  }
  return command;
}

}  // namespace

void empty_caches() {
  constexpr std::size_t k_line = 64;
  const long largest = ::sysconf(_SC_LEVEL3_CACHE_SIZE);
  static std::vector<char> memory(2 * static_cast<std::size_t>(std::max(largest, 32L << 20)));
  for (std::size_t i = 0; i < memory.size(); i += k_line) memory[i] = static_cast<char>(memory[i] + 1);
  keep(memory.data());
}

double thread_cpu_seconds() { return clock_seconds(CLOCK_THREAD_CPUTIME_ID); }
double process_cpu_seconds() { return clock_seconds(CLOCK_PROCESS_CPUTIME_ID); }

double cpu_of(int repeats, const std::function<void()>& work) {
  constexpr double k_short_s = 0.5;
  double least = std::numeric_limits<double>::infinity(), sum = 0;
  for (int i = 0; i < repeats || (repeats > 1 && sum < k_short_s); ++i) {
    const double before = process_cpu_seconds();
    work();
    const double seconds = process_cpu_seconds() - before;
    least = std::min(least, seconds);
    sum += seconds;
  }
  return least;
}
void reset_peak_rss() { std::ofstream("/proc/self/clear_refs") << "5"; }

double median(std::vector<double> values) {
  if (values.empty()) throw InvalidInput("median: no values");
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

void Recorder::time(const std::function<void()>& work) {
  const double cpu_before = process_cpu_seconds();
  const Stopwatch clock;
  work();
  seconds_ = seconds_.value_or(0) + clock.seconds();
  cpu_seconds_ = cpu_seconds_.value_or(0) + process_cpu_seconds() - cpu_before;
}

void Recorder::record(std::string_view quantity, double value) {
  if (!std::isfinite(value)) throw InvalidInput(fmt::format("benchmark: {} is {}", quantity, value));
  for (const auto& [name, old] : values_)
    if (name == quantity) throw InvalidInput(fmt::format("benchmark: {} is recorded twice in one repeat", quantity));
  values_.emplace_back(quantity, value);
}

void Recorder::trace(Trace trace) { trace_ = std::move(trace); }
void Recorder::stop(StopReason reason) { stop_ = reason; }

BenchReport::BenchReport(std::string name, std::string summary, BenchOptions options) : options_(std::move(options)) {
  json_ = {{"benchmark", std::move(name)},
           {"summary", std::move(summary)},
           {"started", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
           {"commit", PAPILLA_BENCH_COMMIT},
           {"version", version()},
           {"machine", machine_json()},
           {"compiler", compiler_json()},
           {"threads", options_.threads > 0 ? options_.threads : oneapi::tbb::info::default_concurrency()},
           {"repeats", options_.repeats},
           {"warm_up", options_.warm_up},
           {"quick", options_.quick}};
}

void BenchReport::add(Subject subject, std::function<void(Recorder&)> work) {
  entries_.push_back({std::move(subject), std::move(work), {}, {}, {}});
}

void BenchReport::compare(std::string method, std::string peer, std::string quantity) {
  comparisons_.push_back({std::move(method), std::move(peer), std::move(quantity)});
}

void BenchReport::run_once(Entry& entry, bool warm_up) {
  Recorder whole, recorder;
  reset_peak_rss();
  whole.time([&] { entry.work(recorder); });
  if (warm_up) return;
  recorder.record("seconds", recorder.seconds_.value_or(*whole.seconds_));
  recorder.record("cpu_seconds", recorder.cpu_seconds_.value_or(*whole.cpu_seconds_));
  recorder.record("peak_rss_mib", peak_rss_mib());

  const bool first = entry.samples.empty();
  if (first)
    for (const auto& [name, value] : recorder.values_) entry.samples.emplace_back(name, std::vector<double>());
  const auto same_name = [](const auto& a, const auto& b) { return a.first == b.first; };
  if (!std::ranges::equal(entry.samples, recorder.values_, same_name))
    throw InvalidInput("benchmark: " + label(entry.subject) + " does not record the same quantities in every repeat");
  for (std::size_t i = 0; i < entry.samples.size(); ++i) entry.samples[i].second.push_back(recorder.values_[i].second);
  entry.trace = std::move(recorder.trace_);
  entry.stop = recorder.stop_;
}

Json BenchReport::entry_json(const Entry& entry) const {
  Json repeats = Json::object(), medians = Json::object();
  for (const auto& [name, values] : entry.samples) {
    repeats[name] = values;
    medians[name] = median(values);
  }
  return {{"method", entry.subject.method},
          {"solver", entry.subject.solver},
          {"input", entry.subject.input},
          {"options", entry.subject.options},
          {"error_name", entry.subject.error_name},
          {"notes", entry.subject.notes},
          {"stop", entry.stop ? Json(to_string(*entry.stop)) : Json()},
          {"repeats", repeats},
          {"median", medians},
          {"trace", trace_json(entry.trace)}};
}

Json BenchReport::ratios_of(const Comparison& comparison) const {
  const auto values = [&](const Entry& entry) -> const std::vector<double>* {
    const auto found =
        std::ranges::find(entry.samples, comparison.quantity, &decltype(entry.samples)::value_type::first);
    return found == entry.samples.end() ? nullptr : &found->second;
  };
  Json ratios = Json::array();
  for (const Entry& entry : entries_)
    for (const Entry& peer : entries_) {
      if (label(entry.subject) != comparison.method || label(peer.subject) != comparison.peer ||
          entry.subject.input != peer.subject.input)
        continue;
      const std::vector<double>*own = values(entry), *others = values(peer);
      if (!own || !others || std::ranges::any_of(*others, [](double v) { return v == 0; })) continue;
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (std::size_t i = 0; i < own->size(); ++i) {
        low = std::min(low, (*own)[i] / (*others)[i]);
        high = std::max(high, (*own)[i] / (*others)[i]);
      }
      ratios.push_back({{"method", comparison.method},
                        {"peer", comparison.peer},
                        {"input", entry.subject.input},
                        {"quantity", comparison.quantity},
                        {"ratio", median(*own) / median(*others)},
                        {"low", low},
                        {"high", high}});
    }
  if (ratios.empty())
    throw InvalidInput(fmt::format("benchmark: no input has {} of both {} and {}, and not zero", comparison.quantity,
                                   comparison.method, comparison.peer));
  return ratios;
}

void BenchReport::measure() {
  for (int turn = -options_.warm_up; turn < options_.repeats; ++turn)
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      const Subject& subject = entries_[i].subject;
      fmt::print(stderr, "[{}/{}, {}] {} {}\n", i + 1, entries_.size(), turn < 0 ? "warm-up" : "measured",
                 label(subject), subject.input);
      run_once(entries_[i], turn < 0);
    }
  Json runs = Json::array(), ratios = Json::array();
  for (const Entry& entry : entries_) runs.push_back(entry_json(entry));
  for (const Comparison& comparison : comparisons_)
    for (const Json& ratio : ratios_of(comparison)) ratios.push_back(ratio);
  json_["runs"] = std::move(runs);
  json_["ratios"] = std::move(ratios);
}

double BenchReport::median_of(const std::string& subject, const std::string& input, const std::string& quantity) const {
  for (const Entry& entry : entries_)
    if (label(entry.subject) == subject && entry.subject.input == input)
      for (const auto& [name, values] : entry.samples)
        if (name == quantity) return median(values);
  throw InvalidInput(fmt::format("benchmark: no {} of {} on {}", quantity, subject, input));
}

std::string BenchReport::table() const {
  std::vector<std::vector<std::string>> rows = {{"method", "input", "median s", "cpu s", "peak MiB", "other medians"}};
  for (const Entry& entry : entries_) {
    std::string others;
    for (const auto& [name, values] : entry.samples)
      if (name != "seconds" && name != "cpu_seconds" && name != "peak_rss_mib")
        others += fmt::format("{}{}={}", others.empty() ? "" : " ", name, number(median(values)));
    const auto of = [&](const char* name) {
      const auto found = std::ranges::find(entry.samples, name, &decltype(entry.samples)::value_type::first);
      return found == entry.samples.end() ? std::string("-") : number(median(found->second));
    };
    rows.push_back({label(entry.subject), entry.subject.input, of("seconds"), of("cpu_seconds"), of("peak_rss_mib"),
                    std::move(others)});
  }
  std::string text = aligned(rows, 2);
  for (const Json& ratio : json_.value("ratios", Json::array()))
    text += fmt::format("{} / {} on {}: {} = {} ({} to {})\n", ratio["method"].get<std::string>(),
                        ratio["peer"].get<std::string>(), ratio["input"].get<std::string>(),
                        ratio["quantity"].get<std::string>(), number(ratio["ratio"].get<double>()),
                        number(ratio["low"].get<double>()), number(ratio["high"].get<double>()));
  return text;
}

int run_benchmark(const std::string& name, const std::string& summary, int argc, char** argv,
                  const std::function<void(BenchReport&)>& body) {
  CLI::App program(summary, "papilla-bench-" + name);
  try {
    const BenchOptions options = parse_options(program, argc, argv);
    std::optional<oneapi::tbb::global_control> limit;
    if (options.threads > 0)
      limit.emplace(oneapi::tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(options.threads));
    BenchReport report(name, summary, options);
    body(report);
    if (!report.json().contains("runs")) throw InvalidInput("benchmark " + name + ": measure() was not called");
    const std::string text = report.json().dump(2) + "\n";
    if (!options.evidence.empty()) write_atomically(options.evidence, report.evidence(command_line(name, argc, argv)));
    if (options.json == "-") {
      std::cout << text;
    } else {
      std::cout << report.table();
      if (!options.json.empty()) write_atomically(options.json, text);
    }
    if (!std::cout.flush()) throw IoError("standard output: cannot be written");
    return app::k_exit_done;
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? app::k_exit_done : app::k_exit_usage;
  } catch (...) {
    return app::report_exception(("papilla-bench-" + name).c_str());
  }
}

}  // namespace papilla::bench
