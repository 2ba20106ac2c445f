// SPDX-License-Identifier: GPL-3.0-or-later
#include "papilla/texture/wallpaper_group.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "checks.hpp"
#include "fft.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/vec.hpp"

namespace papilla {
namespace {

using namespace texture_detail;

/// A whole-number matrix in lattice coordinates: (u, v) → (a u + b v, c u + d v).
struct LatticeMatrix {
  int a = 1, b = 0, c = 0, d = 1;
  friend bool operator==(const LatticeMatrix&, const LatticeMatrix&) = default;
  int determinant() const { return a * d - b * c; }
};

LatticeMatrix product(const LatticeMatrix& p, const LatticeMatrix& q) {
  return {p.a * q.a + p.b * q.c, p.a * q.b + p.b * q.d, p.c * q.a + p.d * q.c, p.c * q.b + p.d * q.d};
}

Vec2 apply(const LatticeMatrix& m, Vec2 x) { return {m.a * x.x + m.b * x.y, m.c * x.x + m.d * x.y}; }

/// x → M x + t/2 in lattice coordinates; t in half lattice vectors, 0 or 1.
struct PlaneOperation {
  LatticeMatrix matrix;
  int half_u = 0, half_v = 0;
};

/// A group without its translations, the identity first, and its name.
struct PlaneGroup {
  WallpaperGroup name = WallpaperGroup::p1;
  std::vector<PlaneOperation> operations;
};

using Matrices = std::vector<LatticeMatrix>;

constexpr LatticeMatrix k_identity{};

/// Matrices of determinant ±1 under which the lengths and the angle of the vectors change by at most `tolerance`. In a
/// reduced basis all of them have entries −1, 0, 1.
Matrices holohedry(const std::array<Vec2, 2>& vectors, double tolerance) {
  const double aa = dot(vectors[0], vectors[0]), bb = dot(vectors[1], vectors[1]), ab = dot(vectors[0], vectors[1]);
  const double scale = std::sqrt(aa * bb);
  Matrices found = {k_identity};
  for (int i = 0; i < 81; ++i) {
    const LatticeMatrix m{i % 3 - 1, i / 3 % 3 - 1, i / 9 % 3 - 1, i / 27 - 1};
    if (std::abs(m.determinant()) != 1 || m == k_identity) continue;
    const auto image_product = [&](int p, int q, int r, int s) {
      return p * r * aa + (p * s + q * r) * ab + q * s * bb;
    };
    const double image_aa = image_product(m.a, m.c, m.a, m.c), image_bb = image_product(m.b, m.d, m.b, m.d);
    const double image_ab = image_product(m.a, m.c, m.b, m.d);
    // Squares of lengths change by twice as much as lengths.
    if (std::abs(image_aa - aa) <= 2 * tolerance * aa && std::abs(image_bb - bb) <= 2 * tolerance * bb &&
        std::abs(image_ab - ab) <= 2 * tolerance * scale)
      found.push_back(m);
  }
  return found;
}

bool contains(const Matrices& group, const LatticeMatrix& m) {
  return std::find(group.begin(), group.end(), m) != group.end();
}

/// The group that two matrices generate; nothing when it is larger than a point group of the plane can be.
std::optional<Matrices> closure(const LatticeMatrix& p, const LatticeMatrix& q) {
  constexpr std::size_t k_most = 12;
  Matrices group = {k_identity};
  for (std::size_t i = 0; i < group.size(); ++i)
    for (const LatticeMatrix& generator : {p, q}) {
      const LatticeMatrix next = product(group[i], generator);
      if (contains(group, next)) continue;
      if (group.size() == k_most) return std::nullopt;
      group.push_back(next);
    }
  return group;
}

bool same_elements(const Matrices& p, const Matrices& q) {
  return p.size() == q.size() &&
         std::all_of(p.begin(), p.end(), [&](const LatticeMatrix& m) { return contains(q, m); });
}

/// All subgroups; those of point groups of the plane have at most two generators.
std::vector<Matrices> subgroups(const Matrices& elements) {
  std::vector<Matrices> groups;
  for (const LatticeMatrix& p : elements)
    for (const LatticeMatrix& q : elements) {
      const std::optional<Matrices> group = closure(p, q);
      const bool known = !group || std::any_of(groups.begin(), groups.end(),
                                               [&](const Matrices& other) { return same_elements(*group, other); });
      if (!known) groups.push_back(*group);
    }
  return groups;
}

bool is_even(int n) { return n % 2 == 0; }

/// A reflection that is diag(1, −1) in some basis, not an exchange of two basis vectors.
bool is_primitive(const LatticeMatrix& m) {
  return is_even(m.a - 1) && is_even(m.b) && is_even(m.c) && is_even(m.d - 1);
}

/// True when M x + t/2, M a reflection, keeps no line fixed: no lattice vector l makes (I + M)(t/2 + l) zero.
bool is_glide(const PlaneOperation& operation) {
  const LatticeMatrix& m = operation.matrix;
  const auto twice = [&](int u, int v) { return std::array{u + m.a * u + m.b * v, v + m.c * u + m.d * v}; };
  const std::array<int, 2> along = twice(operation.half_u, operation.half_v);
  for (int v = -2; v <= 2; ++v)
    for (int u = -2; u <= 2; ++u) {
      const std::array<int, 2> shift = twice(2 * u, 2 * v);
      if (along[0] + shift[0] == 0 && along[1] + shift[1] == 0) return false;
    }
  return true;
}

/// A reflection keeps a shortest lattice vector: mirrors along the translations, as in p31m.
bool keeps_a_shortest_vector(const LatticeMatrix& m, const std::array<Vec2, 2>& vectors) {
  const double shortest = norm(vectors[0] - vectors[1]) < norm(vectors[0] + vectors[1]) ? -1.0 : 1.0;
  for (const Vec2 v : {Vec2{1, 0}, Vec2{0, 1}, Vec2{1, shortest}})
    if (apply(m, v) == v) return true;
  return false;
}

WallpaperGroup name_of(const std::vector<PlaneOperation>& operations, const std::array<Vec2, 2>& vectors) {
  int rotations = 0, mirrors = 0, glides = 0;
  bool centred = true, keeps = false;
  for (const PlaneOperation& operation : operations) {
    if (operation.matrix.determinant() > 0) {
      ++rotations;
      continue;
    }
    ++(is_glide(operation) ? glides : mirrors);
    if (is_primitive(operation.matrix)) centred = false;
    keeps = keeps || keeps_a_shortest_vector(operation.matrix, vectors);
  }
  const bool reflects = mirrors + glides > 0;
  switch (rotations) {
    case 2:
      if (!reflects) return WallpaperGroup::p2;
      if (centred) return WallpaperGroup::cmm;
      return glides == 0 ? WallpaperGroup::pmm : mirrors > 0 ? WallpaperGroup::pmg : WallpaperGroup::pgg;
    case 3: return !reflects ? WallpaperGroup::p3 : keeps ? WallpaperGroup::p31m : WallpaperGroup::p3m1;
    case 4: return !reflects ? WallpaperGroup::p4 : glides == 0 ? WallpaperGroup::p4m : WallpaperGroup::p4g;
    case 6: return reflects ? WallpaperGroup::p6m : WallpaperGroup::p6;
    default:
      if (!reflects) return WallpaperGroup::p1;
      return centred ? WallpaperGroup::cm : glides == 0 ? WallpaperGroup::pm : WallpaperGroup::pg;
  }
}

/// The operations of a point group whose rotations turn about the origin and whose reflection m0 moves by t/2; nothing
/// when these do not generate a group with this lattice.
std::optional<std::vector<PlaneOperation>> operations_of(const Matrices& group, const LatticeMatrix& m0, int half_u,
                                                         int half_v) {
  const auto whole = [&](const LatticeMatrix& m, int sign) {  // (I ± M) t/2 is a lattice vector.
    return is_even(half_u + sign * (m.a * half_u + m.b * half_v)) &&
           is_even(half_v + sign * (m.c * half_u + m.d * half_v));
  };
  std::vector<PlaneOperation> operations;
  for (const LatticeMatrix& m : group) {
    if (m.determinant() < 0) continue;
    if (!whole(m, -1)) return std::nullopt;
    operations.push_back({m, 0, 0});
  }
  const std::size_t rotations = operations.size();
  if (!whole(m0, 1)) return std::nullopt;
  for (std::size_t i = 0; i < rotations; ++i) operations.push_back({product(m0, operations[i].matrix), half_u, half_v});
  return operations;
}

/// All wallpaper groups whose rotations and reflections keep the lattice of `vectors` up to `tolerance`, in every
/// orientation. The vectors must be Gauss-reduced.
std::vector<PlaneGroup> plane_groups(const std::array<Vec2, 2>& vectors, double tolerance) {
  std::vector<PlaneGroup> groups;
  for (const Matrices& group : subgroups(holohedry(vectors, tolerance))) {
    // A diagonal reflection first: only its glides distinguish p4g from p4m.
    std::optional<LatticeMatrix> reflection;
    for (const LatticeMatrix& m : group)
      if (m.determinant() < 0 && (!reflection || (is_primitive(m) && !is_primitive(*reflection)))) reflection = m;
    if (!reflection) {
      std::vector<PlaneOperation> operations;
      for (const LatticeMatrix& m : group) operations.push_back({m, 0, 0});
      groups.push_back({name_of(operations, vectors), std::move(operations)});
      continue;
    }
    for (int t = 0; t < 4; ++t)
      if (auto operations = operations_of(group, *reflection, t % 2, t / 2))
        groups.push_back({name_of(*operations, vectors), std::move(*operations)});
  }
  return groups;
}

/// Images of a point under all operations and the translations around; lattice coordinates.
std::vector<Vec2> images(const std::vector<PlaneOperation>& operations, Vec2 origin, Vec2 point) {
  std::vector<Vec2> found;
  const auto add = [&](Vec2 image, bool identity) {
    // The image nearest to the point, whatever the operation's own translation.
    image = image - Vec2{std::round(image.x - point.x), std::round(image.y - point.y)};
    for (int v = -2; v <= 2; ++v)
      for (int u = -2; u <= 2; ++u)
        if (!identity || u != 0 || v != 0)
          found.push_back(image + Vec2{static_cast<double>(u), static_cast<double>(v)});
  };
  add(point, true);
  for (std::size_t g = 1; g < operations.size(); ++g) {
    const PlaneOperation& op = operations[g];
    add(apply(op.matrix, point - origin) + origin + Vec2{op.half_u / 2.0, op.half_v / 2.0}, false);
  }
  return found;
}

/// The part of a convex polygon on the side of `keep`, nearer to it than to `other`.
std::vector<Vec2> clipped(const std::vector<Vec2>& polygon, Vec2 keep, Vec2 other) {
  const Vec2 normal = other - keep, middle = 0.5 * (keep + other);
  std::vector<Vec2> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
    const double at_p = dot(p - middle, normal), at_q = dot(q - middle, normal);
    if (at_p <= 0) result.push_back(p);
    if ((at_p < 0 && at_q > 0) || (at_p > 0 && at_q < 0)) result.push_back(p + (at_p / (at_p - at_q)) * (q - p));
  }
  return result;
}

/// Area of a polygon with its corners in order.
double polygon_area(const std::vector<Vec2>& corners) {
  double twice = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) twice += cross(corners[i], corners[(i + 1) % corners.size()]);
  return std::abs(twice) / 2;
}

