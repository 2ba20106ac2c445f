// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

#include "papilla/core/vec.hpp"

namespace papilla::texture_detail {

/// Directions to the lights, one a row.
inline Eigen::MatrixXd matrix_of(const std::vector<Vec3>& lights) {
  Eigen::MatrixXd matrix(static_cast<Eigen::Index>(lights.size()), 3);
  for (std::size_t k = 0; k < lights.size(); ++k)
    matrix.row(static_cast<Eigen::Index>(k)) << lights[k].x, lights[k].y, lights[k].z;
  return matrix;
}

/// (AᵀA)⁻¹Aᵀ of a matrix of rank 3 with three columns.
inline Eigen::Matrix<double, 3, Eigen::Dynamic> pseudo_inverse(const Eigen::MatrixXd& matrix) {
  const Eigen::Matrix3d squares = matrix.transpose() * matrix;
  return squares.inverse() * matrix.transpose();
}

}  // namespace papilla::texture_detail
