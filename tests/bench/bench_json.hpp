// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/evidence.hpp"
#include "papilla/core/machine.hpp"
#include "papilla/core/trace.hpp"

/// Harness of the programs papilla-bench-NAME: runs the methods of a comparison in turns and writes one JSON per run.
///
///     int main(int argc, char** argv) {
///       using namespace papilla;
///       return bench::run_benchmark("param", "Flattening of charts", argc, argv, [](bench::BenchReport& report) {
///         const TriangleMesh mesh = test::saddle(50, 80, report.options().quick ? 10 : 150, 200);
///         report.add({.method = "lscm", .input = "saddle"}, [&](bench::Recorder& recorder) {
///           const auto result = flatten(mesh, {});  // timed as a whole; Recorder::time() times a part only
///           recorder.record("stretch_l2", measure(result).stretch_l2);
///           recorder.trace(result.trace);
///         });
///         report.add({.method = "lscm", .solver = "cgal", .input = "saddle"}, ...);  // the peer
///         report.compare("lscm", "lscm/cgal");  // ratio of the median seconds
///         report.measure();
///       });
///     }
namespace papilla::bench {

using Json = nlohmann::ordered_json;

/// Processor time used by the calling thread [s].
double thread_cpu_seconds();
/// Processor time used by all threads of the process [s].
double process_cpu_seconds();
/// The least processor time of some runs [s]: of `repeats`, or, when that is more than one, of as many as half a second
/// takes.
double cpu_of(int repeats, const std::function<void()>& work);
using papilla::peak_rss_mib;
/// Starts a new peak of peak_rss_mib(); does nothing where the kernel does not allow it.
void reset_peak_rss();

/// Writes to twice as much memory as the largest cache holds.
void empty_caches();

/// Makes the compiler believe that `value` is read, so that the work which made it stays.
template <class T>
void keep(const T& value) {
  asm volatile("" : : "r,m"(value) : "memory");
}

/// Middle value, or the mean of the two middle values. @throws InvalidInput when empty.
double median(std::vector<double> values);

/// The options that every benchmark program has.
struct BenchOptions {
  std::string json;                 ///< File for the JSON, "-" for stdout, empty for none.
  int repeats = 5;                  ///< Timed runs of every subject, >= 1.
  int warm_up = 1;                  ///< Untimed runs before them, >= 0.
  int threads = 0;                  ///< Limit for TBB; 0: all cores.
  std::string evidence;             ///< File for the Markdown page, empty for none.
  bool quick = false;               ///< Small inputs: shows that the program works, measures nothing of use.
  std::vector<std::string> inputs;  ///< Files given on the command line.
};

/// What is measured. `method` is the name of the command line, `solver` the variant.
struct Subject {
  std::string method;
  std::string solver = {};
  std::string input = {};  ///< A file's name, or the formula and size of the shape.
  Json options = Json::object();
  std::string error_name = {};  ///< What `error` means in the trace, with unit.
  std::string notes = {};
};

/// Takes what one repeat of a subject yields.
class Recorder {
 public:
  /// Runs `work` and counts only its time for this repeat. Several calls add up.
  void time(const std::function<void()>& work);
  /// A quantity of this repeat beside the time; the unit belongs in the name ("tick_us_p99").
  /// @throws InvalidInput when the value is not finite, or the name was recorded in this repeat already.
  void record(std::string_view quantity, double value);
  /// Error over run time; the last repeat's is reported.
  void trace(Trace trace);
  void stop(StopReason reason);

 private:
  friend class BenchReport;
  std::vector<std::pair<std::string, double>> values_;
  Trace trace_;
  std::optional<StopReason> stop_;
  std::optional<double> seconds_, cpu_seconds_;
};

/// Collects subjects, measures them, and makes the report.
///
/// The repeats go in turns (first repeat of every subject, second repeat of every subject, ...), so that a machine
/// that slows down slows all of them alike and a ratio stays fair.
/// JSON: benchmark, summary, started (UTC), commit, version, machine{cpu, cores, memory_mib, kernel},
/// compiler{name, version, flags, build_type}, threads, repeats, warm_up, quick,
/// runs[] {method, solver, input, options, error_name, notes, stop, repeats{quantity: [value per repeat]},
///         median{quantity: value}, trace[] {seconds, error}},
/// ratios[] {method, peer, input, quantity, ratio, low, high}.
/// Every run has the quantities seconds (wall), cpu_seconds (process) and peak_rss_mib.
class BenchReport {
 public:
  BenchReport(std::string name, std::string summary, BenchOptions options);

  const BenchOptions& options() const noexcept { return options_; }

  /// Adds a subject. `work` runs once per repeat and is timed as a whole unless it calls Recorder::time().
  /// Whatever it refers to must live until measure() returns.
  void add(Subject subject, std::function<void(Recorder&)> work);

  /// `method` and `peer` are "method", or "method/solver" for a subject with a solver.
  /// Asks for median(method) / median(peer) of a quantity for every input that both ran on; `low` and `high` are the
  /// extremes over the repeats, paired in turn. Below 1: the method needs less than its peer.
  void compare(std::string method, std::string peer, std::string quantity = "seconds");

  /// Runs everything that was added, and says on stderr what is running. @throws what a subject throws; InvalidInput
  /// when a repeat records other quantities than the first one, or compare() finds nothing to compare.
  void measure();

  /// What the page says of a promise, and the rows behind it; after measure().
  void target(Target target) { targets_.push_back(std::move(target)); }
  void table(EvidenceTable table) { tables_.push_back(std::move(table)); }
  /// The median of a quantity of a subject ("method" or "method/solver") on an input; after measure().
  /// @throws InvalidInput when there is no such value.
  double median_of(const std::string& subject, const std::string& input, const std::string& quantity) const;
  std::string evidence(const std::string& command) const { return evidence_page(json_, targets_, tables_, command); }

  /// The result of measure().
  const Json& json() const noexcept { return json_; }
  /// The same for people: a line per subject, then the ratios.
  std::string table() const;

 private:
  struct Entry {
    Subject subject;
    std::function<void(Recorder&)> work;
    std::vector<std::pair<std::string, std::vector<double>>> samples;
    Trace trace;
    std::optional<StopReason> stop;
  };
  struct Comparison {
    std::string method, peer, quantity;
  };

  static void run_once(Entry& entry, bool warm_up);
  Json entry_json(const Entry& entry) const;
  Json ratios_of(const Comparison& comparison) const;

  BenchOptions options_;
  std::vector<Entry> entries_;
  std::vector<Comparison> comparisons_;
  std::vector<Target> targets_;
  std::vector<EvidenceTable> tables_;
  Json json_;
};

/// main() of a benchmark program: reads the options, lets `body` add subjects and call measure(), prints the table,
/// writes the JSON. Returns 0, 2 for wrong usage, or the exit code of the exception's kind.
int run_benchmark(const std::string& name, const std::string& summary, int argc, char** argv,
                  const std::function<void(BenchReport&)>& body);

}  // namespace papilla::bench
