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

/// Why a program ends without, or with less than, what it was asked for.
struct Failure {
  std::string what;
  int exit_code = k_exit_input;
};

/// Adds "error": what and "exit_code": number.
inline void add_failure(nlohmann::ordered_json& json, const Failure& failure) {
  json["error"] = failure.what;
  json["exit_code"] = failure.exit_code;
}

/// Prints an object of that on standard output, if that can be written.
inline void print_failure_json(const Failure& failure) noexcept {
  try {
    nlohmann::ordered_json json;
    add_failure(json, failure);
    print_out(json_text(json));
  } catch (const std::exception&) {
    std::clearerr(stdout);  // The message on stderr is enough.
  }
}

/// Prints the failure as one line on stderr and returns its exit code.
inline int print_failure(const char* program, const Failure& failure) {
  std::fprintf(stderr, "%s: error: %s\n", program, shown(failure.what).c_str());
  return failure.exit_code;
}

/// The exception in flight. Call it in a catch block.
inline Failure failure_in_flight() {
  try {
    throw;
  } catch (const UsageError& error) {
    return {error.what(), k_exit_usage};
  } catch (const OverwriteRefused& error) {
    return {error.what(), k_exit_usage};
  } catch (const SolverFailure& error) {
    return {error.what(), k_exit_solver};
  } catch (const DeviceError& error) {
    return {error.what(), k_exit_device};
  } catch (const std::bad_alloc&) {
    return {"out of memory", k_exit_input};
  } catch (const std::exception& error) {
    return {error.what(), k_exit_input};
  }
}

/// print_failure() of failure_in_flight(). @param as_json It is printed as JSON on standard output, too.
inline int report_exception(const char* program, bool as_json = false) {
  const Failure failure = failure_in_flight();
  if (as_json) print_failure_json(failure);
  return print_failure(program, failure);
}

}  // namespace papilla::app
