// SPDX-License-Identifier: MIT
#include "unwrap_value.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "papilla/param/levy_coupling.hpp"

namespace papilla {
namespace {

constexpr double k_farthest_mm = 1e9;

/// Whether the object has an option, which must be one of the method.
class Options {
 public:
  Options(const JsonValue& value, UnwrapMethod method) : value_(value), method_(method) {}

  std::optional<JsonValue> get(const std::string& key, const std::string& option) const {
    auto v = value_.get(key);
    if (!v) return v;
    if (const std::string reason = foreign_option(option, method_); !reason.empty()) v->fail(reason);
    return v;
  }
  std::optional<JsonValue> get(const std::string& key) const { return get(key, key); }

  void number(const char* key, double& target, double low, double high) const {
    if (const auto v = get(key)) target = v->number(low, high);
  }
  template <class Value>
  void choice(const char* key, Value& target, const std::map<std::string, Value>& names) const {
    const auto v = get(key);
    if (!v) return;
    std::vector<std::string_view> words;
    for (const auto& [name, unused] : names) words.emplace_back(name);
    target = names.at(v->one_of(words));
  }

 private:
  const JsonValue& value_;
  UnwrapMethod method_;
};

std::vector<double> read_numbers(const JsonValue& value, std::size_t count, const char* form) {
  if (value.list().size() != count) value.fail(std::string("must be ") + form);
  std::vector<double> numbers;
  for (const JsonValue& v : value.list()) numbers.push_back(v.number(-k_farthest_mm, k_farthest_mm));
  return numbers;
}

Vec3 read_place(const JsonValue& value) {
  const std::vector<double> p = read_numbers(value, 3, "[x, y, z]");
  return {p[0], p[1], p[2]};
}

Vec3 read_direction(const JsonValue& value) {
  const Vec3 d = read_place(value);
  if (!(norm(d) > 0)) value.fail("has no length");
  return d;
}

std::string read_part(const JsonValue& value) {
  const auto part = value.get("part");
  return part ? part->text() : std::string();
}

PlacedPin read_pin(const JsonValue& value) {
  value.expect_keys({"at", "uv", "part"});
  const std::vector<double> uv = read_numbers(value.require("uv"), 2, "[u, v]");
  return {read_place(value.require("at")), {uv[0], uv[1]}, read_part(value)};
}

PlacedIsoLine read_iso_line(const JsonValue& value) {
  value.expect_keys({"of", "through", "value", "part"});
  PlacedIsoLine line;
  line.is_u = value.require("of").one_of({"u", "v"}) == "u";
  const JsonValue through = value.require("through");
  for (const JsonValue& place : through.list()) line.points.push_back(read_place(place));
  if (line.points.size() < 2) through.fail("must be two places or more");
  if (const auto v = value.get("value")) line.value = v->number(-k_farthest_mm, k_farthest_mm);
  line.part = read_part(value);
  return line;
}

/// "up", "longest", [x, y, z] or {"edge": [x, y, z]}.
PlacedGrain read_grain(const JsonValue& value, std::string part) {
  if (value.json().is_array()) return {GrainSource::direction, read_direction(value), std::move(part)};
  if (value.json().is_object()) {
    value.expect_keys({"edge"});
    return {GrainSource::edge_loop, read_place(value.require("edge")), std::move(part)};
  }
  if (!value.json().is_string()) value.fail("must be \"up\", \"longest\", [x, y, z] or {\"edge\": [x, y, z]}");
  const bool is_up = value.one_of({"up", "longest"}) == "up";
  return {is_up ? GrainSource::up : GrainSource::longest, {0, 0, 1}, std::move(part)};
}

void read_grains(const JsonValue& value, std::vector<PlacedGrain>& grains) {
  if (const auto v = value.get("grain")) grains.push_back(read_grain(*v, {}));
  const auto by_part = value.get("grain_of");
  if (!by_part) return;
  by_part->expect_object();
  for (const auto& [pattern, unused] : by_part->json().items()) {
    const JsonValue grain = *by_part->get(pattern);
    if (pattern.empty()) grain.fail("needs a part's name or pattern as its key");
    grains.push_back(read_grain(grain, pattern));
  }
}

void read_options(const JsonValue& value, MethodOptions& o) {
  const Options of(value, o.method);
  if (const auto v = of.get("solver"))
    if (!choose_solver(v->text(), o)) v->fail(unwrap_method_name(o.method) + " has no solver '" + v->text() + "'");
  if (const auto v = of.get("iterations")) {
    const double count = v->number(0, 1e6);
    if (count != std::floor(count)) v->fail("must be a whole number");
    o.iterations = static_cast<int>(count);
  }
  if (const auto v = of.get("tolerance")) o.tolerance = v->number(1e-15, 0.999);
  of.number("phi", o.maillot.length_weight, 0, 1);
  if (const auto v = of.get("allow_flips")) o.maillot.allow_flips = v->yes_or_no();
  of.choice("start", o.maillot.start, maillot_starts());
  if (const auto v = of.get("distortion_limit")) {
    o.maillot.distortion_limit = v->number(0, 1e6);
    if (o.maillot.distortion_limit > 0 && o.maillot.distortion_limit < 1) v->fail("must be 0 or at least 1");
  }
  of.choice("weights", o.levy.weights, levy_weights());
  of.choice("border", o.levy.border, levy_borders());
  of.choice("coupling", o.levy.coupling, levy_couplings());
  of.number("smoothness", o.levy.smoothness, 0, 1e12);
  of.number("orthogonality", o.levy.orthogonality, 0, 1e12);
  of.number("length", o.levy.length, 0, 1e12);
  if (const auto v = of.get("pins", "pin"))
    for (const JsonValue& pin : v->list()) o.pins.push_back(read_pin(pin));
  if (const auto v = of.get("iso_lines", "iso_line"))
    for (const JsonValue& line : v->list()) o.iso_lines.push_back(read_iso_line(line));
  if (o.levy.coupling == LevyCoupling::conformal)
    if (const std::string obstacle = conformal_obstacle(o.levy, !o.iso_lines.empty()); !obstacle.empty())
      of.get("coupling")->fail("can't be conformal: " + obstacle);
  of.choice("shape", o.intermediate.shape, intermediate_shapes());
  of.choice("rule", o.intermediate.rule, intermediate_rules());
  if (const auto v = of.get("eye")) o.intermediate.eye = o.segmentation.eye = read_place(*v);
  if (const auto v = of.get("direction")) o.planar.direction = read_direction(*v);
  if (const auto v = of.get("charts")) {
    o.charts = chart_sources().at(v->one_of({"auto", "keep", "uv"}));
    if (o.charts != ChartSource::automatic && !takes_charts(o.method))
      v->fail(unwrap_method_name(o.method) + " makes its own charts");
  }
  if (const auto v = value.get("feature_angle")) o.segmentation.feature_angle_deg = v->number(1, 180);
  if (const auto v = of.get("max_distortion")) {
    if (value.get("seam_cost")) v->fail("finds the seam cost: give one of the two");
    if (o.charts != ChartSource::automatic) v->fail("finds charts, which are given by 'charts'");
    o.max_distortion = v->json().is_string() ? distortion_bound(v->text()) : DistortionBound{v->number(4, 1e6)};
    if (!o.max_distortion) v->fail("must be a number from 4 on, or \"pNN=D\"");
  }
  if (const auto v = value.get("seam_cost")) {
    o.segmentation.seam_cost = v->number(0, 1e6);
    o.choose_seam_cost = false;
  }
}

/// All but "environment", which moves with the eye.
std::vector<std::string_view> methods_for_materials() {
  std::vector<std::string_view> names;
  for (const auto& [name, method] : unwrap_methods())
    if (method != UnwrapMethod::environment) names.emplace_back(name);
  names.emplace_back("new");
  return names;
}

}  // namespace

void read_unwrap(const JsonValue& value, MaterialRule& rule) {
  std::vector<std::string_view> words = methods_for_materials();
  const auto refuse_environment = [](const JsonValue& v) {
    if (v.json() == "environment") v.fail("'environment' moves with the eye: grain can't lie on it");
  };
  rule.unwrap_options.reset();
  if (!value.json().is_object()) {
    if (!value.json().is_string()) value.fail("must be a word or an object");
    refuse_environment(value);
    words.emplace_back("keep");
    rule.unwrap = value.one_of(words);
    return;
  }
  value.expect_keys({"method",        "solver",        "charts",
                     "iterations",    "tolerance",     "phi",
                     "allow_flips",   "start",         "distortion_limit",
                     "weights",       "border",        "coupling",
                     "smoothness",    "orthogonality", "length",
                     "pins",          "iso_lines",     "shape",
                     "rule",          "direction",     "eye",
                     "feature_angle", "seam_cost",     "grain",
                     "grain_of",      "max_distortion"});
  rule.unwrap = "new";
  if (const auto v = value.get("method")) {
    refuse_environment(*v);
    rule.unwrap = v->one_of(words);
  }
  if (rule.unwrap == "auto") rule.unwrap = "new";  // options are of uv that are made
  MethodOptions& options = rule.unwrap_options.emplace();
  options.method = rule.unwrap == "new" ? UnwrapMethod::automatic : unwrap_methods().at(rule.unwrap);
  read_options(value, options);
  read_grains(value, options.grains);
}

}  // namespace papilla
