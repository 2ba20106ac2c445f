// SPDX-License-Identifier: MIT
#include "papilla/texture/lattice_deformation.hpp"

#include <ceres/cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "bicubic.hpp"
#include "checks.hpp"
#include "even_contrast.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using namespace texture_detail;
using Vectors = std::array<Vec2, 2>;

/// Weights of the uniform cubic B-splines at −1, 0, 1, 2 for a position `u` in [0, 1].
std::array<double, 4> spline_weights(double u) {
  const double r = 1 - u;
  return {r * r * r / 6, (4 - 6 * u * u + 3 * u * u * u) / 6, (4 - 6 * r * r + 3 * r * r * r) / 6, u * u * u / 6};
}

/// The 4 × 4 control points that matter at a place, and their weights.
struct Support {
  int column = 0, row = 0;
  std::array<double, 4> across{}, down{};

  Support(const Displacement& d, Vec2 p) {
    const auto place = [](double x, int count, int& first) {
      // Control point 0 lies one interval before the picture's origin.
      const double t = std::clamp(x + 1, 1.0, count - 2.0);
      first = std::clamp(static_cast<int>(std::floor(t)) - 1, 0, count - 4);
      return spline_weights(t - first - 1);
    };
    across = place(p.x / d.spacing_px, d.columns, column);
    down = place(p.y / d.spacing_px, d.rows, row);
  }
};

Vec2 control_place(const Displacement& d, int i, int j) { return {(i - 1) * d.spacing_px, (j - 1) * d.spacing_px}; }

Displacement no_displacement(const GreyImage& image, double cell_px, const DeformationOptions& options) {
  Displacement d;
  const int longest = std::max(image.width, image.height);
  d.spacing_px = std::max(cell_px, static_cast<double>(longest) / options.most_intervals);
  d.columns = static_cast<int>(std::ceil((image.width - 1) / d.spacing_px)) + 3;
  d.rows = static_cast<int>(std::ceil((image.height - 1) / d.spacing_px)) + 3;
  d.columns = std::max(4, d.columns);
  d.rows = std::max(4, d.rows);
  d.control_px.assign(static_cast<std::size_t>(d.columns) * static_cast<std::size_t>(d.rows), Vec2{});
  return d;
}

/// The mean cell as tables of value and gradient [per pixel], twice as fine as the pixels.
class MeanCell {
 public:
  MeanCell(const Vectors& vectors)
      : columns_(bins(norm(vectors[0]))),
        rows_(bins(norm(vectors[1]))),
        sums_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0.0),
        weights_(sums_.size(), 0.0) {
    const double area = cross(vectors[0], vectors[1]);
    du_ = {vectors[1].y / area, -vectors[1].x / area};
    dv_ = {-vectors[0].y / area, vectors[0].x / area};
  }

  Vec2 lattice_place(Vec2 p) const { return {dot(du_, p), dot(dv_, p)}; }

  void add(Vec2 place, double value) {
    const Position at(place, columns_, rows_);
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i) {
        const double weight = (i != 0 ? at.u : 1 - at.u) * (j != 0 ? at.v : 1 - at.v);
        const std::size_t index = pixel_index((at.column + i) % columns_, (at.row + j) % rows_, columns_);
        sums_[index] += weight * value;
        weights_[index] += weight;
      }
  }

  void finish() {
    for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] = weights_[i] > 0 ? sums_[i] / weights_[i] : 0;
    fine_columns_ = 2 * columns_;
    fine_rows_ = 2 * rows_;
    const auto coarse = [&](int x, int y) {
      return sums_[pixel_index(wrapped(x, columns_), wrapped(y, rows_), columns_)];
    };
    std::vector<double> fine;
    for (int y = 0; y < fine_rows_; ++y)
      for (int x = 0; x < fine_columns_; ++x) fine.push_back(bicubic(x / 2.0, y / 2.0, coarse));
    table_.clear();
    const auto value = [&](int x, int y) {
      return fine[pixel_index(wrapped(x, fine_columns_), wrapped(y, fine_rows_), fine_columns_)];
    };
    for (int y = 0; y < fine_rows_; ++y)
      for (int x = 0; x < fine_columns_; ++x) {
        const double along_u = (value(x + 1, y) - value(x - 1, y)) * fine_columns_ / 2;
        const double along_v = (value(x, y + 1) - value(x, y - 1)) * fine_rows_ / 2;
        table_.push_back({value(x, y), along_u * du_.x + along_v * dv_.x, along_u * du_.y + along_v * dv_.y});
      }
  }

  /// Value and gradient.
  std::array<double, 3> at(Vec2 place) const {
    const Position p(place, fine_columns_, fine_rows_);
    const int right = (p.column + 1) % fine_columns_, below = (p.row + 1) % fine_rows_;
    const auto& a = table_[pixel_index(p.column, p.row, fine_columns_)];
    const auto& b = table_[pixel_index(right, p.row, fine_columns_)];
    const auto& c = table_[pixel_index(p.column, below, fine_columns_)];
    const auto& d = table_[pixel_index(right, below, fine_columns_)];
    std::array<double, 3> result{};
    for (std::size_t k = 0; k < 3; ++k)
      result[k] = (1 - p.v) * ((1 - p.u) * a[k] + p.u * b[k]) + p.v * ((1 - p.u) * c[k] + p.u * d[k]);
    return result;
  }

  int samples() const { return columns_ * rows_; }

 private:
  struct Position {
    int column, row;
    double u, v;
    Position(Vec2 place, int columns, int rows) {
      const double x = (place.x - std::floor(place.x)) * columns, y = (place.y - std::floor(place.y)) * rows;
      column = std::min(columns - 1, static_cast<int>(x));
      row = std::min(rows - 1, static_cast<int>(y));
      u = x - column;
      v = y - row;
    }
  };
  static int bins(double length) { return std::max(6, static_cast<int>(std::lround(length))); }

  int columns_, rows_, fine_columns_ = 0, fine_rows_ = 0;
  Vec2 du_, dv_;
  std::vector<double> sums_, weights_;
  std::vector<std::array<double, 3>> table_;
};

