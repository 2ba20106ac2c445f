// SPDX-License-Identifier: GPL-3.0-or-later
#include "papilla/texture/wallpaper_group.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <string>

#include "checks.hpp"
#include "fft.hpp"
#include "generating_region.hpp"
#include "papilla/core/error.hpp"
#include "plane_groups.hpp"

namespace papilla {
namespace {

using texture_detail::apply;
using texture_detail::LatticeMatrix;
using texture_detail::pixel_index;
using texture_detail::PlaneGroup;
using texture_detail::PlaneOperation;
using texture_detail::RealFft2d;
using texture_detail::wrapped;

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
  texture_detail::require_image(part.primitive, "find_wallpaper_group");
  texture_detail::require_image(part.residual, "find_wallpaper_group");
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
  if (!(spectrum.energy() > 0)) {  // A flat cell has every symmetry; none is told from another.
    result.candidates = {{}};
    result.region_px = texture_detail::generating_region(vectors, {}, {});
    return result;
  }
  const auto parameters = static_cast<double>(spectrum.waves().size());
  const double noise = coefficient_noise(part, area) + options.model_error * spectrum.energy() / parameters;
  const std::vector<PlaneGroup> groups = texture_detail::plane_groups(vectors, options.metric_tolerance);
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
  result.region_px = texture_detail::generating_region(vectors, best.group->operations, best.origin);
  return result;
}

}  // namespace papilla
