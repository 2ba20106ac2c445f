// SPDX-License-Identifier: MIT
#include "cell_distances.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "evaluator.hpp"
#include "noise.hpp"
#include "papilla/core/cpu_clones.hpp"

namespace papilla::procedural_detail {

PAPILLA_CPU_CLONES("avx2")
static void root_row(double* row, int n) {
  for (int i = 0; i < n; ++i) row[i] = std::sqrt(row[i] > 0 ? row[i] : 0);
}

int distances_wanted(const TypeArguments& arguments, bool random) {
  int wanted = 1;
  if (arguments.mentions("f2")) wanted = 2;
  if (arguments.mentions("f3")) wanted = 3;
  if (arguments.mentions("f4") || arguments.mentions("get") || random) wanted = 4;
  return wanted;
}

CellDistance metric_of(const TypeArguments& arguments) {
  constexpr CellDistance metrics[] = {CellDistance::squared, CellDistance::manhattan, CellDistance::minkowski};
  return metrics[arguments.integer("distmode")];
}

void keep_point(const PatternRow& row, int rank, int i, double x, double y, double dx, double dy, double distance,
                double id) {
  if (rank == 0) row.id[i] = id;
  if ((rank + 1) * k_infos_of_point > k_infos) return;
  const double infos[k_infos_of_point] = {x, y, dx, dy, distance, id};
  for (int k = 0; k < k_infos_of_point; ++k) row.info[(rank * k_infos_of_point + k) * k_row + i] = infos[k];
}

Combination::Combination(TypeArguments& arguments, bool random)
    : rooted_(arguments.flag("rooted")),
      inverse_(arguments.flag("inversedistance")),
      func_(arguments.formula("func")),
      random_(random) {
  for (std::uint32_t k = 0; k < k_most_distances; ++k)
    share_[k] = 2 * unit_number(mix_bits(k, arguments.seed(), 77)) - 1;
  const std::string text = arguments.text("func");
  if (text == "f1") plain_ = true;
}

void Combination::apply(const PatternRow& row, double (*distance)[k_row], int wanted) const {
  for (int k = 0; k < wanted; ++k) {
    for (int i = 0; i < row.n; ++i) distance[k][i] = std::min(distance[k][i], k_infinite);
    if (rooted_) root_row(distance[k], row.n);
    if (!inverse_) continue;
    for (int i = 0; i < row.n; ++i) distance[k][i] = 1 / (1 + std::max(0.0, distance[k][i]));
  }
  if (random_) {
    for (int i = 0; i < row.n; ++i) {
      row.out[i] = 0;
      for (int k = 0; k < wanted; ++k) row.out[i] += share_[static_cast<std::size_t>(k)] * distance[k][i];
    }
  } else if (plain_) {
    std::copy_n(distance[0], row.n, row.out);
  } else {
    std::array<const double*, k_most_distances> f{};
    for (int k = 0; k < wanted; ++k) f[static_cast<std::size_t>(k)] = distance[k];
    row.evaluator->run_on_distances(func_, f.data(), wanted, row.n, row.out);
  }
}

void Combination::write_shader(PatternShader& shader, int wanted) const {
  std::vector<std::string> distances;
  for (int k = 0; k < wanted; ++k) {
    distances.push_back("d" + std::to_string(k));
    const ShaderValues values{{"d", distances.back()}};
    shader.add("$d = min($d, 1.0e30);\n", values);
    if (rooted_) shader.add("$d = sqrt(max($d, 0.0));\n", values);
    if (inverse_) shader.add("$d = 1.0 / (1.0 + max(0.0, $d));\n", values);
  }
  if (random_) {
    shader.add("$out = 0.0;\n");
    for (std::size_t k = 0; k < distances.size(); ++k)
      shader.add("$out = $out + $share * $d;\n", {{"share", share_[k]}, {"d", distances[k]}});
  } else {
    shader.add("$out = $value;\n", {{"value", plain_ ? distances[0] : shader.formula(func_, distances)}});
  }
}

std::string metric_shader(CellDistance metric, double a, double b, const std::string& dx, const std::string& dy) {
  const auto power = [](const std::string& d, double p) {
    return "k_power(abs(" + d + "), " + ShaderValue(p).text + ")";
  };
  switch (metric) {
    case CellDistance::squared: return dx + " * " + dx + " + " + dy + " * " + dy;
    case CellDistance::manhattan: return "abs(" + dx + ") + abs(" + dy + ")";
    case CellDistance::minkowski: break;
  }
  return power(dx, a) + " + " + power(dy, b);
}

}  // namespace papilla::procedural_detail