/// Sums over the pixels of a block: of the products of the gradient of P, of the gradient times the rest, of the rest's
/// and the picture's squares.
struct BlockSums {
  double xx = 0, xy = 0, yy = 0, rx = 0, ry = 0, rest = 0, square = 0, pixels = 0;
  void add(const BlockSums& other, double weight) {
    xx += weight * other.xx;
    xy += weight * other.xy;
    yy += weight * other.yy;
    rx += weight * other.rx;
    ry += weight * other.ry;
    rest += weight * other.rest;
    square += weight * other.square;
    pixels += weight * other.pixels;
  }
};

/// Where a window of the picture fits the mean cell best, and how surely: u = place with the information matrix LLᵀ.
struct Match {
  Vec2 centre, place;
  Eigen::Matrix2d information;
};

/// |Lᵀ (u(x) − place)| of one match. Linear in the control points.
class MatchCost : public ceres::CostFunction {
 public:
  MatchCost(const Support& support, const Match& match, double scale) : place_(match.place.x, match.place.y) {
    set_num_residuals(2);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> parts(match.information);
    root_ =
        std::sqrt(scale) * parts.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() * parts.eigenvectors().transpose();
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t i = 0; i < 4; ++i) {
        weights_[4 * j + i] = support.across[i] * support.down[j];
        mutable_parameter_block_sizes()->push_back(2);
      }
  }
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    Eigen::Vector2d u(0, 0);
    for (std::size_t k = 0; k < 16; ++k) u += weights_[k] * Eigen::Vector2d(parameters[k][0], parameters[k][1]);
    Eigen::Map<Eigen::Vector2d>{residuals} = root_ * (u - place_);
    if (jacobians == nullptr) return true;
    for (std::size_t k = 0; k < 16; ++k)
      if (jacobians[k] != nullptr)
        Eigen::Map<Eigen::Matrix<double, 2, 2, Eigen::RowMajor>>{jacobians[k]} = weights_[k] * root_;
    return true;
  }

 private:
  std::array<double, 16> weights_{};
  Eigen::Matrix2d root_;
  Eigen::Vector2d place_;
};

/// weight · Σ f_k c_k for a row of control points: a second difference.
class BendCost : public ceres::CostFunction {
 public:
  BendCost(std::vector<double> factors) : factors_(std::move(factors)) {
    set_num_residuals(2);
    for (std::size_t k = 0; k < factors_.size(); ++k) mutable_parameter_block_sizes()->push_back(2);
  }
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    residuals[0] = residuals[1] = 0;
    for (std::size_t k = 0; k < factors_.size(); ++k) {
      residuals[0] += factors_[k] * parameters[k][0];
      residuals[1] += factors_[k] * parameters[k][1];
      if (jacobians != nullptr && jacobians[k] != nullptr) {
        jacobians[k][0] = jacobians[k][3] = factors_[k];
        jacobians[k][1] = jacobians[k][2] = 0;
      }
    }
    return true;
  }

 private:
  std::vector<double> factors_;
};

