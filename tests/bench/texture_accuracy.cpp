// SPDX-License-Identifier: MIT
#include "texture_accuracy.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <tuple>

#include "papilla/core/error.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/best_dimension.hpp"
#include "papilla/texture/height_from_image.hpp"
#include "papilla/texture/relief_error.hpp"
#include "papilla/texture/resample.hpp"
#include "papilla/texture/shape_from_shading.hpp"
#include "papilla/texture/stein_surface.hpp"
#include "papilla/texture/symmetry.hpp"
#include "papilla/texture/wallpaper_group.hpp"
#include "texture/published_tables.hpp"
#include "texture/seen_surface.hpp"
#include "texture/wallpaper_patterns.hpp"
#if defined(PAPILLA_HAVE_GWYDDION)
#include "gwyddion_dimension.hpp"
#endif

namespace papilla::bench {
namespace {

std::optional<bool> unless_quick(const BenchReport& report, bool holds) {
  return report.options().quick ? std::nullopt : std::optional(holds);
}

std::string beside(double published, double measured) { return fmt::format("{:.2f} / {:.3f}", published, measured); }

// --- published tables -----------------------------------------------------------------------------------------------

void dimension_table(BenchReport& report) {
  EvidenceTable table{
      "Table 6.1 of Schulze 2005, published / measured",
      "Mean of five seeds. Pictures: exact fractional Brownian surfaces of 513², their best plane taken "
      "away, stretched to 8 bits, the central part of the given side. The pictures behind the published "
      "values are not available. The box family saturates, because a column of boxes holds at most as "
      "many points as pixels: the rougher, the lower it reads.",
      {"D", "side", "box", "information", "correlation", "probability"},
      {}};
  double worst_box = 0, worst_probability = 0;
  for (const test::DimensionCell& cell : test::k_dimension_table) {
    if (report.options().quick && cell.side_px != 130) continue;
    const test::FourDimensions measured = test::measured_dimensions(cell);
    std::vector<std::string> row = {fmt::format("{}", cell.dimension), std::to_string(cell.side_px)};
    for (std::size_t i = 0; i < 4; ++i) {
      row.push_back(beside(cell.published[i], measured[i]));
      double& worst = i < 3 ? worst_box : worst_probability;
      worst = std::max(worst, std::abs(measured[i] - cell.published[i]));
    }
    table.rows.push_back(std::move(row));
  }
  report.table(std::move(table));
  report.target({"table 6.1: probability dimension within 0.04 in every cell",
                 fmt::format("largest {:.3f}", worst_probability), unless_quick(report, worst_probability <= 0.04)});
  report.target({"table 6.1: box, information, correlation within 0.12", fmt::format("largest {:.3f}", worst_box),
                 unless_quick(report, worst_box <= 0.12)});
}

void signature_table(BenchReport& report) {
  EvidenceTable table{"Table 2 of Cho et al. 2017, published / measured",
                      "Mean of five seeds of the three-step midpoint displacement on 257².",
                      {"H", "Sta", "FD_Sta", "Str"},
                      {}};
  double sta = 0, str = 0, worst = 0;
  for (const test::SignatureRow& row : test::k_signature_table) {
    const test::SignatureRow measured = test::measured_signature(row.hurst);
    table.rows.push_back({fmt::format("{:.2f}", row.hurst), fmt::format("{:.4f} / {:.4f}", row.sta, measured.sta),
                          fmt::format("{:.4f} / {:.4f}", 3 - row.sta, 3 - measured.sta),
                          fmt::format("{:.4f} / {:.4f}", row.str, measured.str)});
    const double off_sta = measured.sta - row.sta, off_str = measured.str - row.str;
    sta += off_sta * off_sta / test::k_signature_table.size();
    str += off_str * off_str / test::k_signature_table.size();
    worst = std::max({worst, std::abs(off_sta), std::abs(off_str)});
  }
  report.table(std::move(table));
  report.target({"table 2: Sta and Str within 0.03 rms, no cell above 0.06",
                 fmt::format("rms {:.3f} and {:.3f}, largest {:.3f}", std::sqrt(sta), std::sqrt(str), worst),
                 std::sqrt(sta) <= 0.03 && std::sqrt(str) <= 0.03 && worst <= 0.06});
}

// --- dimension ------------------------------------------------------------------------------------------------------

struct DimensionGoal {
  int size, seeds;
  double of_float, of_bytes;
};
constexpr DimensionGoal k_dimension_goals[] = {
    {257, 20, 0.005, 0.006}, {513, 10, 0.0025, 0.004}, {1025, 6, 0.0013, 0.010}};

struct DimensionErrors {
  double of_float = 0, of_bytes = 0, largest = 0, covered = 0, gwyddion = 0;
};

double share(int part, int whole) { return whole > 0 ? 100.0 * part / whole : 0; }

/// The estimate; where there is none, one that is wrong in every respect.
FractalEstimate stated(const BestDimension& best) { return best.estimate.value_or(FractalEstimate{0, 3, 0, 0, {}}); }

/// A way in which a surface is seen, and what the dimension's error may be.
struct CameraGoal {
  const char* name;
  test::SeenSurface how;
  int side, seeds;
  double most_rms;
};

std::vector<CameraGoal> camera_goals() {
  constexpr int k_small = 257, k_large = 1025;
  std::vector<CameraGoal> goals;
  for (const auto& [side, seeds, limits] :
       {std::tuple{k_small, 8, std::array{0.06, 0.12, 0.2}}, std::tuple{k_large, 3, std::array{0.03, 0.06, 0.1}}}) {
    goals.push_back({"0.5 px", {.spread_px = 0.5}, side, seeds, limits[0]});
    goals.push_back({"0.8 px, noise 1 %", {.spread_px = 0.8, .noise = 0.01}, side, seeds, limits[1]});
    goals.push_back({"1.2 px, noise 2 %", {.spread_px = 1.2, .noise = 0.02}, side, seeds, limits[2]});
  }
  goals.push_back({"0.5 px before sampling", {.spread_px = 0.5, .finer = 4}, k_small, 4, 0.06});
  goals.push_back({"pixels that average their area", {.finer = 4, .pixel_area = true}, k_small, 4, 0.06});
  goals.push_back({"0.8 px before pixels that average, noise 1 %",
                   {.spread_px = 0.8, .noise = 0.01, .finer = 4, .pixel_area = true},
                   k_small,
                   4,
                   0.12});
  return goals;
}

void camera_table(BenchReport& report) {
  EvidenceTable table{
      "The best dimension through a camera",
      "Exact surfaces blurred by a Gaussian (by convolution in space, on the grid or on one four times finer), noised "
      "in "
      "% of the range of grey values, cut to 8 bits. Root mean square error of D and share of the 95 % intervals that "
      "hold the truth over D = 2.1, 2.3 … 2.9; mean D found for three of them; refused: no power law stated.",
      {"seen", "side", "pictures", "rms error", "within", "refused", "D 2.1", "D 2.5", "D 2.9"},
      {}};
  for (CameraGoal goal : camera_goals()) {
    if (report.options().quick && !table.rows.empty()) break;
    const int seeds = report.options().quick ? 1 : goal.seeds;
    double squares = 0;
    int count = 0, within = 0, refused = 0;
    std::map<int, double> means;
    for (const int tenth : {1, 3, 5, 7, 9}) {
      int found = 0;
      for (int seed = 1; seed <= seeds; ++seed) {
        goal.how.side = goal.side;
        goal.how.dimension = 2 + tenth / 10.0;
        goal.how.seed = static_cast<std::uint64_t>(40000 + 100 * tenth + seed);
        const BestDimension best = best_dimension(test::seen_surface(goal.how));
        ++count;
        if (!best.power_law()) {
          ++refused;
          continue;
        }
        ++found;
        means[tenth] += best.estimate->dimension;
        squares += std::pow(best.estimate->dimension - goal.how.dimension, 2);
        within += best.estimate->low <= goal.how.dimension && goal.how.dimension <= best.estimate->high;
      }
      means[tenth] = found > 0 ? means[tenth] / found : std::numeric_limits<double>::quiet_NaN();
    }
    const int found = count - refused;
    const double rms = found > 0 ? std::sqrt(squares / found) : 0, cover = share(within, found);
    table.rows.push_back({goal.name, std::to_string(goal.side), std::to_string(count), fmt::format("{:.4f}", rms),
                          fmt::format("{:.0f} %", cover), std::to_string(refused), fmt::format("{:.3f}", means[1]),
                          fmt::format("{:.3f}", means[5]), fmt::format("{:.3f}", means[9])});
    report.target({fmt::format("best behind {} at {}²: rms error of D at most {}, 90 % of the intervals hold it",
                               goal.name, goal.side, goal.most_rms),
                   fmt::format("{:.4f}, {:.0f} %, {} of {} refused", rms, cover, refused, count),
                   unless_quick(report, rms <= goal.most_rms && cover >= 90 && refused == 0)});
  }
  report.table(std::move(table));
}

DimensionErrors dimension_errors(int size, int seeds) {
  DimensionErrors errors;
  int count = 0;
  for (int tenth = 1; tenth <= 9; ++tenth)
    for (int seed = 1; seed <= seeds; ++seed) {
      const double dimension = 2 + tenth / 10.0;
      const HeightGrid surface =
          brownian_surface_exact({size, 3 - dimension, static_cast<std::uint64_t>(100 * tenth + seed)});
      const GreyImage image = to_grey_image(surface);
      const FractalEstimate estimate = stated(best_dimension(image));
      const double off = estimate.dimension - dimension;
      const double off_bytes = stated(best_dimension(to_grey_image(surface, 8))).dimension - dimension;
      errors.of_float += off * off;
      errors.of_bytes += off_bytes * off_bytes;
      errors.largest = std::max(errors.largest, std::abs(off));
      errors.covered += estimate.low <= dimension && dimension <= estimate.high;
#if defined(PAPILLA_HAVE_GWYDDION)
      const double other = gwyddion_partitioning_dimension(image) - dimension;
      errors.gwyddion += other * other;
#endif
      ++count;
    }
  errors.of_float = std::sqrt(errors.of_float / count);
  errors.of_bytes = std::sqrt(errors.of_bytes / count);
  errors.gwyddion = std::sqrt(errors.gwyddion / count);
  errors.covered /= count;
  return errors;
}

// --- symmetry -------------------------------------------------------------------------------------------------------

constexpr int k_groups = 17;

struct SymmetryCount {
  int pictures = 0, lattices = 0, groups = 0, projected = 0;
  std::vector<double> errors;
};

void count_pattern(const test::WallpaperPattern& pattern, SymmetryCount& count) {
  constexpr double k_same_lattice_px = 1;
  ++count.pictures;
  const FeatureMatrix matrix = feature_matrix(pattern.image);
  const Lattice projected = find_lattice(matrix, {.method = LatticeMethod::projection});
  // Its vectors are not fitted: twice the distance counts as right.
  count.projected +=
      projected.found && test::lattice_error(projected.vectors_px, pattern.a, pattern.b) < 2 * k_same_lattice_px;
  const Lattice lattice = find_lattice(matrix);
  if (!lattice.found) return;
  const double error = test::lattice_error(lattice.vectors_px, pattern.a, pattern.b);
  if (error >= k_same_lattice_px) return;
  ++count.lattices;
  count.errors.push_back(error);
  const SymmetricPart part = symmetric_part(pattern.image, lattice.vectors_px);
  count.groups += find_wallpaper_group(part, lattice.vectors_px).group == pattern.group;
}

GreyImage white_noise(int side, unsigned seed) {
  std::mt19937 engine(seed);
  GreyImage image{side, side, {}, 0, 8};
  for (int i = 0; i < side * side; ++i) image.pixels.push_back(static_cast<float>(engine() >> 24) / 255.0F);
  return image;
}

// --- height ---------------------------------------------------------------------------------------------------------

using Relief = std::function<double(double, double)>;

HeightMap sampled(int side, const Relief& z) {
  HeightMap map{side, side, {}, 1, 1, false};
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) map.mm.push_back(static_cast<float>(z(x, y)));
  return map;
}

/// 8-bit Lambert picture from the formula's own slopes, independent of the library's renderer.
GreyImage lit(int side, const Relief& z, Vec3 light) {
  const Vec3 s = normalized(light);
  GreyImage image{side, side, {}, 0, 8};
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      constexpr double h = 1e-3;
      const double p = (z(x + h, y) - z(x - h, y)) / (2 * h), q = (z(x, y + h) - z(x, y - h)) / (2 * h);
      const double cosine = std::max(0.0, (s.z - s.x * p - s.y * q) / std::sqrt(1 + p * p + q * q));
      image.pixels.push_back(static_cast<float>(std::round(255 * cosine) / 255));
    }
  return image;
}

