// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include "papilla/core/deadline.hpp"
#include "papilla/core/progress.hpp"

namespace papilla {

/// The same progress, but it returns false once the deadline has passed.
inline ProgressCallback progress_until(ProgressCallback whole, const Deadline& deadline) {
  if (deadline.never()) return whole;
  return [whole = std::move(whole), deadline](const Progress& done) {
    return (!whole || whole(done)) && !deadline.passed();
  };
}

}  // namespace papilla