class DeformationFit {
 public:
  DeformationFit(const GreyImage& image, const Vectors& vectors, const DeformationOptions& options)
      : width_(image.width),
        height_(image.height),
        vectors_(vectors),
        cell_px_(std::sqrt(std::abs(cross(vectors[0], vectors[1])))),
        bend_(options.bend),
        displacement_(no_displacement(image, cell_px_, options)),
        field_(locally_normalized(image, k_light_cells * std::max(norm(vectors[0]), norm(vectors[1])))) {
    block_px_ = std::max(2, static_cast<int>(std::lround(displacement_.spacing_px / 2)));
    columns_ = (width_ + block_px_ - 1) / block_px_;
    rows_ = (height_ + block_px_ - 1) / block_px_;
    find_seed();
  }

  LatticeDeformation run() {
    const Stopwatch clock;
    LatticeDeformation result;
    radius_ = 1e9;
    average();
    result.explained_before = result.explained_after = explained(measure());
    if (result.explained_before > k_exact) {
      result.vectors_px = vectors_;
      result.displacement = displacement_;
      result.trace.push_back({clock.seconds(), 1 - result.explained_before});
      return result;
    }
    const double whole = std::hypot(width_, height_);
    constexpr double k_growth = 1.3, k_first_cells = 2.2;
    constexpr int k_last_rounds = 4;
    int last = 0;
    for (radius_ = k_first_cells * std::max(norm(vectors_[0]), norm(vectors_[1])); last < k_last_rounds;
         radius_ *= k_growth) {
      average();
      const std::vector<BlockSums> sums = measure();
      result.trace.push_back({clock.seconds(), 1 - explained(sums)});
      fit(sums);
      if (radius_ > whole) ++last;
    }
    radius_ = 1e9;
    average();
    const std::vector<BlockSums> sums = measure();
    result.explained_after = explained(sums);
    result.trace.push_back({clock.seconds(), 1 - result.explained_after});
    // Every control point has two parameters; the rest's neighbours are alike over about a window's pixels.
    const double samples = static_cast<double>(field_.size()) / correlated_pixels();
    const double parameters = 2.0 * static_cast<double>(displacement_.control_px.size());
    const double gain = (result.explained_after - result.explained_before) / std::max(1e-9, 1 - result.explained_after);
    result.significant = gain * samples > 2 * parameters;
    remove_affine_part(result);
    return result;
  }

 private:
  static constexpr double k_exact = 0.985;      // Interpolation leaves more of a cell than is left to follow.
  static constexpr double k_light_cells = 0.7;  // Longer waves than about two cells are light.

  double correlated_pixels() const { return std::max(2.0, cell_px_ * cell_px_ / 60); }

  Vec2 block_centre(int i, int j) const {
    const double left = i * block_px_, top = j * block_px_;
    return {(left + std::min<double>(left + block_px_, width_) - 1) / 2,
            (top + std::min<double>(top + block_px_, height_) - 1) / 2};
  }
  bool active(int i, int j) const { return norm(block_centre(i, j) - seed_) <= radius_; }

  /// The place whose surroundings agree best with those one lattice vector further, in the mean of four directions.
  void find_seed() {
    std::vector<double> scores(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0.0);
    std::vector<double> counts(scores.size(), 0.0);
    for (const Vec2 v : {vectors_[0], vectors_[1]}) {
      const int dx = static_cast<int>(std::lround(v.x)), dy = static_cast<int>(std::lround(v.y));
      for (int y = std::max(0, -dy); y < std::min(height_, height_ - dy); ++y)
        for (int x = std::max(0, -dx); x < std::min(width_, width_ - dx); ++x) {
          const double product = field_[pixel_index(x, y, width_)] * field_[pixel_index(x + dx, y + dy, width_)];
          for (const auto& [px, py] : {std::pair{x, y}, std::pair{x + dx, y + dy}}) {
            const std::size_t block = pixel_index(px / block_px_, py / block_px_, columns_);
            scores[block] += product;
            counts[block] += 1;
          }
        }
    }
    const int reach =
        std::max(1, static_cast<int>(std::lround(1.5 * std::max(norm(vectors_[0]), norm(vectors_[1])) / block_px_)));
    double best = -1e300;
    for (int j = 0; j < rows_; ++j)
      for (int i = 0; i < columns_; ++i) {
        double sum = 0, count = 0;
        for (int l = -reach; l <= reach; ++l)
          for (int k = -reach; k <= reach; ++k) {
            if (i + k < 0 || i + k >= columns_ || j + l < 0 || j + l >= rows_) continue;
            const std::size_t block = pixel_index(i + k, j + l, columns_);
            sum += scores[block];
            count += counts[block];
          }
        // Full windows only count fully: near the borders there is less to start from.
        const double mean = sum / std::max(count, 0.7 * 4 * block_px_ * block_px_ * (2 * reach + 1) * (2 * reach + 1));
        if (mean > best) {
          best = mean;
          seed_ = block_centre(i, j);
        }
      }
  }