double bump(double x, double y, double cx, double cy, double height, double width) {
  return height * std::exp(-((x - cx) * (x - cx) + (y - cy) * (y - cy)) / (2 * width * width));
}

constexpr int k_relief_side = 128;

std::vector<std::pair<std::string, Relief>> reliefs() {
  constexpr double c = (k_relief_side - 1) / 2.0, pi = std::numbers::pi;
  return {{"hemisphere",
           [=](double x, double y) { return std::sqrt(std::max(0.0, 1600 - (x - c) * (x - c) - (y - c) * (y - c))); }},
          {"bumps",
           [](double x, double y) {
             return bump(x, y, 36, 35, 13, 13) + bump(x, y, 91, 40, 11, 12) + bump(x, y, 60, 91, 15, 15);
           }},
          {"weave", [=](double x, double y) { return 2 * std::sin(2 * pi * x / 32) * std::sin(2 * pi * y / 32); }},
          {"vase", [=](double x, double y) { return bump(x, y, c, c, 25, 21); }},
          {"smooth", [](double x, double y) {
             return 4 * std::sin(0.083 * x + 0.038 * y) + 2.7 * std::cos(0.053 * x - 0.09 * y) +
                    1.3 * std::sin(0.15 * y);
           }}};
}

struct ShadingMethod {
  const char* name;
  ShadingResult (*solve)(const GreyImage&, const ShadingOptions&);
};
constexpr ShadingMethod k_shading_methods[] = {{"variational", shape_from_shading_variational},
                                               {"pentland", shape_from_shading_pentland},
                                               {"tsai-shah", shape_from_shading_tsai_shah}};

