// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "haptic/contact_shapes.hpp"
#include "papilla/haptic/haptic_tick.hpp"
#include "papilla/haptic/roughness_field.hpp"

namespace {
std::atomic<long> g_allocations{0};
}

void* operator new(std::size_t size) {
  ++g_allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace papilla {
namespace {

void expect_no_allocation(ContactMaterial material, int ticks) {
  material.static_friction = 0.4;
  material.dynamic_friction = 0.3;
  material.damping = 0.2;
  (is_stimulus(material.model) ? material.stimulus : material.height) = 0;
  const RoughnessTag roughness{2.3, 3e-5, {5e-4, 1e-2}};
  const ContactSurface surface(testing::height_grid(100, 100, 0.1, 0.1, testing::rough_relief), {material},
                               {roughness_field(roughness, {0.1, 0.1}, 1)}, 0);
  HapticTick tick(surface, safety_limits(3.3), 1e-3);
  testing::Wanderer wanderer(2, 0.1, 0.01, 2e-4);
  double sum = 0;
  int contact = 0;
  const long before = g_allocations;
  for (int i = 0; i < ticks; ++i) {
    const Vec2 at = wanderer.next();
    DeviceState state;
    state.position = {at.x, at.y, testing::rough_relief(at.x, at.y) + 0.002 * std::cos(0.01 * i)};
    sum += norm(tick(state));
    contact += tick.proxy().in_contact;
  }
  EXPECT_EQ(g_allocations - before, 0);
  EXPECT_GT(contact, ticks / 4);
  EXPECT_LT(contact, 3 * ticks / 4);
  EXPECT_GT(sum, ticks / 200);
}

TEST(Tick, AllocatesNothing) { expect_no_allocation({}, 20000); }

TEST(Tick, AllocatesNothingForAnyForceModel) {
  ContactMaterial material;
  material.friction = FrictionModel::bristle;
  for (const ForceModel model : {ForceModel::textured_normal, ForceModel::lateral, ForceModel::graph_lateral})
    for (const StimulusForm form : {StimulusForm::usual, StimulusForm::displacement, StimulusForm::place}) {
      material.model = model;
      material.form = form;
      expect_no_allocation(material, 2000);
    }
}

TEST(Tick, CounterCounts) {
  const long before = g_allocations;
  const auto* number = new int(3);
  EXPECT_GT(g_allocations, before);
  delete number;
}

}  // namespace
}  // namespace papilla
