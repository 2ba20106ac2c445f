// SPDX-License-Identifier: GPL-3.0-or-later
#include "memory/spilled_memory.hpp"

#include <fcntl.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <boost/interprocess/mem_algo/rbtree_best_fit.hpp>
#include <boost/interprocess/sync/mutex_family.hpp>
#include <chrono>
#include <cstdlib>
#include <new>
#include <thread>

namespace papilla::app {
namespace {

using Heap = boost::interprocess::rbtree_best_fit<boost::interprocess::null_mutex_family>;

constexpr std::size_t k_check_every = std::size_t{8} << 20;
constexpr std::chrono::milliseconds k_watch_every{2};

/// Pages of the file that are given back below this share of the limit need not be soon again.
constexpr double k_aim = 0.75;

/// What the limit rises by where what is not in the file takes all of it.
constexpr std::size_t k_least_room = std::size_t{64} << 20;

/// Allocates nothing. @return 0 where the system does not say.
std::size_t resident_bytes() noexcept {
  const int file = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0) return 0;
  char text[128] = {};
  const ssize_t length = ::read(file, text, sizeof text - 1);
  ::close(file);
  if (length <= 0) return 0;
  char* second = nullptr;
  std::strtoull(text, &second, 10);
  return std::strtoull(second, nullptr, 10) * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

/// The one whose blocks a forked child makes private.
SpilledMemory* spilled = nullptr;

}  // namespace

bool SpilledMemory::becomes_active(std::size_t size) noexcept {
  if (never_.load(std::memory_order_relaxed)) return false;
  if (unchecked_bytes_.fetch_add(size, std::memory_order_relaxed) + size < k_check_every) return false;
  unchecked_bytes_.store(0, std::memory_order_relaxed);
  if (resident_bytes() + size < limits_.begin_bytes) return false;
  const std::lock_guard lock(mutex_);
  if (active_ || never_) return active_;
  if (open_file()) {
    active_ = true;
    return true;
  }
  never_ = true;
  return false;
}

bool SpilledMemory::open_file() noexcept {
  const char* of_user = std::getenv("TMPDIR");
  const char* folder = limits_.folder ? limits_.folder : of_user && *of_user ? of_user : "/var/tmp";
  file_ = ::open(folder, O_TMPFILE | O_RDWR | O_EXCL | O_CLOEXEC, 0600);
  if (file_ < 0) return false;
  void* reserved = ::mmap(nullptr, k_reserved, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (reserved == MAP_FAILED) return false;
  base_ = static_cast<std::byte*>(reserved);
  limit_ = limits_.resident_bytes;
  spilled = this;
  if (::pthread_atfork(&before_fork, &after_fork_in_parent, &after_fork_in_child) != 0) return false;
  try {
    std::thread([this] { watch(); }).detach();
  } catch (...) {
    return false;
  }
  return true;
}

/// Backs segments by the file. @return whether the disk has the space.
bool SpilledMemory::map(std::size_t first, std::size_t run, bool is_heap) noexcept {
  const auto offset = static_cast<off_t>(first * k_segment);
  const std::size_t bytes = run * k_segment;
  if (::fallocate(file_, 0, offset, static_cast<off_t>(bytes)) != 0) return false;
  if (::mmap(at(first), bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_FIXED, file_, offset) == MAP_FAILED) {
    ::fallocate(file_, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, offset, static_cast<off_t>(bytes));
    return false;
  }
  segments_[first] = {static_cast<std::uint16_t>(run), is_heap, SIZE_MAX};
  for (std::size_t s = first + 1; s < first + run; ++s) segments_[s].run = UINT16_MAX;
  used_ = std::max(used_, first + run);
  return true;
}

void SpilledMemory::unmap(std::size_t first) noexcept {
  const std::size_t run = segments_[first].run, bytes = run * k_segment;
  ::mmap(at(first), bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_FIXED, -1, 0);
  ::fallocate(file_, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, static_cast<off_t>(first * k_segment),
              static_cast<off_t>(bytes));
  for (std::size_t s = first; s < first + run; ++s) segments_[s] = {};
}

/// The first of so many unused segments side by side; k_segments when there are none.
std::size_t SpilledMemory::unused_run(std::size_t run) const noexcept {
  std::size_t unused = 0;
  for (std::size_t s = 0; s < k_segments; ++s) {
    unused = segments_[s].run == 0 ? unused + 1 : 0;
    if (unused == run) return s + 1 - run;
  }
  return k_segments;
}

void* SpilledMemory::take_from_file(std::size_t size) noexcept {
  constexpr std::size_t k_most_in_heap = k_segment / 2;
  if (size >= k_reserved) return nullptr;
  const bool is_small = size <= k_most_in_heap;
  const std::lock_guard lock(mutex_);
  if (unchecked_bytes_.fetch_add(size, std::memory_order_relaxed) + size >= k_check_every) {
    unchecked_bytes_.store(0, std::memory_order_relaxed);
    trim();
  }
  if (is_small)
    if (void* block = take_from_heaps(size)) return block;
  const std::size_t run = is_small ? 1 : (size + k_segment - 1) / k_segment, first = unused_run(run);
  if (first == k_segments || !map(first, run, is_small)) return nullptr;
  return is_small ? (new (at(first)) Heap(k_segment, 0))->allocate(size) : at(first);
}

void* SpilledMemory::take_from_heaps(std::size_t size) noexcept {
  for (std::size_t s = 0; s < used_; ++s) {
    Segment& segment = segments_[s];
    if (!segment.is_heap || size >= segment.refused) continue;
    if (void* block = std::launder(reinterpret_cast<Heap*>(at(s)))->allocate(size)) {
      if (s == empty_heap_) empty_heap_ = k_segments;
      return block;
    }
    segment.refused = size;
  }
  return nullptr;
}

void SpilledMemory::give(void* block) noexcept {
  if (!active_.load(std::memory_order_relaxed)) return;  // A forked child.
  const std::lock_guard lock(mutex_);
  const std::size_t s = static_cast<std::size_t>(static_cast<std::byte*>(block) - at(0)) / k_segment;
  if (!segments_[s].is_heap) return unmap(s);
  Heap& heap = *std::launder(reinterpret_cast<Heap*>(at(s)));
  heap.deallocate(block);
  segments_[s].refused = SIZE_MAX;
  if (!heap.all_memory_deallocated()) return;
  if (empty_heap_ == k_segments)
    empty_heap_ = s;
  else
    unmap(s);
}

std::size_t SpilledMemory::file_bytes() const noexcept {
  struct stat about {};
  const std::lock_guard lock(mutex_);
  return file_ >= 0 && ::fstat(file_, &about) == 0 ? static_cast<std::size_t>(about.st_blocks) * 512 : 0;
}

/// Takes segments out of the process one after the other, in a circle, while it has more than it shall.
void SpilledMemory::trim() noexcept {
  std::size_t resident = resident_bytes();
  if (resident <= limit_) return;
  const auto aim = static_cast<std::size_t>(k_aim * static_cast<double>(limits_.resident_bytes));
  for (std::size_t tried = 0; tried < used_ && resident > aim; ++tried, ++next_) {
    if (next_ >= used_) next_ = 0;
    if (segments_[next_].run == 0) continue;
    ::madvise(at(next_), k_segment, MADV_DONTNEED);
    resident = resident_bytes();
  }
  limit_ = std::max(limits_.resident_bytes, resident + k_least_room);
}

void SpilledMemory::watch() noexcept {
  for (;; std::this_thread::sleep_for(k_watch_every)) {
    const std::lock_guard lock(mutex_);
    trim();
  }
}

/// What the parent changes must not change here, nor what this process changes there. Addresses that hold nothing are
/// given up, as the child may be one whose addresses are limited.
void SpilledMemory::make_private() noexcept {
  active_ = false, never_ = true;
  for (std::size_t s = 0; s < used_; ++s)
    if (segments_[s].run != 0)
      ::mmap(at(s), k_segment, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_FIXED, file_,
             static_cast<off_t>(s * k_segment));
  reserved_ = used_ * k_segment;
  ::munmap(at(used_), k_reserved - reserved_);
}

/// Nobody is in the middle of a change while the process is forked.
void SpilledMemory::before_fork() noexcept { spilled->mutex_.lock(); }

void SpilledMemory::after_fork_in_parent() noexcept { spilled->mutex_.unlock(); }

void SpilledMemory::after_fork_in_child() noexcept {
  spilled->make_private();
  spilled->mutex_.unlock();
}

}  // namespace papilla::app