/// The polygon without the corners that rounding has doubled.
std::vector<Vec2> simplified(const std::vector<Vec2>& corners) {
  const double least = 0.01 * std::sqrt(polygon_area(corners));
  std::vector<Vec2> kept;
  for (const Vec2 corner : corners)
    if (kept.empty() || (norm(corner - kept.back()) > least && norm(corner - kept.front()) > least))
      kept.push_back(corner);
  return kept;
}

/// The Dirichlet cell of a point in general position under the group of the operations about `origin` (lattice
/// coordinates) and the lattice: the points of the plane that are nearer to it than to any of its images. Its area is
/// that of the lattice cell over the number of operations. Corners in the vectors' unit, in order.
std::vector<Vec2> generating_region(const std::array<Vec2, 2>& vectors, const std::vector<PlaneOperation>& operations,
                                    Vec2 origin) {
  const auto in_plane = [&](Vec2 p) { return p.x * vectors[0] + p.y * vectors[1]; };
  // The point furthest from its images gives the roundest region. The grid avoids points on mirrors and centres.
  constexpr int k_grid = 17;
  Vec2 chosen{};
  double furthest = -1;
  for (int j = 0; j < k_grid; ++j)
    for (int i = 0; i < k_grid; ++i) {
      const Vec2 point = origin + Vec2{(i + 0.37) / k_grid, (j + 0.41) / k_grid};
      double nearest = 1e300;
      for (const Vec2 image : images(operations, origin, point))
        nearest = std::min(nearest, norm(in_plane(image - point)));
      if (nearest > furthest * (1 + 1e-9)) {
        furthest = nearest;
        chosen = point;
      }
    }
  const Vec2 centre = in_plane(chosen);
  const double reach = 2 * (norm(vectors[0]) + norm(vectors[1]));
  std::vector<Vec2> region = {centre + Vec2{-reach, -reach}, centre + Vec2{reach, -reach}, centre + Vec2{reach, reach},
                              centre + Vec2{-reach, reach}};
  for (const Vec2 image : images(operations, origin, chosen)) region = clipped(region, centre, in_plane(image));
  return simplified(region);
}