  /// u over a block as a bilinear patch, handed to visit(x, y, u) pixel by pixel.
  template <class Visit>
  void over_block(int i, int j, const Visit& visit) const {
    const int left = i * block_px_, top = j * block_px_;
    const int right = std::min(width_, left + block_px_), bottom = std::min(height_, top + block_px_);
    const auto at = [&](int x, int y) { return displacement_.at({static_cast<double>(x), static_cast<double>(y)}); };
    const Vec2 a = at(left, top), b = at(left + block_px_, top), c = at(left, top + block_px_),
               d = at(left + block_px_, top + block_px_);
    for (int y = top; y < bottom; ++y) {
      const double v = static_cast<double>(y - top) / block_px_;
      const Vec2 from = (1 - v) * a + v * c, step = (1.0 / block_px_) * ((1 - v) * b + v * d - from);
      for (int x = left; x < right; ++x) visit(x, y, from + static_cast<double>(x - left) * step);
    }
  }

  /// The mean cell over the part reached.
  void average() {
    cell_ = MeanCell(vectors_);
    for (int j = 0; j < rows_; ++j)
      for (int i = 0; i < columns_; ++i) {
        if (!active(i, j)) continue;
        over_block(i, j, [&](int x, int y, Vec2 u) {
          cell_.add(cell_.lattice_place(Vec2{static_cast<double>(x), static_cast<double>(y)} + u),
                    field_[pixel_index(x, y, width_)]);
        });
      }
    cell_.finish();
  }

