// SPDX-License-Identifier: MIT
#include "cad_tessellate.hpp"

#include <BRepBndLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <Bnd_Box.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>
#include <sstream>
#include <thread>
#include <tuple>
#include <utility>

#include "base_mesh.hpp"
#include "cad_parallel.hpp"
#include "face_refine.hpp"
#include "occt_session.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/units.hpp"

namespace papilla::cad {
namespace {

/// More triangles than this in one face are a mistake in the options.
constexpr std::size_t k_max_triangles = 20'000'000;
/// The mesher's own shortest edge, relative to the chord.
constexpr double k_min_edge = 0.1;

RefineLimits limits_of(const CadReadOptions& options, const TopoDS_Shape& shape) {
  RefineLimits limits;
  limits.chord = options.relative ? options.chord_mm * diagonal_of({shape}) : options.chord_mm;
  limits.angle = options.angle_deg * k_radians_per_degree;
  limits.min_edge = k_min_edge * limits.chord;
  if (options.max_edge_mm > 0) limits.max_edge = options.max_edge_mm;
  limits.max_triangles = k_max_triangles;
  return limits;
}

/// The mesher's triangulation. To be refined: edges as asked for, between them only what it takes to have triangles.
void run_mesher(const TopoDS_Shape& shape, const RefineLimits& limits, CadMeshing meshing,
                const Message_ProgressRange& range) {
  BRepTools::Clean(shape);
  BRepMesh_IncrementalMesh mesher;
  IMeshTools_Parameters& parameters = mesher.ChangeParameters();
  parameters.Deflection = limits.chord;
  parameters.Angle = limits.angle;
  parameters.InParallel = is_parallel();
  if (meshing == CadMeshing::refined) {
    // Its time for a face grows with the square of the nodes inside.
    constexpr double k_coarse_chord = 100, k_coarse_angle = 1;
    parameters.DeflectionInterior = k_coarse_chord * limits.chord;
    parameters.AngleInterior = std::max(limits.angle, k_coarse_angle);
    parameters.ControlSurfaceDeflection = false;
    parameters.InternalVerticesMode = false;
  }
  mesher.SetShape(shape);
  mesher.Perform(range);
}

/// Tells how much of the work is done, from the calling thread only and never less than before.
class WorkMeter {
 public:
  WorkMeter(const ProgressCallback& progress, double from, double to, std::size_t total)
      : progress_(progress), from_(from), to_(to), total_(std::max<std::size_t>(total, 1)) {}

  void add(std::size_t amount) {
    const std::size_t done = done_ += amount;
    if (!progress_ || std::this_thread::get_id() != owner_) return;
    const double fraction = static_cast<double>(done) / static_cast<double>(total_);
    if (fraction < shown_ + 0.01) return;
    shown_ = fraction;
    report_progress(progress_, "tessellate", from_ + std::min(1.0, fraction) * (to_ - from_));
  }

