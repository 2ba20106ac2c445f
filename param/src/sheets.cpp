// SPDX-License-Identifier: MIT
#include "sheets.hpp"

#include <algorithm>
#include <span>

#include "chart_pieces.hpp"
#include "sheet_overlap.hpp"

namespace papilla::detail {
namespace {

constexpr std::uint32_t k_no_sheet = ~std::uint32_t{0};

double edge_length(const TriangleMesh& mesh, std::size_t t, std::size_t k) {
  return norm(mesh.corner(t, static_cast<int>((k + 1) % 3)) - mesh.corner(t, static_cast<int>(k)));
}

ProjectionAxes axes_of(std::uint8_t label, GrainUp up) { return projection_axes(label >> 1, label & 1, up); }

std::array<Vec2, 3> projected(const TriangleMesh& mesh, std::size_t t, const ProjectionAxes& axes) {
  return {project(mesh.corner(t, 0), axes), project(mesh.corner(t, 1), axes), project(mesh.corner(t, 2), axes)};
}

/// A common border of two sheets, seen from the first.
struct CommonBorder {
  std::uint32_t sheet, other;
  double length;
};

/// All common borders, longest first within each sheet.
std::vector<CommonBorder> common_borders(const TriangleMesh& mesh, const Adjacency& across, const Sheets& sheets) {
  std::vector<CommonBorder> edges;
  for (std::size_t h = 0; h < across.size(); ++h) {
    if (across[h] == k_no_triangle) continue;
    const std::uint32_t own = sheets.of_triangle[h / 3], other = sheets.of_triangle[across[h]];
    if (own != other) edges.push_back({own, other, edge_length(mesh, h / 3, h % 3)});
  }
  // Stable: equal pairs keep mesh order, so that sums round alike in every run.
  std::stable_sort(edges.begin(), edges.end(), [](const CommonBorder& a, const CommonBorder& b) {
    return a.sheet != b.sheet ? a.sheet < b.sheet : a.other < b.other;
  });
  std::vector<CommonBorder> borders;
  for (const CommonBorder& e : edges) {
    if (!borders.empty() && borders.back().sheet == e.sheet && borders.back().other == e.other)
      borders.back().length += e.length;
    else
      borders.push_back(e);
  }
  std::stable_sort(borders.begin(), borders.end(), [](const CommonBorder& a, const CommonBorder& b) {
    return a.sheet != b.sheet ? a.sheet < b.sheet : a.length > b.length;
  });
  return borders;
}

std::vector<BorderEdge> border_of(const TriangleMesh& mesh, const Adjacency& across, const Sheets& sheets,
                                  std::uint32_t sheet, std::span<const Index> triangles, const ProjectionAxes& axes) {
  std::vector<BorderEdge> border;
  for (const std::size_t t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index other = across[3 * t + k];
      if (other != k_no_triangle && sheets.of_triangle[other] == sheet) continue;
      const Index from = mesh.triangles[t][k], to = mesh.triangles[t][(k + 1) % 3];
      border.push_back({from, to, project(mesh.positions[from], axes), project(mesh.positions[to], axes)});
    }
  return border;
}

PlaneSheet plane_sheet(const TriangleMesh& mesh, const Adjacency& across, const Sheets& sheets, std::uint32_t sheet,
                       std::span<const Index> triangles, const ProjectionAxes& axes, std::vector<Index>& local) {
  PlaneSheet plane;
  plane.triangles.reserve(triangles.size());
  plane.across.reserve(triangles.size());
  for (Index i = 0; i < triangles.size(); ++i) local[triangles[i]] = i;
  for (const std::size_t t : triangles) {
    plane.triangles.push_back(projected(mesh, t, axes));
    std::array<Index, 3> neighbours{k_no_triangle, k_no_triangle, k_no_triangle};
    for (std::size_t k = 0; k < 3; ++k) {
      const Index other = across[3 * t + k];
      if (other != k_no_triangle && sheets.of_triangle[other] == sheet) neighbours[k] = local[other];
    }
    plane.across.push_back(neighbours);
  }
  return plane;
}

/// How many triangles each sheet has.
std::vector<Index> sheet_sizes(const Sheets& sheets) {
  std::vector<Index> size(sheets.count, 0);
  for (const std::uint32_t s : sheets.of_triangle) ++size[s];
  return size;
}

/// Repairs sheets of one triangle, one at a time.
class LoneTriangles {
 public:
  LoneTriangles(const TriangleMesh& mesh, const Adjacency& across, double cosine, GrainUp up,
                LabelledTriangles& triangles, Sheets& sheets)
      : mesh_(mesh), across_(across), cosine_(cosine), up_(up), triangles_(triangles), sheets_(sheets),
        size_(sheet_sizes(sheets)) {}

