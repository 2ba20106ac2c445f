// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <string_view>

#include "papilla/pipeline/unwrap_method.hpp"

namespace papilla {
namespace {

template <class Value>
std::string name_in(const std::map<std::string, Value>& names, Value value) {
  return std::find_if(names.begin(), names.end(), [&](const auto& n) { return n.second == value; })->first;
}

}  // namespace

const std::map<std::string, UnwrapMethod>& unwrap_methods() {
  static const std::map<std::string, UnwrapMethod> names{{"natural", UnwrapMethod::natural},
                                                         {"intermediate", UnwrapMethod::intermediate},
                                                         {"planar", UnwrapMethod::planar},
                                                         {"environment", UnwrapMethod::environment},
                                                         {"triplanar", UnwrapMethod::triplanar},
                                                         {"maillot", UnwrapMethod::maillot},
                                                         {"levy", UnwrapMethod::levy},
                                                         {"tutte", UnwrapMethod::tutte},
                                                         {"mvc", UnwrapMethod::mvc},
                                                         {"lscm", UnwrapMethod::lscm},
                                                         {"arap", UnwrapMethod::arap},
                                                         {"best", UnwrapMethod::best},
                                                         {"auto", UnwrapMethod::automatic}};
  return names;
}

std::string unwrap_method_name(UnwrapMethod method) { return name_in(unwrap_methods(), method); }

const std::map<std::string, UnwrapEffort>& unwrap_efforts() {
  static const std::map<std::string, UnwrapEffort> names{
      {"fast", UnwrapEffort::fast}, {"normal", UnwrapEffort::normal}, {"best", UnwrapEffort::best}};
  return names;
}

const std::map<std::string, ChartSource>& chart_sources() {
  static const std::map<std::string, ChartSource> names{
      {"auto", ChartSource::automatic}, {"keep", ChartSource::keep}, {"uv", ChartSource::uv}};
  return names;
}

std::string chart_source_name(ChartSource source) { return name_in(chart_sources(), source); }

const std::map<std::string, LscmSolver>& lscm_solvers() {
  static const std::map<std::string, LscmSolver> names{{"cgal", LscmSolver::cgal},
                                                       {"hermitian", LscmSolver::hermitian}};
  return names;
}

const std::map<std::string, MaillotSolver>& maillot_solvers() {
  static const std::map<std::string, MaillotSolver> names{{"gradient-descent", MaillotSolver::gradient_descent},
                                                          {"gauss-newton", MaillotSolver::gauss_newton}};
  return names;
}

const std::map<std::string, MaillotStart>& maillot_starts() {
  static const std::map<std::string, MaillotStart> names{{"coarse-to-fine", MaillotStart::coarse_to_fine},
                                                         {"conformal", MaillotStart::conformal},
                                                         {"planar", MaillotStart::planar}};
  return names;
}

const std::map<std::string, LevySolver>& levy_solvers() {
  static const std::map<std::string, LevySolver> names{{"gauss-seidel", LevySolver::gauss_seidel},
                                                       {"direct", LevySolver::direct}};
  return names;
}

const std::map<std::string, LevyWeights>& levy_weights() {
  static const std::map<std::string, LevyWeights> names{{"uniform", LevyWeights::uniform},
                                                        {"cotangent", LevyWeights::cotangent},
                                                        {"mean-value", LevyWeights::mean_value}};
  return names;
}

const std::map<std::string, LevyBorder>& levy_borders() {
  static const std::map<std::string, LevyBorder> names{
      {"convex", LevyBorder::convex}, {"released", LevyBorder::released}, {"free", LevyBorder::free}};
  return names;
}

const std::map<std::string, LevyCoupling>& levy_couplings() {
  static const std::map<std::string, LevyCoupling> names{{"auto", LevyCoupling::automatic},
                                                         {"conformal", LevyCoupling::conformal},
                                                         {"orthogonal", LevyCoupling::orthogonal}};
  return names;
}

const std::map<std::string, IntermediateShape>& intermediate_shapes() {
  static const std::map<std::string, IntermediateShape> names{{"sphere", IntermediateShape::sphere},
                                                              {"cylinder", IntermediateShape::cylinder},
                                                              {"cone", IntermediateShape::cone},
                                                              {"box", IntermediateShape::box}};
  return names;
}

const std::map<std::string, IntermediateRule>& intermediate_rules() {
  static const std::map<std::string, IntermediateRule> names{
      {"reflected-ray", IntermediateRule::reflected_ray},
      {"object-normal", IntermediateRule::object_normal},
      {"object-centroid", IntermediateRule::object_centroid},
      {"intermediate-normal", IntermediateRule::intermediate_normal}};
  return names;
}

const std::map<std::string, EnvironmentMap>& environment_maps() {
  static const std::map<std::string, EnvironmentMap> names{{"sphere", EnvironmentMap::sphere},
                                                           {"equal-area", EnvironmentMap::equal_area}};
  return names;
}

std::optional<DistortionBound> distortion_bound(const std::string& text) {
  const auto number = [](std::string_view digits) {
    double value = 0;
    const char* end = digits.data() + digits.size();
    const auto [rest, error] = std::from_chars(digits.data(), end, value);
    return error == std::errc() && rest == end ? value : std::numeric_limits<double>::quiet_NaN();
  };
  constexpr double k_most = 1e6;
  DistortionBound bound;
  const std::string_view all = text;
  const std::size_t equals = all.find('=');
  if (equals != std::string_view::npos) {
    if (!all.starts_with('p')) return std::nullopt;
    bound.percentile = number(all.substr(1, equals - 1));
    if (!(*bound.percentile > 0 && *bound.percentile <= 100)) return std::nullopt;
  }
  bound.most = number(equals == std::string_view::npos ? all : all.substr(equals + 1));
  if (!(bound.most >= 4 && bound.most <= k_most)) return std::nullopt;
  return bound;
}

std::string distortion_bound_name(const DistortionBound& bound) {
  if (!bound.percentile) return fmt::format("{:g}", bound.most);
  return fmt::format("p{:g}={:g}", *bound.percentile, bound.most);
}

bool choose_solver(const std::string& name, MethodOptions& options) {
  const auto pick = [&](const auto& choices, auto& value) {
    const auto found = choices.find(name);
    if (found != choices.end()) value = found->second;
    return found != choices.end();
  };
  switch (options.method) {
    case UnwrapMethod::lscm: return pick(lscm_solvers(), options.lscm.solver);
    case UnwrapMethod::maillot: return pick(maillot_solvers(), options.maillot.solver);
    case UnwrapMethod::levy: return pick(levy_solvers(), options.levy.solver);
    default: return false;
  }
}

const std::vector<UnwrapMethod>& methods_of_option(const std::string& option) {
  using Method = UnwrapMethod;
  static const std::vector<Method> iterating{Method::automatic, Method::best, Method::maillot, Method::levy,
                                             Method::arap};
  static const std::vector<Method> maillot{Method::maillot}, levy{Method::levy}, planar{Method::planar},
      intermediate{Method::intermediate}, environment{Method::environment}, none;
  static const std::map<std::string, std::vector<Method>> of{
      {"iterations", iterating},
      {"tolerance", iterating},
      {"phi", maillot},
      {"allow_flips", maillot},
      {"start", maillot},
      {"distortion_limit", maillot},
      {"weights", levy},
      {"border", levy},
      {"coupling", levy},
      {"smoothness", levy},
      {"orthogonality", levy},
      {"length", levy},
      {"pin", levy},
      {"iso_line", levy},
      {"shape", intermediate},
      {"rule", intermediate},
      {"direction", planar},
      {"max_distortion", {Method::automatic, Method::best}},
      {"environment_map", environment},
      {"eye", {Method::automatic, Method::best, Method::environment, Method::intermediate}}};
  const auto found = of.find(option);
  return found == of.end() ? none : found->second;
}

std::string foreign_option(const std::string& option, UnwrapMethod method) {
  const std::vector<UnwrapMethod>& methods = methods_of_option(option);
  if (methods.empty() || std::find(methods.begin(), methods.end(), method) != methods.end()) return {};
  std::string names;
  for (const UnwrapMethod m : methods) names += (names.empty() ? "" : ", ") + unwrap_method_name(m);
  return "is of " + names + ", not of " + unwrap_method_name(method);
}

}  // namespace papilla
