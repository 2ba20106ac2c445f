// SPDX-License-Identifier: MIT
#include "chart_field.hpp"

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace papilla::detail {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// Nodes of the system: pieces with more interior vertices are clustered.
constexpr std::size_t k_max_nodes = 4000;
/// Cotangents beyond this belong to needles; their edges conduct as if welded.
constexpr double k_max_cotangent = 1e4;
/// Edges whose cotangents cancel still conduct a little, so that the system stays definite.
constexpr double k_min_weight = 1e-3;

/// The angle at a between b and c; the angles of any triangle sum to π, also of one without area.
double angle_at(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 p = b - a, q = c - a;
  return std::atan2(norm(cross(p, q)), dot(p, q));
}

std::array<double, 3> triangle_angles(const Piece& piece, Index t) {
  const Triangle& v = piece.triangles[t];
  const Vec3 &a = piece.positions[v[0]], &b = piece.positions[v[1]], &c = piece.positions[v[2]];
  if (a == b) return {std::numbers::pi / 2, std::numbers::pi / 2, 0};
  if (b == c) return {0, std::numbers::pi / 2, std::numbers::pi / 2};
  if (c == a) return {std::numbers::pi / 2, 0, std::numbers::pi / 2};
  const double alpha = angle_at(a, b, c), beta = angle_at(b, c, a);
  return {alpha, beta, std::max(0.0, std::numbers::pi - alpha - beta)};
}

double cotangent(double angle) {
  return std::clamp(1 / std::tan(std::max(angle, 0.1 / k_max_cotangent)), -k_max_cotangent, k_max_cotangent);
}

}  // namespace

namespace {

std::vector<std::array<double, 3>> all_angles(const Piece& piece) {
  std::vector<std::array<double, 3>> angles;
  angles.reserve(piece.size());
  for (Index t = 0; t < piece.size(); ++t) angles.push_back(triangle_angles(piece, t));
  return angles;
}

std::vector<double> defects_from(const Piece& piece, const std::vector<std::array<double, 3>>& angles) {
  std::vector<double> defect(piece.vertex_count());
  for (Index v = 0; v < defect.size(); ++v) defect[v] = piece.on_border(v) ? std::numbers::pi : 2 * std::numbers::pi;
  for (Index t = 0; t < piece.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) defect[piece.triangles[t][k]] -= angles[t][k];
  return defect;
}

}  // namespace

std::vector<double> angle_defects(const Piece& piece) { return defects_from(piece, all_angles(piece)); }

/// Rows of nodes that a cut takes out have nothing but a one on the diagonal.
struct ChartField::System {
  Matrix matrix;                  ///< Its upper half, which the factorization reads as it is.
  std::vector<double*> values;    ///< Where the links have their entries; none for the border.
  std::vector<double*> diagonal;  ///< Per row.
  Eigen::SimplicialLDLT<Matrix, Eigen::Upper, Eigen::NaturalOrdering<int>> factor;
};

ChartField::ChartField(const Piece& piece) {
  cluster(piece);
  const std::vector<std::array<double, 3>> angles = all_angles(piece);
  connect(piece, angles);
  defect_ = defects_from(piece, angles);
  charge_.assign(centre_.size(), 0);
  area_.assign(centre_.size(), 0);
  for (Index v = 0; v < node_.size(); ++v)
    if (node_[v] != k_none) charge_[node_[v]] += defect_[v];
  for (Index t = 0; t < piece.size(); ++t) {
    const double third = piece.area(t) / 3;
    for (const Index v : piece.triangles[t]) (node_[v] == k_none ? border_area_ : area_[node_[v]]) += third;
  }
  order();
  make_system();
  solve({});
}

ChartField::~ChartField() = default;

/// Grows clusters of equally many vertices over the edges, in the order of vertices.
void ChartField::cluster(const Piece& piece) {
  constexpr Index k_open = k_none - 1;
  std::size_t interior = 0;
  node_.assign(piece.vertex_count(), k_none);
  for (Index v = 0; v < node_.size(); ++v)
    if (!piece.on_border(v)) node_[v] = k_open, ++interior;
  const std::size_t size = interior / k_max_nodes + 1;
  std::vector<Index> queue;
  for (Index seed = 0; seed < node_.size(); ++seed) {
    if (node_[seed] != k_open) continue;
    const auto number = static_cast<Index>(centre_.size());
    centre_.push_back(seed);
    queue.assign(1, seed);
    node_[seed] = number;
    for (std::size_t i = 0; i < queue.size() && queue.size() < size; ++i)
      piece.visit_edges(queue[i], [&](Index, Index w) {
        if (node_[w] != k_open || queue.size() >= size) return;
        node_[w] = number;
        queue.push_back(w);
      });
  }
}

