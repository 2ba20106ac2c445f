// SPDX-License-Identifier: MIT
#include "papilla/study/regression.hpp"

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "binomial_deviance.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

/// Log odds beyond this are as good as certain: a coefficient that grows to it has no finite value.
constexpr double k_most_log_odds = 20;

struct Rows {
  Eigen::MatrixXd x;
  Eigen::VectorXd y;
  std::vector<std::size_t> clusters;
};

Rows checked(const RegressionData& data, const char* what) {
  const std::size_t n = data.answers.size();
  if (data.columns == 0 || n == 0 || data.predictors.size() != n * data.columns || data.clusters.size() != n)
    throw InvalidInput(fmt::format("{}: {} answers, {} predictors in rows of {}, {} clusters do not fit", what, n,
                                   data.predictors.size(), data.columns, data.clusters.size()));
  for (const auto* list : {&data.predictors, &data.answers})
    for (const double value : *list)
      if (!std::isfinite(value)) throw InvalidInput(fmt::format("{}: {} is not finite", what, value));
  Rows rows;
  rows.x = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      data.predictors.data(), static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(data.columns));
  rows.y = Eigen::Map<const Eigen::VectorXd>(data.answers.data(), static_cast<Eigen::Index>(n));
  rows.clusters = data.clusters;
  return rows;
}

