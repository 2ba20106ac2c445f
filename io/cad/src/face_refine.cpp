// SPDX-License-Identifier: MIT
#include "face_refine.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "papilla/core/bounds.hpp"

namespace papilla::cad {
namespace {

double angle_between(Vec3 a, Vec3 b) { return std::atan2(norm(cross(a, b)), dot(a, b)); }

bool is_zero(Vec3 v) { return v.x == 0 && v.y == 0 && v.z == 0; }

struct Turn {
  double whole = 0;   ///< Largest angle between two of the three normals.
  bool kink = false;  ///< It all happens in one half of the edge, as at a crease of the surface.
};

Turn turn_along(Vec3 a, Vec3 middle, Vec3 b) {
  const auto angle = [](Vec3 p, Vec3 q) { return is_zero(p) || is_zero(q) ? 0.0 : angle_between(p, q); };
  const double first = angle(a, middle), second = angle(middle, b), whole = std::max({first, second, angle(a, b)});
  constexpr double k_nearly_all = 0.9;
  return {whole, !is_zero(a) && !is_zero(b) && !is_zero(middle) && std::max(first, second) > k_nearly_all * whole};
}

/// A surface whose parameters run this unevenly along an edge is not followed by its triangles yet.
constexpr double k_max_slip = 0.4;
/// Edges shorter than this part of the chord are left alone: what they miss is a gap, not curvature.
constexpr double k_shortest = 0.01;
/// Triangles flatter than this, altitude over longest edge, are turned away whatever their edges deviate.
constexpr double k_cap = 0.03;
/// Triangles flatter than this part of the chord are left alone: what they miss is in their edges.
constexpr double k_flattest = 0.05;
/// Triangles are split when their samples exceed this part of the chord: the rest is for what lies between samples.
constexpr double k_goal = 0.9;

/// Barycentric coordinates at which a triangle is compared with the surface while it is refined: first those that do
/// for surfaces of constant curvature, then also beside the quarters of the edges, between which others may wave.
constexpr std::array<std::array<double, 3>, 13> k_samples = {{{1.0 / 3, 1.0 / 3, 1.0 / 3},
                                                              {0.1, 0.45, 0.45},
                                                              {0.45, 0.1, 0.45},
                                                              {0.45, 0.45, 0.1},
                                                              {2.0 / 3, 1.0 / 6, 1.0 / 6},
                                                              {1.0 / 6, 2.0 / 3, 1.0 / 6},
                                                              {1.0 / 6, 1.0 / 6, 2.0 / 3},
                                                              {0.73, 0.24, 0.03},
                                                              {0.24, 0.73, 0.03},
                                                              {0.03, 0.73, 0.24},
                                                              {0.03, 0.24, 0.73},
                                                              {0.73, 0.03, 0.24},
                                                              {0.24, 0.03, 0.73}}};
constexpr std::size_t k_samples_of_elementary = 4;
/// Those of the measurement afterwards.
constexpr std::array<std::array<double, 3>, 9> k_measures = {{{7.0 / 9, 1.0 / 9, 1.0 / 9},
                                                              {1.0 / 9, 7.0 / 9, 1.0 / 9},
                                                              {1.0 / 9, 1.0 / 9, 7.0 / 9},
                                                              {4.0 / 9, 4.0 / 9, 1.0 / 9},
                                                              {4.0 / 9, 1.0 / 9, 4.0 / 9},
                                                              {1.0 / 9, 4.0 / 9, 4.0 / 9},
                                                              {5.0 / 9, 2.0 / 9, 2.0 / 9},
                                                              {2.0 / 9, 5.0 / 9, 2.0 / 9},
                                                              {2.0 / 9, 2.0 / 9, 5.0 / 9}}};

class Refiner {
 public:
  Refiner(FacePatch& patch, const FaceSurface& surface, const RefineLimits& limits)
      : patch_(patch), surface_(surface), limits_(limits) {}