GreyImage uniform(int width, int height, float grey) {
  return {width, height, Values<float>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), grey), 0,
          32};
}

/// Pictures that nothing can be read from.
std::vector<std::pair<std::string, GreyImage>> bad_pictures() {
  GreyImage spots = uniform(40, 40, 0.5F), checks = uniform(32, 32, 0), holes = uniform(20, 20, 0.5F);
  spots.pixels[820] = std::numeric_limits<float>::quiet_NaN();
  holes.pixels[7] = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < checks.pixels.size(); ++i) checks.pixels[i] = (i + i / 32) % 2 ? 1e6F : -1e6F;
  return {{"flat", uniform(64, 64, 0.5F)},    {"black", uniform(64, 64, 0)},
          {"saturated", uniform(64, 64, 1)},  {"1 x 1", uniform(1, 1, 0.3F)},
          {"1 x 500", uniform(1, 500, 0.3F)}, {"500 x 1", uniform(500, 1, 0.3F)},
          {"2 x 2", white_noise(2, 3)},       {"noise", white_noise(48, 4)},
          {"checks of a million", checks},    {"NaN pixel", spots},
          {"infinite pixel", holes},          {"16384 x 16384", GreyImage{16384, 16384, {}, 0, 8}}};
}

void report_robustness(BenchReport& report) {
  int runs = 0, refused = 0, bad = 0;
  for (auto& [name, picture] : bad_pictures()) {
    const bool huge = picture.width > 8192;
    if (huge && report.options().quick) continue;
    if (huge) picture.pixels.assign(std::size_t{16384} * 16384, 0.5F);
    for (const char* method : {"variational", "pentland", "tsai-shah", "intensity"})
      for (const Vec3 light : {Vec3{0, 0, 1}, Vec3{0.01, 0.01, 1}, Vec3{1, -1, 1}, Vec3{1, 0, 1e-3}}) {
        if (huge && std::string(method) == "intensity") continue;  // Copies; nothing to go wrong.
        ++runs;
        try {
          const HeightResult result =
              height_from_image(picture, {.method = height_method(method), .light = light, .iterations = 20});
          bad += std::any_of(result.map.mm.begin(), result.map.mm.end(), [](float h) { return !std::isfinite(h); });
        } catch (const InvalidInput&) {
          ++refused;
        }
      }
  }
  report.target(
      {"shape from shading: never NaN, whatever the light and picture; a result or a refusal",
       fmt::format("{} runs on bad pictures: {} with a value that is not finite, {} refused", runs, bad, refused),
       bad == 0});
}

