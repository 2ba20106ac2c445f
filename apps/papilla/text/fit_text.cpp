// SPDX-License-Identifier: GPL-3.0-or-later
#include "text/fit_text.hpp"

#include <utility>
#include <vector>

#include "shown_format.hpp"

namespace papilla::app {
namespace {

struct Row {
  const char* name;
  FittedNumber number;
  const char* unit;
};

std::vector<Row> rows_of(const MaterialFit& fit) {
  std::vector<Row> rows;
  const auto add = [&](const char* name, const std::optional<FittedNumber>& number, const char* unit,
                       double factor = 1) {
    if (number) rows.push_back({name, {factor * number->value, factor * number->low, factor * number->high}, unit});
  };
  add("stiffness", fit.stiffness, "N/m");
  add("damping", fit.damping, "N·s/m");
  add("static friction", fit.static_friction, "");
  add("dynamic friction", fit.dynamic_friction, "");
  add("Stribeck velocity", fit.stribeck_velocity, "mm/s", 1e3);
  if (fit.roughness) add("roughness, rms", fit.roughness->rms_m, "µm", 1e6);
  if (fit.roughness) add("Hurst exponent", fit.roughness->hurst, "");
  return rows;
}

}  // namespace

std::string fit_intervals(const MaterialFit& fit) {
  std::string text;
  for (const Row& row : rows_of(fit))
    text += shown_format("{}{} {:.4g} [{:.4g}, {:.4g}]{}{}", text.empty() ? "" : ", ", row.name, row.number.value,
                         row.number.low, row.number.high, *row.unit ? " " : "", row.unit);
  return text;
}

std::string fit_text(const MaterialFit& fit) {
  std::string text;
  for (const Row& row : rows_of(fit))
    text += shown_format("{:<18} {:>10.4g}   95 % {:.4g} to {:.4g} {}\n", row.name, row.number.value, row.number.low,
                         row.number.high, row.unit);
  for (const NotIdentified& missing : fit.not_identified)
    text += shown_format("not identified: {}: {}\n", missing.parameter, missing.reason);
  for (const std::string& warning : fit.warnings) text += shown_format("warning: {}\n", warning);
  return text + shown_format("{} samples, {} of them far off; {:.3g} mN (rms) not explained; surface: {}; {}\n",
                             fit.samples, fit.outliers, 1e3 * fit.rms_residual_n,
                             fit.surface == StrokeSurface::recorded ? "as recorded" : "a plane", to_string(fit.stop));
}

}  // namespace papilla::app
