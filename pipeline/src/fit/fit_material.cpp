// SPDX-License-Identifier: MIT
#include "papilla/pipeline/fit_material.hpp"

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

#include "fit/profile_roughness.hpp"
#include "fit/stroke_model.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using P = StrokeParameters;

constexpr std::size_t k_least_samples = 50;
constexpr std::size_t k_least_contacts = 20;  // Samples with force.
constexpr double k_least_force_n = 5e-3;      // A press; below the friction of every device.
constexpr double k_contact_share = 0.2;       // Of the largest force: surely contact, for first parameters.
constexpr double k_best_sensor = 1e-3;        // Of the root mean square force: no force is known better.
constexpr double k_huber = 4;               // Robust deviations, of a vector: one of a thousand normal ones is beyond.
constexpr double k_rough_tolerance = 1e-3;  // Of the misfit, to choose among starts.
constexpr int k_reweightings = 3;
constexpr double k_block_s = 0.05;     // Errors hang together for no longer: the player's fade-in.
constexpr double k_deviations = 1.96;  // 95 %
constexpr double k_widest = 0.5;       // Of a number: half the interval of one that is identified.
constexpr double k_wide_friction = 0.05, k_wide_damping = 0.25;  // So much is known of a zero, too.
constexpr double k_least_slide_m = 1e-3;
constexpr std::size_t k_least_slips = 20;
constexpr double k_wide_range = 5;  // Of speeds, to say that friction does not depend on them.
constexpr double k_chance = 9.21;   // 1 % of chi square with two degrees of freedom.

std::vector<double> sorted(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values;
}

/// @pre sorted and not empty.
double quantile(const std::vector<double>& values, double share) {
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// What is fitted: the model, the weight of every sample, and the parameters that are free.
class Fit {
 public:
  Fit(StrokeModel model, double floor_n)
      : model_(std::move(model)), weights_(model_.stroke().size(), 1.0), floor_n_(floor_n) {}

  StrokeParameters parameters;
  std::vector<P::Index> free;
  Trace trace;
  Stopwatch clock;
  StopReason stop = StopReason::converged;

  StrokeModel& model() { return model_; }
  const StrokeModel& model() const { return model_; }
  const std::vector<double>& weights() const { return weights_; }
  double floor_n() const { return floor_n_; }

  std::vector<ModelForce> forces() const {
    std::vector<ModelForce> forces;
    model_.evaluate(parameters, forces);
    return forces;
  }
  Vec3 residual(std::size_t i, const std::vector<ModelForce>& forces) const {
    return model_.stroke()[i].force_n - forces[i].force_n;
  }
  /// Sum of weighted squares.
  double misfit() const {
    const std::vector<ModelForce> now = forces();
    double sum = 0;
    for (std::size_t i = 0; i < now.size(); ++i) {
      const Vec3 r = residual(i, now);
      sum += weights_[i] * dot(r, r);
    }
    return sum;
  }

  /// Least squares with the weights as they are.
  /// @param tolerance relative, of the misfit.
  void solve(const ProgressCallback& progress, const std::string& name, double tolerance = 1e-7);
  /// Huber's weights from the residuals.
  void reweight();
  /// Residuals and their derivatives, three rows a sample, times the roots of the weights.
  void linearize(Eigen::VectorXd& residuals, Eigen::MatrixXd& slopes) const;

 private:
  StrokeModel model_;
  std::vector<double> weights_;
  double floor_n_;
};

/// Residuals over the free parameters.
class Residuals {
 public:
  explicit Residuals(const Fit& fit) : fit_(fit) {}

  bool operator()(double const* const* free, double* residuals) const {
    StrokeParameters p = fit_.parameters;
    for (std::size_t k = 0; k < fit_.free.size(); ++k) p.x[fit_.free[k]] = free[0][k];
    std::vector<ModelForce> forces;
    fit_.model().evaluate(p, forces);
    for (std::size_t i = 0; i < forces.size(); ++i) {
      const Vec3 r = std::sqrt(fit_.weights()[i]) * fit_.residual(i, forces);
      if (!is_finite(r)) return false;
      residuals[3 * i] = r.x, residuals[3 * i + 1] = r.y, residuals[3 * i + 2] = r.z;
    }
    return true;
  }

 private:
  const Fit& fit_;
};

using NumericCost = ceres::DynamicNumericDiffCostFunction<Residuals, ceres::CENTRAL>;

std::unique_ptr<NumericCost> cost_of(const Fit& fit) {
  auto cost = std::make_unique<NumericCost>(new Residuals(fit));
  cost->AddParameterBlock(static_cast<int>(fit.free.size()));
  cost->SetNumResiduals(static_cast<int>(3 * fit.model().stroke().size()));
  return cost;
}

class TraceCallback : public ceres::IterationCallback {
 public:
  TraceCallback(Fit& fit, double samples, const ProgressCallback& progress)
      : fit_(fit), samples_(samples), progress_(progress) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& now) override {
    fit_.trace.push_back({fit_.clock.seconds(), std::sqrt(2 * now.cost / samples_)});
    const bool goes_on = !progress_ || progress_({"fit", 1 - 1 / (1 + 0.05 * static_cast<double>(fit_.trace.size()))});
    return goes_on ? ceres::SOLVER_CONTINUE : ceres::SOLVER_ABORT;
  }

 private:
  Fit& fit_;
  double samples_;
  const ProgressCallback& progress_;
};