std::string dimension_or_reason(const BestDimension& best) {
  if (!best.power_law()) return "none: " + best.reason;
  return fmt::format("{:.3f} [{:.3f}, {:.3f}] at {:.0f} to {:.0f} px", best.estimate->dimension, best.estimate->low,
                     best.estimate->high, best.least_scale_px, best.most_scale_px);
}

/// Correlation of two pictures of the same size.
double correlation(std::span<const float> a, std::span<const float> b) {
  double mean_a = 0, mean_b = 0, ab = 0, aa = 0, bb = 0;
  const auto count = static_cast<double>(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    mean_a += static_cast<double>(a[i]) / count;
    mean_b += static_cast<double>(b[i]) / count;
  }
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double da = static_cast<double>(a[i]) - mean_a, db = static_cast<double>(b[i]) - mean_b;
    ab += da * db;
    aa += da * da;
    bb += db * db;
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

}  // namespace

void report_published_tables(BenchReport& report) {
  dimension_table(report);
  signature_table(report);
}

void report_dimension_error(BenchReport& report) {
  EvidenceTable table{
      "Error of the best dimension",
      "Root mean square error of D on exact surfaces, D = 2.1 to 2.9 in tenths; `within` is the share of the "
      "95 % intervals that hold the truth. Gwyddion: the partitioning method of its library.",
      {"side", "surfaces", "float", "8 bit", "largest, float", "within", "Gwyddion, float"},
      {}};
  for (const DimensionGoal& goal : k_dimension_goals) {
    if (report.options().quick && goal.size > 257) break;
    const int seeds = report.options().quick ? 1 : goal.seeds;
    const DimensionErrors errors = dimension_errors(goal.size, seeds);
    table.rows.push_back({std::to_string(goal.size), std::to_string(9 * seeds), fmt::format("{:.4f}", errors.of_float),
                          fmt::format("{:.4f}", errors.of_bytes), fmt::format("{:.4f}", errors.largest),
                          fmt::format("{:.0f} %", 100 * errors.covered),
                          errors.gwyddion > 0 ? fmt::format("{:.4f}", errors.gwyddion) : "-"});
    report.target({fmt::format("best at {0}²: rms error of D at most {1} for floats, {2} for 8 bits", goal.size,
                               goal.of_float, goal.of_bytes),
                   fmt::format("{:.4f} and {:.4f}", errors.of_float, errors.of_bytes),
                   unless_quick(report, errors.of_float <= goal.of_float && errors.of_bytes <= goal.of_bytes)});
    if (errors.gwyddion > 0)
      report.target(
          {fmt::format("best at {}²: at least 10 times less error than Gwyddion's best dimension method", goal.size),
           fmt::format("{:.1f} times", errors.gwyddion / errors.of_float),
           unless_quick(report, errors.gwyddion >= 10 * errors.of_float)});
  }
  report.table(std::move(table));
  camera_table(report);
#if !defined(PAPILLA_HAVE_GWYDDION)
  report.target(
      {"best: at least 10 times less error than Gwyddion's best dimension method", "no libgwyddion here", {}});
#endif
}