constexpr std::array<std::string_view, 17> k_names = {"p1", "p2",  "pm",  "pg", "cm",   "pmm",  "pmg", "pgg", "cmm",
                                                      "p4", "p4m", "p4g", "p3", "p3m1", "p31m", "p6",  "p6m"};

/// Fourier coefficients of the cell: f(u, v) = Σ F(m, n) exp(2πi (m u + n v)).
class CellSpectrum {
 public:
  /// Waves longer than `shortest_px` only, so that the set is the same in all directions.
  CellSpectrum(const GreyImage& cell, const std::array<Vec2, 2>& vectors, double shortest_px) {
    RealFft2d fft(cell.width, cell.height);
    for (int y = 0; y < cell.height; ++y)
      for (int x = 0; x < cell.width; ++x) fft.real(x, y) = static_cast<double>(cell.at(x, y));
    fft.forward();
    const double area = cross(vectors[0], vectors[1]), norm = 1 / (static_cast<double>(cell.width) * cell.height);
    const int most_m = (cell.width - 1) / 2, most_n = (cell.height - 1) / 2;
    reach_m_ = most_m;
    reach_n_ = most_n;
    table_.resize(static_cast<std::size_t>(2 * most_m + 1) * static_cast<std::size_t>(2 * most_n + 1));
    for (int n = -most_n; n <= most_n; ++n)
      for (int m = 0; m <= most_m; ++m) {
        // The wave vector whose products with the lattice vectors are m and n.
        const Vec2 k{(m * vectors[1].y - n * vectors[0].y) / area, (n * vectors[0].x - m * vectors[1].x) / area};
        if ((m == 0 && n == 0) || papilla::norm(k) * shortest_px > 1) continue;
        const std::complex<double> value =
            norm * fft.spectrum()[static_cast<std::size_t>(wrapped(n, cell.height)) * fft.spectrum_width() +
                                  static_cast<std::size_t>(m)];
        set(m, n, value);
        if (m > 0) set(-m, -n, std::conj(value));
      }
    for (int n = -most_n; n <= most_n; ++n)
      for (int m = -most_m; m <= most_m; ++m)
        if (at(m, n) != std::complex<double>()) waves_.push_back({m, n});
    for (const auto& [m, n] : waves_) energy_ += std::norm(at(m, n));
  }