  std::size_t run() {
    const std::size_t before = patch_.nodes.size();
    for (std::uint32_t t = 0; t < patch_.triangles.size(); ++t) touch(t);
    legalize_all();
    for (bool again = true; again && !full();) {
      while (split_edges() && !full()) {
      }
      again = split_triangles();
    }
    return patch_.nodes.size() - before - collapse_short_edges();
  }

 private:
  struct Candidate {
    double length;
    Index a, b;
    HalfEdge h;
  };

  bool full() const { return patch_.triangles.size() >= limits_.max_triangles; }

  void touch(std::uint32_t t) {
    if (t >= touched_.size()) {
      touched_.resize(patch_.triangles.size(), 0);
      unchecked_.resize(patch_.triangles.size(), 0);
    }
    if (touched_[t] == 0) touched_list_.push_back(t);
    touched_[t] = 1;
    if (unchecked_[t] == 0) unchecked_list_.push_back(t);
    unchecked_[t] = 1;
  }

  double length(Index a, Index b) const { return norm(patch_.nodes[b].position - patch_.nodes[a].position); }

  /// Excess of the edge, computed once for as long as its ends stay.
  double excess(HalfEdge h) {
    const Index a = std::min(patch_.from(h), patch_.to(h)), b = std::max(patch_.from(h), patch_.to(h));
    if (known_.size() < 3 * patch_.triangles.size()) known_.resize(3 * patch_.triangles.size());
    for (const HalfEdge side : {h, patch_.opposite(h)})
      if (side != k_no_value && known_[side].a == a && known_[side].b == b) return known_[side].excess;
    const double value = edge_excess(patch_, a, b, surface_.at(patch_.middle_uv(a, b)), limits_);
    known_[h] = {a, b, value};
    return value;
  }