void report_symmetry(BenchReport& report) {
  constexpr double k_noise[] = {0, 0.25, 0.5, 1};
  const int per_group = report.options().quick ? 1 : 25, step = report.options().quick ? 8 : 1;
  EvidenceTable table{
      "Lattices and groups of generated pictures",
      "256 x 256 pixels, 8 bits, all 17 groups, cells of 22 to 66 pixels at any angle, oblique and "
      "rectangular, normal noise in standard deviations of the signal. A group counts only on the right "
      "lattice. `projection` is the source's way to a lattice (to 2 pixels) on the same minima.",
      {"noise", "pictures", "lattice", "group", "median error [px]", "projection"},
      {}};
  SymmetryCount all;
  std::map<std::string, int> wrong;
  for (const double noise : k_noise) {
    SymmetryCount count;
    for (int g = 0; g < k_groups; g += step)
      for (int i = 0; i < per_group; ++i) {
        const auto group = static_cast<WallpaperGroup>(g);
        const int before = count.groups;
        count_pattern(test::wallpaper_pattern(group, static_cast<std::uint64_t>(5000 + 100 * noise + i), noise, 256),
                      count);
        if (count.groups == before) ++wrong[std::string(to_string(group))];
      }
    table.rows.push_back({fmt::format("{}", noise), std::to_string(count.pictures),
                          fmt::format("{:.2f} %", share(count.lattices, count.pictures)),
                          fmt::format("{:.2f} %", share(count.groups, count.pictures)),
                          count.errors.empty() ? "-" : fmt::format("{:.4f}", median(count.errors)),
                          fmt::format("{:.2f} %", share(count.projected, count.pictures))});
    all.pictures += count.pictures;
    all.lattices += count.lattices;
    all.groups += count.groups;
    all.errors.insert(all.errors.end(), count.errors.begin(), count.errors.end());
  }
  for (const auto& [group, count] : wrong) table.note += fmt::format(" Wrong on {} of {}.", count, group);
  report.table(std::move(table));
  report.target({"lattices: at least 99 % right on 1700 pictures, noise up to the signal",
                 fmt::format("{:.2f} % of {}", share(all.lattices, all.pictures), all.pictures),
                 unless_quick(report, share(all.lattices, all.pictures) >= 99)});
  report.target({"groups: at least 97 %", fmt::format("{:.2f} %", share(all.groups, all.pictures)),
                 unless_quick(report, share(all.groups, all.pictures) >= 97)});
  if (!all.errors.empty())
    report.target({"lattice vectors within 0.02 pixels, median", fmt::format("{:.4f}", median(all.errors)),
                   unless_quick(report, median(all.errors) <= 0.02)});

  int pictures = 0, found = 0;
  const int each = report.options().quick ? 2 : 100;
  for (int i = 0; i < each; ++i) {
    std::vector<GreyImage> without = {white_noise(128 + i % 128, static_cast<unsigned>(i) + 1)};
    for (const double hurst : {0.1, 0.4, 0.7})
      without.push_back(to_grey_image(brownian_surface_exact({192, hurst, static_cast<std::uint64_t>(i) + 1}), 8));
    for (const GreyImage& image : without) {
      ++pictures;
      found += find_lattice(feature_matrix(image)).found;
    }
  }
  report.target({"false lattices on noise and fractal surfaces: at most 1 %", fmt::format("{} of {}", found, pictures),
                 unless_quick(report, share(found, pictures) <= 1)});
}