  using Wave = std::array<int, 2>;
  const std::vector<Wave>& waves() const { return waves_; }
  double energy() const { return energy_; }
  std::complex<double> at(int m, int n) const {
    if (std::abs(m) > reach_m_ || std::abs(n) > reach_n_) return {};
    return table_[index(m, n)];
  }
  /// conj(F(k)) F(Mᵀk): the coefficient of C_M at −k.
  std::complex<double> product(const Wave& k, const LatticeMatrix& matrix) const {
    return std::conj(at(k[0], k[1])) * at(matrix.a * k[0] + matrix.c * k[1], matrix.b * k[0] + matrix.d * k[1]);
  }

 private:
  std::size_t index(int m, int n) const {
    return static_cast<std::size_t>(n + reach_n_) * static_cast<std::size_t>(2 * reach_m_ + 1) +
           static_cast<std::size_t>(m + reach_m_);
  }
  void set(int m, int n, std::complex<double> value) { table_[index(m, n)] = value; }

  int reach_m_ = 0, reach_n_ = 0;
  std::vector<std::complex<double>> table_;
  std::vector<Wave> waves_;
  double energy_ = 0;
};

constexpr int k_grid = 64;

/// C_M(t) for all t on the grid, row by row.
std::vector<double> correlations(const CellSpectrum& spectrum, const LatticeMatrix& matrix) {
  RealFft2d fft(k_grid, k_grid);
  std::fill_n(fft.spectrum(), fft.spectrum_width() * static_cast<std::size_t>(k_grid), std::complex<double>());
  for (const CellSpectrum::Wave& k : spectrum.waves()) {
    const int column = wrapped(-k[0], k_grid), row = wrapped(-k[1], k_grid);
    if (2 * column <= k_grid)
      fft.spectrum()[static_cast<std::size_t>(row) * fft.spectrum_width() + static_cast<std::size_t>(column)] +=
          spectrum.product(k, matrix);
  }
  fft.backward();
  std::vector<double> values;
  for (int y = 0; y < k_grid; ++y)
    for (int x = 0; x < k_grid; ++x) values.push_back(fft.real(x, y));
  return values;
}

