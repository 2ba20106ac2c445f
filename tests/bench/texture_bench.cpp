// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/bench_json.hpp"
#include "papilla/core/cpu_clones.hpp"
#include "papilla/texture/best_dimension.hpp"
#include "papilla/texture/feature_matrix.hpp"
#include "papilla/texture/grain.hpp"
#include "papilla/texture/lattice.hpp"
#include "papilla/texture/probability_dimension.hpp"
#include "papilla/texture/shape_from_shading.hpp"
#include "papilla/texture/stein_surface.hpp"
#include "texture/wallpaper_patterns.hpp"
#include "texture_accuracy.hpp"
#include "texture_sizes.hpp"
#if defined(PAPILLA_HAVE_GWYDDION)
#include "gwyddion_dimension.hpp"
#endif

namespace papilla {
namespace {

std::vector<std::uint8_t> bytes_of(const GreyImage& image) {
  std::vector<std::uint8_t> bytes;
  for (const float grey : image.pixels)
    bytes.push_back(static_cast<std::uint8_t>(std::lround(255 * static_cast<double>(grey))));
  return bytes;
}

// The peers are the definitions, coded for the vector units of the machine the benchmark runs on.
PAPILLA_CPU_CLONES("avx2")
std::int64_t squared_difference(const std::uint8_t* a, const std::uint8_t* b, int count) {
  std::int32_t sum = 0;  // At most 2^15 · 255², below 2^31.
  for (int i = 0; i < count; ++i) {
    const int d = static_cast<int>(a[i]) - static_cast<int>(b[i]);
    sum += d * d;
  }
  return sum;
}

/// Numerators of the feature matrix for dy ≥ 0, row by row.
std::vector<std::int64_t> direct_feature_matrix(const std::vector<std::uint8_t>& bytes, int n) {
  std::vector<std::int64_t> sums;
  for (int dy = 0; dy <= n / 2; ++dy)
    for (int dx = -(n / 2); dx <= n / 2; ++dx) {
      std::int64_t sum = 0;
      for (int y = 0; y + dy < n; ++y) {
        const std::uint8_t* here = bytes.data() + y * n + std::max(0, -dx);
        sum += squared_difference(here, here + dy * n + dx, n - std::abs(dx));
      }
      sums.push_back(sum);
    }
  return sums;
}

/// Adds to `points` of a row of centres whether the pixels at one offset lie within the cube.
PAPILLA_CPU_CLONES("avx2")
void add_points(const std::uint8_t* centres, const std::uint8_t* others, int count, int radius, std::uint16_t* points) {
  for (int x = 0; x < count; ++x) {
    const int d = static_cast<int>(centres[x]) - static_cast<int>(others[x]);
    points[x] = static_cast<std::uint16_t>(points[x] + (d <= radius && -d <= radius ? 1 : 0));
  }
}

std::vector<std::int64_t> direct_cubes(const std::vector<std::uint8_t>& bytes, int n, int side) {
  const int r = (side - 1) / 2, count = n - 2 * r;
  std::vector<std::int64_t> counts(static_cast<std::size_t>(side * side + 1), 0);
  std::vector<std::uint16_t> points(static_cast<std::size_t>(count));
  for (int y = r; y < n - r; ++y) {
    std::fill(points.begin(), points.end(), std::uint16_t{0});
    const std::uint8_t* centres = bytes.data() + y * n + r;
    for (int j = -r; j <= r; ++j)
      for (int i = -r; i <= r; ++i) add_points(centres, centres + j * n + i, count, r, points.data());
    for (const std::uint16_t m : points) ++counts[m];
  }
  return counts;
}

void require(bool equal, const char* what) {
  if (!equal) throw std::runtime_error(std::string(what) + ": the methods disagree");
}

void add_feature_matrix(bench::BenchReport& report, const GreyImage& image, const std::vector<std::uint8_t>& bytes) {
  const int n = image.width;
  const std::string input = "brownian surface " + std::to_string(n);
  report.add({.method = "feature_matrix", .solver = "fft", .input = input},
             [&](bench::Recorder&) { bench::keep(feature_matrix(image).distortion.data()); });
  report.add({.method = "feature_matrix", .solver = "direct", .input = input}, [&, n](bench::Recorder& recorder) {
    std::vector<std::int64_t> sums;
    recorder.time([&] { sums = direct_feature_matrix(bytes, n); });
    const FeatureMatrix matrix = feature_matrix(image);
    std::size_t i = 0;
    for (int dy = 0; dy <= matrix.reach_y; ++dy)
      for (int dx = -matrix.reach_x; dx <= matrix.reach_x; ++dx, ++i) {
        const double overlap = static_cast<double>(n - std::abs(dx)) * (n - dy);
        require(std::llround(matrix.at(dx, dy) * 255 * 255 * overlap) == sums[i], "feature matrix");
      }
  });
  report.compare("feature_matrix/fft", "feature_matrix/direct", "cpu_seconds");
}

void add_probability(bench::BenchReport& report, const GreyImage& image, const std::vector<std::uint8_t>& bytes) {
  const int n = image.width;
  const std::string input = "brownian surface " + std::to_string(n);
  report.add({.method = "probability", .solver = "running-counts", .input = input},
             [&](bench::Recorder&) { bench::keep(cube_histograms(image).data()); });
  report.add({.method = "probability", .solver = "direct", .input = input}, [&, n](bench::Recorder& recorder) {
    const std::vector<CubeHistogram> expected = cube_histograms(image);
    for (const CubeHistogram& histogram : expected) {
      std::vector<std::int64_t> counts;
      recorder.time([&] { counts = direct_cubes(bytes, n, histogram.side); });
      require(counts == histogram.counts, "cube counts");
    }
  });
  report.compare("probability/running-counts", "probability/direct");
}

/// The whole way to a lattice of a picture that has one.
void add_lattice(bench::BenchReport& report, const GreyImage& image) {
  report.add({.method = "lattice", .input = "wallpaper pattern " + std::to_string(image.width)},
             [&](bench::Recorder&) { bench::keep(find_lattice(feature_matrix(image)).vectors_px.data()); });
}

void add_dimension(bench::BenchReport& report, const GreyImage& image) {
  const std::string input = "brownian surface " + std::to_string(image.width);
  report.add({.method = "best", .input = input},
             [&](bench::Recorder&) { bench::keep(best_dimension(image).chi2_per_dof); });
#if defined(PAPILLA_HAVE_GWYDDION)
  report.add({.method = "best", .solver = "gwyddion", .input = input},
             [&](bench::Recorder&) { bench::keep(bench::gwyddion_partitioning_dimension(image)); });
#endif
}

void add_shading(bench::BenchReport& report, const GreyImage& image) {
  const std::string input = "lit grain " + std::to_string(image.width);
  const auto add = [&](const char* method, ShadingResult (*solve)(const GreyImage&, const ShadingOptions&)) {
    report.add({.method = method, .input = input, .error_name = "rms of brightness - R"},
               [&image, solve](bench::Recorder& recorder) {
                 ShadingResult result = solve(image, {.light = GrainOptions{}.light, .periodic = true});
                 recorder.trace(std::move(result.trace));
                 recorder.stop(result.stop);
               });
  };
  add("variational", shape_from_shading_variational);
  add("pentland", shape_from_shading_pentland);
}

void report_speed(bench::BenchReport& report, int size, int small) {
  const std::string input = "brownian surface " + std::to_string(size);
  const auto holds = [&](bool value) { return report.options().quick ? std::nullopt : std::optional(value); };
  const double fft = report.median_of("feature_matrix/fft", input, "cpu_seconds");
  const double ratio = report.median_of("feature_matrix/direct", input, "cpu_seconds") / fft;
  report.target({"feature matrix of 1024²: at least 200 times faster than the direct sum in vector units",
                 fmt::format("{:.0f} times at {}², {:.1f} ms", ratio, size, 1e3 * fft), holds(ratio >= 200)});
  report.target(
      {"feature matrix: equal to the direct sum to 1e-9", "every entry the same whole number of grey steps", true});
  const double lattice = report.median_of("lattice", "wallpaper pattern " + std::to_string(small), "cpu_seconds");
  report.target({"feature matrix and lattice of 256² within 5 ms on one core",
                 fmt::format("{:.1f} ms at {}²", 1e3 * lattice, small), holds(lattice <= 0.005)});
  const double dimension = report.median_of("best", input, "cpu_seconds");
  report.target(
      {"best of 1024² within 1 s on one core", fmt::format("{:.2f} s at {}²", dimension, size), holds(dimension <= 1)});
}

void body(bench::BenchReport& report) {
  const bool quick = report.options().quick;
  const int size = quick ? 96 : 1024, small = quick ? 96 : 256;
  const GreyImage bytes_image = to_grey_image(brownian_surface_exact({size, 0.5, 1}), 8);
  const GreyImage float_image = to_grey_image(brownian_surface_exact({size, 0.5, 1}));
  const std::vector<std::uint8_t> bytes = bytes_of(bytes_image);
  const GreyImage probed = quick ? bytes_image : to_grey_image(brownian_surface_exact({512, 0.5, 1}), 8);
  const std::vector<std::uint8_t> probed_bytes = bytes_of(probed);
  const GreyImage pattern = test::wallpaper_pattern(WallpaperGroup::p4m, 1, 0.25, small).image;
  const GreyImage grain = synthesize_grain(GrainKind::spheres8, {.size_px = size}).picture;
  add_feature_matrix(report, bytes_image, bytes);
  add_probability(report, probed, probed_bytes);
  add_lattice(report, pattern);
  add_dimension(report, float_image);
  add_shading(report, grain);
  report.measure();
  bench::report_published_tables(report);
  bench::report_dimension_error(report);
  report_speed(report, size, small);
  bench::report_symmetry(report);
  bench::report_bent_lattices(report);
  bench::report_height(report);
  bench::report_one_photograph(report);
  bench::report_stereo(report);
  bench::report_sizes(report);
  bench::report_photographs(report);
}

}  // namespace
}  // namespace papilla

int main(int argc, char** argv) {
  return papilla::bench::run_benchmark("texture-analysis", "Texture analysis", argc, argv, papilla::body);
}
