// SPDX-License-Identifier: MIT
#include "cad_parallel.hpp"

#include <OSD_Parallel.hxx>
#include <exception>
#include <vector>

namespace papilla::cad {

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body) {
  std::vector<std::exception_ptr> failures(count);
  OSD_Parallel::For(0, static_cast<int>(count), [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    try {
      body(index);
    } catch (...) {
      failures[index] = std::current_exception();
    }
  });
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace papilla::cad
