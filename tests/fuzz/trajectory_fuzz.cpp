// SPDX-License-Identifier: MIT
#include "fuzz_input.hpp"
#include "papilla/haptic/trajectory.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace papilla;
  fuzz::expect_read([&] {
    const Trajectory hand = parse_trajectory(fuzz::text_of(data, size), "input.csv");
    fuzz::require(!hand.samples().empty(), "a trajectory has samples");
    for (int i = -1; i <= 11; ++i)
      fuzz::require(is_finite(hand.position(hand.start_s() + 0.1 * i * (hand.end_s() - hand.start_s()))),
                    "positions are finite");
  });
  return 0;
}