  /// Sums of the blocks within the part reached; empty ones elsewhere.
  std::vector<BlockSums> measure() const {
    std::vector<BlockSums> blocks(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    for (int j = 0; j < rows_; ++j)
      for (int i = 0; i < columns_; ++i) {
        if (!active(i, j)) continue;
        BlockSums& sums = blocks[pixel_index(i, j, columns_)];
        over_block(i, j, [&](int x, int y, Vec2 u) {
          const auto [value, gx, gy] =
              cell_.at(cell_.lattice_place(Vec2{static_cast<double>(x), static_cast<double>(y)} + u));
          const double grey = field_[pixel_index(x, y, width_)], rest = grey - value;
          sums.xx += gx * gx;
          sums.xy += gx * gy;
          sums.yy += gy * gy;
          sums.rx += gx * rest;
          sums.ry += gy * rest;
          sums.rest += rest * rest;
          sums.square += grey * grey;
          sums.pixels += 1;
        });
      }
    return blocks;
  }

  double explained(const std::vector<BlockSums>& blocks) const {
    BlockSums all;
    for (const BlockSums& block : blocks) all.add(block, 1);
    const double free = all.pixels - cell_.samples();
    if (!(all.square > 0) || free < 1) return 0;
    return 1 - all.rest / free * all.pixels / all.square;
  }

  std::vector<Match> matches(const std::vector<BlockSums>& blocks) const {
    constexpr double k_most_step = 0.2;  // Of the cell.
    std::vector<Match> found;
    for (int j = 0; j < rows_; ++j)
      for (int i = 0; i < columns_; ++i) {
        if (!active(i, j)) continue;
        BlockSums window;
        double total = 0;
        for (int l = std::max(0, j - 1); l <= std::min(rows_ - 1, j + 1); ++l)
          for (int k = std::max(0, i - 1); k <= std::min(columns_ - 1, i + 1); ++k) {
            const double weight = (k == i ? 2.0 : 1.0) * (l == j ? 2.0 : 1.0);
            window.add(blocks[pixel_index(k, l, columns_)], weight);
            total += weight;
          }
        Eigen::Matrix2d information;
        information << window.xx, window.xy, window.xy, window.yy;
        information /= total;
        const double trace = information.trace();
        if (!(trace > 0)) continue;
        const Eigen::Matrix2d safe = information + 0.02 * trace * Eigen::Matrix2d::Identity();
        Eigen::Vector2d step = safe.ldlt().solve(Eigen::Vector2d(window.rx, window.ry) / total);
        const double length = step.norm(), most = k_most_step * cell_px_;
        if (length > most) step *= most / length;
        const Vec2 centre = block_centre(i, j);
        found.push_back({centre, displacement_.at(centre) + Vec2{step.x(), step.y()}, information});
      }
    return found;
  }

  void fit(const std::vector<BlockSums>& blocks) {
    BlockSums all;
    for (const BlockSums& block : blocks) all.add(block, 1);
    const double variance = std::max(0.02, all.rest / std::max(1.0, all.pixels));
    const double scale = 1 / (variance * correlated_pixels());
    ceres::Problem::Options owned;
    ceres::Problem problem(owned);
    auto* const loss = new ceres::CauchyLoss(3.0);
    bool shared = false;
    Displacement next = displacement_;
    const auto control = [&](int i, int j) { return &next.control_px[pixel_index(i, j, next.columns)].x; };
    for (const Match& match : matches(blocks)) {
      const Support support(next, match.centre);
      std::vector<double*> parameters;
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) parameters.push_back(control(support.column + i, support.row + j));
      problem.AddResidualBlock(new MatchCost(support, match, scale), loss, parameters);
      shared = true;
    }
    if (!shared) {
      delete loss;
      return;
    }
    const double intervals = next.spacing_px / cell_px_;
    const double weight = 1 / (bend_ * cell_px_ * intervals);
    for (int j = 0; j < next.rows; ++j)
      for (int i = 0; i < next.columns; ++i) {
        if (i + 2 < next.columns)
          problem.AddResidualBlock(new BendCost({weight, -2 * weight, weight}), nullptr,
                                   std::vector<double*>{control(i, j), control(i + 1, j), control(i + 2, j)});
        if (j + 2 < next.rows)
          problem.AddResidualBlock(new BendCost({weight, -2 * weight, weight}), nullptr,
                                   std::vector<double*>{control(i, j), control(i, j + 1), control(i, j + 2)});
        if (i + 1 < next.columns && j + 1 < next.rows) {
          const double mixed = std::numbers::sqrt2 * weight;
          problem.AddResidualBlock(
              new BendCost({mixed, -mixed, -mixed, mixed}), nullptr,
              std::vector<double*>{control(i, j), control(i + 1, j), control(i, j + 1), control(i + 1, j + 1)});
        }
      }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    // CHOLMOD's four threads wait for each other by spinning, many times a factorization: on fewer processors for
    // minutes.
    options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
    options.max_num_iterations = 3;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    const bool usable =
        std::all_of(next.control_px.begin(), next.control_px.end(), [](Vec2 c) { return is_finite(c); });
    if (usable) displacement_ = std::move(next);
  }

  /// Moves the affine part of u into the vectors, and measures what is left.
  void remove_affine_part(LatticeDeformation& result) const {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Matrix<double, 3, 2> right = Eigen::Matrix<double, 3, 2>::Zero();
    for (int j = 0; j < rows_; ++j)
      for (int i = 0; i < columns_; ++i) {
        const Vec2 p = block_centre(i, j), u = displacement_.at(p);
        const Eigen::Vector3d terms(1, p.x, p.y);
        normal += terms * terms.transpose();
        right += terms * Eigen::RowVector2d(u.x, u.y);
      }
    const Eigen::Matrix<double, 3, 2> affine = normal.completeOrthogonalDecomposition().solve(right);
    const Eigen::Vector2d shift = affine.row(0).transpose();
    const Eigen::Matrix2d matrix = Eigen::Matrix2d::Identity() + affine.bottomRows<2>().transpose();
    const Eigen::Matrix2d inverse = matrix.inverse();
    result.displacement = displacement_;
    Displacement& d = result.displacement;
    for (int j = 0; j < d.rows; ++j)
      for (int i = 0; i < d.columns; ++i) {
        Vec2& c = d.control_px[pixel_index(i, j, d.columns)];
        const Vec2 p = control_place(d, i, j);
        const Eigen::Vector2d straight = inverse * (Eigen::Vector2d(p.x + c.x, p.y + c.y) - shift);
        c = {straight.x() - p.x, straight.y() - p.y};
      }
    for (std::size_t k = 0; k < 2; ++k) {
      const Eigen::Vector2d v = inverse * Eigen::Vector2d(vectors_[k].x, vectors_[k].y);
      result.vectors_px[k] = {v.x(), v.y()};
    }
    const double cell = std::sqrt(std::abs(cross(result.vectors_px[0], result.vectors_px[1])));
    double squares = 0, most = 0;
    for (int j = 0; j < rows_; ++j)
      for (int i = 0; i < columns_; ++i) {
        const double length = norm(d.at(block_centre(i, j)));
        squares += length * length;
        most = std::max(most, length);
      }
    result.rms_percent_of_cell = 100 * std::sqrt(squares / (static_cast<double>(columns_) * rows_)) / cell;
    result.max_percent_of_cell = 100 * most / cell;
  }