void report_bent_lattices(BenchReport& report) {
  struct Level {
    const char* name;
    test::PhotoConditions photo;
    double least_lattices, least_groups;
  };
  constexpr std::uint64_t k_first_seed = 9000;
  const std::uint64_t seeds = report.options().quick ? 1 : 4;
  const int step = report.options().quick ? 8 : 1;
  for (const Level& level : {Level{"5 % of the cell", test::k_bent_photo, 97, 94},
                             Level{"10 % of the cell", test::k_badly_bent_photo, 80, 65}}) {
    int pictures = 0, lattices = 0, groups = 0;
    for (int g = 0; g < k_groups; g += step)
      for (std::uint64_t seed = k_first_seed; seed < k_first_seed + seeds; ++seed) {
        const auto group = static_cast<WallpaperGroup>(g);
        const test::WallpaperPattern pattern = test::photographed_pattern(group, seed, level.photo, 256);
        const SymmetryAnalysis analysis = analyze_symmetry(pattern.image);
        const double cell = std::sqrt(std::abs(cross(pattern.a, pattern.b)));
        const bool right = analysis.lattice.found &&
                           test::lattice_error(analysis.lattice.vectors_px, pattern.a, pattern.b) < 0.05 * cell;
        ++pictures;
        lattices += right;
        groups += right && find_wallpaper_group(analysis).group == group;
      }
    report.target({fmt::format("cells displaced by {}: at least {} % of lattices", level.name, level.least_lattices),
                   fmt::format("{:.1f} % of {}", share(lattices, pictures), pictures),
                   unless_quick(report, share(lattices, pictures) >= level.least_lattices)});
    report.target({fmt::format("cells displaced by {}: at least {} % of groups", level.name, level.least_groups),
                   fmt::format("{:.1f} %", share(groups, pictures)),
                   unless_quick(report, share(groups, pictures) >= level.least_groups)});
  }
}

