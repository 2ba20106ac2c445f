// SPDX-License-Identifier: MIT
#include "edge_net.hpp"

#include <BRep_Tool.hxx>
#include <GCPnts_TangentialDeflection.hxx>
#include <Geom_Surface.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "cad_parallel.hpp"

namespace papilla::cad {
namespace {

/// The edge's point; the first face's surface where the edge has no curve in space.
class EdgeCurve {
 public:
  explicit EdgeCurve(const TopoDS_Edge& edge) {
    double first = 0, last = 0;
    const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, first, last);
    if (!curve.IsNull()) curve_ = std::make_unique<BRepAdaptor_Curve>(edge);
  }
  bool exists() const { return curve_ != nullptr; }
  Vec3 at(double t) const { return to_vec(curve_->Value(t).XYZ()); }

 private:
  std::unique_ptr<BRepAdaptor_Curve> curve_;
};

/// A face next to the edge that is being refined.
struct Side {
  const FaceMesh* mesh;
  const EdgeUse* use;
};

struct Added {
  double parameter;
  Vec3 position;
};

class LineRefiner {
 public:
  LineRefiner(const EdgeNet& net, std::uint32_t edge, const std::vector<Side>& sides)
      : line_(net.lines()[edge]), points_(net.points()), curve_(net.edge(edge)), limits_(sides.front().mesh->limits) {
    for (const Side& side : sides) {
      surfaces_.push_back({side.use, side.mesh->limits, FaceSurface(side.mesh->face)});
      limits_.chord = std::min(limits_.chord, side.mesh->limits.chord);
    }
  }

  /// The points to add, by segment: those that the limits ask for, and halves until there are `least` segments.
  std::vector<std::vector<Added>> run(std::size_t least) {
    std::vector<std::vector<Added>> result(line_.parameters.size() - 1);
    if (!curve_.exists()) return result;
    least_depth_ = 0;
    while ((result.size() << least_depth_) < least) ++least_depth_;
    for (std::size_t k = 0; k + 1 < line_.parameters.size(); ++k) {
      const Added from{line_.parameters[k], points_[line_.shared[k]]},
          to{line_.parameters[k + 1], points_[line_.shared[k + 1]]};
      cut(from, to, 0, result[k]);
    }
    return result;
  }

 private:
  struct Seen {
    const EdgeUse* use;
    const RefineLimits& limits;
    FaceSurface surface;
  };

  void cut(const Added& from, const Added& to, int depth, std::vector<Added>& result) const {
    constexpr int k_max_depth = 14;
    const double t = 0.5 * (from.parameter + to.parameter);
    const Added middle{t, curve_.at(t)};
    if (depth == k_max_depth ||
        !(depth < least_depth_ || exceeds_curve(from, middle, to) || exceeds_surfaces(from, to)))
      return;
    cut(from, middle, depth + 1, result);
    result.push_back(middle);
    cut(middle, to, depth + 1, result);
  }

  bool exceeds_curve(const Added& from, const Added& middle, const Added& to) const {
    const double length = norm(to.position - from.position);
    const double reach = std::max(length, 2 * norm(middle.position - from.position));
    if (reach < 0.01 * limits_.chord) return false;
    if (length > limits_.max_edge) return true;
    const auto away = [&](Vec3 p) {
      const Vec3 along = normalized(to.position - from.position), offset = p - from.position;
      return norm(offset - dot(offset, along) * along);
    };
    const auto at = [&](double w) { return curve_.at((1 - w) * from.parameter + w * to.parameter); };
    constexpr double k_goal = 0.8;  // Leaves something to the triangles beside the segment.
    const double allowed = k_goal * limits_.chord;
    return away(middle.position) > allowed || away(at(0.25)) > allowed || away(at(0.75)) > allowed;
  }

  bool exceeds_surfaces(const Added& from, const Added& to) const {
    for (const Seen& seen : surfaces_) {
      FacePatch pair;
      pair.nodes = {node_at(seen, from), node_at(seen, to)};
      if (edge_excess(pair, 0, 1, seen.surface.at(pair.middle_uv(0, 1)), seen.limits) > 1) return true;
    }
    return false;
  }

  static PatchNode node_at(const Seen& seen, const Added& point) {
    return edge_node(*seen.use, point.parameter, seen.surface, k_no_value, point.position);
  }

  const EdgeLine& line_;
  const std::vector<Vec3>& points_;
  EdgeCurve curve_;
  int least_depth_ = 0;
  RefineLimits limits_;  // The strictest of the faces'.
  std::vector<Seen> surfaces_;
};

using AddedPoints = std::vector<std::vector<Added>>;

/// Finds half-edges of a patch by their ends.
class HalfEdgeFinder {
 public:
  HalfEdgeFinder(const FacePatch& patch, const std::vector<EdgeUse>& uses)
      : patch_(patch), on_edge_(patch.nodes.size(), 0) {
    for (const EdgeUse& use : uses)
      for (const Index node : use.nodes) on_edge_[node] = 1;
    index();
  }

