// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "noise.hpp"
#include "patterns.hpp"

namespace papilla::procedural_detail {
namespace {

/// Root mean square of noise_row().
constexpr double k_noise_rms = 0.28;
/// Three standard deviations fill [0, 1].
constexpr double k_spread = 1.0 / 6;
/// H beyond these has no power law that a finite sum could follow.
constexpr double k_least_h = 0.05, k_most_h = 0.95;

/// Octave k of a noise family at `cells` per unit, wrapped when the row has periods.
Octave octave_of(double cells, int k, std::uint32_t seed, double period_x, double period_y) {
  Octave o;
  o.frequency_x = fitted(cells, period_x);
  o.frequency_y = fitted(cells, period_y);
  if (period_x > 0) o.period_x = std::round(o.frequency_x * period_x);
  if (period_y > 0) o.period_y = std::round(o.frequency_y * period_y);
  const std::uint32_t hash = mix_bits(static_cast<std::uint32_t>(k), seed, 41);
  o.shift_x = (hash & 1023U) / 1024.0;  // Dyadic: adding whole periods changes no bit.
  o.shift_y = (hash >> 10 & 1023U) / 1024.0;
  o.seed = hash;
  return o;
}

void octave_row(const PatternRow& row, const Octave& o, double z, double* out) {
  if (z == 0) {
    noise_row(row.x, row.y, row.n, o, out);
    return;
  }
  double depth[k_row];
  std::fill_n(depth, row.n, z);
  noise_row(row.x, row.y, depth, row.n, o, out);
}

/// The parameter `octaves` within the least and the most.
double limited_octaves(const TypeArguments& arguments) {
  const double most = arguments.number("maximumoctaves");
  return std::clamp(arguments.number("octaves"), std::min(arguments.number("minimumoctaves"), most),
                    std::max(1.0, most));
}

enum class FbmKind { fbm, hetero, multi, hybrid, ridged };

class Fbm final : public Pattern {
 public:
  explicit Fbm(TypeArguments& arguments)
      : lacunarity_(arguments.number("lacunarity")),
        octaves_(limited_octaves(arguments)),
        gain_(arguments.number("gain")),
        offset_(arguments.number("offset")),
        z_(arguments.number("zvalue")),
        dynamic_(arguments.flag("dynamicoctaves")),
        least_(arguments.number("minimumoctaves")),
        seed_(arguments.seed()) {
    const std::string kind = arguments.text("type");
    kind_ = kind == "fbm"                  ? FbmKind::fbm
            : kind == "heteroterrain"      ? FbmKind::hetero
            : kind == "multifractal"       ? FbmKind::multi
            : kind == "hybridmultifractal" ? FbmKind::hybrid
                                           : FbmKind::ridged;
    weights_ = numbers_of(arguments, "weights");
    if (weights_.empty()) power_law(arguments.number("h"), arguments.flag("closed"));
    if (kind_ == FbmKind::fbm) {
      double squares = 0;
      for (const double w : weights_) squares += w * w;
      factor_ = gain_ / 0.67 * k_spread / (k_noise_rms * std::sqrt(std::max(squares, 1e-30)));
      middle_ = 0;
    } else {
      stretch_to_unit();
    }
  }

  void evaluate(const PatternRow& row) const override {
    raw(row);
    for (int i = 0; i < row.n; ++i) row.out[i] = 0.5 + factor_ * (row.out[i] - middle_);
  }

  void write_shader(PatternShader& shader) const override {
    shader.add("float value = 0.0;\nfloat weight = 0.0;\nfloat signal = 0.0;\nfloat noise = 0.0;\n");
    double cells = k_cells;
    for (std::size_t k = 0; k < weights_.size(); ++k, cells *= lacunarity_) {
      const double share = kept(cells, shader.texel, k);
      if (share <= 0) break;
      const double w = weights_[k] * share;
      if (w == 0 && k > 0) continue;
      const Octave octave = octave_of(cells, static_cast<int>(k), seed_, shader.period_x, shader.period_y);
      shader.add("noise = $noise;\n", {{"noise", shader.noise("$x", "$y", octave, z_)}});
      shader.add(octave_statements(k == 0), {{"w", w}, {"offset", offset_}, {"gain", gain_}});
    }
    shader.add("$out = 0.5 + $factor * (value - $middle);\n", {{"factor", factor_}, {"middle", middle_}});
  }

 private:
  /// w_k = lacunarity^(-H k). What the missing octaves beyond both ends would add to the variogram is added to the
  /// first (whose increments grow with r^2, as those of all slower octaves) and to the last one (whose increments are
  /// as saturated as those of all faster ones).
  void power_law(double h, bool closed) {
    const int count = static_cast<int>(std::ceil(octaves_));
    for (int k = 0; k < count; ++k) weights_.push_back(std::pow(lacunarity_, -h * k) * std::min(1.0, octaves_ - k));
    if (kind_ != FbmKind::fbm || !closed || lacunarity_ <= 1 || count < 2 || h < k_least_h || h > k_most_h) return;
    weights_.front() /= std::sqrt(1 - std::pow(lacunarity_, -2 * (1 - h)));
    weights_.back() /= std::sqrt(1 - std::pow(lacunarity_, -2 * h));
  }

