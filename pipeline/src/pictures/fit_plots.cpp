// SPDX-License-Identifier: MIT
#include "papilla/pipeline/pictures/fit_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "papilla/haptic/friction.hpp"

namespace papilla {
namespace {

using Style = PlotSeries::Style;

constexpr std::size_t k_drawn = 4000;

Plot force_plot(const MaterialFit& fit) {
  Plot plot{
      .title = fmt::format("Force, measured and fitted: {:.3g} mN (rms) are not explained", 1e3 * fit.rms_residual_n),
      .x_name = "time [s]",
      .y_name = "force [N]"};
  PlotSeries normal{"normal, measured", {}, Style::points, 4}, along{"along, measured", {}, Style::points, 5};
  PlotSeries fitted_normal{"normal, fitted", {}, Style::line, 0}, fitted_along{"along, fitted", {}, Style::line, 1};
  const std::size_t step = std::max<std::size_t>(1, fit.forces.size() / k_drawn);
  for (std::size_t i = 0; i < fit.forces.size(); i += step) {
    const FittedForce& f = fit.forces[i];
    normal.points.push_back({f.t_s, f.normal_n});
    along.points.push_back({f.t_s, f.along_n});
    fitted_normal.points.push_back({f.t_s, f.fitted_normal_n});
    fitted_along.points.push_back({f.t_s, f.fitted_along_n});
  }
  plot.series = {std::move(normal), std::move(along), std::move(fitted_normal), std::move(fitted_along)};
  return plot;
}

Plot friction_plot(const MaterialFit& fit) {
  constexpr double k_light = 0.2;  // Of the heaviest load; below, the quotient is noise.
  Plot plot{
      .title = "Friction over speed", .x_name = "speed of slip [mm/s]", .y_name = "force along / load", .log_x = true};
  double heaviest = 0;
  for (const FittedForce& f : fit.forces) heaviest = std::max(heaviest, f.load_n);
  PlotSeries measured{"measured", {}, Style::points, 4}, fitted{"fitted", {}, Style::line, 1};
  double slowest = std::numeric_limits<double>::infinity(), fastest = 0;
  const std::size_t step = std::max<std::size_t>(1, fit.forces.size() / k_drawn);
  for (std::size_t i = 0; i < fit.forces.size(); i += step) {
    const FittedForce& f = fit.forces[i];
    if (!(f.slip_m_per_s > 0) || f.load_n < k_light * heaviest) continue;
    measured.points.push_back({1e3 * f.slip_m_per_s, f.along_n / f.load_n});
    slowest = std::min(slowest, f.slip_m_per_s);
    fastest = std::max(fastest, f.slip_m_per_s);
  }
  if (fit.dynamic_friction && fastest > 0) {
    constexpr int k_points = 200;
    ContactMaterial material;
    material.dynamic_friction = fit.dynamic_friction->value;
    material.static_friction = fit.static_friction ? fit.static_friction->value : material.dynamic_friction;
    if (fit.stribeck_velocity) material.stribeck_velocity = fit.stribeck_velocity->value;
    for (int i = 0; i <= k_points; ++i) {
      const double speed = slowest * std::pow(fastest / slowest, static_cast<double>(i) / k_points);
      fitted.points.push_back({1e3 * speed, friction_coefficient(material, speed)});
    }
  }
  plot.series = {std::move(measured), std::move(fitted)};
  return plot;
}

}  // namespace

std::vector<Plot> fit_plots(const MaterialFit& fit) { return {force_plot(fit), friction_plot(fit)}; }

}  // namespace papilla
