// SPDX-License-Identifier: MIT
#include "papilla/study/estimate.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace papilla {

double student_t_quantile(double share, double degrees) {
  return boost::math::quantile(boost::math::students_t(degrees), share);
}

Estimate jackknife_interval(double value, const std::vector<double>& without, double confidence) {
  const auto clusters = static_cast<double>(without.size());
  if (without.size() < 2) return {value, {}, {}};
  double squares = 0;
  for (const double other : without) squares += (other - value) * (other - value);
  const double reach =
      student_t_quantile(0.5 + confidence / 2, clusters - 1) * std::sqrt((clusters - 1) / clusters * squares);
  if (!std::isfinite(reach)) return {value, {}, {}};
  return {value, value - reach, value + reach};
}

Estimate wilson_interval(int hits, int trials, double confidence) {
  const double n = trials, share = hits / n;
  const double z = boost::math::quantile(boost::math::normal(), 0.5 + confidence / 2), squared = z * z / n;
  const double middle = (share + squared / 2) / (1 + squared);
  const double reach = z * std::sqrt(share * (1 - share) / n + squared / (4 * n)) / (1 + squared);
  return {share, std::max(0.0, middle - reach), std::min(1.0, middle + reach)};
}

}  // namespace papilla