  /// The half-edge from a to b, both of them nodes that were there at construction; k_no_value when there is none.
  HalfEdge find(Index a, Index b) {
    HalfEdge h = look_up(a, b);
    const bool moved = h != k_no_value && (patch_.from(h) != a || patch_.to(h) != b);
    if (!moved) return h;
    index();
    return look_up(a, b);
  }

 private:
  struct Known {
    Index a, b;
    HalfEdge h;
    auto operator<=>(const Known&) const = default;
  };

  void index() {
    known_.clear();
    const auto wanted = [&](Index node) { return node < on_edge_.size() && on_edge_[node] != 0; };
    for (HalfEdge h = 0; h < 3 * patch_.triangles.size(); ++h)
      if (wanted(patch_.from(h)) && wanted(patch_.to(h))) known_.push_back({patch_.from(h), patch_.to(h), h});
    std::sort(known_.begin(), known_.end());
  }

  HalfEdge look_up(Index a, Index b) const {
    const auto found = std::lower_bound(known_.begin(), known_.end(), Known{a, b, 0});
    return found != known_.end() && found->a == a && found->b == b ? found->h : k_no_value;
  }

  const FacePatch& patch_;
  std::vector<std::uint8_t> on_edge_;
  std::vector<Known> known_;
};

/// Puts the new nodes of one use onto the face's boundary.
void split_use(FacePatch& patch, EdgeUse& use, const AddedPoints& added, const std::vector<std::uint32_t>& first_shared,
               const FaceSurface& surface, HalfEdgeFinder& finder) {
  if (use.nodes.size() != added.size() + 1) return;
  std::vector<Index> nodes;
  for (std::size_t k = 0; k < added.size(); ++k) {
    const Index a = use.nodes[k], b = use.nodes[k + 1];
    nodes.push_back(a);
    if (added[k].empty()) continue;
    std::vector<Index> between;
    for (std::size_t i = 0; i < added[k].size(); ++i) {
      between.push_back(static_cast<Index>(patch.nodes.size()));
      patch.nodes.push_back(edge_node(use, added[k][i].parameter, surface,
                                      first_shared[k] + static_cast<std::uint32_t>(i), added[k][i].position));
    }
    nodes.insert(nodes.end(), between.begin(), between.end());
    HalfEdge rest = finder.find(a, b);
    if (rest == k_no_value) {
      rest = finder.find(b, a);
      std::reverse(between.begin(), between.end());
    }
    if (rest == k_no_value) continue;
    for (const Index node : between) rest = patch.split(rest, node);
  }
  nodes.push_back(use.nodes.back());
  use.nodes = std::move(nodes);
}

}  // namespace

EdgeNet::EdgeNet(const TopoDS_Shape& shape) {
  TopExp::MapShapes(shape, TopAbs_EDGE, edges_);
  TopExp::MapShapes(shape, TopAbs_VERTEX, vertices_);
  vertex_points_.assign(static_cast<std::size_t>(vertices_.Extent()), k_no_value);
  lines_.resize(static_cast<std::size_t>(edges_.Extent()));
  for (std::size_t i = 0; i < lines_.size(); ++i)
    lines_[i].degenerate = BRep_Tool::Degenerated(edge(static_cast<std::uint32_t>(i)));
}

std::uint32_t EdgeNet::index_of(const TopoDS_Edge& edge) const {
  return static_cast<std::uint32_t>(edges_.FindIndex(edge) - 1);
}

TopoDS_Edge EdgeNet::edge(std::uint32_t index) const {
  return TopoDS::Edge(edges_(static_cast<int>(index) + 1).Oriented(TopAbs_FORWARD));
}

std::uint32_t EdgeNet::add_point(Vec3 position) {
  points_.push_back(position);
  return static_cast<std::uint32_t>(points_.size() - 1);
}

std::uint32_t EdgeNet::vertex_point(const TopoDS_Shape& vertex, Vec3 position) {
  const int index = vertex.IsNull() ? 0 : vertices_.FindIndex(vertex);
  if (index == 0) return add_point(position);
  std::uint32_t& known = vertex_points_[static_cast<std::size_t>(index - 1)];
  if (known == k_no_value) known = add_point(to_vec(BRep_Tool::Pnt(TopoDS::Vertex(vertex)).XYZ()));
  return known;
}

void EdgeNet::set_line(std::uint32_t index, std::vector<double> parameters) {
  EdgeLine& line = lines_[index];
  const TopoDS_Edge shape = edge(index);
  const EdgeCurve curve(shape);
  TopoDS_Vertex first, last;
  TopExp::Vertices(shape, first, last, false);
  const auto position = [&](double t) { return curve.exists() ? curve.at(t) : Vec3{}; };
  line.shared.clear();
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const bool start = k == 0, end = k + 1 == parameters.size();
    if (line.degenerate || start)
      line.shared.push_back(vertex_point(first, position(parameters[k])));
    else
      line.shared.push_back(end ? vertex_point(last, position(parameters[k])) : add_point(position(parameters[k])));
  }
  line.parameters = std::move(parameters);
}

