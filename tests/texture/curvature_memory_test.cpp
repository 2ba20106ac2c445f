// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature_memory.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <vector>

namespace papilla::texture_detail {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

std::vector<double> to_field(const Vector& v) { return {v.data(), v.data() + v.size()}; }

/// Random steps on a random quadratic energy, with a preconditioner that is not its inverse.
struct Problem {
  explicit Problem(int size, unsigned seed) : random(seed) {
    const Matrix a = Matrix::NullaryExpr(size, size, [this] { return value(random); });
    hessian = a * a.transpose() + Matrix::Identity(size, size);
    inverse = (hessian.diagonal().cwiseInverse()).asDiagonal();
  }
  Vector random_vector() {
    return Vector::NullaryExpr(hessian.rows(), [this] { return value(random); });
  }

  std::mt19937 random;
  std::uniform_real_distribution<double> value{-1, 1};
  Matrix hessian, inverse;
};

/// The update of the inverse by one pair [Nocedal and Wright, 6.17].
Matrix updated(const Matrix& h, const Vector& s, const Vector& y) {
  const double rho = 1 / s.dot(y);
  const Matrix left = Matrix::Identity(h.rows(), h.cols()) - rho * s * y.transpose();
  return left * h * left.transpose() + rho * s * s.transpose();
}

TEST(CurvatureMemory, DirectionIsThatOfTheUpdatesOfTheLastFourPairs) {
  Problem problem(40, 3);
  CurvatureMemory memory;
  Vector gradient = problem.random_vector();
  std::vector<std::pair<Vector, Vector>> pairs;
  for (int step = 0; step < 9; ++step) {
    const Vector direction = problem.random_vector();
    const Vector next = gradient + 0.5 * problem.hessian * direction;
    const auto before = to_field(gradient), h_before = to_field(problem.inverse * gradient), now = to_field(next),
               h_now = to_field(problem.inverse * next);
    memory.add(0.5, to_field(direction), {before, h_before}, {now, h_now});
    pairs.emplace_back(0.5 * direction, next - gradient);
    if (pairs.size() > 4) pairs.erase(pairs.begin());
    gradient = next;

    Matrix h = problem.inverse;
    for (const auto& [s, y] : pairs) h = updated(h, s, y);
    const Vector expected = -h * gradient;
    std::vector<double> result(now.size());
    const double slope = memory.direction({now, h_now}, result);
    const Vector got = Eigen::Map<const Vector>(result.data(), expected.size());
    // The pairs are held in single precision.
    EXPECT_LT((got - expected).norm(), 1e-5 * expected.norm()) << step;
    EXPECT_NEAR(slope, got.dot(gradient), 1e-12 * std::abs(slope)) << step;
    EXPECT_LT(slope, 0) << step;
  }
}

TEST(CurvatureMemory, PairWithoutCurvatureIsNotKept) {
  const std::vector<double> gradient{1, 2, 3}, changed{0, 2, 3}, direction{1, 0, 0};
  CurvatureMemory memory;
  memory.add(1, direction, {gradient, gradient}, {changed, changed});
  std::vector<double> result(3);
  memory.direction({changed, changed}, result);
  EXPECT_EQ(result, (std::vector<double>{0, -2, -3}));
}

}  // namespace
}  // namespace papilla::texture_detail
