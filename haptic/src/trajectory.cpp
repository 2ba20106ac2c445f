// SPDX-License-Identifier: MIT
#include "papilla/haptic/trajectory.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

#include "papilla/core/error.hpp"
#include "papilla/haptic/contact_surface.hpp"

namespace papilla {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

bool to_number(std::string_view text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

/// Removes the text up to the next separator from `rest` and returns it.
std::string_view next_field(std::string_view& rest, char separator) {
  const auto at = rest.find(separator);
  const std::string_view field = rest.substr(0, at);
  rest = at == std::string_view::npos ? std::string_view{} : rest.substr(at + 1);
  return trimmed(field);
}

}  // namespace

Trajectory::Trajectory(std::vector<Sample> samples) : samples_(std::move(samples)) {
  if (samples_.empty()) throw InvalidInput("Trajectory: no samples");
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (!std::isfinite(samples_[i].t) || !is_finite(samples_[i].position))
      throw InvalidInput("Trajectory: sample " + std::to_string(i) + " is not finite");
    if (!ContactSurface::is_valid_position(samples_[i].position))
      throw InvalidInput("Trajectory: sample " + std::to_string(i) + " is farther than 1000 km");
    if (i > 0 && !(samples_[i].t > samples_[i - 1].t))
      throw InvalidInput("Trajectory: the time of sample " + std::to_string(i) + " does not increase");
  }
}

Vec3 Trajectory::position(double t) const noexcept {
  const auto after = std::upper_bound(samples_.begin(), samples_.end(), t,
                                      [](double time, const Sample& sample) { return time < sample.t; });
  if (after == samples_.begin()) return samples_.front().position;
  const Sample& a = *(after - 1);
  if (after == samples_.end() || a.t == t) return a.position;
  return a.position + ((t - a.t) / (after->t - a.t)) * (after->position - a.position);
}

Trajectory parse_trajectory(std::string_view csv, const std::string& name) {
  std::vector<Trajectory::Sample> samples;
  bool heading_allowed = true;
  for (int line_number = 1; !csv.empty(); ++line_number) {
    std::string_view line = next_field(csv, '\n');
    if (line.empty() || line.front() == '#') continue;
    double values[4] = {};
    int read = 0;
    while (read < 4 && !line.empty() && to_number(next_field(line, ','), values[read])) ++read;
    if (read == 0 && heading_allowed) {
      heading_allowed = false;
      continue;
    }
    heading_allowed = false;
    const std::string place = name + ":" + std::to_string(line_number) + ": ";
    if (read < 4) throw InvalidInput(place + "column " + std::to_string(read + 1) + " of t,x,y,z is no number");
    const Trajectory::Sample sample{values[0], {values[1], values[2], values[3]}};
    if (!std::isfinite(sample.t) || !is_finite(sample.position)) throw InvalidInput(place + "a number is not finite");
    if (!ContactSurface::is_valid_position(sample.position))
      throw InvalidInput(place + "a position is farther than 1000 km");
    if (!samples.empty() && !(sample.t > samples.back().t)) throw InvalidInput(place + "the time does not increase");
    samples.push_back(sample);
  }
  if (samples.empty()) throw InvalidInput(name + ": holds no line of t,x,y,z");
  return Trajectory(std::move(samples));
}

}  // namespace papilla
