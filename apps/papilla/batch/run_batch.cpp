// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/run_batch.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <deque>
#include <mutex>
#include <numeric>
#include <optional>
#include <thread>

#include "papilla/core/child_process.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"

namespace papilla::app {
namespace {

using State = LineResult::State;

std::atomic<int> g_signal = 0;

void end_children(int signal) {
  g_signal = signal;
  signal_children(signal);
}

/// While it lives, signals that would end this process end its children.
class SignalsToChildren {
 public:
  SignalsToChildren() {
    g_signal = 0;
    for (std::size_t i = 0; i < k_signals.size(); ++i) old_[i] = std::signal(k_signals[i], end_children);
  }
  ~SignalsToChildren() {
    for (std::size_t i = 0; i < k_signals.size(); ++i) std::signal(k_signals[i], old_[i]);
  }
  SignalsToChildren(const SignalsToChildren&) = delete;
  SignalsToChildren& operator=(const SignalsToChildren&) = delete;

 private:
  static constexpr std::array k_signals{SIGINT, SIGTERM, SIGHUP};
  std::array<void (*)(int), k_signals.size()> old_{};
};

/// The order in which lines begin.
std::vector<std::size_t> order_of(std::span<const BatchLine> lines) {
  std::vector<std::size_t> order(lines.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (std::all_of(lines.begin(), lines.end(), [](const BatchLine& line) { return line.cost_seconds.has_value(); }))
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return lines[a].cost_seconds > lines[b].cost_seconds; });
  return order;
}

class Batch {
 public:
  Batch(std::span<const BatchLine> lines, const BatchOptions& options)
      : lines_(lines), options_(options), order_(order_of(lines)) {
    result_.lines.resize(lines.size());
  }

  BatchResult run(const std::function<void(std::size_t, const LineResult&)>& on_end) {
    const SignalsToChildren signals;
    std::vector<std::jthread> workers;
    const Ending ending{*this};  // Before the workers are joined, whatever on_end throws.
    working_ = std::min<std::size_t>(static_cast<std::size_t>(options_.jobs), lines_.size());
    for (std::size_t i = working_; i > 0; --i) workers.emplace_back([this] { work(); });
    while (const std::optional<std::size_t> line = next_ended()) on_end(*line, result_.lines[*line]);
    result_.signal = g_signal;
    return std::move(result_);
  }

 private:
  struct Ending {
    Batch& batch;
    ~Ending() { batch.end_all(); }
  };

  void end_all() {
    stops_ = true;
    signal_children(SIGTERM);
  }

  bool ends_all() const { return stops_ || g_signal != 0; }

  std::optional<std::size_t> next_to_begin() {
    const std::scoped_lock lock(mutex_);
    if (ends_all() || (failed_ && !options_.keep_going) || begun_ == order_.size()) return std::nullopt;
    return order_[begun_++];
  }

  void work() {
    while (const std::optional<std::size_t> line = next_to_begin()) {
      LineResult result = run_line(lines_[*line]);
      const std::scoped_lock lock(mutex_);
      failed_ = failed_ || result.state == State::failed;
      result_.lines[*line] = std::move(result);
      ended_.push_back(*line);
      changed_.notify_one();
    }
    const std::scoped_lock lock(mutex_);
    --working_;
    changed_.notify_one();
  }

  /// Waits for a line; none when all workers are at their end.
  std::optional<std::size_t> next_ended() {
    constexpr double k_longest_wait_s = 3600;
    std::unique_lock lock(mutex_);
    while (ended_.empty() && working_ > 0) {
      if (options_.deadline.passed() && !result_.timed_out) {
        result_.timed_out = true;
        end_all();
      }
      const double left = result_.timed_out ? k_longest_wait_s : options_.deadline.left();
      changed_.wait_for(lock, std::chrono::duration<double>(std::clamp(left, 0.0, k_longest_wait_s)));
    }
    if (ended_.empty()) return std::nullopt;
    const std::size_t line = ended_.front();
    ended_.pop_front();
    return line;
  }

  std::vector<std::string> command_of(const BatchLine& line) const {
    std::vector<std::string> words = line.words;
    if (!line.names_threads) words.insert(words.begin() + 1, {"--threads", std::to_string(options_.threads)});
    words.insert(words.begin(), "/proc/self/exe");
    return words;
  }

  LineResult run_line(const BatchLine& line) const {
    LineResult result;
    if (options_.skip_existing && is_up_to_date(line)) {
      result.state = State::skipped;
      return result;
    }
    const Stopwatch clock;
    try {
      ChildProcess child(command_of(line));
      if (ends_all()) child.send(SIGTERM);  // The others got theirs before this one was there.
      ChildEnd end = child.wait();
      result.exit_code = end.exit_code;
      result.cpu_seconds = end.cpu_seconds;
      result.peak_mib = end.peak_mib;
      if (end.exit_code != 0) result.messages = std::move(end.messages);
      result.state = end.exit_code == 0 ? State::done : end.signal != 0 && ends_all() ? State::ended : State::failed;
    } catch (const IoError& error) {
      constexpr int k_shell_not_started = 126;
      result.exit_code = k_shell_not_started;
      result.messages = error.what();
      result.state = State::failed;
    }
    result.seconds = clock.seconds();
    return result;
  }

  const std::span<const BatchLine> lines_;
  const BatchOptions& options_;
  const std::vector<std::size_t> order_;
  std::atomic<bool> stops_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t begun_ = 0, working_ = 0;
  bool failed_ = false;
  std::deque<std::size_t> ended_;
  BatchResult result_;
};

}  // namespace

BatchResult run_batch(std::span<const BatchLine> lines, const BatchOptions& options,
                      const std::function<void(std::size_t, const LineResult&)>& on_end) {
  return Batch(lines, options).run(on_end);
}

}  // namespace papilla::app