void Fit::solve(const ProgressCallback& progress, const std::string& name, double tolerance) {
  std::vector<double> x;
  for (const P::Index k : free) x.push_back(parameters.x[k]);
  ceres::Problem problem;
  problem.AddResidualBlock(cost_of(*this).release(), nullptr, x.data());
  for (std::size_t k = 0; k < free.size(); ++k) {
    const auto [low, high] = [&]() -> std::pair<double, double> {
      switch (free[k]) {
        case P::stiffness: return {std::log(1e-3), std::log(1e6)};  // The range of MATERIALS.json.
        case P::damping: return {0, 1e4};
        case P::dynamic_friction:
        case P::friction_drop: return {0, 10};
        case P::stribeck: return {std::log(1e-6), std::log(10)};
        case P::tilt_u:
        case P::tilt_v: return {-1, 1};
        case P::offset:
          return model_.surface() == StrokeSurface::recorded ? std::pair{0.0, k_widest_gap_m} : std::pair{-1e6, 1e6};
        default: return {-1e6, 1e6};
      }
    }();
    problem.SetParameterLowerBound(x.data(), static_cast<int>(k), low);
    problem.SetParameterUpperBound(x.data(), static_cast<int>(k), high);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  options.max_num_iterations = 50;
  options.function_tolerance = tolerance;
  TraceCallback callback(*this, std::accumulate(weights_.begin(), weights_.end(), 0.0), progress);
  options.callbacks.push_back(&callback);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (summary.termination_type == ceres::USER_FAILURE) throw Cancelled("cancelled during 'fit'");
  if (!summary.IsSolutionUsable()) throw SolverFailure(name + ": no material fits the forces");
  for (std::size_t k = 0; k < free.size(); ++k) parameters.x[free[k]] = x[k];
  stop = summary.termination_type == ceres::CONVERGENCE ? StopReason::converged : StopReason::iteration_limit;
}

void Fit::reweight() {
  const std::vector<ModelForce> now = forces();
  std::vector<double> parts;
  for (std::size_t i = 0; i < now.size(); ++i)
    if (now[i].load_n > 0) {
      const Vec3 r = residual(i, now);
      for (const double part : {r.x, r.y, r.z}) parts.push_back(std::abs(part));
    }
  if (parts.empty()) return;
  const double scale_n = std::max(floor_n_, 1.4826 * quantile(sorted(std::move(parts)), 0.5));
  for (std::size_t i = 0; i < now.size(); ++i)
    weights_[i] = std::min(1.0, k_huber * scale_n / std::max(norm(residual(i, now)), 1e-300));
}

void Fit::linearize(Eigen::VectorXd& residuals, Eigen::MatrixXd& slopes) const {
  const auto rows = static_cast<Eigen::Index>(3 * model_.stroke().size());
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> by_row(rows,
                                                                                static_cast<Eigen::Index>(free.size()));
  residuals.resize(rows);
  std::vector<double> x;
  for (const P::Index k : free) x.push_back(parameters.x[k]);
  const double* block = x.data();
  double* jacobian = by_row.data();
  cost_of(*this)->Evaluate(&block, residuals.data(), &jacobian);
  slopes = by_row;
}

/// Two covariances of the free parameters; an interval is that of the larger variance.
class Uncertainty {
 public:
  explicit Uncertainty(const Fit& fit) : fit_(fit) {
    Eigen::VectorXd residuals;
    Eigen::MatrixXd slopes;
    fit.linearize(residuals, slopes);
    const std::vector<ModelForce> forces = fit.forces();
    const Eigen::Index count = slopes.cols();
    Eigen::MatrixXd blocks = Eigen::MatrixXd::Zero(count, count);
    Eigen::VectorXd block = Eigen::VectorXd::Zero(count);
    double squares = 0, rows = 0, begin = fit.model().stroke().front().t_s;
    const auto close = [&] {
      blocks += block * block.transpose();
      block.setZero();
    };
    for (std::size_t i = 0; i < forces.size(); ++i) {
      if (const double t = fit.model().stroke()[i].t_s; t - begin > k_block_s) close(), begin = t;
      const auto row = static_cast<Eigen::Index>(3 * i);
      block += slopes.middleRows(row, 3).transpose() * residuals.segment(row, 3);
      if (!(forces[i].load_n > 0)) continue;
      squares += fit.weights()[i] * residuals.segment(row, 3).squaredNorm();  // Of Huber's psi.
      rows += 3;
    }
    close();
    const double floor = fit.floor_n() * fit.floor_n();
    variance_ = std::max(floor, squares / std::max(1.0, rows - static_cast<double>(count)));
    const Eigen::MatrixXd inverse = scaled_inverse(slopes.transpose() * slopes);
    independent_ = variance_ * inverse;
    hanging_ = inverse * blocks * inverse;
  }

  double variance() const { return variance_; }

  /// Half of the 95 % interval of a sum of parameters; infinite when one is not free.
  double half(std::initializer_list<P::Index> sum) const {
    Eigen::VectorXd pick = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(fit_.free.size()));
    for (const P::Index k : sum) {
      const auto at = std::find(fit_.free.begin(), fit_.free.end(), k);
      if (at == fit_.free.end()) return std::numeric_limits<double>::infinity();
      pick[at - fit_.free.begin()] = 1;
    }
    const double independent = pick.dot(independent_ * pick), hanging = pick.dot(hanging_ * pick);
    if (!std::isfinite(independent) || !std::isfinite(hanging)) return std::numeric_limits<double>::infinity();
    return k_deviations * std::sqrt(std::max({0.0, independent, hanging}));
  }

 private:
  /// Of a matrix whose rows have different units. What nothing depends on becomes as good as unknown.
  static Eigen::MatrixXd scaled_inverse(const Eigen::MatrixXd& information) {
    constexpr double k_least = 1e-12;
    const double largest = std::max(information.diagonal().maxCoeff(), 1e-200);
    const Eigen::VectorXd scale =
        information.diagonal().cwiseMax(k_least * k_least * largest).cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scale.asDiagonal() * information * scale.asDiagonal());
    const Eigen::VectorXd inverse = solver.eigenvalues().cwiseMax(k_least).cwiseInverse();
    return scale.asDiagonal() * solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose() *
           scale.asDiagonal();
  }

  const Fit& fit_;
  double variance_ = 0;
  Eigen::MatrixXd independent_, hanging_;
};

