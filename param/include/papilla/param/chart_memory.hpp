// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

namespace papilla {

/// The maps of charts of one surface, kept from one call of a method to the next: a chart that has the same triangles,
/// joined in the same way, is not mapped again. For calls with charts of which some were changed; method and options
/// must be the same in all of them, but for where maps begin and a limit of energy, which what is kept has to hold.
/// Charts without a valid map by the method are not kept.
class ChartMemory {
 public:
  ChartMemory();
  ~ChartMemory();
  ChartMemory(const ChartMemory&) = delete;
  ChartMemory& operator=(const ChartMemory&) = delete;

  struct Maps;
  Maps& maps() const noexcept { return *maps_; }  ///< For the methods.

 private:
  std::unique_ptr<Maps> maps_;
};

}  // namespace papilla
