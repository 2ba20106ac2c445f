// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/core.h>

#include <csignal>
#include <exception>
#include <new>

#include "command_line.hpp"
#include "exit_code.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/file_guard.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace {

/// Leaves no temporary file behind, then ends as the signal would have.
void end_on_signal(int signal) {
  papilla::remove_temporaries();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

int main(int argc, char** argv) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, end_on_signal);

  papilla::start_file_guard();

  CLI::App program("papilla: CAD interiors that can be seen and felt", "papilla");
  program.set_version_flag("--version", std::string("papilla ") + papilla::version());
  program.require_subcommand(1);
  program.fallthrough(false);
  program.footer(
      "Exit codes: 0 done, 1 a gate of measure failed, 2 usage, 3 input, 4 solver, 5 device.\n"
      "'papilla VERB --help' shows the options of a verb and an example.");

  using namespace papilla::app;
  add_verbs(program);

  const bool as_json = wants_json_on_stdout(argc, argv);
  program.parse_complete_callback([&] { refuse_no_numbers(program); });
  try {
    try {
      program.parse(argc, argv);
      return verb_exit_code();
    } catch (const CLI::ParseError& error) {
      return report_parse_error(program, error, as_json);
    }
  } catch (...) {
    return report_exception("papilla", as_json);
  }
}
