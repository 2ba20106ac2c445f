// SPDX-License-Identifier: MIT
#include "sheets.hpp"

#include <algorithm>
#include <span>

#include "chart_pieces.hpp"
#include "sheet_overlap.hpp"

namespace papilla::param_detail {
namespace {

constexpr std::uint32_t k_no_sheet = ~std::uint32_t{0};

double edge_length(const TriangleMesh& mesh, std::size_t t, std::size_t k) {
  return norm(mesh.corner(t, static_cast<int>((k + 1) % 3)) - mesh.corner(t, static_cast<int>(k)));
}

ProjectionAxes axes_of(std::uint8_t label, UpAxis up) { return projection_axes(label >> 1, label & 1, up); }

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
  LoneTriangles(const TriangleMesh& mesh, const Adjacency& across, double cosine, UpAxis up,
                LabelledTriangles& triangles, Sheets& sheets)
      : mesh_(mesh),
        across_(across),
        cosine_(cosine),
        up_(up),
        triangles_(triangles),
        sheets_(sheets),
        size_(sheet_sizes(sheets)),
        searches_left_(k_searches * sheets.of_triangle.size()) {}

  void run() {
    for (Index t = 0; t < sheets_.of_triangle.size(); ++t) {
      if (size_[sheets_.of_triangle[t]] != 1) continue;
      std::array<std::size_t, 3> edges{0, 1, 2};
      std::stable_sort(edges.begin(), edges.end(), [&](std::size_t a, std::size_t b) {
        return edge_length(mesh_, t, a) > edge_length(mesh_, t, b);
      });
      const auto across_edge = [&](std::size_t k) { return across_[3 * std::size_t{t} + k]; };
      if (std::none_of(edges.begin(), edges.end(), [&](std::size_t k) { return join(t, across_edge(k)); }))
        std::any_of(edges.begin(), edges.end(), [&](std::size_t k) { return take(t, across_edge(k)); });
    }
  }

 private:
  /// How many triangles may be looked at in all searches together, per triangle of the mesh.
  static constexpr std::size_t k_searches = 16;
  /// Penetration, as a fraction of the triangle's size, that counts as touching.
  static constexpr double k_touching = 1e-13;

  void move(Index t, std::uint32_t sheet, std::uint8_t label) {
    --size_[sheets_.of_triangle[t]];
    ++size_[sheet];
    sheets_.of_triangle[t] = sheet;
    triangles_.label[t] = label;
    moved_.push_back(t);
  }

  /// Whether a triangle of the sheet lies over `own`, as far as the searches last; when in doubt, yes.
  bool is_covered(const std::array<Vec2, 3>& own, std::uint32_t sheet, const ProjectionAxes& axes) {
    if (members_.triangles.empty()) members_ = sort_by_chart(sheets_.of_triangle, sheets_.count);
    const auto covers = [&](Index m) {
      return sheets_.of_triangle[m] == sheet &&
             interiors_meet(own, projected(mesh_, m, axes), k_touching * norm(own[1] - own[0]));
    };
    const auto members = members_.of(sheet);  // as they were; those that came since are in moved_
    const std::size_t cost = members.size() + moved_.size();
    if (cost > searches_left_) return true;
    searches_left_ -= cost;
    return std::any_of(members.begin(), members.end(), covers) || std::any_of(moved_.begin(), moved_.end(), covers);
  }

  /// Moves t to the sheet of its neighbour s.
  bool join(Index t, Index s) {
    if (s == k_no_triangle || !accepts(mesh_, t, triangles_.label[s], cosine_)) return false;
    const std::uint32_t sheet = sheets_.of_triangle[s];
    const ProjectionAxes axes = axes_of(triangles_.label[s], up_);
    if (is_covered(projected(mesh_, t, axes), sheet, axes)) return false;
    move(t, sheet, triangles_.label[s]);
    return true;
  }

  /// Moves the neighbour s out of its sheet to t. Two triangles that share an edge and are not flipped can't overlap.
  bool take(Index t, Index s) {
    if (s == k_no_triangle || size_[sheets_.of_triangle[s]] < 3 || divides_its_sheet(s)) return false;
    for (const std::uint8_t label : {triangles_.label[t], triangles_.label[s]}) {
      if (!accepts(mesh_, t, label, cosine_) || !accepts(mesh_, s, label, cosine_)) continue;
      triangles_.label[t] = label;
      move(s, sheets_.of_triangle[t], label);
      return true;
    }
    return false;
  }

  /// Whether the neighbours of s in its sheet would perhaps lose touch without s: there are two of them, and no
  /// fan of the sheet around their common corner joins them.
  bool divides_its_sheet(Index s) const {
    const std::uint32_t sheet = sheets_.of_triangle[s];
    std::vector<Index> in_sheet;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index other = across_[3 * std::size_t{s} + k];
      if (other != k_no_triangle && sheets_.of_triangle[other] == sheet) in_sheet.push_back(other);
    }
    if (in_sheet.size() < 2) return false;
    if (in_sheet.size() > 2) return true;
    Index before = s, at = in_sheet[0];
    for (int steps = 0; steps < k_fan_steps && at != in_sheet[1]; ++steps) {
      const Index corner = common_corner(s, in_sheet[0], in_sheet[1]);
      const Index after = next_in_fan(at, before, corner);
      if (after == k_no_triangle || after == s || sheets_.of_triangle[after] != sheet) return true;
      before = at;
      at = after;
    }
    return at != in_sheet[1];
  }

  static constexpr int k_fan_steps = 32;

  bool has_corner(Index t, Index vertex) const {
    const Triangle& c = mesh_.triangles[t];
    return c[0] == vertex || c[1] == vertex || c[2] == vertex;
  }

  Index common_corner(Index s, Index a, Index b) const {
    for (const Index v : mesh_.triangles[s])
      if (has_corner(a, v) && has_corner(b, v)) return v;
    return k_no_triangle;
  }

  /// The neighbour of t around the vertex that is not `before`.
  Index next_in_fan(Index t, Index before, Index vertex) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index other = across_[3 * std::size_t{t} + k];
      const bool touches = mesh_.triangles[t][k] == vertex || mesh_.triangles[t][(k + 1) % 3] == vertex;
      if (touches && other != before) return other;
    }
    return k_no_triangle;
  }

  const TriangleMesh& mesh_;
  const Adjacency& across_;
  double cosine_;
  UpAxis up_;
  LabelledTriangles& triangles_;
  Sheets& sheets_;
  std::vector<Index> size_;
  std::size_t searches_left_;
  TrianglesOfCharts members_;
  std::vector<Index> moved_;
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
  for (std::size_t t = 0; t < sheets.of_triangle.size(); ++t)
    area[sheets.of_triangle[t]] += double{triangles.doubled_area[t]};
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
                     [&](Index t) { return accepts(mesh, t, wanted, options.absorption_cosine); }))
      continue;
    for (const Index t : own) triangles.label[t] = wanted;
    involved[border.sheet] = 'm';  // moved: its old label is no target any more
    involved[border.other] = 't';  // target: stays where it is in this round
    ++absorbed;
  }
  return absorbed;
}

std::uint32_t split_folded_sheets(const TriangleMesh& mesh, const Adjacency& across,
                                  const std::vector<std::uint8_t>& label, UpAxis up, Sheets& sheets) {
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

void join_lone_triangles(const TriangleMesh& mesh, const Adjacency& across, double cosine, UpAxis up,
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

}  // namespace papilla::param_detail
