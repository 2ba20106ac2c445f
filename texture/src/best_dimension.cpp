// SPDX-License-Identifier: MIT
#include "papilla/texture/best_dimension.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include "checks.hpp"
#include "sharp_hurst.hpp"
#include "spectrum_fit.hpp"

namespace papilla {
namespace {

using texture_detail::fit_spectrum;
using texture_detail::PointSpread;
using texture_detail::scan_spectrum;
using texture_detail::SpectrumBand;
using texture_detail::SpectrumCell;
using texture_detail::SpectrumFit;
using texture_detail::SpectrumModel;
using texture_detail::SurfaceSpectrumModel;

constexpr int k_least_side = 32;
constexpr double k_normal_95 = 1.959964;

/// Least step between the grey values in use, when the picture was rounded to `bits`; 0 for floating point.
double grey_step(const GreyImage& image) {
  if (image.bits != 8 && image.bits != 16) return 0;
  const int top = image.bits == 8 ? 255 : 65535;
  const int first = static_cast<int>(std::lround(static_cast<double>(image.pixels.front()) * top));
  int step = 0;
  for (const float value : image.pixels)
    step = std::gcd(step, std::abs(static_cast<int>(std::lround(static_cast<double>(value) * top)) - first));
  return static_cast<double>(step) / top;
}

/// ⟨(z(x + e) − 2 z(x) + z(x − e))²⟩ for the step e = (dx, dy), dx ≥ 0.
double second_difference(const GreyImage& image, int dx, int dy) {
  const auto step = static_cast<std::ptrdiff_t>(dy) * image.width + dx;
  double sum = 0;
  for (int y = std::abs(dy); y < image.height - std::abs(dy); ++y) {
    const float* row = image.pixels.data() + image.index(0, y);
    double squares = 0;
    for (int x = dx; x < image.width - dx; ++x) {
      const double d = static_cast<double>((row[x + step] - row[x]) + (row[x - step] - row[x]));
      squares += d * d;
    }
    sum += squares;
  }
  return sum / (static_cast<double>(image.width - 2 * dx) * (image.height - 2 * std::abs(dy)));
}

std::vector<ScalePoint> second_difference_curve(const GreyImage& image) {
  std::vector<ScalePoint> curve;
  for (const int lag : {1, 2, 3, 4, 6, 8, 12, 16, 24, 32}) {
    if (4 * lag > std::min(image.width, image.height)) break;
    curve.push_back({static_cast<double>(lag),
                     std::sqrt((second_difference(image, lag, 0) + second_difference(image, 0, lag)) / 2)});
  }
  return curve;
}

/// Rings of equal width in ln f.
std::size_t ring_of(const SpectrumCell& cell) {
  constexpr double k_rings_per_log = 7, k_lowest_log = -12;
  return static_cast<std::size_t>(
      std::max(0.0, (0.5 * std::log(cell.frequency_squared()) - k_lowest_log) * k_rings_per_log));
}

/// The spectrum over the model by distance from the origin.
struct RingRatio {
  double ratio = 0, count = 0;
};

std::vector<RingRatio> ring_ratios(std::span<const SpectrumCell> cells, const SpectrumFit& fit,
                                   const SpectrumBand& band) {
  std::vector<RingRatio> rings;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (!band.holds(cells[c])) continue;
    const std::size_t index = ring_of(cells[c]);
    if (rings.size() <= index) rings.resize(index + 1);
    RingRatio& ring = rings[index];
    for (std::size_t m = 0; m < 2; ++m) {
      ring.ratio += cells[c].count[m] * cells[c].power[m] / fit.power[2 * c + m];
      ring.count += cells[c].count[m];
    }
  }
  std::erase_if(rings, [](const RingRatio& ring) { return !(ring.count > 0); });
  for (RingRatio& ring : rings) ring.ratio /= ring.count;
  return rings;
}

/// How far the rings are off.
struct Misfit {
  double chi2_per_dof = 1;
  double rms = 0;  ///< Of ln(spectrum / model) over rings, the part of chance taken away.
};

Misfit misfit_of(const std::vector<RingRatio>& rings) {
  constexpr int k_fitted = 4;
  constexpr double k_few = 30;  // Rings of fewer frequencies say little.
  double chi2 = 0, squares = 0, weights = 0;
  for (const RingRatio& ring : rings) {
    chi2 += ring.count * (ring.ratio - 1) * (ring.ratio - 1);
    const double log = std::log(std::max(1e-6, ring.ratio));
    const double weight = ring.count / (ring.count + k_few);
    squares += weight * (log * log - 1 / ring.count);
    weights += weight;
  }
  return {chi2 / std::max(1.0, static_cast<double>(rings.size()) - k_fitted),
          std::sqrt(std::max(0.0, squares / weights))};
}

/// Fits of one band with their weights.
struct Mixture {
  std::vector<SpectrumFit> fits;
  std::vector<double> weights;
  SpectrumBand band;
  Misfit misfit;  ///< Of the likeliest.
  double hurst = 0, low = 0, high = 0;