void report_height(BenchReport& report) {
  EvidenceTable table{
      "Depth error of shape from shading",
      "Mean distance over the range of the true relief, the best plane taken away; 128 x 128 pixels, 8 bits, "
      "known light, no scaling.",
      {"light", "method", "hemisphere", "bumps", "weave", "vase", "smooth", "mean"},
      {}};
  double sum = 0, weave = 1;
  int count = 0;
  for (const Vec3 light : {Vec3{0.3, 0.3, 1}, Vec3{1, 0, 1}, Vec3{1, 1, 1}})
    for (const ShadingMethod& method : k_shading_methods) {
      std::vector<std::string> row = {fmt::format("({}, {}, {})", light.x, light.y, light.z), method.name};
      double mean = 0;
      for (const auto& [name, z] : reliefs()) {
        const ShadingOptions options{.light = light, .periodic = name == "weave"};
        const double error =
            relief_error(method.solve(lit(k_relief_side, z, light), options).height_px, sampled(k_relief_side, z)).mean;
        mean += error / static_cast<double>(reliefs().size());
        row.push_back(fmt::format("{:.1f} %", 100 * error));
        if (std::string(method.name) == "variational" && name == "weave" && light.y == 0) weave = error;
      }
      row.push_back(fmt::format("{:.1f} %", 100 * mean));
      table.rows.push_back(std::move(row));
      if (std::string(method.name) != "variational") continue;
      sum += mean;
      ++count;
    }
  report.table(std::move(table));
  report.target({"variational: mean depth error at most 12 % of the range under oblique light",
                 fmt::format("{:.1f} %", 100 * sum / count), sum / count <= 0.12});
  report.target(
      {"variational: at most 3 % for a weave lit along one axis", fmt::format("{:.1f} %", 100 * weave), weave <= 0.03});
  report_robustness(report);
}