/// What the stroke did, as the reasons tell it.
struct StrokeFacts {
  double slid_m = 0;                  ///< Along the surface while there was force.
  std::vector<double> slips_m_per_s;  ///< Of the slipping samples, ascending.
  double fastest_press_m_per_s = 0;   ///< 95 % of the speeds along the normal.
  double shallowest_m = 0, deepest_m = 0;
};

StrokeFacts facts_of(const Fit& fit, const std::vector<ModelForce>& forces) {
  StrokeFacts facts;
  std::vector<double> presses, depths;
  const double k = std::exp(fit.parameters.x[P::stiffness]);
  for (std::size_t i = 1; i < forces.size(); ++i) {
    const ModelForce& f = forces[i];
    if (!(f.load_n > 0)) continue;
    const Vec3 moved = fit.model().stroke()[i].probe_m - fit.model().stroke()[i - 1].probe_m;
    facts.slid_m += norm(moved - dot(moved, f.normal) * f.normal);
    if (f.slip_m_per_s > 0) facts.slips_m_per_s.push_back(f.slip_m_per_s);
    presses.push_back(std::abs(dot(f.velocity_m_per_s, f.normal)));
    depths.push_back(f.load_n / k);
  }
  facts.slips_m_per_s = sorted(std::move(facts.slips_m_per_s));
  if (presses.empty()) return facts;
  facts.fastest_press_m_per_s = quantile(sorted(std::move(presses)), 0.95);
  depths = sorted(std::move(depths));
  facts.shallowest_m = depths.front(), facts.deepest_m = depths.back();
  return facts;
}