  /// Splits every edge of the touched triangles that exceeds the limits, longest first.
  bool split_edges() {
    std::vector<std::uint32_t> list = std::exchange(touched_list_, {});
    std::sort(list.begin(), list.end());
    for (const std::uint32_t t : list) touched_[t] = 0;
    std::vector<Candidate> candidates;
    for (const std::uint32_t t : list)
      for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
        if (patch_.is_fixed(h) || (patch_.opposite(h) < h && in(list, patch_.opposite(h) / 3))) continue;
        if (excess(h) > 1 && !passes_apex(h))
          candidates.push_back({length(patch_.from(h), patch_.to(h)), patch_.from(h), patch_.to(h), h});
      }
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& p, const Candidate& q) {
      return std::tie(q.length, p.a, p.b) < std::tie(p.length, q.a, q.b);
    });
    bool changed = false;
    for (const Candidate& c : candidates) {
      const bool stale = patch_.from(c.h) != c.a || patch_.to(c.h) != c.b;
      if (stale) {
        touch(c.h / 3);
        changed = true;
        continue;
      }
      if (full()) return false;
      if (should_flip(c.h))
        legalize({c.h});
      else
        split_edge(c.h);
      changed = true;
    }
    return changed;
  }

  /// Its middle is the third corner of a triangle beside it: splitting it would only stack up nodes.
  bool passes_apex(HalfEdge h) const {
    const Vec2 a = patch_.nodes[patch_.from(h)].uv, b = patch_.nodes[patch_.to(h)].uv;
    const Vec2 middle = patch_.middle_uv(patch_.from(h), patch_.to(h));
    constexpr double k_same = 1e-9;
    for (const HalfEdge side : {h, patch_.opposite(h)}) {
      if (side == k_no_value) continue;
      const Vec2 away = patch_.nodes[patch_.apex(side)].uv - middle;
      if (dot(away, away) <= k_same * k_same * dot(b - a, b - a)) return true;
    }
    return false;
  }

  static bool in(const std::vector<std::uint32_t>& sorted, std::uint32_t t) {
    return std::binary_search(sorted.begin(), sorted.end(), t);
  }

  void split_edge(HalfEdge h) {
    const Index m = add_node(patch_.middle_uv(patch_.from(h), patch_.to(h)));
    const HalfEdge rest = patch_.split(h, m);
    legalize_around({h, rest});
  }

  Index add_node(Vec2 uv) {
    patch_.nodes.push_back(surface_node(surface_, uv));
    return static_cast<Index>(patch_.nodes.size() - 1);
  }

  /// Legalizes the edges opposite to the node that was put on the edge h-rest.
  void legalize_around(const std::array<HalfEdge, 2>& halves) {
    std::vector<HalfEdge> stack;
    for (const HalfEdge half : halves)
      for (const HalfEdge side : {half, patch_.opposite(half)}) {
        if (side == k_no_value) continue;
        touch(side / 3);
        stack.push_back(FacePatch::next(side));
        stack.push_back(FacePatch::next(FacePatch::next(side)));
      }
    legalize(std::move(stack));
  }

  void legalize_all() {
    std::vector<HalfEdge> stack;
    for (HalfEdge h = 0; h < 3 * patch_.triangles.size(); ++h)
      if (!patch_.is_fixed(h) && h < patch_.opposite(h)) stack.push_back(h);
    std::reverse(stack.begin(), stack.end());
    legalize(std::move(stack));
  }

  void legalize(std::vector<HalfEdge> stack) {
    // In the plane flips end by themselves; on a surface rounding could make them run in circles.
    std::size_t left = 8 * stack.size() + 32;
    while (!stack.empty() && left > 0) {
      const HalfEdge h = stack.back();
      stack.pop_back();
      if (patch_.is_fixed(h) || !should_flip(h)) continue;
      --left;
      patch_.flip(h);
      const HalfEdge g = patch_.opposite(h);
      for (const HalfEdge side : {h, g}) {
        touch(side / 3);
        stack.push_back(FacePatch::next(side));
        stack.push_back(FacePatch::next(FacePatch::next(side)));
      }
    }
  }

  bool should_flip(HalfEdge h) {
    const Index a = patch_.from(h), b = patch_.to(h), c = patch_.apex(h), d = patch_.apex(patch_.opposite(h));
    if (c == d) return false;
    const bool singular = patch_.nodes[a].is_singular() || patch_.nodes[b].is_singular() ||
                          patch_.nodes[c].is_singular() || patch_.nodes[d].is_singular();
    const bool folded = !singular && (is_flat(a, b, c) || is_flat(b, a, d));
    if (!(singular ? is_convex_in_space(a, b, c, d) : is_convex(a, b, c, d))) return false;
    if (folded) return true;
    if (!is_illegal(a, b, c, d)) return false;
    // A cap would only be cut into smaller caps, its new nodes beside its apex.
    const double before = std::min(flatness(a, b, c), flatness(b, a, d)),
                 after = std::min(flatness(c, d, b), flatness(d, c, a));
    if (before < k_cap && after > 2 * before) return true;
    const Vec2 middle = patch_.middle_uv(c, d);
    return edge_excess(patch_, std::min(c, d), std::max(c, d), surface_.at(middle), limits_) <=
           std::max(1.0, excess(h));
  }

  double area(Index p, Index q, Index r) const {
    const auto uv = [&](Index node) { return patch_.nodes[node].uv; };
    return cross(uv(q) - uv(p), uv(r) - uv(p));
  }

  /// Folded, or its corners on one line up to rounding: splitting its longest edge would put a node onto its third.
  bool is_flat(Index p, Index q, Index r) const {
    constexpr double k_collinear = 1e-10;
    const auto squared = [&](Index from, Index to) {
      const Vec2 edge = patch_.nodes[to].uv - patch_.nodes[from].uv;
      return dot(edge, edge);
    };
    return area(p, q, r) <= k_collinear * std::max({squared(p, q), squared(q, r), squared(r, p)});
  }

  /// Both triangles beside the other diagonal are to run counter-clockwise and not to be slivers.
  static constexpr double k_flat = 1e-6;

  bool is_convex(Index a, Index b, Index c, Index d) const {
    if (is_flat(c, d, b) || is_flat(d, c, a)) return false;
    const double first = area(c, d, b), second = area(d, c, a);
    return std::min(first, second) > k_flat * (std::abs(first) + std::abs(second));
  }

  /// The same in the plane of the four corners, for where parameters mean nothing.
  bool is_convex_in_space(Index a, Index b, Index c, Index d) const {
    const auto at = [&](Index node) { return patch_.nodes[node].position; };
    const auto twice_area = [&](Index p, Index q, Index r) { return cross(at(q) - at(p), at(r) - at(p)); };
    const Vec3 n = normalized(twice_area(a, b, c) + twice_area(b, a, d));
    const double first = dot(twice_area(c, d, b), n), second = dot(twice_area(d, c, a), n);
    return std::min(first, second) > k_flat * (std::abs(first) + std::abs(second));
  }

  /// Whether the angles at c and d, opposite to the edge a-b, are more than π together.
  bool is_illegal(Index a, Index b, Index c, Index d) const {
    const auto cotangent = [&](Index apex) {
      const Vec3 p = patch_.nodes[a].position - patch_.nodes[apex].position,
                 q = patch_.nodes[b].position - patch_.nodes[apex].position;
      const double sine = norm(cross(p, q)), cosine = dot(p, q);
      constexpr double k_needle = 1e-12;
      return sine > k_needle * std::abs(cosine) ? cosine / sine : std::copysign(1 / k_needle, cosine);
    };
    constexpr double k_clearly = 1e-6;
    return cotangent(c) + cotangent(d) < -k_clearly;
  }

  /// Merges nodes inside of the face into neighbours that splits have put right beside them: in a fan of needles each
  /// new node gives rise to the next, ever nearer to it, and single precision would make them one. Returns how many.
  std::size_t collapse_short_edges() {
    std::size_t count = 0;
    for (HalfEdge h = 0; h < 3 * patch_.triangles.size(); ++h)
      if (patch_.from(h) != patch_.to(h) && length(patch_.from(h), patch_.to(h)) < k_shortest * limits_.chord &&
          is_collapsible(h)) {
        patch_.collapse(h);
        ++count;
      }
    if (count == 0) return 0;
    std::vector<std::uint8_t> gone;
    for (const Triangle& t : patch_.triangles) gone.push_back(t[0] == t[1]);
    patch_.remove(gone);
    return count;
  }

  /// Whether the edge's start is inside of the face and can move onto its end without folding a triangle over.
  bool is_collapsible(HalfEdge h) const {
    const PatchNode &start = patch_.nodes[patch_.from(h)], &end = patch_.nodes[patch_.to(h)];
    if (start.shared != k_no_value || start.is_singular() || end.is_singular() || patch_.is_fixed(h)) return false;
    const Index to = patch_.to(h), c = patch_.apex(h), d = patch_.apex(patch_.opposite(h));
    std::vector<Index> others;
    for (const HalfEdge g : patch_.around(h)) {
      if (patch_.is_fixed(g)) return false;
      const Index p = patch_.to(g), q = patch_.apex(g);
      if (p != to && q != to && is_flat(to, p, q)) return false;
      if (p != to && p != c && p != d) others.push_back(p);
    }
    // Of the nodes that the start would hand over, none may be a neighbour of the end already.
    for (const HalfEdge g : patch_.around(FacePatch::next(h)))
      for (const Index p : {patch_.to(g), patch_.apex(g)})
        if (std::find(others.begin(), others.end(), p) != others.end()) return false;
    return c != d;
  }

  double sample_excess(std::uint32_t t) const {
    double worst = 0;
    const std::size_t count = surface_.is_elementary() ? k_samples_of_elementary : k_samples.size();
    for (std::size_t i = 0; i < count; ++i) {
      const std::array<double, 3>& w = k_samples[i];
      const SurfaceSample s = surface_.at(patch_.uv_in(t, w));
      Vec3 gap;
      for (std::size_t k = 0; k < 3; ++k) gap = gap + w[k] * patch_.nodes[patch_.triangles[t][k]].gap;
      worst = std::max(worst, std::abs(dot(s.point + gap - patch_.point_in(t, w), s.normal)));
    }
    return worst / (k_goal * limits_.chord);
  }

  /// Splits the triangles that keep the limits on their edges but not between them.
  bool split_triangles() {
    std::vector<std::uint32_t> list = std::exchange(unchecked_list_, {});
    std::sort(list.begin(), list.end());
    for (const std::uint32_t t : list) unchecked_[t] = 0;
    if (surface_.is_plane()) return false;
    std::vector<std::uint32_t> violating;
    for (const std::uint32_t t : list)
      if (sample_excess(t) > 1) violating.push_back(t);
    bool changed = false;
    std::vector<Triangle> as_found;
    for (const std::uint32_t t : violating) as_found.push_back(patch_.triangles[t]);
    for (std::size_t i = 0; i < violating.size() && !full(); ++i) {
      const std::uint32_t t = violating[i];
      if (patch_.triangles[t] != as_found[i]) {
        touch(t);
        changed = true;
      } else {
        changed = split_triangle(t) || changed;
      }
    }
    return changed;
  }

  bool split_triangle(std::uint32_t t) {
    const auto [a, b, c] = patch_.triangles[t];
    if (altitude(a, b, c) < k_flattest * limits_.chord) return false;
    HalfEdge longest = k_no_value;
    double most = 0, longest_fixed = 0;
    for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
      const double l = length(patch_.from(h), patch_.to(h));
      if (patch_.is_fixed(h)) {
        longest_fixed = std::max(longest_fixed, l);
      } else if (l > most) {
        most = l;
        longest = h;
      }
    }
    if (most < k_shortest * limits_.chord) return false;
    if (longest_fixed <= most) {
      split_edge(longest);
      return true;
    }
    const Index m = add_node(patch_.uv_in(t, {1.0 / 3, 1.0 / 3, 1.0 / 3}));
    const auto added = static_cast<std::uint32_t>(patch_.triangles.size());
    patch_.insert(t, m);
    for (const std::uint32_t piece : {t, added, added + 1}) touch(piece);
    legalize({3 * t, 3 * added, 3 * (added + 1)});
    return true;
  }

  double altitude(Index a, Index b, Index c) const {
    const Vec3 origin = patch_.nodes[a].position;
    const double area = norm(cross(patch_.nodes[b].position - origin, patch_.nodes[c].position - origin));
    const double longest = std::max({length(a, b), length(b, c), length(c, a)});
    return longest > 0 ? area / longest : 0;
  }

  /// Smallest altitude over longest edge.
  double flatness(Index a, Index b, Index c) const {
    const double longest = std::max({length(a, b), length(b, c), length(c, a)});
    return longest > 0 ? altitude(a, b, c) / longest : 0;
  }

  struct Known {
    Index a = k_no_value, b = k_no_value;
    double excess = 0;
  };

  FacePatch& patch_;
  const FaceSurface& surface_;
  const RefineLimits& limits_;
  std::vector<std::uint8_t> touched_, unchecked_;
  std::vector<std::uint32_t> touched_list_, unchecked_list_;
  std::vector<Known> known_;
};