void report_photographs(BenchReport& report) {
  namespace fs = std::filesystem;
  std::map<std::string, fs::path> files;
  for (const std::string& input : report.options().inputs) {
    if (!fs::is_directory(input)) {
      files[fs::path(input).filename().string()] = input;
      continue;
    }
    for (const auto& entry : fs::directory_iterator(input))
      if (entry.is_regular_file() && entry.path().extension() != ".txt")
        files[entry.path().filename().string()] = entry.path();
  }
  EvidenceTable table{"Photographs",
                      "Files given on the command line. No truth is known of them but for the wool, whose map shading "
                      "does not find. Pictures with lattice and relief drawn, and what one photograph does not tell: "
                      "[gallery](texture-gallery.md).",
                      {"file", "pixels", "lattice [px]", "significance", "explained", "group", "D (best), or why none"},
                      {}};
  std::map<std::string, Lattice> lattices;
  for (const auto& [name, path] : files) {
    const GreyImage image = read_grey_image(path);
    const SymmetryAnalysis analysis = analyze_symmetry(image);
    const Lattice& lattice = analysis.lattice;
    lattices[name] = lattice;
    const auto& [a, b] = lattice.vectors_px;
    const bool measurable = std::min(image.width, image.height) >= 32;
    table.rows.push_back(
        {name, fmt::format("{} x {}", image.width, image.height),
         lattice.found ? fmt::format("({:.2f}, {:.2f}), ({:.2f}, {:.2f})", a.x, a.y, b.x, b.y) : "none",
         fmt::format("{:.2f}", lattice.significance), fmt::format("{:.0f} %", 100 * analysis.explained_variance()),
         lattice.found ? std::string(to_string(find_wallpaper_group(analysis).group)) : "-",
         measurable ? dimension_or_reason(best_dimension(image)) : "-"});
  }
  if (!table.rows.empty()) report.table(std::move(table));
  const auto check = [&](const std::string& name, const std::string& promise,
                         const std::function<bool(const Lattice&)>& holds) {
    const auto found = lattices.find(name);
    if (found == lattices.end()) {
      report.target({promise, "the file was not given", {}});
      return;
    }
    const auto& [a, b] = found->second.vectors_px;
    report.target({promise,
                   found->second.found ? fmt::format("({:.2f}, {:.2f}), ({:.2f}, {:.2f})", a.x, a.y, b.x, b.y)
                                       : fmt::format("none, significance {:.2f}", found->second.significance),
                   holds(found->second)});
  };
  check("krita_woof_tissue.png", "woof tissue: a lattice of 16 x 16 pixels", [](const Lattice& l) {
    return l.found && norm(l.vectors_px[0] - Vec2{16, 0}) < 0.05 && norm(l.vectors_px[1] - Vec2{0, 16}) < 0.05;
  });
  check("grass.png", "grass: no lattice", [](const Lattice& l) { return !l.found; });
  check("gimp_leather_64.png", "leather: no lattice", [](const Lattice& l) { return !l.found; });
  constexpr const char* k_wool = "wool: auto takes the method that correlates most with the map beside it";
  const auto wool = files.find("godot_wool_albedo.jpg"), depth = files.find("godot_wool_depth.png");
  if (wool == files.end() || depth == files.end()) {
    report.target({k_wool, "the files were not given", {}});
    return;
  }
  const GreyImage picture = middle_part(read_grey_image(wool->second), 1024),
                  truth = middle_part(read_grey_image(depth->second), 1024);
  // The file is a depth map by its name: white is deep.
  std::string measured;
  double chosen = 0, best = -1;
  for (const char* method : {"auto", "intensity", "wiener", "variational", "pentland"}) {
    const HeightResult result = height_from_image(picture, {.method = height_method(method)});
    const double r = -correlation(result.map.mm, truth.pixels);
    if (std::string(method) == "auto") chosen = r;
    best = std::max(best, r);
    measured += fmt::format("{}{} {:.2f}", measured.empty() ? "r = " : ", ", method, r);
  }
  report.target(
      {k_wool, measured + " (the map read as depth, white is deep; with the opposite sign as height)", chosen >= best});
}

}  // namespace papilla::bench
