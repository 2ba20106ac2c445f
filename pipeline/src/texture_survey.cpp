// SPDX-License-Identifier: MIT
#include "papilla/pipeline/texture_survey.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/image_bands.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/analysis_pictures.hpp"
#include "papilla/texture/picture_relief.hpp"
#include "papilla/texture/resample.hpp"
#include "papilla/texture/texture_order.hpp"
#include "papilla/texture/texture_reading.hpp"
#include "pictures/pixel_text.hpp"
#include "pictures/texture_plots.hpp"

namespace papilla {
namespace {

constexpr std::int64_t k_most_band_pixels = std::int64_t{1} << 26;
constexpr int k_least_band_rows = 128;

/// First pixel of part k of `count` equal parts of a side.
int part_begin(int k, int count, int side) { return static_cast<int>(std::int64_t{k} * side / count); }

int part_count(std::int64_t side, std::int64_t most) { return static_cast<int>((side + most - 1) / most); }

/// Rows and columns of the centred part of a side, at most `most` long.
struct Window {
  int begin, length;
  Window(int side, int most) : begin((side - std::min(side, most)) / 2), length(std::min(side, most)) {}
};

/// Collects the middle of a picture from its bands.
class MiddlePart {
 public:
  MiddlePart(int width, int height, int most) : across_(width, most), down_(height, most) {}

  void add(const GreyImage& band, int top) {
    const int first = std::max(top, down_.begin), last = std::min(top + band.height, down_.begin + down_.length);
    if (first >= last) return;
    const GreyImage part = crop(band, across_.begin, first - top, across_.length, last - first);
    image_.pixels.insert(image_.pixels.end(), part.pixels.begin(), part.pixels.end());
    image_.width = part.width;
    image_.height += part.height;
    image_.pitch_mm = part.pitch_mm;
    image_.bits = part.bits;
    image_.curve = part.curve;
  }
  GreyImage take() { return std::move(image_); }