/// Distance of q from the surface near uv.
double distance_to(const FaceSurface& surface, Vec3 q, Vec2 uv, double chord) {
  SurfaceSample s = surface.at(uv);
  // Newton's steps in the tangent plane; one is exact when the parametrization is even.
  for (int step = 0; step < 3; ++step) {
    const Vec3 delta = q - s.point;
    if (is_zero(s.normal)) return norm(delta);
    const double along = dot(delta, s.normal);
    const double slip = norm(delta - along * s.normal);
    if (slip < 0.1 * chord || step == 2) return std::abs(along);
    const double e = dot(s.du, s.du), f = dot(s.du, s.dv), g = dot(s.dv, s.dv), det = e * g - f * f;
    const double p = dot(delta, s.du), r = dot(delta, s.dv);
    uv = uv + Vec2{(g * p - f * r) / det, (e * r - f * p) / det};
    const SurfaceSample moved = surface.at(uv);
    if (!is_finite(moved.point) || norm(q - moved.point) > norm(delta)) return std::abs(along);
    s = moved;
  }
  return norm(q - s.point);
}

}  // namespace

PatchNode surface_node(const FaceSurface& surface, Vec2 uv) {
  const SurfaceSample s = surface.at(uv);
  PatchNode node;
  node.position = s.point;
  node.normal = s.normal;
  node.uv = uv;
  return node;
}

