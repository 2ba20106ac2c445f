// SPDX-License-Identifier: MIT
#include "papilla/haptic/safety.hpp"

#include <algorithm>
#include <cmath>

namespace papilla {

SafetyLimits safety_limits(double max_force_n) noexcept {
  return {.max_force_n = max_force_n, .slew_n_per_s = max_force_n / 2e-3};
}

Vec3 ForceGuard::apply(Vec3 force_n, double period_s, double age_s, const ContactStep& contact) noexcept {
  if (!is_finite(force_n) || !std::isfinite(norm(force_n)))
    fault_ = Fault::not_finite;
  else if (!(age_s <= limits_.watchdog_s) && fault_ == Fault::none)
    fault_ = Fault::stale_input;
  if (fault_ != Fault::none) return last_ = {};

  force_n = faded_in(force_n, period_s, contact);
  const double size = norm(force_n);
  if (size > limits_.max_force_n) force_n = (limits_.max_force_n / size) * force_n;
  const bool goes_on = contact.in_contact && contact_s_ >= limits_.new_contact_s;
  contact_s_ = contact.in_contact ? contact_s_ + period_s : 0;
  double most = limits_.slew_n_per_s * period_s;
  if (goes_on) most = std::min(most, std::max(limits_.steady_share * most, contact.spring_n));
  const Vec3 change = force_n - last_;
  const double wanted = norm(change);
  last_ = wanted > most ? last_ + (most / wanted) * change : force_n;
  return last_;
}

Vec3 ForceGuard::faded_in(Vec3 force_n, double period_s, const ContactStep& contact) noexcept {
  const double size = norm(force_n);
  if (faded_in_s_ < limits_.soft_start_s && (size > 0 || faded_in_s_ > 0)) faded_in_s_ += period_s;
  const double share = limits_.soft_start_s > 0 ? std::min(1.0, faded_in_s_ / limits_.soft_start_s) : 1;
  if (!contact.in_contact) {
    withheld_n_ = raw_n_ = work_j_ = 0;
    return share * force_n;
  }
  work_j_ -= dot(last_, contact.moved_m);
  withheld_n_ = std::clamp(withheld_n_ + (1 - share) * (size - raw_n_), 0.0, size);
  raw_n_ = size;
  if (withheld_n_ == 0) return force_n;
  const double paid = std::sqrt(2 * share * contact.stiffness * std::max(0.0, work_j_)) - (size - withheld_n_);
  withheld_n_ -= std::clamp(paid, 0.0, std::min(withheld_n_, size * period_s / limits_.soft_start_s));
  return ((size - withheld_n_) / size) * force_n;
}

void ForceGuard::resume() noexcept {
  fault_ = Fault::none;
  faded_in_s_ = contact_s_ = withheld_n_ = raw_n_ = work_j_ = 0;
  last_ = {};
}

}  // namespace papilla