 private:
  Window across_, down_;
  GreyImage image_;
};

bool needs_lattice(const SurveyOptions& options) {
  return options.symmetry || options.order || !options.pictures.empty();
}

SymmetryAnalysis symmetry_of(const GreyImage& image, const SurveyOptions& options, const ProgressCallback& progress) {
  report_progress(progress, "symmetry", 0);
  SymmetryAnalysis analysis = analyze_symmetry(image, options.lattice, options.feature, progress);
  report_progress(progress, "symmetry", 1);
  return analysis;
}

/// Whether the class of the picture asks for the readings; else says why not.
bool wants_fractal(const SurveyOptions& options, TextureSurvey& survey) {
  if (!options.fractal || !options.by_class || !survey.order) return options.fractal;
  const PlanStep& step = step_of(survey.order->plan, "fractal_dimension");
  if (!step.run) survey.no_fractal = step.reason;
  return step.run;
}

void survey_whole(const ImageBands& bands, const SurveyOptions& options, const ProgressCallback& progress,
                  TextureSurvey& survey) {
  std::optional<TextureReading> reading;
  if (needs_lattice(options)) {
    reading = read_texture(survey.middle, {options.lattice, options.feature, false, {}, progress});
    if (options.order)
      survey.order = OrderSurvey{reading->kind, orientation_field(survey.middle), reading->suitability,
                                 is_monochrome(bands.sample()), reading->plan};
  }
  if (wants_fractal(options, survey)) survey.fractal = read_fractal_dimensions(survey.middle, progress);
  if (survey.order) {
    if (survey.fractal) reading->roughness = survey.fractal->best;
    survey.order->plan = plan_relief(survey.middle, *reading);
  }
  if (reading) survey.symmetry = std::move(reading->symmetry);
}

/// Drops the lattice of the middle unless enough pieces have it too.
void confirm_lattice(SymmetryAnalysis& symmetry, const std::vector<Lattice>& lattices, LatticeAgreement& agreement) {
  for (const Lattice& lattice : lattices) agreement.add(symmetry.lattice, lattice);
  if (!symmetry.lattice.found || agreement.holds()) return;
  symmetry.lattice.found = false;
  symmetry.lattice.vectors_px = {};
  symmetry.part.reset();
  symmetry.straight.reset();
  symmetry.deformation.reset();
  symmetry.lattice.reason =
      fmt::format("the middle repeats, but only {} of {} pieces do so likewise", agreement.same, agreement.pieces());
}

void survey_pieces(ImageBands& bands, const SurveyOptions& options, const ProgressCallback& progress,
                   TextureSurvey& survey) {
  const int side = options.largest_px / 2;
  PieceSurvey pieces;
  pieces.columns = part_count(survey.width, side);
  pieces.rows = std::max(part_count(survey.height, side),
                         part_count(std::int64_t{survey.width} * survey.height, k_most_band_pixels));
  if (survey.height > k_least_band_rows && survey.height / pieces.rows < k_least_band_rows / 2)
    throw InvalidInput(fmt::format("{} x {} pixels are too wide to be read in bands", survey.width, survey.height));
  MiddlePart middle(survey.width, survey.height, side);
  TextureOrder order;
  std::vector<FractalReadings> readings;
  std::vector<Lattice> lattices;
  const double count = static_cast<double>(pieces.columns) * pieces.rows;
  double done = 0;
  for (int row = 0; row < pieces.rows; ++row) {
    const int top = part_begin(row, pieces.rows, survey.height);
    const GreyImage band = bands.next(part_begin(row + 1, pieces.rows, survey.height) - top);
    middle.add(band, top);
    for (int column = 0; column < pieces.columns; ++column) {
      report_progress(progress, "pieces of the picture", done++ / count);
      const int left = part_begin(column, pieces.columns, survey.width);
      const GreyImage piece =
          crop(band, left, 0, part_begin(column + 1, pieces.columns, survey.width) - left, band.height);
      if (options.fractal) readings.push_back(read_fractal_dimensions(piece));
      if (options.order) order.add(piece);
      if (!needs_lattice(options)) continue;
      lattices.push_back(find_lattice(feature_matrix(piece), options.lattice));
      lattices.back().minima = {};
    }
  }
  report_progress(progress, "pieces of the picture", 1);
  survey.middle = middle.take();
  if (needs_lattice(options)) {
    survey.symmetry = symmetry_of(survey.middle, options, progress);
    confirm_lattice(*survey.symmetry, lattices, pieces.lattice);
  }
  if (options.order)
    survey.order = OrderSurvey{order.classify(survey.symmetry->explained_variance(), survey.symmetry->lattice.stripes),
                               order.orientation(pieces.columns, pieces.rows),
                               order.suitability(survey.symmetry->lattice),
                               is_monochrome(bands.sample()),
                               {}};
  if (survey.order) survey.order->plan = plan_analysis(survey.order->kind, survey.order->suitability);
  if (!readings.empty() && wants_fractal(options, survey)) survey.fractal = mean_readings(readings);
  survey.pieces = pieces;
}

SymmetryGroups groups_of(const TextureSurvey& survey, SymmetryPattern pattern) {
  SymmetryGroups groups;
  const SymmetryAnalysis& symmetry = *survey.symmetry;
  if (symmetry.lattice.found) groups.plane = find_wallpaper_group(symmetry);
  const GreyImage& image = survey.middle;
  if (pattern == SymmetryPattern::strip) groups.strip = find_frieze_group(image);
  if (pattern == SymmetryPattern::rosette)
    groups.rosette = find_rosette_group(image, {(image.width - 1) / 2.0, (image.height - 1) / 2.0});
  return groups;
}

std::vector<SurveyPicture> draw_survey(const TextureSurvey& survey, const std::filesystem::path& folder) {
  make_folder(folder);
  const auto file = [&](const char* name) { return (folder / name).string(); };
  std::vector<std::string> captions = {"picture", "feature matrix", "no lattice", "", ""};
  if (survey.symmetry->part) captions = {"lattice", "feature matrix", "primitive", "synthesis", "rest"};
  write_color_image(file("symmetry.png"), with_captions(symmetry_strip(*survey.symmetry), captions));
  std::vector<SurveyPicture> pictures{{"symmetry", file("symmetry.png")}};
  if (!survey.fractal || !survey.fractal->best) return pictures;
  const auto draw = [&](const char* name, const std::string& path, const Plot& plot) {
    pictures.push_back({name, path, write_plot(path, plot)});
  };
  draw("log-log", file("log-log.svg"), log_log_plot(named_readings(*survey.fractal)));
  draw("hurst", file("hurst.svg"), hurst_plot(*survey.fractal->fshot));
  return pictures;
}

}  // namespace

std::array<FractalReading, 6> named_readings(const FractalReadings& readings) {
  const auto reading = [](std::string_view name, int side, const FractalEstimate* estimate) {
    return FractalReading{name, side, estimate, estimate != nullptr ? &estimate->curve : nullptr};
  };
  const auto of = [](const auto& value) { return value ? &*value : nullptr; };
  FractalReading best = reading("best", k_least_fractal_side, nullptr);
  if (readings.best) {
    best.estimate = of(readings.best->estimate);
    best.curve = &readings.best->curve;
    if (!readings.best->power_law()) best.none = readings.best->reason;
  }
  return {reading("box", k_least_fractal_side, of(readings.box)),
          reading("information", k_least_fractal_side, of(readings.information)),
          reading("correlation", k_least_fractal_side, of(readings.correlation)),
          reading("probability", k_least_probability_side, of(readings.probability)),
          reading("fshot", k_least_fractal_side, readings.fshot ? &readings.fshot->estimate : nullptr),
          best};
}

TextureSurvey survey_picture(const std::filesystem::path& path, const SurveyOptions& options,
                             const ProgressCallback& progress) {
  ImageBands bands(path);
  TextureSurvey survey;
  survey.width = bands.width();
  survey.height = bands.height();
  survey.bits = bands.bits();
  survey.pitch_mm = options.pitch_mm > 0 ? options.pitch_mm : bands.pitch_mm();
  if (std::max(survey.width, survey.height) > options.largest_px) {
    survey_pieces(bands, options, progress, survey);
  } else {
    survey.middle = bands.next(survey.height);
    survey_whole(bands, options, progress, survey);
  }
  if (options.symmetry) survey.groups = groups_of(survey, options.pattern);
  if (!options.pictures.empty()) survey.pictures = draw_survey(survey, options.pictures);
  return survey;
}

}  // namespace papilla