  /// The sharp model with no noise but that of rounding is the likeliest: second differences are more precise than the
  /// spectrum.
  bool is_sharp(double rounding) const {
    constexpr double k_much_noise = 2;  // Rounding that is not white passes for as much.
    return !best().model.blurred && (!best().model.noisy || best().noise < k_much_noise * rounding);
  }
  const SpectrumFit& best() const {
    return fits[static_cast<std::size_t>(std::max_element(weights.begin(), weights.end()) - weights.begin())];
  }
};

/// What a fit's further parameters cost. A sharp picture without noise is the only model with two parameters, and keeps
/// its precision by Schwarz's criterion; with noise, sharp and blurred can't be told apart and both count; so
/// they do where the band lacks the highest frequencies.
double penalty(const SpectrumFit& fit, double log_count, bool has_top) {
  constexpr double k_sharp_in_noise = 3, k_no_surface = 10;
  if (!fit.model.noisy) return fit.model.blurred && has_top ? log_count : 0;
  const bool at_bound = fit.hurst > 0.99 && !fit.model.blurred;
  return log_count + (fit.model.blurred ? k_sharp_in_noise : 0) + (at_bound ? k_no_surface : 0);
}

/// Probability of H below `hurst` in the mixture.
double mixture_share(const Mixture& mixture, double hurst, double widening) {
  double share = 0;
  for (std::size_t i = 0; i < mixture.fits.size(); ++i) {
    const double deviation = std::max(1e-6, widening * mixture.fits[i].hurst_deviation);
    share += mixture.weights[i] * 0.5 * std::erfc((mixture.fits[i].hurst - hurst) / (deviation * std::numbers::sqrt2));
  }
  return share;
}

double mixture_quantile(const Mixture& mixture, double probability, double widening) {
  double low = -1, high = 2;
  for (int i = 0; i < 50; ++i) {
    const double middle = (low + high) / 2;
    (mixture_share(mixture, middle, widening) < probability ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// Deviations by Fisher's information are those of an ideal window and of independent cells; measured on exact
/// surfaces.
constexpr double k_fisher_widening = 1.6;

/// Frequency at which the noise is as strong as the sharp surface.
double noise_crossing(const SpectrumFit& fit, double rounding) {
  const double noise = fit.noise + rounding;
  return noise > 0 ? std::pow(fit.amplitude / noise, 0.5 / (fit.hurst + 1)) : 1;
}

/// Highest frequency at which the point spread halves the power at most, and the noise is no more than the surface.
double highest_frequency(const SpectrumFit& fit, double rounding) {
  double f = 0.5;
  if (fit.model.blurred && fit.spread_squared > 0)
    f = std::min(f, std::sqrt(std::numbers::ln2 / fit.spread_squared) / (2 * std::numbers::pi));
  return std::min(f, noise_crossing(fit, rounding));
}

Mixture fit_band(std::span<const SpectrumCell> cells, const SurfaceSpectrumModel& surface, const SpectrumBand& band,
                 double rounding) {
  Mixture mixture;
  mixture.band = band;
  double count = 0;
  for (const SpectrumCell& cell : cells)
    if (band.holds(cell)) count += cell.count[0] + cell.count[1];
  const auto scan = [&](bool blurred, bool noisy) {
    return scan_spectrum(cells, {PointSpread::optical, blurred, noisy}, band, rounding);
  };
  const auto fit = [&](const SpectrumModel& model, const SpectrumFit& start) {
    mixture.fits.push_back(fit_spectrum(cells, surface, model, band, rounding, start));
  };
  const auto fit_pair = [&](PointSpread spread, const SpectrumFit& quiet, const SpectrumFit& noisy) {
    // A picture that can't do without noise need not be tried without.
    const bool blurred = quiet.model.blurred, needs_noise = blurred && quiet.misfit > 5 * noisy.misfit + 300;
    if (!needs_noise) fit({spread, blurred, false}, quiet);
    const bool little = !needs_noise && noisy.misfit > quiet.misfit - 20;
    const SpectrumFit start = little ? mixture.fits.back() : noisy;
    fit({spread, blurred, true}, start);
  };
  fit_pair(PointSpread::optical, scan(false, false), scan(false, true));
  const SpectrumFit quiet = scan(true, false), noisy = scan(true, true);
  for (const PointSpread spread :
       {PointSpread::optical, PointSpread::pixel, PointSpread::band_limited, PointSpread::filtered})
    fit_pair(spread, quiet, noisy);
  // The kernel's transfer is the filter's but near the highest frequencies, where the scan knows nothing of it.
  const SpectrumFit filtered = mixture.fits.back();
  const SpectrumFit& before = mixture.fits[mixture.fits.size() - 2];
  const bool has_quiet = before.model.spread == PointSpread::filtered;
  SpectrumFit quiet_filtered = has_quiet ? before : quiet;
  if (!has_quiet) quiet_filtered.misfit = 1e300;
  fit_pair(PointSpread::kernel, quiet_filtered, filtered);

  const double log_count = std::log(std::max(2.0, count));
  const auto criterion = [&](const SpectrumFit& f, double scale) {
    return f.misfit / scale + penalty(f, log_count, band.most >= 0.5);
  };
  const SpectrumFit& likeliest =
      *std::min_element(mixture.fits.begin(), mixture.fits.end(),
                        [&](const SpectrumFit& a, const SpectrumFit& b) { return criterion(a, 1) < criterion(b, 1); });
  mixture.misfit = misfit_of(ring_ratios(cells, likeliest, band));
  // Where the model is not exact, differences of the likelihood are exaggerated as much as the misfit.
  const double scale = std::max(1.0, mixture.misfit.chi2_per_dof);
  const double least = criterion(likeliest, scale);
  double sum = 0;
  for (const SpectrumFit& f : mixture.fits)
    sum += mixture.weights.emplace_back(std::exp(std::min(50.0, -0.5 * (criterion(f, scale) - least))));
  for (std::size_t i = 0; i < mixture.fits.size(); ++i)
    mixture.hurst += (mixture.weights[i] /= sum) * mixture.fits[i].hurst;
  constexpr double k_less_exact = 2;  // A band that was chosen for its fit fits too well.
  const bool chosen = band.most < 0.5 || band.least > 0;
  // Nor is rounding white noise where nothing else moves the grey values by its step.
  const bool rounded = !likeliest.model.noisy && rounding > 0 && noise_crossing(likeliest, rounding) < 0.5;
  const double widening = k_fisher_widening * std::sqrt(scale) * (chosen || rounded ? k_less_exact : 1);
  mixture.low = std::min(mixture.hurst, mixture_quantile(mixture, 0.025, widening));
  mixture.high = std::max(mixture.hurst, mixture_quantile(mixture, 0.975, widening));
  return mixture;
}

/// Median of spectrum over model by ring: what lies between the peaks, also where the model is off.
std::vector<double> ring_medians(std::span<const SpectrumCell> cells, const SpectrumFit& fit) {
  std::vector<std::vector<double>> ratios;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const std::size_t ring = ring_of(cells[c]);
    if (ratios.size() <= ring) ratios.resize(ring + 1);
    for (std::size_t m = 0; m < 2; ++m)
      if (cells[c].count[m] > 0) ratios[ring].push_back(cells[c].power[m] / fit.power[2 * c + m]);
  }
  std::vector<double> medians;
  for (std::vector<double>& ring : ratios) {
    const auto middle = ring.begin() + static_cast<std::ptrdiff_t>(ring.size() / 2);
    std::nth_element(ring.begin(), middle, ring.end());
    medians.push_back(ring.empty() ? 1 : *middle);
  }
  return medians;
}

/// Share of the picture's power, every octave alike for H = 0, in single frequencies far above those around.
double peak_share(std::span<const SpectrumCell> cells, const SpectrumFit& fit) {
  constexpr double k_chance = 20;  // e^−20 of the frequencies of noise are as far above their mean.
  const std::vector<double> medians = ring_medians(cells, fit);
  double peaks = 0, all = 0;
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (std::size_t m = 0; m < 2; ++m) {
      if (!(cells[c].count[m] > 0)) continue;
      const double level = cells[c].frequency_squared(), around = fit.power[2 * c + m] * medians[ring_of(cells[c])];
      all += cells[c].count[m] * cells[c].power[m] * level;
      if (cells[c].largest[m] > k_chance * around) peaks += cells[c].largest[m] * level;
    }
  return all > 0 ? peaks / all : 0;
}

constexpr double k_exact_chi2 = 4, k_exact_part_chi2 = 1.6;
constexpr double k_tolerable_misfit = 0.2;  // A fifth of the power, rms over the rings.

/// The widest band that a single law fits, at least three octaves, or most of those that the picture holds.
Mixture fit_widest_band(std::span<const SpectrumCell> cells, const SurfaceSpectrumModel& surface, double rounding) {
  double least = 1;
  for (const SpectrumCell& cell : cells) least = std::min(least, cell.frequency_squared());
  least = std::sqrt(least);
  Mixture whole = fit_band(cells, surface, {0, 1}, rounding);
  if (whole.misfit.rms <= k_tolerable_misfit && whole.misfit.chi2_per_dof < k_exact_chi2) return whole;
  const double octaves = std::log2(0.5 / least);
  Mixture best = whole;
  std::vector<SpectrumBand> bands = {{0, 0.35}, {2 * least, 1}, {2 * least, 0.35}, {0, 0.25}, {4 * least, 1}};
  // Rounding is no white noise where the grey values change by less than its step from pixel to pixel.
  if (rounding > 0) bands.insert(bands.end(), {{0, 0.18}, {0, 0.125}, {0, 0.09}, {0, 0.06}});
  for (const SpectrumBand& band : bands) {
    const double kept = std::log2(std::min(0.5, band.most) / std::max(least, band.least));
    if (kept < std::min(3.0, 0.8 * octaves) || kept < 0.6 * octaves) continue;
    Mixture part = fit_band(cells, surface, band, rounding);
    if (part.misfit.rms < 0.6 * best.misfit.rms || part.high - part.low < 0.6 * (best.high - best.low))
      best = std::move(part);
    if (best.misfit.rms <= k_tolerable_misfit && best.misfit.chi2_per_dof < k_exact_part_chi2) break;
  }
  return best;
}

std::optional<std::array<double, 4>> directional_hurst(std::span<const SpectrumCell> cells, const Mixture& mixture,
                                                       double rounding) {
  constexpr std::array<double, 4> k_angles = {0, 90, 45, -45};
  std::array<double, 4> result{};
  for (std::size_t d = 0; d < k_angles.size(); ++d) {
    std::vector<SpectrumCell> part;
    for (const SpectrumCell& cell : cells) {
      SpectrumCell kept = cell;
      for (std::size_t m = 0; m < 2; ++m) {
        const double angle = std::atan2(m == 1 ? -cell.fy : cell.fy, cell.fx) - k_angles[d] * std::numbers::pi / 180;
        if (std::abs(std::sin(angle)) > std::sin(std::numbers::pi / 8)) kept.count[m] = 0;
      }
      if (kept.count[0] + kept.count[1] > 0) part.push_back(kept);
    }
    constexpr std::size_t k_least_cells = 20;
    if (part.size() < k_least_cells) return std::nullopt;
    const SpectrumFit& best = mixture.best();
    SpectrumModel model = best.model;
    const SurfaceSpectrumModel surface(part);
    result[d] = fit_spectrum(part, surface, model, mixture.band, rounding, best).hurst;
  }
  return result;
}

/// Why there is no dimension; empty when there is one.
std::string objection(std::span<const SpectrumCell> cells, const Mixture& mixture, double rounding) {
  constexpr double k_widest_spread = 2.5, k_periodic_share = 0.1, k_widest_interval = 0.8;
  const SpectrumFit& best = mixture.best();
  if (peak_share(cells, best) > k_periodic_share)
    return "periodic: single frequencies hold more than a tenth of the power";
  const bool smooth = (mixture.hurst > 0.97 && mixture.low > 0.9) || std::sqrt(best.spread_squared) > k_widest_spread;
  if (smooth) return "smooth at the scale of a pixel: the spectrum falls faster than that of any self-affine surface";
  if (mixture.hurst < 0.02 && mixture.high < 0.1)
    return "level: the spectrum does not rise towards long waves, as that of noise";
  if (mixture.misfit.rms > k_tolerable_misfit)
    return "no single power law: the log-log curve bends, as of two regimes or one scale of its own";
  const double highest = highest_frequency(best, rounding);
  double least = 1;
  for (const SpectrumCell& cell : cells)
    if (mixture.band.holds(cell)) least = std::min(least, cell.frequency_squared());
  if (highest < 1.5 * std::sqrt(least)) return "noise and point spread hide the surface at every scale";
  if (mixture.high - mixture.low > k_widest_interval) return "too uncertain: the interval is wider than 0.8";
  return "";
}

}  // namespace

BestDimension best_dimension(const GreyImage& image, double longest_wave_px) {
  texture_detail::require_image(image, "best_dimension", k_least_side);
  BestDimension result;
  result.quantization_step = grey_step(image);
  result.curve = second_difference_curve(image);
  const auto [low, high] = std::minmax_element(image.pixels.begin(), image.pixels.end());
  if (!(*high > *low)) {
    result.reason = "flat: a single grey value";
    return result;
  }
  std::vector<SpectrumCell> cells = texture_detail::spectrum_cells(image);
  std::erase_if(cells, [&](const SpectrumCell& cell) {
    return cell.frequency_squared() * longest_wave_px * longest_wave_px < 1;
  });
  if (std::none_of(cells.begin(), cells.end(), [](const SpectrumCell& c) { return c.power[0] + c.power[1] > 0; })) {
    result.reason = "flat: a plane";
    return result;
  }
  const double rounding = result.quantization_step * result.quantization_step / 12;
  const SurfaceSpectrumModel surface(cells);
  const Mixture mixture = fit_widest_band(cells, surface, rounding);
  const SpectrumFit& best = mixture.best();
  result.psf_sigma_px = std::sqrt(best.spread_squared);
  result.noise_rms = std::sqrt(best.noise + rounding);
  result.chi2_per_dof = mixture.misfit.chi2_per_dof;
  result.reason = objection(cells, mixture, rounding);
  if (!result.reason.empty()) return result;

  double least = 1;
  for (const SpectrumCell& cell : cells)
    if (mixture.band.holds(cell)) least = std::min(least, cell.frequency_squared());
  result.most_scale_px = 1 / std::sqrt(least);
  result.least_scale_px = std::max(2.0, 1 / std::min({0.5, mixture.band.most, highest_frequency(best, rounding)}));
  FractalEstimate& estimate = result.estimate.emplace();
  double hurst = mixture.hurst;
  if (mixture.is_sharp(rounding)) {
    const double sharp = texture_detail::sharp_hurst(image, result.quantization_step);
    if (sharp > mixture.low && sharp < mixture.high) hurst = sharp;
  }
  estimate.hurst = std::clamp(hurst, 0.0, 1.0);
  estimate.dimension = 3 - estimate.hurst;
  estimate.low = std::clamp(3 - mixture.high, 2.0, estimate.dimension);
  estimate.high = std::clamp(3 - mixture.low, estimate.dimension, 3.0);
  estimate.curve = result.curve;
  result.directional_hurst = directional_hurst(cells, mixture, rounding);
  result.reason = std::string("a power law") + (best.model.blurred ? ", seen through a point spread" : "") +
                  (best.model.noisy ? " in noise" : "");
  return result;
}

}  // namespace papilla