  void run() {
    for (Index t = 0; t < sheets_.of_triangle.size(); ++t) {
      if (size_[sheets_.of_triangle[t]] != 1) continue;
      std::array<std::size_t, 3> edges{0, 1, 2};
      std::stable_sort(edges.begin(), edges.end(), [&](std::size_t a, std::size_t b) {
        return edge_length(mesh_, t, a) > edge_length(mesh_, t, b);
      });
      if (std::none_of(edges.begin(), edges.end(), [&](std::size_t k) { return join(t, across_[3 * std::size_t{t} + k]); }))
        std::any_of(edges.begin(), edges.end(), [&](std::size_t k) { return take(t, across_[3 * std::size_t{t} + k]); });
    }
  }

 private:
  /// Sheets up to this size are searched for overlap with a joining triangle.
  static constexpr Index k_searched = 64;

  void move(Index t, std::uint32_t sheet, std::uint8_t label) {
    --size_[sheets_.of_triangle[t]];
    ++size_[sheet];
    sheets_.of_triangle[t] = sheet;
    triangles_.label[t] = label;
  }

  /// The triangles of the sheet of `start`, or nothing when there are more than k_searched.
  std::vector<Index> small_sheet(Index start) const {
    const std::uint32_t sheet = sheets_.of_triangle[start];
    std::vector<Index> members;
    if (size_[sheet] > k_searched) return members;
    members.push_back(start);
    for (std::size_t i = 0; i < members.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const Index other = across_[3 * std::size_t{members[i]} + k];
        if (other == k_no_triangle || sheets_.of_triangle[other] != sheet) continue;
        if (std::find(members.begin(), members.end(), other) == members.end()) members.push_back(other);
      }
    return members;
  }

  /// Moves t to the sheet of its neighbour s.
  bool join(Index t, Index s) {
    if (s == k_no_triangle || !triangles_.accepts(t, triangles_.label[s], cosine_)) return false;
    const std::vector<Index> members = small_sheet(s);
    if (members.empty()) return false;
    const ProjectionAxes axes = axes_of(triangles_.label[s], up_);
    const auto own = projected(mesh_, t, axes);
    for (const Index m : members)
      if (m != s && interiors_meet(own, projected(mesh_, m, axes), 1e-10 * edge_length(mesh_, t, 0))) return false;
    move(t, sheets_.of_triangle[s], triangles_.label[s]);
    return true;
  }

  /// Moves the neighbour s out of its sheet to t. Two triangles that share an edge and are not flipped can't overlap.
  bool take(Index t, Index s) {
    if (s == k_no_triangle) return false;
    const std::uint32_t from = sheets_.of_triangle[s];
    if (size_[from] < 3 || neighbours_in(s, from) != 1) return false;
    for (const std::uint8_t label : {triangles_.label[t], triangles_.label[s]}) {
      if (!triangles_.accepts(t, label, cosine_) || !triangles_.accepts(s, label, cosine_)) continue;
      triangles_.label[t] = label;
      move(s, sheets_.of_triangle[t], label);
      return true;
    }
    return false;
  }

  int neighbours_in(Index t, std::uint32_t sheet) const {
    int count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index other = across_[3 * std::size_t{t} + k];
      count += other != k_no_triangle && sheets_.of_triangle[other] == sheet;
    }
    return count;
  }

  const TriangleMesh& mesh_;
  const Adjacency& across_;
  double cosine_;
  GrainUp up_;
  LabelledTriangles& triangles_;
  Sheets& sheets_;
  std::vector<Index> size_;
};

}  // namespace