  int width_, height_;
  Vectors vectors_;
  double cell_px_, bend_;
  Displacement displacement_;
  std::vector<double> field_;
  int block_px_ = 1, columns_ = 0, rows_ = 0;
  Vec2 seed_;
  double radius_ = 0;
  MeanCell cell_{Vectors{Vec2{8, 0}, Vec2{0, 8}}};
};

void require(const GreyImage& image, const Vectors& vectors, const DeformationOptions& options) {
  require_image(image, "find_lattice_deformation", 8);
  const auto usable = [&](Vec2 v) {
    return is_finite(v) && norm(v) >= 2 && std::abs(v.x) <= image.width && std::abs(v.y) <= image.height;
  };
  const double area = std::abs(cross(vectors[0], vectors[1]));
  if (!usable(vectors[0]) || !usable(vectors[1]) || area < 0.01 * norm(vectors[0]) * norm(vectors[1]) || area < 4)
    throw InvalidInput("find_lattice_deformation: the vectors (" + std::to_string(vectors[0].x) + ", " +
                       std::to_string(vectors[0].y) + "), (" + std::to_string(vectors[1].x) + ", " +
                       std::to_string(vectors[1].y) + ") span no cell of the picture");
  if (!is_positive(options.bend) || options.most_intervals < 1)
    throw InvalidInput("find_lattice_deformation: bend " + std::to_string(options.bend) + " or most_intervals " +
                       std::to_string(options.most_intervals) + " is not above 0");
}

}  // namespace

Vec2 Displacement::at(Vec2 p) const {
  const Support support(*this, p);
  Vec2 sum{};
  for (int j = 0; j < 4; ++j) {
    Vec2 row{};
    for (int i = 0; i < 4; ++i)
      row = row + support.across[static_cast<std::size_t>(i)] *
                      control_px[pixel_index(support.column + i, support.row + j, columns)];
    sum = sum + support.down[static_cast<std::size_t>(j)] * row;
  }
  return sum;
}

LatticeDeformation find_lattice_deformation(const GreyImage& image, const std::array<Vec2, 2>& vectors_px,
                                            const DeformationOptions& options) {
  require(image, vectors_px, options);
  return DeformationFit(image, vectors_px, options).run();
}

Vec2 bent_place(const Displacement& displacement, Vec2 y) {
  constexpr int k_rounds = 12;
  constexpr double k_near_px = 1e-3;
  Vec2 x = y;
  for (int round = 0; round < k_rounds; ++round) {
    const Vec2 next = y - displacement.at(x);
    const bool near = norm(next - x) < k_near_px;
    x = next;
    if (near) break;
  }
  return x;
}

GreyImage straightened(const GreyImage& image, const Displacement& displacement) {
  require_image(image, "straightened");
  const auto clamped = [&](int x, int y) {
    return image.at(std::clamp(x, 0, image.width - 1), std::clamp(y, 0, image.height - 1));
  };
  GreyImage straight{image.width, image.height, {}, image.pitch_mm, 32};
  straight.pixels.reserve(image.pixels.size());
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Vec2 from = bent_place(displacement, {static_cast<double>(x), static_cast<double>(y)});
      straight.pixels.push_back(
          static_cast<float>(bicubic(std::clamp(from.x, -1.0, static_cast<double>(image.width)),
                                     std::clamp(from.y, -1.0, static_cast<double>(image.height)), clamped)));
    }
  return straight;
}

}  // namespace papilla
