// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

namespace papilla::player {

/// A second process that switches a device off when this one dies without doing so, even by SIGKILL. It holds one end
/// of a pipe; when the other end closes without a farewell, it runs `switch_off` and ends.
///
/// Make it before threads and locked memory. Where no process can be forked there is no sentinel, and watched() says
/// so.
class Sentinel {
 public:
  explicit Sentinel(const std::function<void()>& switch_off);
  ~Sentinel();
  Sentinel(const Sentinel&) = delete;
  Sentinel& operator=(const Sentinel&) = delete;

  bool watched() const noexcept { return child_ > 0; }

 private:
  int child_ = -1, farewell_ = -1;
};

}  // namespace papilla::player