 private:
  const ProgressCallback& progress_;
  double from_, to_;
  std::size_t total_;
  std::atomic<std::size_t> done_ = 0;
  double shown_ = 0;  // Of the owner only.
  std::thread::id owner_ = std::this_thread::get_id();
};

struct FaceResult {
  PatchDeviation deviation;
  double gap = 0;
  std::size_t folded = 0;
};

/// An edge inside of a face whose two ends are on CAD edges.
struct Bridge {
  std::uint32_t low, high;
  std::size_t face;
  HalfEdge h;
  bool boundary;
};

std::vector<Bridge> bridges_of(const std::vector<FaceMesh>& faces) {
  std::vector<Bridge> result;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const FacePatch& patch = faces[f].patch;
    for (HalfEdge h = 0; h < 3 * patch.triangles.size(); ++h) {
      const std::uint32_t a = patch.nodes[patch.from(h)].shared, b = patch.nodes[patch.to(h)].shared;
      if (a == k_no_value || b == k_no_value || a == b || (!patch.is_boundary(h) && patch.opposite(h) < h)) continue;
      result.push_back({std::min(a, b), std::max(a, b), f, h, patch.is_fixed(h)});
    }
  }
  std::sort(result.begin(), result.end(), [](const Bridge& p, const Bridge& q) {
    return std::tie(p.low, p.high, p.face, p.h) < std::tie(q.low, q.high, q.face, q.h);
  });
  return result;
}

/// Two faces that touch along an edge may join the same two points of it through their inside: four triangles would
/// meet there. Such edges get a node of their own face.
std::size_t part_bridges(std::vector<FaceMesh>& faces) {
  const std::vector<Bridge> bridges = bridges_of(faces);
  std::size_t count = 0;
  for (std::size_t i = 0; i < bridges.size();) {
    std::size_t end = i, inner = 0;
    bool boundary = false;
    for (; end < bridges.size() && bridges[end].low == bridges[i].low && bridges[end].high == bridges[i].high; ++end) {
      boundary = boundary || bridges[end].boundary;
      inner += bridges[end].boundary ? 0u : 1u;
    }
    const bool crowded = inner > (boundary ? std::size_t{0} : std::size_t{1});
    for (; i < end; ++i) {
      if (!crowded || bridges[i].boundary) continue;
      FacePatch& patch = faces[bridges[i].face].patch;
      // An earlier split may have moved the edge to another triangle; its ends then differ.
      const HalfEdge h = bridges[i].h;
      const std::uint32_t a = patch.nodes[patch.from(h)].shared, b = patch.nodes[patch.to(h)].shared;
      if (std::min(a, b) != bridges[i].low || std::max(a, b) != bridges[i].high) continue;
      const FaceSurface surface(faces[bridges[i].face].face);
      patch.nodes.push_back(surface_node(surface, patch.middle_uv(patch.from(h), patch.to(h))));
      patch.split(h, static_cast<Index>(patch.nodes.size() - 1));
      ++count;
    }
  }
  return count;
}

/// Largest distance of a boundary node from where its parameters put it, in any direction.
double largest_offset(const FacePatch& patch) {
  double largest = 0;
  for (const PatchNode& node : patch.nodes) largest = std::max(largest, norm(node.gap));
  return largest;
}

/// Whether the boundary lies so far off the surface that triangles between the two would follow neither.
bool is_torn(const FaceMesh& mesh) {
  constexpr double k_tolerated = 0.05;
  const Vec3 origin = mesh.patch.nodes.front().position;
  double reach = 0;
  for (const PatchNode& node : mesh.patch.nodes) reach = std::max(reach, norm(node.position - origin));
  return largest_offset(mesh.patch) > std::max(k_tolerated * reach, 2 * mesh.limits.chord);
}

std::size_t refine_face(FaceMesh& mesh) {
  if (mesh.patch.triangles.empty() || is_torn(mesh)) return 0;
  return refine_patch(mesh.patch, FaceSurface(mesh.face), mesh.limits);
}

FaceResult measure_face(const FaceMesh& mesh) {
  if (mesh.patch.triangles.empty()) return {};
  return {measure_patch(mesh.patch, FaceSurface(mesh.face), mesh.limits), largest_gap(mesh.patch),
          count_folded(mesh.patch)};
}

std::string describe(const FaceResult& face, const RefineLimits& limits) {
  std::ostringstream text;
  if (face.deviation.distance > limits.chord) {
    text << "deviates by " << face.deviation.distance << " mm";
    if (face.gap > 0.5 * face.deviation.distance)
      text << " (its edges lie " << face.gap << " mm off its surface in the CAD file)";
  }
  if (face.folded > 0) text << (text.str().empty() ? "" : ", ") << face.folded << " triangles are folded over";
  return text.str();
}

/// The part of one shape's work that comes before its faces can be refined independently.
TessellatedShape prepare(const TopoDS_Shape& shape, const RefineLimits& limits, CadMeshing meshing) {
  EdgeNet net(shape);
  TessellatedShape result;
  std::vector<BaseFace> bases = base_faces(shape, net, limits);
  for (std::uint32_t i = 0; i < bases.size(); ++i) {
    if (!bases[i].refused.empty()) result.troubles.push_back({i, bases[i].refused, bases[i].tried, bases[i].solved});
    FaceMesh& mesh = result.faces.emplace_back(std::move(bases[i].mesh));
    mesh.limits = limits;
    // What the edges lie off the surface by their CAD tolerance is not left for the triangles.
    constexpr double k_least = 0.5;
    const double gap = largest_gap(mesh.patch);
    mesh.limits.chord = std::max(k_least * limits.chord, limits.chord - gap);
    // Triangles between an edge and a surface that lie further apart can't keep the chord, however many there are.
    constexpr std::size_t k_max_torn = 200'000;
    if (largest_offset(mesh.patch) > limits.chord) mesh.limits.max_triangles = k_max_torn;
  }
  if (meshing == CadMeshing::refined) result.added_nodes = net.refine(result.faces);
  result.points = net.points();
  return result;
}

}  // namespace