/// (I − M) o + t/2.
Vec2 shift_of(const PlaneOperation& operation, Vec2 origin) {
  return origin - apply(operation.matrix, origin) + Vec2{operation.half_u / 2.0, operation.half_v / 2.0};
}

/// The energy that averaging over the group about an origin keeps.
double kept_energy(const CellSpectrum& spectrum, const PlaneGroup& group, Vec2 origin) {
  double sum = spectrum.energy();  // Of the identity.
  for (std::size_t g = 1; g < group.operations.size(); ++g) {
    const Vec2 t = shift_of(group.operations[g], origin);
    for (const CellSpectrum::Wave& k : spectrum.waves()) {
      const double angle = 2 * std::numbers::pi * (k[0] * t.x + k[1] * t.y);
      const std::complex<double> value = spectrum.product(k, group.operations[g].matrix);
      sum += value.real() * std::cos(angle) + value.imag() * std::sin(angle);
    }
  }
  return sum / static_cast<double>(group.operations.size());
}

struct Placed {
  const PlaneGroup* group = nullptr;
  Vec2 origin{};
  double kept = 0;  ///< Energy.
  double criterion = 0;
};

using CorrelationTables = std::vector<std::pair<LatticeMatrix, std::vector<double>>>;

const std::vector<double>& table_of(CorrelationTables& tables, const CellSpectrum& spectrum, const LatticeMatrix& m) {
  for (const auto& [matrix, table] : tables)
    if (matrix == m) return table;
  tables.emplace_back(m, correlations(spectrum, m));
  return tables.back().second;
}