bool slides(const StrokeFacts& facts) {
  return facts.slid_m >= k_least_slide_m && facts.slips_m_per_s.size() >= k_least_slips;
}

/// Whether the stroke slipped slower and faster than vs.
bool spans(const StrokeFacts& facts, double vs) {
  std::size_t slow = 0, fast = 0;
  for (const double slip : facts.slips_m_per_s) {
    const double held = std::exp(-(slip / vs) * (slip / vs));
    slow += held > 0.5, fast += held < 0.1;
  }
  return slow >= k_least_slips && fast >= k_least_slips;
}

/// Whether a proxy slides unsteadily: δ·|dμ/dv| at its steepest is longer than the memory of friction (proxy.hpp).
bool sticks_and_slips(const StrokeParameters& p, const StrokeFacts& facts) {
  constexpr double k_memory_s = 1e-2, k_steepest = 0.858;  // √(2/e)
  return facts.deepest_m * k_steepest * p.x[P::friction_drop] / std::exp(p.x[P::stribeck]) > k_memory_s;
}

/// Goes on from the guess that leads to the least misfit.
void begin(Fit& fit, const std::vector<FirstGuess>& guesses, const ProgressCallback& progress,
           const std::string& name) {
  FirstGuess best = guesses.front();
  double least = std::numeric_limits<double>::infinity();
  for (const FirstGuess& guess : guesses) {
    fit.model().set_normal(guess.normal);
    fit.parameters = guess.parameters;
    fit.solve(progress, name, k_rough_tolerance);
    if (const double misfit = fit.misfit(); misfit < least) least = misfit, best = {fit.parameters, guess.normal};
  }
  fit.model().set_normal(best.normal);
  fit.parameters = best.parameters;
}

/// Fits with frictions that depend on speed from several speeds. @returns whether they explain more than chance.
bool fit_stribeck(Fit& fit, const StrokeFacts& facts, const ProgressCallback& progress, const std::string& name) {
  const StrokeParameters constant = fit.parameters;
  const StopReason stop = fit.stop;
  const std::vector<P::Index> before = fit.free;
  fit.free.push_back(P::friction_drop);
  fit.free.push_back(P::stribeck);
  StrokeParameters best;
  double least = std::numeric_limits<double>::infinity();
  for (const double share : {0.1, 0.5, 0.9}) {
    fit.parameters = constant;
    fit.parameters.x[P::friction_drop] = 0.1 * constant.x[P::dynamic_friction] + 0.01;
    fit.parameters.x[P::stribeck] = std::log(0.5 * std::max(1e-4, quantile(facts.slips_m_per_s, share)));
    fit.solve(progress, name, k_rough_tolerance);
    if (const double misfit = fit.misfit(); misfit < least) least = misfit, best = fit.parameters;
  }
  fit.parameters = best;
  for (int i = 0; i < k_reweightings; ++i) fit.reweight(), fit.solve(progress, name);
  const StrokeParameters found = fit.parameters;
  const double with = fit.misfit();
  const Uncertainty uncertainty(fit);
  const double drop = found.x[P::friction_drop], vs = std::exp(found.x[P::stribeck]);
  const bool is_known = drop > uncertainty.half({P::friction_drop}) && uncertainty.half({P::stribeck}) <= k_widest &&
                        spans(facts_of(fit, fit.forces()), vs);
  fit.parameters = constant;
  fit.free = before;
  fit.solve(progress, name);
  if (is_known && fit.misfit() - with > k_chance * uncertainty.variance()) {
    fit.parameters = found;
    fit.free.push_back(P::friction_drop);
    fit.free.push_back(P::stribeck);
    return true;
  }
  for (int i = 0; i < k_reweightings; ++i) fit.reweight(), fit.solve(progress, name);
  fit.stop = worse(fit.stop, stop);
  return false;
}