double diagonal_of(const std::vector<TopoDS_Shape>& shapes) {
  Bnd_Box box;
  for (const TopoDS_Shape& shape : shapes) BRepBndLib::Add(shape, box, false);
  return box.IsVoid() || box.IsOpen() ? 0 : std::sqrt(box.SquareExtent());
}

std::vector<TessellatedShape> tessellate(const std::vector<TopoDS_Shape>& shapes, const CadReadOptions& options,
                                         const ProgressCallback& progress) {
  std::vector<RefineLimits> limits;
  for (const TopoDS_Shape& shape : shapes) limits.push_back(limits_of(options, shape));
  const Handle(OcctProgress) indicator = new OcctProgress(progress, "tessellate", 0.3, 0.5);
  if (options.relative) {
    for (std::size_t i = 0; i < shapes.size(); ++i) run_mesher(shapes[i], limits[i], options.meshing, {});
  } else if (!shapes.empty()) {
    TopoDS_Compound all;
    BRep_Builder builder;
    builder.MakeCompound(all);
    for (const TopoDS_Shape& shape : shapes) builder.Add(all, shape);
    run_mesher(all, limits.front(), options.meshing, indicator->Start());
  }

  std::vector<TessellatedShape> result(shapes.size());
  parallel_for(shapes.size(), [&](std::size_t i) { result[i] = prepare(shapes[i], limits[i], options.meshing); });

  struct Job {
    std::size_t shape, face;
  };
  std::vector<Job> jobs;
  for (std::size_t i = 0; i < shapes.size(); ++i)
    for (std::size_t k = 0; k < result[i].faces.size(); ++k) jobs.push_back({i, k});
  const auto mesh_of = [&](std::size_t job) -> FaceMesh& { return result[jobs[job].shape].faces[jobs[job].face]; };
  WorkMeter meter(progress, 0.5, 0.9, 2 * jobs.size());
  std::vector<std::size_t> added(jobs.size());
  const bool refined = options.meshing == CadMeshing::refined;
  parallel_for(jobs.size(), [&](std::size_t i) {
    if (refined) added[i] = refine_face(mesh_of(i));
    meter.add(1);
  });
  parallel_for(shapes.size(), [&](std::size_t i) {
    if (refined) result[i].added_nodes += part_bridges(result[i].faces);
  });
  std::vector<FaceResult> faces(jobs.size());
  parallel_for(jobs.size(), [&](std::size_t i) {
    faces[i] = measure_face(mesh_of(i));
    meter.add(1);
  });
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    TessellatedShape& shape = result[jobs[i].shape];
    shape.added_nodes += added[i];
    shape.max_deviation_mm = std::max(shape.max_deviation_mm, faces[i].deviation.distance);
    shape.max_angle_deg = std::max(shape.max_angle_deg, faces[i].deviation.angle / k_radians_per_degree);
    const std::string off = describe(faces[i], limits[jobs[i].shape]);
    if (!off.empty()) shape.off.push_back({static_cast<std::uint32_t>(jobs[i].face), off});
  }
  return result;
}

