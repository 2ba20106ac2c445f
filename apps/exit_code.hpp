// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <exception>
#include <new>

#include "papilla/core/error.hpp"
#include "papilla/core/file_guard.hpp"
#include "papilla/core/one_line.hpp"

namespace papilla::app {

inline constexpr int k_exit_done = 0, k_exit_gate = 1, k_exit_usage = 2, k_exit_input = 3, k_exit_solver = 4,
                     k_exit_device = 5;

/// A wrong combination of options that only the verb can see.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// Prints the exception in flight as one line on stderr and returns its exit code. Call it in a catch block.
inline int report_exception(const char* program) {
  const auto print = [program](const char* what) {
    std::fprintf(stderr, "%s: error: %s\n", program, shown(what).c_str());
  };
  try {
    throw;
  } catch (const UsageError& error) {
    print(error.what());
    return k_exit_usage;
  } catch (const OverwriteRefused& error) {
    print(error.what());
    return k_exit_usage;
  } catch (const SolverFailure& error) {
    print(error.what());
    return k_exit_solver;
  } catch (const DeviceError& error) {
    print(error.what());
    return k_exit_device;
  } catch (const std::bad_alloc&) {
    print("out of memory");
    return k_exit_input;
  } catch (const std::exception& error) {
    print(error.what());
    return k_exit_input;
  }
}

}  // namespace papilla::app