/// A positive number from its logarithm.
FittedNumber from_log(double log, double half) { return {std::exp(log), std::exp(log - half), std::exp(log + half)}; }
FittedNumber not_negative(double value, double half) { return {value, std::max(0.0, value - half), value + half}; }

class Verdicts {
 public:
  Verdicts(MaterialFit& result, const Fit& fit) : result_(result), fit_(fit), uncertainty_(fit) {}

  void judge_stiffness(const StrokeFacts& facts) {
    const double half = uncertainty_.half({P::stiffness});
    if (half <= k_widest)
      result_.stiffness = from_log(fit_.parameters.x[P::stiffness], half);
    else
      leave_out("stiffness", fmt::format("the depth of the press changed too little beside the noise of the force: "
                                         "the fit has it from {:.3g} to {:.3g} mm",
                                         1e3 * facts.shallowest_m, 1e3 * facts.deepest_m));
  }

  void judge_damping(const StrokeFacts& facts) {
    const double b = fit_.parameters.x[P::damping], half = uncertainty_.half({P::damping});
    if (half <= std::max(k_widest * b, k_wide_damping))
      result_.damping = not_negative(b, half);
    else
      leave_out("damping", fmt::format("the probe moved in and out of the surface too slowly for it: at no more than "
                                       "{:.3g} mm/s in 95 % of the contact",
                                       1e3 * facts.fastest_press_m_per_s));
  }

  void judge_friction(const StrokeFacts& facts, bool by_speed) {
    if (!slides(facts)) {
      const std::string reason = fmt::format(
          "the probe never slid: it moved {:.3g} mm along the surface while it pressed, and {} samples slip",
          1e3 * facts.slid_m, facts.slips_m_per_s.size());
      for (const char* name : {"static_friction", "dynamic_friction", "stribeck_velocity"}) leave_out(name, reason);
      return;
    }
    result_.slowest_slip_m_per_s = quantile(facts.slips_m_per_s, 0.05);
    result_.fastest_slip_m_per_s = quantile(facts.slips_m_per_s, 0.95);
    const double mu = fit_.parameters.x[P::dynamic_friction], half = uncertainty_.half({P::dynamic_friction});
    if (half > std::max(k_widest * mu, k_wide_friction)) {
      for (const char* name : {"static_friction", "dynamic_friction", "stribeck_velocity"})
        leave_out(name, "the force along the way is lost in the noise");
      return;
    }
    result_.dynamic_friction = not_negative(mu, half);
    if (by_speed) {
      result_.static_friction = not_negative(mu + fit_.parameters.x[P::friction_drop],
                                             uncertainty_.half({P::dynamic_friction, P::friction_drop}));
      result_.stribeck_velocity = from_log(fit_.parameters.x[P::stribeck], uncertainty_.half({P::stribeck}));
      return;
    }
    const std::string speeds =
        fmt::format("{:.3g} to {:.3g} mm/s", 1e3 * result_.slowest_slip_m_per_s, 1e3 * result_.fastest_slip_m_per_s);
    if (result_.fastest_slip_m_per_s > k_wide_range * result_.slowest_slip_m_per_s) {
      result_.static_friction = result_.dynamic_friction;
      leave_out("stribeck_velocity", "friction does not change over the speeds of the stroke, " + speeds);
      return;
    }
    for (const char* name : {"static_friction", "stribeck_velocity"})
      leave_out(name, "the probe slid at one speed only, " + speeds + "; the dynamic friction is that at this speed");
  }

