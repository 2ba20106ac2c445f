// SPDX-License-Identifier: MIT
#pragma once

#include <unistd.h>

namespace papilla {

/// An open file or folder that is closed at the end of the scope.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { ::close(number_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  operator int() const noexcept { return number_; }

 private:
  int number_;
};

}  // namespace papilla