/// The best origin on the grid.
Placed place(const PlaneGroup& group, const CellSpectrum& spectrum, CorrelationTables& tables) {
  Placed best{&group, {}, spectrum.energy(), 0};
  if (group.operations.size() == 1) return best;
  for (const PlaneOperation& operation : group.operations) table_of(tables, spectrum, operation.matrix);
  std::vector<const std::vector<double>*> of;
  for (const PlaneOperation& operation : group.operations) of.push_back(&table_of(tables, spectrum, operation.matrix));
  best.kept = -1;
  for (int v = 0; v < k_grid; ++v)
    for (int u = 0; u < k_grid; ++u) {
      double sum = spectrum.energy();
      for (std::size_t g = 1; g < of.size(); ++g) {
        const PlaneOperation& op = group.operations[g];
        const int x = wrapped(u - op.matrix.a * u - op.matrix.b * v + op.half_u * k_grid / 2, k_grid);
        const int y = wrapped(v - op.matrix.c * u - op.matrix.d * v + op.half_v * k_grid / 2, k_grid);
        sum += (*of[g])[pixel_index(x, y, k_grid)];
      }
      sum /= static_cast<double>(of.size());
      if (sum <= best.kept) continue;
      best.kept = sum;
      best.origin = {static_cast<double>(u) / k_grid, static_cast<double>(v) / k_grid};
    }
  return best;
}

/// Moves the origin off the grid, by halving steps.
void refine(Placed& placed, const CellSpectrum& spectrum) {
  if (placed.group->operations.size() == 1) return;
  for (double step = 0.5 / k_grid; step > 1e-4; step /= 2)
    for (const Vec2 direction : {Vec2{1, 0}, Vec2{-1, 0}, Vec2{0, 1}, Vec2{0, -1}}) {
      const Vec2 origin = placed.origin + step * direction;
      const double kept = kept_energy(spectrum, *placed.group, origin);
      if (kept <= placed.kept) continue;
      placed.kept = kept;
      placed.origin = origin;
    }
}

/// The cell averaged over the group.
GreyImage averaged(const GreyImage& cell, const CellSpectrum& spectrum, const Placed& placed) {
  double mean = 0;
  for (const float grey : cell.pixels) mean += static_cast<double>(grey) / static_cast<double>(cell.pixels.size());
  RealFft2d fft(cell.width, cell.height);
  std::fill_n(fft.spectrum(), fft.spectrum_width() * static_cast<std::size_t>(cell.height), std::complex<double>());
  fft.spectrum()[0] = mean;
  const auto count = static_cast<double>(placed.group->operations.size());
  for (const auto& [m, n] : spectrum.waves()) {
    if (m < 0) continue;
    std::complex<double> sum;
    for (const PlaneOperation& operation : placed.group->operations) {
      // f(M⁻¹(x − t)) has the coefficient F(Mᵀk) exp(−2πi k·t).
      const LatticeMatrix& matrix = operation.matrix;
      const Vec2 t = shift_of(operation, placed.origin);
      sum += spectrum.at(matrix.a * m + matrix.c * n, matrix.b * m + matrix.d * n) *
             std::polar(1.0, -2 * std::numbers::pi * (m * t.x + n * t.y));
    }
    fft.spectrum()[static_cast<std::size_t>(wrapped(n, cell.height)) * fft.spectrum_width() +
                   static_cast<std::size_t>(m)] = sum / count;
  }
  fft.backward();
  GreyImage result = cell;
  for (int y = 0; y < cell.height; ++y)
    for (int x = 0; x < cell.width; ++x) result.at(x, y) = static_cast<float>(fft.real(x, y));
  return result;
}

