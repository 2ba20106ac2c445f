// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "json_text.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/file_guard.hpp"
#include "papilla/core/one_line.hpp"
#include "standard_output.hpp"

namespace papilla::app {

inline constexpr int k_exit_done = 0, k_exit_gate = 1, k_exit_usage = 2, k_exit_input = 3, k_exit_solver = 4,
                     k_exit_device = 5;

/// A wrong combination of options that only the verb can see.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// Prints {"error": what, "exit_code": number} on standard output, if that can be written.
inline void print_error_json(const std::string& what, int exit_code) noexcept {
  try {
    print_out(json_text({{"error", what}, {"exit_code", exit_code}}));
  } catch (const std::exception&) {
    std::clearerr(stdout);  // The message on stderr is enough.
  }
}

/// Prints the exception in flight as one line on stderr and returns its exit code. Call it in a catch block.
/// @param as_json It is printed as JSON on standard output, too.
inline int report_exception(const char* program, bool as_json = false) {
  const auto report = [program, as_json](const char* what, int exit_code) {
    if (as_json) print_error_json(what, exit_code);
    std::fprintf(stderr, "%s: error: %s\n", program, shown(what).c_str());
    return exit_code;
  };
  try {
    throw;
  } catch (const UsageError& error) {
    return report(error.what(), k_exit_usage);
  } catch (const OverwriteRefused& error) {
    return report(error.what(), k_exit_usage);
  } catch (const SolverFailure& error) {
    return report(error.what(), k_exit_solver);
  } catch (const DeviceError& error) {
    return report(error.what(), k_exit_device);
  } catch (const std::bad_alloc&) {
    return report("out of memory", k_exit_input);
  } catch (const std::exception& error) {
    return report(error.what(), k_exit_input);
  }
}

}  // namespace papilla::app