  void leave_out(std::string parameter, std::string reason) {
    result_.not_identified.push_back({std::move(parameter), std::move(reason)});
  }

 private:
  MaterialFit& result_;
  const Fit& fit_;
  Uncertainty uncertainty_;
};

/// Noise of a component of force: of differences between neighbours without contact, or at rest in it, which an offset
/// does not matter to; nothing where there are few.
std::optional<double> noise_of(const Fit& fit, const std::vector<ModelForce>& forces) {
  constexpr double k_rest_m_per_s = 1e-4;
  const auto is_quiet = [&](std::size_t i) {
    return !(forces[i].load_n > 0) || norm(forces[i].velocity_m_per_s) <= k_rest_m_per_s;
  };
  double squares = 0, count = 0;
  for (std::size_t i = 1; i < forces.size(); ++i) {
    if (!is_quiet(i) || !is_quiet(i - 1) || (forces[i].load_n > 0) != (forces[i - 1].load_n > 0)) continue;
    const Vec3 d = fit.residual(i, forces) - fit.residual(i - 1, forces);
    squares += dot(d, d) / 6;
    count += 1;
  }
  if (count < static_cast<double>(k_least_samples)) return std::nullopt;
  return std::max(fit.floor_n(), std::sqrt(squares / count));
}

/// The straight pieces that the probe slid along, as places of the surface.
std::vector<std::vector<ProfilePoint>> profiles_of(const Fit& fit, const std::vector<ModelForce>& forces) {
  constexpr double k_straight = 0.9;  // Cosine.
  constexpr double k_far_off = 0.1;   // Weight of a force that is no relief.
  const double k = std::exp(fit.parameters.x[P::stiffness]);
  std::vector<std::vector<ProfilePoint>> runs;
  Vec3 direction;
  bool goes_on = false;
  for (std::size_t i = 1; i < forces.size(); ++i) {
    const ModelForce& f = forces[i];
    const StrokeSample& now = fit.model().stroke()[i];
    const Vec3 moved = now.probe_m - fit.model().stroke()[i - 1].probe_m;
    const Vec3 way = moved - dot(moved, f.normal) * f.normal;
    const bool slips = fit.weights()[i] > k_far_off && f.slip_m_per_s > 0;
    if (!slips || dot(normalized(way), direction) < k_straight) goes_on = false;
    if (norm(way) > 0) direction = normalized(way);
    if (!slips) continue;
    if (!goes_on) runs.emplace_back();
    const double way_m = goes_on ? runs.back().back().way_m + norm(way) : 0;
    if (goes_on && !(norm(way) > 0)) continue;
    goes_on = true;
    const double depth = (f.load_n + dot(fit.residual(i, forces), f.normal)) / k;
    runs.back().push_back({way_m, now.probe_m + depth * f.normal, f.normal});
  }
  return runs;
}

void judge_roughness(MaterialFit& result, const Fit& fit, const std::vector<ModelForce>& forces,
                     const StrokeFacts& facts, Verdicts& verdicts) {
  const auto noise = noise_of(fit, forces);
  ProfileRoughness found;
  found.no_hurst = "there is no roughness";
  if (!result.stiffness)
    found.no_roughness = "heights follow from forces by the stiffness";
  else if (!slides(facts))
    found.no_roughness = "the probe never slid";
  else if (!noise)
    found.no_roughness = "no 50 samples without contact or at rest tell the noise of the force";
  else
    found = profile_roughness(profiles_of(fit, forces), *noise / result.stiffness->value);
  result.roughness = found.roughness;
  if (!found.no_roughness.empty()) verdicts.leave_out("roughness", found.no_roughness);
  if (!found.no_hurst.empty()) verdicts.leave_out("hurst", found.no_hurst);
}

/// Whether the forces are those on the surface, not on the hand: they press the probe from its proxies.
bool points_inwards(std::span<const StrokeSample> stroke) {
  double sum = 0;
  for (const StrokeSample& sample : stroke)
    if (sample.proxy_m) sum += dot(sample.force_n, *sample.proxy_m - sample.probe_m);
  return sum < 0;
}

