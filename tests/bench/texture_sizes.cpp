// SPDX-License-Identifier: MIT
#include "bench/texture_sizes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "bench/whole_process.hpp"
#include "io/temporary_folder.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/shading.hpp"
#include "papilla/texture/shape_from_shading.hpp"

namespace papilla::bench {
namespace {

/// A lit relief that repeats every 37.3 × 29.1 pixels, with noise.
GreyImage picture(int side) {
  GreyImage image{side, side, {}, 0.05, 8};
  std::uint64_t state = 1;
  const auto noise = [&] {
    state = state * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(state >> 40) / (1 << 24) - 0.5;
  };
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const double u = 2 * std::numbers::pi * x / 37.3, v = 2 * std::numbers::pi * y / 29.1;
      const double grey = 0.5 + 0.2 * std::cos(u) * std::cos(v) + 0.1 * std::cos(2 * u + v) + 0.1 * noise();
      image.pixels.push_back(static_cast<float>(grey));
    }
  return image;
}

struct Verb {
  const char* name;
  std::vector<std::string> arguments;
  int most_side;
};

/// One row a verb and size; the cost of the program's start is part of it.
void report_verbs(BenchReport& report) {
  const test::TemporaryFolder folder;
  const int least = report.options().quick ? 64 : 2048, most = report.options().quick ? 128 : 8192;
  const std::vector<Verb> verbs = {
      {"analyze", {"analyze"}, most},
      {"prepare", {"prepare", "-o", folder / "prepared.png"}, most},
      {"height intensity", {"height", "--method", "intensity", "-o", folder / "h.exr"}, most},
      {"height pentland", {"height", "--method", "pentland", "-o", folder / "h.exr"}, most},
      {"height variational",
       {"height", "--method", "variational", "-o", folder / "h.exr"},
       report.options().quick ? 128 : 4096}};
  EvidenceTable table{"Large pictures",
                      "8-bit pictures of a noisy lit relief, every verb as a whole process. Memory is the peak of the "
                      "process; the share that does not grow with the picture counts in full.",
                      {"verb", "side", "processor time [µs/pixel]", "peak [MiB]", "peak [bytes/pixel]"},
                      {}};
  double worst = 0;
  for (const Verb& verb : verbs) {
    double first = 0;
    for (int side = least; side <= verb.most_side; side *= 2) {
      const std::string file = folder / fmt::format("{}.png", side);
      if (!std::filesystem::exists(file)) write_grey_image(file, picture(side), 8);
      std::vector<std::string> command = {PAPILLA_PROGRAM};
      command.insert(command.end(), verb.arguments.begin(), verb.arguments.end());
      command.push_back(file);
      const ProcessCost cost = run_process(command);
      const double pixels = static_cast<double>(side) * side, us = 1e6 * cost.cpu_seconds / pixels;
      const auto bytes = static_cast<double>(cost.peak_bytes);
      table.rows.push_back({verb.name, std::to_string(side), fmt::format("{:.2f}", us),
                            fmt::format("{:.0f}", bytes / (1 << 20)), fmt::format("{:.1f}", bytes / pixels)});
      if (side == least) first = us;
      worst = std::max(worst, us / first);
    }
  }
  report.target({"large pictures: time per pixel does not grow with the picture",
                 fmt::format("at most {:.2f} times that of {}²", worst, least),
                 report.options().quick ? std::nullopt : std::optional(worst <= 2)});
  report.table(std::move(table));
}

double rms_share(const std::vector<double>& a, const std::vector<double>& b) {
  double squares = 0;
  for (std::size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i]) * (a[i] - b[i]);
  const auto [low, high] = std::minmax_element(b.begin(), b.end());
  return std::sqrt(squares / static_cast<double>(a.size())) / (*high - *low);
}

/// Pieces against the whole, on a picture that still can be solved as one.
void report_seams(BenchReport& report) {
  const int side = report.options().quick ? 128 : 1536, piece = report.options().quick ? 64 : 1024;
  HeightMap relief{side, side, {}, 1, 1, true};
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      double sum = 0;
      for (const int n : {5, 23, 61})
        sum += std::sin(2 * std::numbers::pi * n * x / side + n) *
               std::sin(2 * std::numbers::pi * (n + 1) * y / side + 2 * n) * side / (20.0 * n);
      relief.mm.push_back(static_cast<float>(sum));
    }
  ShadingOptions options;
  options.light = {-1, -0.5, 1.5};
  options.periodic = true;
  const GreyImage image = render_lambert(relief, options.light);
  const auto difference = [&](ShadingResult (*solve)(const GreyImage&, const ShadingOptions&)) {
    options.largest_piece_px = side;
    const ShadingResult whole = solve(image, options);
    options.largest_piece_px = piece;
    return rms_share(solve(image, options).height_px, whole.height_px);
  };
  const double tsai_shah = difference(shape_from_shading_tsai_shah);
  const double pentland = difference(shape_from_shading_pentland);
  const double variational = difference(shape_from_shading_variational);
  report.target({"large pictures: shape from shading in pieces is that of the whole",
                 fmt::format("rms difference over the range, {0}² in pieces of {1}: tsai-shah {2:.2g} %, pentland "
                             "{3:.1f} %, variational {4:.1f} %",
                             side, piece / 2, 100 * tsai_shah, 100 * pentland, 100 * variational),
                 report.options().quick ? std::nullopt
                                        : std::optional(tsai_shah == 0 && pentland <= 0.05 && variational <= 0.05)});
}

}  // namespace

void report_sizes(BenchReport& report) {
  report_verbs(report);
  report_seams(report);
}

}  // namespace papilla::bench