std::vector<std::size_t> names_of(const std::vector<std::size_t>& clusters) {
  std::vector<std::size_t> names = clusters;
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

/// The rows without those of a cluster.
Rows without(const Rows& rows, std::size_t cluster) {
  std::vector<Eigen::Index> kept;
  Rows left;
  for (std::size_t i = 0; i < rows.clusters.size(); ++i)
    if (rows.clusters[i] != cluster) {
      kept.push_back(static_cast<Eigen::Index>(i));
      left.clusters.push_back(rows.clusters[i]);
    }
  left.x = rows.x(kept, Eigen::all);
  left.y = rows.y(kept);
  return left;
}

/// The column that the ones before it make, if there is one.
/// @param size  of each column before means were subtracted, which leave dust of rounding.
std::optional<Eigen::Index> collinear_column(const Eigen::MatrixXd& x, const Eigen::RowVectorXd& size) {
  constexpr double k_nothing = 1e-9;
  Eigen::MatrixXd basis(x.rows(), 0);
  for (Eigen::Index k = 0; k < x.cols(); ++k) {
    Eigen::VectorXd rest = x.col(k);
    for (int twice = 0; twice < 2; ++twice) rest -= basis * (basis.transpose() * rest).eval();
    if (!(rest.norm() > k_nothing * size[k])) return k;
    basis.conservativeResize(Eigen::NoChange, k + 1);
    basis.col(k) = rest.normalized();
  }
  return std::nullopt;
}

/// Each row less the means of its cluster.
Rows within_clusters(const Rows& rows) {
  std::map<std::size_t, std::pair<Eigen::VectorXd, double>> sums;
  for (std::size_t i = 0; i < rows.clusters.size(); ++i) {
    Eigen::VectorXd row(rows.x.cols() + 1);
    row << rows.x.row(static_cast<Eigen::Index>(i)).transpose(), rows.y[static_cast<Eigen::Index>(i)];
    auto& [sum, count] = sums.try_emplace(rows.clusters[i], Eigen::VectorXd::Zero(row.size()), 0).first->second;
    sum += row;
    count += 1;
  }
  Rows centred = rows;
  for (std::size_t i = 0; i < rows.clusters.size(); ++i) {
    const auto& [sum, count] = sums.at(rows.clusters[i]);
    centred.x.row(static_cast<Eigen::Index>(i)) -= (sum.head(rows.x.cols()) / count).transpose();
    centred.y[static_cast<Eigen::Index>(i)] -= sum[rows.x.cols()] / count;
  }
  return centred;
}

Eigen::VectorXd least_squares(const Rows& centred) { return centred.x.householderQr().solve(centred.y); }

/// Intervals of what `fit` finds, by leaving out a cluster at a time.
template <class Fit>
std::vector<Estimate> jackknifed(const Rows& rows, const Eigen::VectorXd& value,
                                 const std::vector<std::size_t>& clusters, double confidence, const Fit& fit) {
  std::vector<std::vector<double>> left_out(static_cast<std::size_t>(value.size()));
  for (const std::size_t cluster : clusters) {
    const std::optional<Eigen::VectorXd> found = fit(without(rows, cluster));
    if (!found) continue;
    for (Eigen::Index k = 0; k < value.size(); ++k) left_out[static_cast<std::size_t>(k)].push_back((*found)[k]);
  }
  std::vector<Estimate> estimates;
  for (Eigen::Index k = 0; k < value.size(); ++k) {
    const auto& others = left_out[static_cast<std::size_t>(k)];
    estimates.push_back(others.size() == clusters.size() ? jackknife_interval(value[k], others, confidence)
                                                         : Estimate{value[k], {}, {}});
  }
  return estimates;
}

std::vector<Estimate> with_reach(const Eigen::VectorXd& value, const Eigen::VectorXd& reach) {
  std::vector<Estimate> estimates;
  for (Eigen::Index k = 0; k < value.size(); ++k)
    estimates.push_back(std::isfinite(reach[k]) ? Estimate{value[k], value[k] - reach[k], value[k] + reach[k]}
                                                : Estimate{value[k], {}, {}});
  return estimates;
}

/// The rows of a logistic regression, and the intercept as first parameter.
class LogisticCost : public ceres::CostFunction {
 public:
  LogisticCost(const Rows& rows, const RegressionOptions& options) : rows_(rows), options_(options) {
    set_num_residuals(static_cast<int>(rows.y.size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(rows.x.cols()) + 1);
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Index columns = rows_.x.cols();
    const Eigen::Map<const Eigen::VectorXd> b(parameters[0] + 1, columns);
    const double range = 1 - options_.guess - options_.lapse;
    for (Eigen::Index i = 0; i < rows_.y.size(); ++i) {
      const double f = 1 / (1 + std::exp(-(parameters[0][0] + rows_.x.row(i).dot(b))));
      const study_detail::DevianceRoot root = study_detail::deviance_root(rows_.y[i], 1, options_.guess + range * f);
      if (!std::isfinite(root.value) || !std::isfinite(root.by_probability)) return false;
      residuals[i] = root.value;
      if (jacobians == nullptr || jacobians[0] == nullptr) continue;
      const double by_log_odds = root.by_probability * range * f * (1 - f);
      double* row = jacobians[0] + i * (columns + 1);
      row[0] = by_log_odds;
      for (Eigen::Index k = 0; k < columns; ++k) row[1 + k] = by_log_odds * rows_.x(i, k);
    }
    return true;
  }

 private:
  const Rows& rows_;
  const RegressionOptions& options_;
};

struct LogisticFit {
  Eigen::VectorXd parameters;  ///< The intercept first.
  double deviance = 0;
};

LogisticFit most_likely(const Rows& rows, const RegressionOptions& options, const Eigen::VectorXd& start) {
  LogisticFit fit{start, 0};
  ceres::Problem problem;
  problem.AddParameterBlock(fit.parameters.data(), static_cast<int>(start.size()));
  problem.AddResidualBlock(new LogisticCost(rows, options), nullptr, fit.parameters.data());
  for (int k = 0; k < start.size(); ++k) {
    problem.SetParameterLowerBound(fit.parameters.data(), k, -k_most_log_odds);
    problem.SetParameterUpperBound(fit.parameters.data(), k, k_most_log_odds);
  }
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.logging_type = ceres::SILENT;
  solver.num_threads = 1;
  solver.max_num_iterations = 100;
  solver.function_tolerance = 1e-10;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  fit.deviance = 2 * summary.final_cost;
  if (!std::isfinite(fit.deviance)) throw SolverFailure("logistic_regression: the deviance is not finite");
  return fit;
}

/// Expected information of intercept and coefficients.
Eigen::MatrixXd information(const Rows& rows, const RegressionOptions& options, const Eigen::VectorXd& parameters) {
  const double range = 1 - options.guess - options.lapse;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(parameters.size(), parameters.size());
  for (Eigen::Index i = 0; i < rows.y.size(); ++i) {
    Eigen::VectorXd row(parameters.size());
    row << 1, rows.x.row(i).transpose();
    const double f = 1 / (1 + std::exp(-row.dot(parameters))), p = options.guess + range * f;
    const double slope = range * f * (1 - f);
    if (p > 0 && p < 1) sum += slope * slope / (p * (1 - p)) * row * row.transpose();
  }
  return sum;
}

}  // namespace

Regression linear_regression(const RegressionData& data, const RegressionOptions& options) {
  constexpr const char* k_name = "linear_regression";
  const Rows rows = checked(data, k_name), centred = within_clusters(rows);
  if (const auto k = collinear_column(centred.x, rows.x.colwise().norm()))
    throw InvalidInput(fmt::format("{}: column {} does not vary by itself", k_name, *k));
  const std::vector<std::size_t> clusters = names_of(rows.clusters);
  const Eigen::VectorXd b = least_squares(centred);
  const double degrees = static_cast<double>(rows.y.size() - b.size()) - static_cast<double>(clusters.size());
  Regression result;
  result.rows = data.answers.size();
  result.clusters = clusters.size();
  const double squares = (centred.y - centred.x * b).squaredNorm();
  result.residual = degrees > 0 ? std::sqrt(squares / degrees) : 0;
  result.is_determined.assign(data.columns, true);
  if (clusters.size() > 1) {
    result.coefficients =
        jackknifed(rows, b, clusters, options.confidence, [](const Rows& left) -> std::optional<Eigen::VectorXd> {
          const Rows less = within_clusters(left);
          if (collinear_column(less.x, left.x.colwise().norm())) return std::nullopt;
          return least_squares(less);
        });
  } else if (degrees >= 1) {
    const Eigen::MatrixXd covariance = squares / degrees * (centred.x.transpose() * centred.x).inverse();
    result.coefficients =
        with_reach(b, student_t_quantile(0.5 + options.confidence / 2, degrees) * covariance.diagonal().cwiseSqrt());
  } else {
    for (const double value : b) result.coefficients.push_back({value, {}, {}});
  }
  return result;
}

Regression logistic_regression(const RegressionData& data, const RegressionOptions& options) {
  constexpr const char* k_name = "logistic_regression";
  const Rows rows = checked(data, k_name);
  for (const double answer : data.answers)
    if (answer != 0 && answer != 1)
      throw InvalidInput(fmt::format("{}: the answer {} is neither 0 nor 1", k_name, answer));
  if (!(options.guess >= 0 && options.lapse >= 0 && options.guess + options.lapse < 1))
    throw InvalidInput(
        fmt::format("{}: guess {} and lapse {} leave nothing between", k_name, options.guess, options.lapse));
  Eigen::MatrixXd with_intercept(rows.x.rows(), rows.x.cols() + 1);
  with_intercept << Eigen::VectorXd::Ones(rows.x.rows()), rows.x;
  if (const auto k = collinear_column(with_intercept, with_intercept.colwise().norm()))
    throw InvalidInput(fmt::format("{}: column {} does not vary by itself", k_name, *k - 1));

  const std::vector<std::size_t> clusters = names_of(rows.clusters);
  const LogisticFit fit = most_likely(rows, options, Eigen::VectorXd::Zero(rows.x.cols() + 1));
  const Eigen::VectorXd b = fit.parameters.tail(rows.x.cols());
  Regression result;
  result.rows = data.answers.size();
  result.clusters = clusters.size();
  result.residual = fit.deviance;
  if (clusters.size() > 1) {
    result.coefficients =
        jackknifed(rows, b, clusters, options.confidence, [&](const Rows& left) -> std::optional<Eigen::VectorXd> {
          return most_likely(left, options, fit.parameters).parameters.tail(rows.x.cols());
        });
  } else {
    const double z = boost::math::quantile(boost::math::normal(), 0.5 + options.confidence / 2);
    const Eigen::MatrixXd covariance =
        information(rows, options, fit.parameters).completeOrthogonalDecomposition().pseudoInverse();
    result.coefficients = with_reach(b, z * covariance.diagonal().tail(b.size()).cwiseMax(0).cwiseSqrt());
  }
  // Half of the bound: the likelihood is flat long before it.
  const bool is_runaway = fit.parameters.cwiseAbs().maxCoeff() > k_most_log_odds / 2;
  for (std::size_t k = 0; k < data.columns; ++k) {
    const bool determined = !(is_runaway && std::abs(result.coefficients[k].value) > k_most_log_odds / 4);
    result.is_determined.push_back(determined);
    if (!determined) result.coefficients[k].low = result.coefficients[k].high = std::nullopt;
  }
  return result;
}

}  // namespace papilla