/// Conductances by finite volumes: the length of the dual edges between two nodes over the distance of their centres.
void ChartField::connect(const Piece& piece, const std::vector<std::array<double, 3>>& angles) {
  std::vector<Vec3> middle(centre_.size());
  std::vector<double> members(centre_.size(), 0);
  for (Index v = 0; v < node_.size(); ++v)
    if (node_[v] != k_none) {
      middle[node_[v]] = middle[node_[v]] + piece.positions[v];
      members[node_[v]] += 1;
    }
  for (Index n = 0; n < middle.size(); ++n) middle[n] = (1 / members[n]) * middle[n];

  std::vector<double> cotangents(piece.opposite.size());
  for (Index t = 0; t < piece.size(); ++t)
    for (Index k = 0; k < 3; ++k) cotangents[3 * t + k] = cotangent(angles[t][(k + 2) % 3]);
  for (Index h = 0; h < piece.opposite.size(); ++h) {
    const Index other = piece.opposite[h];
    if (other == k_none || other < h) continue;
    Index v = piece.from(h), w = piece.to(h);
    if (node_[v] == k_none) std::swap(v, w);
    if (node_[v] == k_none || node_[v] == node_[w]) continue;
    const double weight = std::max(0.5 * (cotangents[h] + cotangents[other]), k_min_weight);
    const Vec3 end = node_[w] == k_none ? piece.positions[w] : middle[node_[w]];
    const double distance = norm(end - middle[node_[v]]), length = piece.length(h);
    links_.push_back({node_[v], node_[w], w, distance > length ? weight * length / distance : weight});
  }
}

/// Nodes in an order that leaves little fill-in, whichever of them a cut takes out.
void ChartField::order() {
  std::vector<Eigen::Triplet<double>> entries;
  for (const Link& link : links_)
    if (link.b != k_none)
      entries.emplace_back(static_cast<int>(std::max(link.a, link.b)), static_cast<int>(std::min(link.a, link.b)), 1);
  const auto size = static_cast<int>(centre_.size());
  for (int n = 0; n < size; ++n) entries.emplace_back(n, n, 1);
  Matrix pattern(size, size);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::AMDOrdering<int>::PermutationType permutation;
  Eigen::AMDOrdering<int>()(pattern.selfadjointView<Eigen::Lower>(), permutation);
  row_.resize(centre_.size());
  for (int r = 0; r < size; ++r) row_[static_cast<std::size_t>(permutation.indices()[r])] = r;
}

void ChartField::make_system() {
  const auto size = static_cast<int>(centre_.size());
  const auto rows_of = [&](const Link& link) { return std::minmax(row_[link.a], row_[link.b]); };
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(links_.size() + centre_.size());
  for (const Link& link : links_)
    if (link.b != k_none) entries.emplace_back(rows_of(link).first, rows_of(link).second, 0);
  for (int r = 0; r < size; ++r) entries.emplace_back(r, r, 0);
  system_ = std::make_unique<System>();
  system_->matrix.resize(size, size);
  system_->matrix.setFromTriplets(entries.begin(), entries.end());
  for (const Link& link : links_)
    system_->values.push_back(link.b == k_none ? nullptr
                                               : &system_->matrix.coeffRef(rows_of(link).first, rows_of(link).second));
  for (int r = 0; r < size; ++r) system_->diagonal.push_back(&system_->matrix.coeffRef(r, r));
  system_->factor.analyzePattern(system_->matrix);
}

