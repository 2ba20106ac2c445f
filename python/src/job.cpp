// SPDX-License-Identifier: MIT
#include "job.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace papilla::python {
namespace {

/// How long a signal waits at most until its handler runs.
constexpr std::chrono::milliseconds k_signal_interval(20);

bool is_main_thread() {
  const py::module_ threading = py::module_::import("threading");
  return threading.attr("current_thread")().is(threading.attr("main_thread")());
}

/// What became of a job; its Python objects are only touched with the GIL.
class Job {
 public:
  explicit Job(const py::object& callback) : callback_(callback), has_callback_(!callback.is_none()) {}

  void run(const std::function<void(const ProgressCallback&)>& work) noexcept {
    try {
      work([this](const Progress& progress) { return report(progress); });
    } catch (...) {
      failure_ = std::current_exception();
    }
  }

  /// Runs the handlers of signals that have come. With the GIL, in the main thread.
  void check_signals() {
    if (raised_by_signal_ || PyErr_CheckSignals() == 0) return;
    raised_by_signal_.emplace();
    is_cancelled_ = true;
  }

  /// With the GIL, when the work has ended.
  void rethrow() {
    if (raised_by_signal_) throw std::move(*raised_by_signal_);
    if (raised_by_callback_) throw std::move(*raised_by_callback_);
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  bool report(const Progress& progress) {
    if (is_cancelled_) return false;
    if (!has_callback_) return true;
    const py::gil_scoped_acquire with_gil;
    if (raised_by_callback_) return false;
    try {
      const py::object answer = callback_(py::str(progress.stage.data(), progress.stage.size()), progress.fraction);
      return !answer.is(py::bool_(false));
    } catch (py::error_already_set& error) {
      raised_by_callback_.emplace(error);
      return false;
    }
  }

  const py::object& callback_;
  bool has_callback_;
  std::atomic<bool> is_cancelled_ = false;
  std::exception_ptr failure_;
  std::optional<py::error_already_set> raised_by_signal_, raised_by_callback_;
};

void run_beside(Job& job, const std::function<void(const ProgressCallback&)>& work) {
  std::mutex mutex;
  std::condition_variable ended;
  bool has_ended = false;
  std::thread worker([&] {
    job.run(work);
    const std::scoped_lock lock(mutex);
    has_ended = true;
    ended.notify_one();
  });
  std::unique_lock lock(mutex);
  while (!ended.wait_for(lock, k_signal_interval, [&] { return has_ended; })) {
    lock.unlock();
    {
      const py::gil_scoped_acquire with_gil;
      job.check_signals();
    }
    lock.lock();
  }
  lock.unlock();
  worker.join();
}

}  // namespace

void run_job(const std::function<void(const ProgressCallback&)>& work, const py::object& callback) {
  Job job(callback);
  const bool is_main = is_main_thread();
  {
    const py::gil_scoped_release without_gil;
    if (is_main)
      run_beside(job, work);
    else
      job.run(work);
  }
  if (is_main) job.check_signals();  // One that came within the last interval.
  job.rethrow();
}

}  // namespace papilla::python