std::vector<double> EdgeNet::discretize(std::uint32_t index, const RefineLimits& limits) const {
  const TopoDS_Edge shape = edge(index);
  double first = 0, last = 0;
  BRep_Tool::Range(shape, first, last);
  std::vector<double> result = {first, last};
  const EdgeCurve curve(shape);
  if (lines_[index].degenerate || !curve.exists()) return result;
  try {
    const GCPnts_TangentialDeflection points(BRepAdaptor_Curve(shape), limits.angle, limits.chord, 2, 1e-9,
                                             limits.min_edge);
    result.resize(1);
    for (int i = 2; i < points.NbPoints(); ++i) result.push_back(points.Parameter(i));
    result.push_back(last);
  } catch (const Standard_Failure&) {
    // The two ends are refined like any other segment.
    result = {first, last};
  }
  return result;
}

/// So many segments each edge needs for its polyline to enclose something with its neighbours': an edge that returns to
/// its start needs three, one of several between the same two points two.
std::vector<std::size_t> EdgeNet::least_segments() const {
  std::vector<std::size_t> result(lines_.size(), 1);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>> between;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (lines_[i].degenerate || lines_[i].shared.size() < 2) continue;
    const auto ends = std::minmax(lines_[i].shared.front(), lines_[i].shared.back());
    if (ends.first == ends.second)
      result[i] = 3;
    else
      between[ends].push_back(i);
  }
  for (const auto& [ends, edges] : between)
    if (edges.size() > 1)
      for (const std::size_t i : edges) result[i] = 2;
  return result;
}

std::size_t EdgeNet::refine(std::vector<FaceMesh>& faces) {
  std::vector<std::vector<Side>> sides(lines_.size());
  for (const FaceMesh& mesh : faces)
    for (const EdgeUse& use : mesh.uses) sides[use.edge].push_back({&mesh, &use});
  const std::vector<std::size_t> least = least_segments();
  std::vector<AddedPoints> added(lines_.size());
  parallel_for(lines_.size(), [&](std::size_t i) {
    if (lines_[i].parameters.size() < 2 || lines_[i].degenerate || sides[i].empty()) return;
    added[i] = LineRefiner(*this, static_cast<std::uint32_t>(i), sides[i]).run(least[i]);
  });

  std::size_t count = 0;
  std::vector<std::vector<std::uint32_t>> first_shared(lines_.size());
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    EdgeLine line = lines_[i];
    line.parameters.clear();
    line.shared.clear();
    for (std::size_t k = 0; k < added[i].size(); ++k) {
      line.parameters.push_back(lines_[i].parameters[k]);
      line.shared.push_back(lines_[i].shared[k]);
      first_shared[i].push_back(static_cast<std::uint32_t>(points_.size()));
      for (const Added& point : added[i][k]) {
        line.parameters.push_back(point.parameter);
        line.shared.push_back(add_point(point.position));
        ++count;
      }
    }
    if (added[i].empty()) continue;
    line.parameters.push_back(lines_[i].parameters.back());
    line.shared.push_back(lines_[i].shared.back());
    lines_[i] = std::move(line);
  }
  if (count == 0) return 0;
  parallel_for(faces.size(), [&](std::size_t f) {
    const FaceSurface surface(faces[f].face);
    HalfEdgeFinder finder(faces[f].patch, faces[f].uses);
    for (EdgeUse& use : faces[f].uses)
      if (!added[use.edge].empty())
        split_use(faces[f].patch, use, added[use.edge], first_shared[use.edge], surface, finder);
  });
  return count;
}

bool make_use(const EdgeNet& net, const TopoDS_Edge& edge, const TopoDS_Face& face, EdgeUse& use) {
  use.edge = net.index_of(edge);
  use.reversed = edge.Orientation() == TopAbs_REVERSED;
  double first = 0, last = 0, edge_first = 0, edge_last = 0;
  use.curve = BRep_Tool::CurveOnSurface(edge, face, first, last);
  if (use.curve.IsNull()) return false;
  BRep_Tool::Range(edge, edge_first, edge_last);
  const bool same = edge_last == edge_first || (first == edge_first && last == edge_last);
  use.factor = same ? 1 : (last - first) / (edge_last - edge_first);
  use.offset = same ? 0 : first - use.factor * edge_first;
  return true;
}

PatchNode edge_node(const EdgeUse& use, double parameter, const FaceSurface& surface, std::uint32_t shared,
                    Vec3 position) {
  const gp_Pnt2d uv = use.curve->Value(use.offset + use.factor * parameter);
  PatchNode node = surface_node(surface, {uv.X(), uv.Y()});
  node.gap = position - node.position;
  node.position = position;
  node.shared = shared;
  return node;
}

}  // namespace papilla::cad