namespace {

/// Normal of the surface beside a corner where it has none itself, as on a cone's apex: on the way to the triangle's
/// middle.
Vec3 limit_normal(const FacePatch& patch, const FaceSurface& surface, std::uint32_t t, std::size_t k) {
  constexpr double k_step = 1e-3;
  const Vec2 corner = patch.corner_uv(t, k);
  const Vec2 middle = (1.0 / 3) * (patch.corner_uv(t, 0) + patch.corner_uv(t, 1) + patch.corner_uv(t, 2));
  const Vec3 n = surface.at(corner + k_step * (middle - corner)).normal;
  if (norm(n) > 0 && is_finite(n)) return n;
  const Triangle& nodes = patch.triangles[t];
  const Vec3 a = patch.nodes[nodes[0]].position;
  const Vec3 flat = normalized(cross(patch.nodes[nodes[1]].position - a, patch.nodes[nodes[2]].position - a));
  return norm(flat) > 0 ? flat : Vec3{0, 0, 1};
}

bool has_own_values(const PatchNode& node) { return !node.is_singular() && norm(node.normal) > 0.5; }

/// Appends one face's corner values: one per node, and one per corner where the surface is singular.
class CornerWriter {
 public:
  CornerWriter(const FaceMesh& face, TriangleMesh& mesh)
      : face_(face), mesh_(mesh), index_of_(face.patch.nodes.size(), k_no_value) {}

  Index corner(std::uint32_t t, std::size_t k) {
    const FacePatch& patch = face_.patch;
    const Index node = patch.triangles[t][k];
    if (has_own_values(patch.nodes[node])) {
      if (index_of_[node] == k_no_value) index_of_[node] = append(patch.nodes[node].normal, patch.nodes[node].uv);
      return index_of_[node];
    }
    if (!surface_) surface_ = std::make_unique<FaceSurface>(face_.face);
    return append(limit_normal(patch, *surface_, t, k), patch.corner_uv(t, k));
  }

 private:
  Index append(Vec3 normal, Vec2 uv) {
    mesh_.normals.values.push_back(face_.reversed ? -normal : normal);
    mesh_.cad_uv.values.push_back(uv);
    return static_cast<Index>(mesh_.cad_uv.values.size() - 1);
  }

  const FaceMesh& face_;
  TriangleMesh& mesh_;
  std::vector<Index> index_of_;
  std::unique_ptr<FaceSurface> surface_;
};

class Gatherer {
 public:
  Gatherer(const std::vector<Vec3>& points, ShapeMesh& result)
      : points_(points), index_of_(points.size(), k_no_value), result_(result) {}

  void add(const FaceMesh& face, std::uint32_t number) {
    TriangleMesh& mesh = result_.mesh;
    const FacePatch& patch = face.patch;
    std::vector<Index> inner(patch.nodes.size(), k_no_value);
    CornerWriter corners(face, mesh);
    for (const std::uint32_t t : patch.in_rings()) {
      Triangle positions{}, values{};
      for (std::size_t k = 0; k < 3; ++k) positions[k] = position(patch, patch.triangles[t][k], inner);
      if (positions[0] == positions[1] || positions[1] == positions[2] || positions[2] == positions[0]) {
        ++result_.dropped_triangles;
        continue;
      }
      for (std::size_t k = 0; k < 3; ++k) values[k] = corners.corner(t, k);
      if (face.reversed) {
        std::swap(positions[1], positions[2]);
        std::swap(values[1], values[2]);
      }
      mesh.triangles.push_back(positions);
      mesh.normals.indices.push_back(values);
      mesh.cad_uv.indices.push_back(values);
      mesh.face.push_back(number);
    }
  }

 private:
  Index position(const FacePatch& patch, Index node, std::vector<Index>& inner) {
    const PatchNode& n = patch.nodes[node];
    Index& known = n.shared == k_no_value ? inner[node] : index_of_[n.shared];
    if (known == k_no_value) {
      known = static_cast<Index>(result_.mesh.positions.size());
      result_.mesh.positions.push_back(n.shared == k_no_value ? n.position : points_[n.shared]);
    }
    return known;
  }

  const std::vector<Vec3>& points_;
  std::vector<Index> index_of_;
  ShapeMesh& result_;
};

}  // namespace

ShapeMesh to_mesh(TessellatedShape shape) {
  ShapeMesh result;
  Gatherer gatherer(shape.points, result);
  for (std::uint32_t number = 0; number < shape.faces.size(); ++number) {
    gatherer.add(shape.faces[number], number);
    shape.faces[number] = {};
  }
  return result;
}

}  // namespace papilla::cad
