// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <string>

#include "json/json.hpp"
#include "papilla/core/deadline.hpp"
#include "papilla/core/progress.hpp"

namespace papilla {
class StageCache;
}

namespace papilla::app {

/// Where a verb's text for people goes: stdout, unless --quiet or `--json -` claims it.
class Console {
 public:
  explicit Console(bool silent) : silent_(silent) {}
  void print(const std::string& text) const;
  bool silent() const noexcept { return silent_; }

 private:
  bool silent_;
};

/// What every verb gets beside its own options.
struct VerbContext {
  Console console;
  /// Draws on stderr when that is a terminal and the work takes over a second. Returns false at the deadline, unless
  /// the verb ends by itself.
  ProgressCallback progress;
  int threads = 0;         ///< 0: all cores.
  Deadline deadline;       ///< --time-limit.
  Deadline read_deadline;  ///< Of reading, before which there is no result to end with: twice the limit and a minute.
  std::uint64_t seed = 1;
  const StageCache* cache = nullptr;  ///< Of verbs that remember results; null: none is wanted.
  int exit_code = 0;                  ///< Set by a verb that ends normally but not with 0.
};

struct VerbInfo {
  std::string name;
  std::string summary;  ///< One sentence.
  std::string example;  ///< A command line that works as printed.
  /// What a time limit does: the verb ends with the best valid result so far, or it is cancelled and has none.
  enum class AtDeadline { ends, is_cancelled } at_deadline = AtDeadline::is_cancelled;
  /// Whether it has --cache: results of its stages are found again.
  enum class Remembers { no, yes } remembers = Remembers::no;
};

/// The body of a verb: does the work, prints for people, returns the machine-readable result.
using VerbBody = std::function<Json(VerbContext&)>;

/// Adds a verb with the options that all verbs share (--json, --quiet, --threads, --seed, --max-memory, --progress,
/// --time-limit).
/// The caller adds its own options to the returned command, bound to an object that `body` shares.
CLI::App* add_verb(CLI::App& program, const VerbInfo& info, VerbBody body);

/// Gives the machine-readable result of the verb that runs now, for one that goes on: what its body returns is not
/// written any more.
void publish_result(const Json& result);

/// The exit code that the verb which ran asked for.
int verb_exit_code() noexcept;

}  // namespace papilla::app