void require(const SymmetricPart& part, const std::array<Vec2, 2>& vectors, const WallpaperOptions& options) {
  require_image(part.primitive, "find_wallpaper_group");
  require_image(part.residual, "find_wallpaper_group");
  const double area = std::abs(cross(vectors[0], vectors[1]));
  if (!is_finite(vectors[0]) || !is_finite(vectors[1]) || !(area >= 1))
    throw InvalidInput("find_wallpaper_group: the vectors (" + std::to_string(vectors[0].x) + ", " +
                       std::to_string(vectors[0].y) + "), (" + std::to_string(vectors[1].x) + ", " +
                       std::to_string(vectors[1].y) + ") span no cell");
  if (!(options.metric_tolerance > 0 && options.metric_tolerance <= 0.2) ||
      !(options.model_error > 0 && options.model_error < 1))
    throw InvalidInput("find_wallpaper_group: tolerance " + std::to_string(options.metric_tolerance) +
                       " or model error " + std::to_string(options.model_error) + " is out of range");
}

/// Expected |δF|² of one coefficient from white noise of the residual's variance.
double coefficient_noise(const SymmetricPart& part, double cell_area) {
  double squares = 0;
  for (const float value : part.residual.pixels) squares += static_cast<double>(value) * static_cast<double>(value);
  const auto pixels = static_cast<double>(part.residual.pixels.size());
  return squares / std::max(1.0, pixels - cell_area) / pixels;
}

}  // namespace

std::string_view to_string(WallpaperGroup group) noexcept { return k_names[static_cast<std::size_t>(group)]; }

WallpaperSymmetry find_wallpaper_group(const SymmetricPart& part, const std::array<Vec2, 2>& vectors,
                                       const WallpaperOptions& options) {
  require(part, vectors, options);
  constexpr double k_shortest_wave_px = 4;  // Bicubic means dampen shorter waves.
  WallpaperSymmetry result;
  result.primitive = part.primitive;
  const CellSpectrum spectrum(part.primitive, vectors, k_shortest_wave_px);
  const double area = std::abs(cross(vectors[0], vectors[1]));
  if (!(spectrum.energy() > 0)) {  // A flat cell has every symmetry; they can't be distinguished.
    result.candidates = {{}};
    result.region_px = generating_region(vectors, {}, {});
    return result;
  }
  const auto parameters = static_cast<double>(spectrum.waves().size());
  const double noise = coefficient_noise(part, area) + options.model_error * spectrum.energy() / parameters;
  const std::vector<PlaneGroup> groups = plane_groups(vectors, options.metric_tolerance);
  CorrelationTables tables;
  std::vector<Placed> placed;
  const auto rate = [&](Placed& p) {
    p.criterion =
        (spectrum.energy() - p.kept) / noise + 2 * parameters / static_cast<double>(p.group->operations.size());
  };
  for (const PlaneGroup& group : groups) {
    placed.push_back(place(group, spectrum, tables));
    rate(placed.back());
  }
  const auto by_criterion = [](const Placed& p, const Placed& q) { return p.criterion < q.criterion; };
  std::stable_sort(placed.begin(), placed.end(), by_criterion);
  // Refining the origin changes what is kept by a few percent: only the first ones can still win.
  constexpr std::size_t k_refined = 8;
  for (std::size_t i = 0; i < std::min(k_refined, placed.size()); ++i) {
    refine(placed[i], spectrum);
    rate(placed[i]);
  }
  std::stable_sort(placed.begin(), placed.end(), by_criterion);
  for (const Placed& p : placed)
    result.candidates.push_back({p.group->name, std::clamp(p.kept / spectrum.energy(), 0.0, 1.0), p.criterion});
  const Placed& best = placed.front();
  result.group = best.group->name;
  result.order = static_cast<int>(best.group->operations.size());
  result.kept = result.candidates.front().kept;
  result.origin_px = best.origin.x * vectors[0] + best.origin.y * vectors[1];
  result.primitive = averaged(part.primitive, spectrum, best);
  result.region_px = generating_region(vectors, best.group->operations, best.origin);
  return result;
}

}  // namespace papilla