double edge_excess(const FacePatch& patch, Index a, Index b, const SurfaceSample& middle, const RefineLimits& limits) {
  const PatchNode &p = patch.nodes[a], &q = patch.nodes[b];
  const Vec3 start = p.position - p.gap, end = q.position - q.gap;
  const double length = norm(end - start);
  // The edges between the two sides of a seam have no length, but what they span is not small.
  const double reach = std::max(length, 2 * norm(middle.point - start));
  if (reach < k_shortest * limits.chord) return 0;
  const Vec3 delta = middle.point - 0.5 * (start + end);
  const double away = is_zero(middle.normal) ? norm(delta) : std::abs(dot(delta, middle.normal));
  double excess = std::max(away / (k_goal * limits.chord), length / limits.max_edge);
  if (norm(delta) > k_goal * limits.chord) excess = std::max(excess, norm(delta) / (k_max_slip * reach));
  if (reach > limits.min_edge) {
    const Turn turn = turn_along(p.normal, middle.normal, q.normal);
    if (!turn.kink || reach > limits.chord) excess = std::max(excess, turn.whole / limits.angle);
  }
  return excess;
}

double largest_gap(const FacePatch& patch) {
  double largest = 0;
  for (const PatchNode& node : patch.nodes)
    largest = std::max(largest, is_zero(node.normal) ? norm(node.gap) : std::abs(dot(node.gap, node.normal)));
  return largest;
}