/// Where a contact of the player ends though the probe is as deep as before: a player that stands still lets it go.
std::optional<double> let_go_s(std::span<const StrokeSample> stroke) {
  constexpr double k_least_depth_m = 5e-5, k_still_deep = 0.5, k_rounding_m = 1e-9;
  for (std::size_t i = 1; i < stroke.size(); ++i) {
    const StrokeSample &before = stroke[i - 1], &now = stroke[i];
    if (!before.proxy_m || !now.proxy_m) continue;
    const Vec3 behind = *before.proxy_m - before.probe_m;
    if (norm(behind) < k_least_depth_m || norm(*now.proxy_m - now.probe_m) > k_rounding_m) continue;
    if (dot(normalized(behind), *before.proxy_m - now.probe_m) > k_still_deep * norm(behind)) return now.t_s;
  }
  return std::nullopt;
}

/// Nine of ten speeds of the probe are below, where there is force.
double high_speed(std::span<const StrokeSample> stroke, double contact_n) {
  std::vector<double> speeds;
  for (std::size_t i = 1; i < stroke.size(); ++i)
    if (norm(stroke[i].force_n) >= contact_n)
      speeds.push_back(norm(stroke[i].probe_m - stroke[i - 1].probe_m) / (stroke[i].t_s - stroke[i - 1].t_s));
  return speeds.empty() ? 0 : quantile(sorted(std::move(speeds)), 0.9);
}

/// What makes the intervals say too much.
/// @param rms_force_n  of all samples.
void warn_of_recording(MaterialFit& result, const FitOptions& options, std::span<const StrokeSample> stroke,
                       double contact_n, double rms_force_n) {
  constexpr double k_fastest_hand = 5;                    // m/s
  constexpr double k_unexplained = 0.1, k_far_off = 0.2;  // Of the force, of the samples.
  if (const double speed = high_speed(stroke, contact_n); speed > k_fastest_hand)
    result.warnings.push_back(fmt::format(
        "while it presses the probe moves at {:.3g} m/s and more in a tenth of the samples, faster than a hand: places "
        "are in metres and times in seconds",
        speed));
  if (const auto at = let_go_s(stroke); at && options.forces != StrokeForces::sensor)
    result.warnings.push_back(fmt::format(
        "at {:.4g} s the surface lets the probe go while it is deep: the player stood still, or the part "
        "ends there; what comes after may be of its other side (papilla-player --watchdog keeps a recording "
        "whole)",
        *at));
  const double left = result.rms_residual_n / rms_force_n;
  const double far_off = static_cast<double>(result.outliers) / static_cast<double>(result.samples);
  if (left > k_unexplained || far_off > k_far_off)
    result.warnings.push_back(
        fmt::format("the model leaves {:.0f} % of the force unexplained, and {:.0f} % of the samples are far off: the "
                    "numbers are less certain than their intervals say",
                    100 * left, 100 * far_off));
}

std::vector<FittedForce> fitted_forces(const Fit& fit, const std::vector<ModelForce>& forces) {
  std::vector<FittedForce> fitted;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const StrokeSample& sample = fit.model().stroke()[i];
    const Vec3 n = forces[i].normal;
    const Vec3 friction = forces[i].force_n - dot(forces[i].force_n, n) * n;
    const Vec3 against = normalized(friction);
    fitted.push_back({sample.t_s, dot(sample.force_n, n), dot(sample.force_n, against), dot(forces[i].force_n, n),
                      norm(friction), forces[i].load_n, forces[i].slip_m_per_s});
  }
  return fitted;
}

/// Force from which on a sample counts as contact. @throws InvalidInput when the stroke never presses.
double contact_force(std::span<const StrokeSample> stroke, const std::string& name) {
  double largest = 0;
  for (const StrokeSample& sample : stroke) largest = std::max(largest, norm(sample.force_n));
  const double contact = std::max(k_least_force_n, k_contact_share * largest);
  std::size_t count = 0;
  for (const StrokeSample& sample : stroke) count += norm(sample.force_n) >= contact;
  if (count < k_least_contacts)
    throw InvalidInput(
        fmt::format("{}: the stroke never presses: {} samples have a force of {:.3g} N or more, so that "
                    "nothing of the material is identified",
                    name, count, contact));
  return contact;
}