Sheets connect_sheets(const Adjacency& across, const std::vector<std::uint8_t>& label) {
  Sheets sheets;
  sheets.of_triangle.assign(label.size(), k_no_sheet);
  std::vector<Index> stack;
  for (Index seed = 0; seed < label.size(); ++seed) {
    if (sheets.of_triangle[seed] != k_no_sheet) continue;
    const std::uint32_t sheet = sheets.count++;
    sheets.of_triangle[seed] = sheet;
    stack.push_back(seed);
    while (!stack.empty()) {
      const Index t = stack.back();
      stack.pop_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const Index other = across[3 * std::size_t{t} + k];
        if (other == k_no_triangle || sheets.of_triangle[other] != k_no_sheet || label[other] != label[seed]) continue;
        sheets.of_triangle[other] = sheet;
        stack.push_back(other);
      }
    }
  }
  return sheets;
}

std::size_t absorb_small_sheets(const TriangleMesh& mesh, const Adjacency& across, const Sheets& sheets,
                                const TriplanarOptions& options, LabelledTriangles& triangles) {
  const std::vector<CommonBorder> borders = common_borders(mesh, across, sheets);
  if (borders.empty()) return 0;
  const TrianglesOfCharts members = sort_by_chart(sheets.of_triangle, sheets.count);
  std::vector<double> area(sheets.count, 0);
  for (std::size_t t = 0; t < sheets.of_triangle.size(); ++t) area[sheets.of_triangle[t]] += triangles.doubled_area[t];
  std::vector<std::uint8_t> label(sheets.count);
  for (std::uint32_t s = 0; s < sheets.count; ++s) label[s] = triangles.label[members.of(s).front()];

  std::vector<char> involved(sheets.count, 0);
  std::size_t absorbed = 0;
  for (const CommonBorder& border : borders) {
    if (involved[border.sheet] || involved[border.other] == 'm' || label[border.sheet] == label[border.other]) continue;
    const auto own = members.of(border.sheet);
    const bool small = area[border.sheet] < options.small_piece * area[border.other] ||
                       (own.size() == 1 && area[border.sheet] <= area[border.other]);
    if (!small) continue;
    const std::uint8_t wanted = label[border.other];
    if (!std::all_of(own.begin(), own.end(),
                     [&](Index t) { return triangles.accepts(t, wanted, options.absorption_cosine); }))
      continue;
    for (const Index t : own) triangles.label[t] = wanted;
    involved[border.sheet] = 'm';  // moved: its old label is no target any more
    involved[border.other] = 't';  // target: stays where it is in this round
    ++absorbed;
  }
  return absorbed;
}

std::uint32_t split_folded_sheets(const TriangleMesh& mesh, const Adjacency& across,
                                  const std::vector<std::uint8_t>& label, GrainUp up, Sheets& sheets) {
  const TrianglesOfCharts members = sort_by_chart(sheets.of_triangle, sheets.count);
  std::vector<Index> local;
  std::uint32_t folded = 0;
  const std::uint32_t count = sheets.count;
  for (std::uint32_t s = 0; s < count; ++s) {
    const auto own = members.of(s);
    if (own.size() < 3) continue;  // two triangles share an edge and lie on its two sides
    const ProjectionAxes axes = axes_of(label[own.front()], up);
    if (border_proves_injective(border_of(mesh, across, sheets, s, own, axes))) continue;
    if (local.empty()) local.resize(mesh.triangles.size());
    const PlaneSheet plane = plane_sheet(mesh, across, sheets, s, own, axes, local);
    if (!overlaps_itself(plane)) continue;
    ++folded;
    const std::vector<std::uint32_t> piece = split_overlaps(plane);
    std::uint32_t last = 0;
    for (std::size_t i = 0; i < own.size(); ++i) {
      if (piece[i] > 0) sheets.of_triangle[own[i]] = sheets.count + piece[i] - 1;
      last = std::max(last, piece[i]);
    }
    sheets.count += last;
  }
  return folded;
}

void join_lone_triangles(const TriangleMesh& mesh, const Adjacency& across, double cosine, GrainUp up,
                         LabelledTriangles& triangles, Sheets& sheets) {
  LoneTriangles(mesh, across, cosine, up, triangles, sheets).run();
}

void renumber(Sheets& sheets) {
  std::vector<std::uint32_t> number(sheets.count, k_no_sheet);
  std::uint32_t count = 0;
  for (std::uint32_t& s : sheets.of_triangle) {
    if (number[s] == k_no_sheet) number[s] = count++;
    s = number[s];
  }
  sheets.count = count;
}

}  // namespace papilla::detail
