// SPDX-License-Identifier: MIT
#include "cad_parallel.hpp"

#include <oneapi/tbb/global_control.h>
#include <OSD_Parallel.hxx>
#include <OSD_ThreadPool.hxx>

#include <algorithm>
#include <exception>
#include <vector>

namespace papilla::cad {
namespace {

bool g_started = false;   // The pool has threads in this process.
bool g_orphaned = false;  // They stayed in the parent.

}  // namespace

int wanted_threads() {
  using oneapi::tbb::global_control;
  return static_cast<int>(global_control::active_value(global_control::max_allowed_parallelism));
}

void set_up_threads(int wanted) {
  if (g_orphaned) return;
  OSD_Parallel::SetUseOcctThreads(true);
  const Handle(OSD_ThreadPool)& pool = OSD_ThreadPool::DefaultPool(wanted);
  if (pool->NbThreads() != wanted) pool->Init(wanted);
  g_started = true;
}

void after_fork() { g_orphaned = g_started; }

bool is_parallel() { return g_started && !g_orphaned; }

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body) {
  std::vector<std::exception_ptr> failures(count);
  const auto run = [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    try {
      body(index);
    } catch (...) {
      failures[index] = std::current_exception();
    }
  };
  OSD_Parallel::For(0, static_cast<int>(count), run, !is_parallel());
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace papilla::cad
