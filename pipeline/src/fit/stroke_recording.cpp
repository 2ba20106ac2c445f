// SPDX-License-Identifier: MIT
#include "papilla/pipeline/stroke_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <memory>

#include "papilla/core/error.hpp"
#include "papilla/core/near_name.hpp"
#include "papilla/haptic/contact_surface.hpp"

namespace papilla {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t at = 0;; ++at) {
    const std::size_t end = line.find(',', at);
    fields.push_back(trimmed(line.substr(at, end == std::string_view::npos ? end : end - at)));
    if (end == std::string_view::npos) return fields;
    at = end;
  }
}

/// Where a number or a vector stands in a line.
using Columns = std::array<std::size_t, 3>;

class Heading {
 public:
  Heading(std::string_view line, std::string place) : names_(fields_of(line)), place_(std::move(place)) {}

  std::optional<std::size_t> find(const std::string& name) const {
    const auto at = std::find(names_.begin(), names_.end(), name);
    if (at == names_.end()) return std::nullopt;
    if (std::find(at + 1, names_.end(), name) != names_.end())
      throw InvalidInput(place_ + "the heading has the column " + name + " twice");
    return static_cast<std::size_t>(at - names_.begin());
  }
  std::size_t require(const std::string& name) const {
    if (const auto at = find(name)) return *at;
    const bool is_of_others = names_.size() == 1 && names_.front().find_first_of(";\t") != std::string_view::npos;
    throw InvalidInput(place_ + "the heading has no column " + name +
                       (is_of_others ? "; commas must separate columns" : did_you_mean(name, names_)));
  }
  /// The three columns of that prefix; nothing when there is none of them.
  std::optional<Columns> find_vector(const std::string& prefix) const {
    if (!find(prefix + "x") && !find(prefix + "y") && !find(prefix + "z")) return std::nullopt;
    return require_vector(prefix);
  }
  Columns require_vector(const std::string& prefix) const {
    return {require(prefix + "x"), require(prefix + "y"), require(prefix + "z")};
  }
  const std::vector<std::string_view>& names() const { return names_; }

 private:
  std::vector<std::string_view> names_;
  std::string place_;
};

/// The columns that are read.
struct Layout {
  explicit Layout(const Heading& heading)
      : t(heading.require("t")),
        probe(probe_of(heading)),
        force(heading.require_vector("force_")),
        proxy(heading.find_vector("proxy_")),
        velocity(heading.find_vector("velocity_")) {}
  static Columns probe_of(const Heading& heading) {
    const auto columns = heading.find_vector("probe_");
    return columns ? *columns : heading.require_vector("");
  }
  std::size_t t;
  Columns probe, force;
  std::optional<Columns> proxy, velocity;
};

class Line {
 public:
  Line(std::string_view line, const Heading& heading, std::string place)
      : fields_(fields_of(line)), heading_(heading), place_(std::move(place)) {
    if (fields_.size() > heading.names().size())
      throw InvalidInput(
          fmt::format("{}has {} values, and the heading {} columns", place_, fields_.size(), heading.names().size()));
  }

  double number(std::size_t column) const {
    const std::string_view name = heading_.names()[column];
    if (column >= fields_.size())
      throw InvalidInput(fmt::format("{}column {} ({}) is missing", place_, column + 1, name));
    double value = 0;
    const std::string_view text = fields_[column];
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
      throw InvalidInput(fmt::format("{}column {} ({}) is no number", place_, column + 1, name));
    if (!std::isfinite(value))
      throw InvalidInput(fmt::format("{}column {} ({}) is not finite", place_, column + 1, name));
    return value;
  }
  Vec3 vector(const Columns& columns) const { return {number(columns[0]), number(columns[1]), number(columns[2])}; }
  Vec3 position(const Columns& columns) const {
    const Vec3 p = vector(columns);
    if (!ContactSurface::is_valid_position(p)) throw InvalidInput(place_ + "a position is farther than 1000 km");
    return p;
  }
  const std::string& place() const { return place_; }

 private:
  std::vector<std::string_view> fields_;
  const Heading& heading_;
  std::string place_;
};

StrokeSample sample_of(const Line& line, const Layout& layout) {
  StrokeSample sample;
  sample.t_s = line.number(layout.t);
  sample.probe_m = line.position(layout.probe);
  sample.force_n = line.vector(layout.force);
  if (layout.proxy) sample.proxy_m = line.position(*layout.proxy);
  if (layout.velocity) sample.velocity_m_per_s = line.vector(*layout.velocity);
  return sample;
}

}  // namespace

std::vector<StrokeSample> parse_stroke_recording(std::string_view csv, const std::string& name) {
  constexpr std::string_view k_byte_order_mark = "\xef\xbb\xbf";  // Spreadsheets write it.
  if (csv.starts_with(k_byte_order_mark)) csv.remove_prefix(k_byte_order_mark.size());
  std::vector<StrokeSample> samples;
  std::unique_ptr<const Heading> heading;
  std::unique_ptr<const Layout> layout;
  for (int number = 1; !csv.empty(); ++number) {
    const std::size_t end = csv.find('\n');
    const std::string_view text = trimmed(csv.substr(0, end));
    csv = end == std::string_view::npos ? std::string_view{} : csv.substr(end + 1);
    if (text.empty() || text.front() == '#') continue;
    const std::string place = fmt::format("{}:{}: ", name, number);
    if (!heading) {
      heading = std::make_unique<const Heading>(text, place);
      layout = std::make_unique<const Layout>(*heading);
      continue;
    }
    const Line line(text, *heading, place);
    samples.push_back(sample_of(line, *layout));
    if (samples.size() > 1 && !(samples.back().t_s > samples[samples.size() - 2].t_s))
      throw InvalidInput(place + "the time does not increase");
  }
  if (samples.size() < 2)
    throw InvalidInput(name + ": holds no recording: a heading and at least two lines of t, probe and force");
  return samples;
}

}  // namespace papilla