/// What the player's guard did to the forces.
std::optional<SafetyLimits> guard_of(std::span<const StrokeSample> stroke, const FitOptions& options) {
  const bool is_player = options.forces == StrokeForces::player ||
                         (options.forces == StrokeForces::automatic && stroke.front().proxy_m.has_value());
  if (!is_player) return std::nullopt;
  return safety_limits(options.max_force_n);
}

StrokeSurface surface_of(std::span<const StrokeSample> stroke, const FitOptions& options, const std::string& name) {
  const bool has_proxies = stroke.front().proxy_m.has_value();
  if (options.surface == StrokeSurface::recorded && !has_proxies)
    throw InvalidInput(name + ": has no columns proxy_x, proxy_y, proxy_z that tell the surface");
  if (options.surface == StrokeSurface::automatic) return has_proxies ? StrokeSurface::recorded : StrokeSurface::plane;
  return options.surface;
}

}  // namespace

MaterialFit fit_material(std::span<const StrokeSample> stroke, const FitOptions& options, const std::string& name,
                         const ProgressCallback& progress) {
  MaterialFit result;
  if (stroke.size() < k_least_samples)
    throw InvalidInput(fmt::format("{}: {} samples are fewer than {}", name, stroke.size(), k_least_samples));
  if (stroke.size() > options.most_samples) {
    result.warnings.push_back(
        fmt::format("only the first {} of {} samples are used", options.most_samples, stroke.size()));
    stroke = stroke.first(options.most_samples);
  }
  const double contact_n = contact_force(stroke, name);
  if (points_inwards(stroke))
    throw InvalidInput(name +
                       ": the forces point into the surface: force_x, force_y, force_z are those on the hand, "
                       "of the opposite sign");
  double all_squares = 0, squares = 0, contacts = 0;
  for (const StrokeSample& sample : stroke) all_squares += dot(sample.force_n, sample.force_n);
  for (const StrokeSample& sample : stroke)
    if (norm(sample.force_n) >= contact_n) squares += dot(sample.force_n, sample.force_n), ++contacts;
  Fit fit(StrokeModel(stroke, surface_of(stroke, options, name), contact_n, guard_of(stroke, options)),
          k_best_sensor * std::sqrt(squares / contacts));
  fit.free = {P::stiffness, P::offset, P::damping, P::dynamic_friction};
  if (fit.model().surface() == StrokeSurface::plane) fit.free.insert(fit.free.end(), {P::tilt_u, P::tilt_v});
  begin(fit, first_guesses(fit.model(), contact_n), progress, name);
  fit.solve(progress, name);
  for (int i = 0; i < k_reweightings; ++i) fit.reweight(), fit.solve(progress, name);
  const StrokeFacts first = facts_of(fit, fit.forces());
  const bool by_speed = slides(first) && fit_stribeck(fit, first, progress, name);

  const std::vector<ModelForce> forces = fit.forces();
  const StrokeFacts facts = facts_of(fit, forces);
  result.surface = fit.model().surface();
  result.normal = fit.model().normal(fit.parameters);
  result.stop = fit.stop;
  result.trace = std::move(fit.trace);
  result.samples = stroke.size();
  double sum = 0;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const Vec3 r = fit.residual(i, forces);
    sum += dot(r, r);
    result.outliers += fit.weights()[i] < 0.5;
  }
  result.rms_residual_n = std::sqrt(sum / static_cast<double>(forces.size()));
  result.forces = fitted_forces(fit, forces);
  warn_of_recording(result, options, stroke, contact_n, std::sqrt(all_squares / static_cast<double>(stroke.size())));
  if (by_speed && result.surface == StrokeSurface::plane && sticks_and_slips(fit.parameters, facts))
    result.warnings.push_back(
        "friction falls so fast with speed that the contact sticks and slips: without recorded proxies static friction "
        "and Stribeck speed are less certain than their intervals say");
  Verdicts verdicts(result, fit);
  verdicts.judge_stiffness(facts);
  verdicts.judge_damping(facts);
  verdicts.judge_friction(facts, by_speed);
  judge_roughness(result, fit, forces, facts, verdicts);
  return result;
}

}  // namespace papilla
