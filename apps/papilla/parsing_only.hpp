// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace papilla::app {

/// While one lives, a verb whose command line is parsed does nothing.
class ParsingOnly {
 public:
  ParsingOnly() noexcept;
  ~ParsingOnly();
  ParsingOnly(const ParsingOnly&) = delete;
  ParsingOnly& operator=(const ParsingOnly&) = delete;
};

}  // namespace papilla::app