  /// Weight left of an octave of that many cells per texel: none beyond the Nyquist frequency.
  double kept(double cells, double texel, std::size_t k) const {
    if (!dynamic_ || texel <= 0 || static_cast<double>(k) < least_) return 1;
    return std::clamp(2 - 4 * cells * texel, 0.0, 1.0);
  }

  void raw(const PatternRow& row) const {
    std::fill_n(row.out, row.n, 0.0);
    double noise[k_row], weight[k_row];
    const int n = row.n;
    double cells = k_cells;
    for (std::size_t k = 0; k < weights_.size(); ++k, cells *= lacunarity_) {
      const double share = kept(cells, row.texel, k);
      if (share <= 0) break;
      const double w = weights_[k] * share;
      if (w == 0 && k > 0) continue;
      octave_row(row, octave_of(cells, static_cast<int>(k), seed_, row.period_x, row.period_y), z_, noise);
      add_octave(k, w, noise, weight, row.out, n);
    }
  }

  void add_octave(std::size_t k, double w, const double* noise, double* weight, double* out, int n) const {
    switch (kind_) {
      case FbmKind::fbm:
        for (int i = 0; i < n; ++i) out[i] = (k == 0 ? 0 : out[i]) + w * noise[i];
        break;
      case FbmKind::hetero:
        for (int i = 0; i < n; ++i) out[i] = k == 0 ? offset_ + noise[i] : out[i] + (noise[i] + offset_) * w * out[i];
        break;
      case FbmKind::multi:
        for (int i = 0; i < n; ++i) out[i] = (k == 0 ? 1 : out[i]) * (w * noise[i] + offset_);
        break;
      case FbmKind::hybrid:
        for (int i = 0; i < n; ++i) {
          const double signal = (noise[i] + offset_) * w;
          if (k == 0) {
            out[i] = weight[i] = signal;
          } else {
            weight[i] = std::min(weight[i], 1.0);
            out[i] += weight[i] * signal;
            weight[i] *= signal;
          }
        }
        break;
      case FbmKind::ridged:
        for (int i = 0; i < n; ++i) {
          double signal = offset_ - std::abs(noise[i]);
          signal *= signal;
          if (k == 0) {
            out[i] = weight[i] = signal;
          } else {
            signal *= std::clamp(weight[i] * gain_, 0.0, 1.0);
            weight[i] = signal;
            out[i] += signal * w;
          }
        }
        break;
    }
  }

  /// add_octave() in a shader.
  std::string_view octave_statements(bool first) const {
    switch (kind_) {
      case FbmKind::fbm: return "value = value + $w * noise;\n";
      case FbmKind::hetero:
        return first ? "value = $offset + noise;\n" : "value = value + (noise + $offset) * $w * value;\n";
      case FbmKind::multi:
        return first ? "value = $w * noise + $offset;\n" : "value = value * ($w * noise + $offset);\n";
      case FbmKind::hybrid:
        return first
                   ? "value = (noise + $offset) * $w;\nweight = value;\n"
                   : "signal = (noise + $offset) * $w;\nweight = min(weight, 1.0);\nvalue = value + weight * signal;\n"
                     "weight = weight * signal;\n";
      case FbmKind::ridged: break;
    }
    return first ? "signal = $offset - abs(noise);\nvalue = signal * signal;\nweight = value;\n"
                 : "signal = $offset - abs(noise);\nsignal = signal * signal * clamp(weight * $gain, 0.0, 1.0);\n"
                   "weight = signal;\nvalue = value + signal * $w;\n";
  }

  /// Maps the middle 99 % of the values to [0, 1]: the kinds differ in range by powers of ten.
  void stretch_to_unit() {
    std::vector<double> values;
    double x[k_row], y[k_row], out[k_row];
    for (int block = 0; block < 16; ++block) {
      for (int i = 0; i < k_row; ++i) {
        const auto k = static_cast<std::uint32_t>(block * k_row + i);
        x[i] = 16 * unit_number(mix_bits(k, 1, 5)), y[i] = 16 * unit_number(mix_bits(k, 2, 5));
      }
      PatternRow row;
      row.n = k_row, row.x = x, row.y = y, row.out = out;
      raw(row);
      for (const double v : out)
        if (std::isfinite(v)) values.push_back(v);
    }
    if (values.empty()) return;
    std::sort(values.begin(), values.end());
    const double low = values[values.size() / 200], high = values[values.size() - 1 - values.size() / 200];
    middle_ = (low + high) / 2;
    factor_ = high > low ? 1 / (high - low) : 0;
  }

