// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

namespace papilla::player {

/// A second process that switches a device off when this one dies without doing so, even by SIGKILL. It reads from a
/// pipe; when the other end closes without the release byte of the destructor, it runs `switch_off` and exits.
///
/// Construct it before threads and locked memory. watched() is false when no process could be forked.
class Sentinel {
 public:
  explicit Sentinel(const std::function<void()>& switch_off);
  ~Sentinel();
  Sentinel(const Sentinel&) = delete;
  Sentinel& operator=(const Sentinel&) = delete;

  bool watched() const noexcept { return child_ > 0; }

 private:
  int child_ = -1, pipe_ = -1;
};

}  // namespace papilla::player