void ChartField::solve(const std::vector<std::uint8_t>& cut_vertex) {
  std::vector<std::uint8_t> fixed(centre_.size(), 0);
  for (Index v = 0; v < cut_vertex.size(); ++v)
    if (cut_vertex[v] && node_[v] != k_none) fixed[node_[v]] = 1;
  const auto free = static_cast<std::size_t>(std::find(fixed.begin(), fixed.end(), 0) - fixed.begin());
  solution_.u.assign(centre_.size(), 0);
  if (free == fixed.size()) return sum_up();

  Matrix& matrix = system_->matrix;
  std::fill_n(matrix.valuePtr(), matrix.nonZeros(), 0.0);
  const auto diagonal = [&](Index n) -> double& { return *system_->diagonal[static_cast<std::size_t>(row_[n])]; };
  bool grounded = false;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const Link& link = links_[i];
    const bool a = !fixed[link.a], b = link.b != k_none && !fixed[link.b];
    if (a) diagonal(link.a) += link.weight;
    if (b) diagonal(link.b) += link.weight;
    if (a && b) *system_->values[i] -= link.weight;
    grounded = grounded || a != b;
  }
  Eigen::VectorXd right = Eigen::VectorXd::Zero(matrix.rows());
  const double total_charge = std::accumulate(charge_.begin(), charge_.end(), 0.0);
  const double total_area = std::accumulate(area_.begin(), area_.end(), border_area_);
  for (Index n = 0; n < fixed.size(); ++n) {
    if (fixed[n]) {
      diagonal(n) = 1;
      continue;
    }
    right[row_[n]] = charge_[n] - (grounded || !(total_area > 0) ? 0 : total_charge * area_[n] / total_area);
    // Nothing holds a closed surface: the scale of its first node is zero.
    diagonal(n) += n == free && !grounded ? 1.0 : 1e-12;
  }
  system_->factor.factorize(matrix);
  const Eigen::VectorXd found = system_->factor.solve(right);
  for (Index n = 0; n < fixed.size(); ++n)
    if (!fixed[n] && std::isfinite(found[row_[n]])) solution_.u[n] = found[row_[n]];
  sum_up();
}

void ChartField::sum_up() {
  auto& [u, mean, distortion, squared_scale] = solution_;
  double total = border_area_;
  mean = distortion = squared_scale = 0;
  for (std::size_t n = 0; n < u.size(); ++n) {
    total += area_[n];
    mean += area_[n] * u[n];
  }
  if (!(total > 0)) return;
  mean /= total;
  const auto excess = [](double scale) {
    const double s = std::sinh(std::clamp(scale, -20.0, 20.0));
    return 8 * s * s;
  };
  distortion = border_area_ * excess(mean);
  for (std::size_t n = 0; n < u.size(); ++n) {
    distortion += area_[n] * excess(u[n] - mean);
    squared_scale += area_[n] * excess(u[n]);
  }
  distortion /= total;
  squared_scale /= total;
}

ChartField::Extremes ChartField::extremes() const {
  Extremes result;
  const std::vector<double>& u = solution_.u;
  if (u.empty()) return result;
  const auto [low, high] = std::minmax_element(u.begin(), u.end());
  if (*high > 0) result.largest = centre_[static_cast<std::size_t>(high - u.begin())];
  if (*low < 0) result.smallest = centre_[static_cast<std::size_t>(low - u.begin())];
  return result;
}

std::vector<Vec2> ChartField::lay_out(const Piece& piece, const std::vector<Index>& outer) const {
  std::vector<double> turning = defect_;
  for (const Link& link : links_)
    if (link.b == k_none) turning[link.border_vertex] += link.weight * solution_.u[link.a];
  double sum = 0, perimeter = 0;
  for (const Index h : outer) {
    sum += turning[piece.from(h)];
    perimeter += piece.length(h);
  }
  // Other loops may have taken some of the turn.
  const double correction = (2 * std::numbers::pi - sum) / std::max(perimeter, 1e-300);
  std::vector<Vec2> polygon;
  polygon.reserve(outer.size());
  Vec2 at;
  double direction = 0;
  for (const Index h : outer) {
    const double length = piece.length(h);
    direction += turning[piece.from(h)] + correction * length;
    polygon.push_back(at);
    at = at + length * Vec2{std::cos(direction), std::sin(direction)};
  }
  const Vec2 gap = at;
  double walked = 0;
  for (std::size_t i = 0; i < outer.size(); ++i) {
    polygon[i] = polygon[i] - (perimeter > 0 ? walked / perimeter : 0) * gap;
    walked += piece.length(outer[i]);
  }
  return polygon;
}

ChartOutline make_outline(const Piece& piece, const ChartField& field) {
  ChartOutline outline;
  outline.triangles = piece.triangle_of;
  const std::vector<Index> outer = border_loops(piece).front();
  outline.place = field.lay_out(piece, outer);
  for (const Index h : outer) {
    outline.border.push_back(piece.halfedge_of(h));
    outline.turning.push_back(field.defect(piece.from(h)));
  }
  for (Index t = 0; t < piece.size(); ++t) outline.area += piece.area(t);
  outline.distortion = field.distortion();
  return outline;
}

}  // namespace papilla::detail