  FbmKind kind_ = FbmKind::fbm;
  double lacunarity_, octaves_, gain_, offset_, z_;
  bool dynamic_;
  double least_;
  std::uint32_t seed_;
  std::vector<double> weights_;
  double middle_ = 0, factor_ = 1;
};

/// Octaves of weight 2^-k, and what maps their sum to [0, 1].
struct Turbulence {
  explicit Turbulence(const TypeArguments& arguments)
      : octaves(limited_octaves(arguments)),
        least(arguments.number("minimumoctaves")),
        z(arguments.number("zvalue")),
        absolute(arguments.flag("absturb")),
        dynamic(arguments.flag("dynamicoctaves")),
        seed(arguments.seed()) {}

  /// Calls visit(octave, weight) for those that a row of this texel and these periods shows.
  /// @returns middle and factor.
  template <class Visit>
  std::pair<double, double> visit(double texel, double period_x, double period_y, Visit&& visit) const {
    double weights = 0, squares = 0;
    for (int k = 0; k < octaves; ++k) {
      const double cells = k_cells * std::ldexp(1.0, k);
      if (dynamic && k > 0 && k >= least && texel > 0 && cells * texel >= 0.5) break;
      const double w = std::ldexp(std::min(1.0, octaves - k), -k);
      visit(octave_of(cells, k, seed, period_x, period_y), w);
      weights += w, squares += w * w;
    }
    return absolute ? std::pair(0.0, 1 / (0.6 * weights)) : std::pair(0.5, k_spread / k_noise_rms / std::sqrt(squares));
  }

  double octaves, least, z;
  bool absolute, dynamic;
  std::uint32_t seed;
};

std::unique_ptr<Pattern> make_turbulence(TypeArguments& arguments) {
  const Turbulence turbulence(arguments);
  return row_pattern(
      [turbulence](const PatternRow& row) {
        double noise[k_row];
        std::fill_n(row.out, row.n, 0.0);
        const auto [middle, factor] =
            turbulence.visit(row.texel, row.period_x, row.period_y, [&](const Octave& octave, double w) {
              octave_row(row, octave, turbulence.z, noise);
              for (int i = 0; i < row.n; ++i) row.out[i] += w * (turbulence.absolute ? std::abs(noise[i]) : noise[i]);
            });
        for (int i = 0; i < row.n; ++i) row.out[i] = middle + factor * row.out[i];
      },
      [turbulence](PatternShader& shader) {
        shader.add("float sum = 0.0;\n");
        const auto [middle, factor] =
            turbulence.visit(shader.texel, shader.period_x, shader.period_y, [&](const Octave& octave, double w) {
              shader.add(turbulence.absolute ? "sum = sum + $w * abs($noise);\n" : "sum = sum + $w * $noise;\n",
                         {{"w", w}, {"noise", shader.noise("$x", "$y", octave, turbulence.z)}});
            });
        shader.add("$out = $middle + $factor * sum;\n", {{"middle", middle}, {"factor", factor}});
      });
}

std::unique_ptr<Pattern> make_noise(TypeArguments& arguments) {
  const std::uint32_t seed = arguments.seed();
  return row_pattern(
      [seed](const PatternRow& row) {
        octave_row(row, octave_of(k_cells, 0, seed, row.period_x, row.period_y), 0, row.out);
        for (int i = 0; i < row.n; ++i) row.out[i] = 0.5 + k_spread / k_noise_rms * row.out[i];
      },
      [seed](PatternShader& shader) {
        const Octave octave = octave_of(k_cells, 0, seed, shader.period_x, shader.period_y);
        shader.add("$out = 0.5 + $factor * $noise;\n",
                   {{"factor", k_spread / k_noise_rms}, {"noise", shader.noise("$x", "$y", octave)}});
      });
}

}  // namespace

void turbulence_row(const double* x, const double* y, int n, double cells, double octaves, bool absolute,
                    std::uint32_t seed, double* out) {
  double noise[k_row];
  std::fill_n(out, n, 0.0);
  for (int k = 0; k < octaves; ++k) {
    noise_row(x, y, n, octave_of(cells * std::ldexp(1.0, k), k, seed, 0, 0), noise);
    const double w = std::ldexp(std::min(1.0, octaves - k), -k);
    for (int i = 0; i < n; ++i) out[i] += w * (absolute ? std::abs(noise[i]) : noise[i]);
  }
}

double fitted(double wanted, double period, double multiple) {
  return period > 0 ? std::max(1.0, std::round(wanted * period / multiple)) * multiple / period : wanted;
}

std::unique_ptr<Pattern> make_noise_pattern(std::string_view type, TypeArguments& arguments) {
  if (type == "noise") return make_noise(arguments);
  if (type == "turbulence") return make_turbulence(arguments);
  if (type == "fbm") return std::make_unique<Fbm>(arguments);
  return nullptr;
}

}  // namespace papilla::procedural_detail