PatchDeviation measure_patch(const FacePatch& patch, const FaceSurface& surface, const RefineLimits& limits) {
  PatchDeviation worst;
  for (const PatchNode& node : patch.nodes)
    if (norm(node.gap) > worst.distance)
      worst.distance = std::max(worst.distance, distance_to(surface, node.position, node.uv, limits.chord));
  if (surface.is_plane()) return worst;
  for (std::uint32_t t = 0; t < patch.triangles.size(); ++t)
    for (const std::array<double, 3>& w : k_measures)
      worst.distance =
          std::max(worst.distance, distance_to(surface, patch.point_in(t, w), patch.uv_in(t, w), limits.chord));
  for (HalfEdge h = 0; h < 3 * patch.triangles.size(); ++h) {
    if (!patch.is_boundary(h) && patch.opposite(h) < h) continue;
    for (const double part : {0.2, 0.5, 0.8}) {
      std::array<double, 3> w{};
      w[h % 3] = 1 - part;
      w[FacePatch::next(h) % 3] = part;
      const Vec3 point = patch.point_in(h / 3, w);
      worst.distance = std::max(worst.distance, distance_to(surface, point, patch.uv_in(h / 3, w), limits.chord));
    }
    const PatchNode &p = patch.nodes[patch.from(h)], &q = patch.nodes[patch.to(h)];
    if (norm(q.position - p.position) <= limits.min_edge || is_zero(p.normal) || is_zero(q.normal)) continue;
    worst.angle = std::max(worst.angle, angle_between(p.normal, q.normal));
  }
  return worst;
}

std::size_t refine_patch(FacePatch& patch, const FaceSurface& surface, const RefineLimits& limits) {
  // What the limits may take of a face that is as large as its box, several times over. A chord as coarse as the face
  // leaves boundaries from which no split leads to the surface: those would go on for ever.
  constexpr double k_times = 16;
  Bounds<Vec3> box;
  for (const PatchNode& node : patch.nodes) box.add(node.position), box.add(node.position - node.gap);
  const double cells = box.diagonal() / std::min(limits.min_edge, limits.max_edge);
  RefineLimits bounded = limits;
  const double most = static_cast<double>(patch.triangles.size()) + k_times * cells * cells;
  if (most < static_cast<double>(limits.max_triangles)) bounded.max_triangles = static_cast<std::size_t>(most);
  return Refiner(patch, surface, bounded).run();
}

}  // namespace papilla::cad
