// SPDX-License-Identifier: GPL-3.0-or-later
#include "text/touch_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "shown_format.hpp"
#include "text/hertz.hpp"

namespace papilla::app {
namespace {

constexpr std::size_t k_listed = 20;  // Pairs of a kind.

std::string differences_text(const MaterialPair& pair) {
  std::string text;
  for (std::size_t k = 0; k < k_touch_quantities; ++k) {
    const auto& difference = pair.difference[k];
    if (difference && std::isfinite(*difference))
      text += shown_format("{}{} {:.2f}", text.empty() ? "" : ", ", weber_fractions()[k].name, *difference);
  }
  return text;
}

std::string pairs_of(const TouchReport& report, PairVerdict verdict, const char* heading) {
  std::string lines;
  std::size_t count = 0;
  for (const MaterialPair& pair : report.pairs) {
    if (pair.verdict != verdict || ++count > k_listed) continue;
    lines += shown_format("  {} | {}: {} ({})\n", report.materials[pair.a].name, report.materials[pair.b].name,
                          pair.reason, differences_text(pair));
  }
  if (count == 0) return "";
  if (count > k_listed) lines += shown_format("  and {} more\n", count - k_listed);
  return shown_format("{}:\n", heading) + lines;
}

std::string receptors_text(const FeltWaves& felt) {
  std::string text;
  for (const ReceptorShare& share : felt.receptors)
    text += shown_format("{}{} {:.0f} %", text.empty() ? "" : ", ", share.receptor, 100 * share.variance_share);
  return text;
}

std::string relief_line(const FeltMaterial& material, const ReliefSaving& saving) {
  const FeltWaves& felt = *material.felt;
  std::string line =
      shown_format("  {}: {} to {} Hz ({}), {:.3g} times the threshold", material.name, hertz(felt.slowest_hz),
                   hertz(felt.fastest_hz), receptors_text(felt), felt.times_threshold);
  if (felt.may_be_left_out) return line + "; nobody feels it: it may be left out\n";
  if (felt.finest_felt_mm > 0) line += shown_format("; waves below {:.3g} mm are not felt", felt.finest_felt_mm);
  if (saving.saves())
    line += shown_format(": {} x {} samples would do for {} x {}, {:.0f} of {:.0f} kB", saving.needed_width,
                         saving.needed_height, saving.width, saving.height,
                         static_cast<double>(saving.needed_bytes) / 1e3, static_cast<double>(saving.bytes) / 1e3);
  return line + "\n";
}

}  // namespace

std::string touch_text(const TouchReport& report) {
  if (report.materials.empty()) return "";
  std::array<std::size_t, 3> count{};
  for (const MaterialPair& pair : report.pairs) ++count[static_cast<std::size_t>(pair.verdict)];
  std::string text = shown_format("\ntouch: {} materials, {} pairs: {} told apart, {} alike, {} not known\n",
                                  report.materials.size(), report.pairs.size(), count[0], count[1], count[2]);
  text += pairs_of(report, PairVerdict::alike, "nobody tells apart by hand");
  text += pairs_of(report, PairVerdict::unknown, "not known");
  std::string reliefs;
  for (const FeltMaterial& material : report.materials)
    if (material.felt) reliefs += relief_line(material, report.savings.at(material.name));
  if (!reliefs.empty()) text += shown_format("reliefs under a stroke of {:g} m/s:\n", report.options.speed_m_per_s);
  return text + reliefs;
}

}  // namespace papilla::app
