// SPDX-License-Identifier: MIT
#include "bench/simplify_comparison.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "papilla/meshing/deviation.hpp"
#include "papilla/meshing/mesh_bounds.hpp"
#include "papilla/meshing/simplify.hpp"
#include "support/formula_meshes.hpp"
#include "support/solid_meshes.hpp"

#ifdef PAPILLA_HAVE_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

namespace papilla::bench {
namespace {

/// Tolerances over the bounding diagonal.
constexpr std::array k_tolerances = {1e-3, 1e-4};

struct Shape {
  std::string name;
  TriangleMesh mesh;
  double diagonal_mm;
};

/// A shape within a tolerance.
struct Case {
  const Shape* shape;
  double tolerance_mm;
  std::string name;
  double triangles = 0, peer_triangles = 0;
  double deviation_mm = 0, peer_deviation_mm = 0;
  bool held = false;
};

/// Whether no point of either surface is farther than the tolerance from the other one.
bool holds(const TriangleMesh& input, const TriangleMesh& result, double tolerance_mm) {
  DeviationOptions options;
  options.settled_below_mm = tolerance_mm;
  options.mean_samples = 0;
  return surface_deviation(input, result, options).bound() <= tolerance_mm;
}

/// The largest distance between the surfaces, to 1 %.
double deviation_mm(const TriangleMesh& input, const TriangleMesh& result) {
  DeviationOptions options;
  options.mean_samples = 0;
  return surface_deviation(input, result, options).value();
}

Shape shape_of(std::string name, TriangleMesh mesh) {
  const double diagonal = bounds_of(mesh).diagonal();
  return {std::move(name), std::move(mesh), diagonal};
}

#ifdef PAPILLA_HAVE_MESHOPTIMIZER
TriangleMesh by_meshoptimizer(const TriangleMesh& mesh, double error_mm) {
  std::vector<float> positions;
  for (const Vec3& p : mesh.positions)
    positions.insert(positions.end(), {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
  std::vector<unsigned> indices, left(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
  constexpr std::size_t k_stride = 3 * sizeof(float);
  const float scale = meshopt_simplifyScale(positions.data(), mesh.positions.size(), k_stride);
  left.resize(meshopt_simplify(left.data(), indices.data(), indices.size(), positions.data(), mesh.positions.size(),
                               k_stride, 0, static_cast<float>(error_mm) / scale, 0, nullptr));
  TriangleMesh result;
  result.positions = mesh.positions;
  for (std::size_t i = 0; i < left.size(); i += 3) result.triangles.push_back({left[i], left[i + 1], left[i + 2]});
  return result;
}

/// The result with the fewest triangles that holds the tolerance.
TriangleMesh fewest(const Case& c) {
  constexpr int k_steps = 8;
  double low = 0, high = 2 * c.tolerance_mm;
  TriangleMesh best = c.shape->mesh;
  for (int step = 0; step < k_steps; ++step) {
    const double error = step == 0 ? c.tolerance_mm : 0.5 * (low + high);
    TriangleMesh candidate = by_meshoptimizer(c.shape->mesh, error);
    const bool within = !candidate.triangles.empty() && holds(c.shape->mesh, candidate, c.tolerance_mm);
    (within ? low : high) = error;
    if (within && candidate.triangles.size() < best.triangles.size()) best = std::move(candidate);
  }
  return best;
}
#endif

}  // namespace

struct SimplifyComparison::State {
  std::vector<Shape> shapes;
  std::vector<Case> cases;
};

SimplifyComparison::SimplifyComparison(BenchReport& report) : state_(std::make_unique<State>()) {
  state_->shapes.push_back(shape_of("capped cylinder 64", test::capped_cylinder_mesh(64)));
  if (!report.options().quick) {
    state_->shapes.push_back(shape_of("torus 200 x 50", test::torus_mesh(200, 50)));
    state_->shapes.push_back(shape_of("handle 32 x 160", test::grid_mesh(32, 160, test::grab_handle, 0.15)));
    state_->shapes.push_back(shape_of("panel 118 x 42", test::panel_mesh(118, 42)));
  }
  for (const Shape& shape : state_->shapes)
    for (const double relative : k_tolerances)
      state_->cases.push_back({&shape, relative * shape.diagonal_mm, fmt::format("{}, {:g}", shape.name, relative)});
  for (Case& c : state_->cases) {
    report.add({.method = "simplify", .input = c.name}, [&c](Recorder& recorder) {
      SimplifyOptions options;
      options.tolerance_mm = c.tolerance_mm;
      SimplifyResult result;
      recorder.time([&] { result = simplify(c.shape->mesh, options); });
      recorder.trace(std::move(result.trace));
      c.triangles = static_cast<double>(result.mesh.triangles.size());
      c.deviation_mm = deviation_mm(c.shape->mesh, result.mesh);
      c.held = holds(c.shape->mesh, result.mesh, c.tolerance_mm);
      recorder.record("triangles", c.triangles);
    });
#ifdef PAPILLA_HAVE_MESHOPTIMIZER
    report.add({.method = "meshoptimizer", .input = c.name}, [&c](Recorder& recorder) {
      TriangleMesh result;
      recorder.time([&] { result = fewest(c); });
      c.peer_triangles = static_cast<double>(result.triangles.size());
      c.peer_deviation_mm = deviation_mm(c.shape->mesh, result);
      recorder.record("triangles", c.peer_triangles);
    });
#endif
  }
#ifdef PAPILLA_HAVE_MESHOPTIMIZER
  report.compare("simplify", "meshoptimizer", "triangles");
  report.compare("simplify", "meshoptimizer", "cpu_seconds");
#endif
}

SimplifyComparison::~SimplifyComparison() = default;

void SimplifyComparison::report(BenchReport& report) const {
  EvidenceTable table{"Simplification",
                      "Triangles left within a tolerance (of the bounding diagonal), and the largest distance between "
                      "the surfaces, measured both ways to 1 %, over that tolerance. For libmeshoptimizer the error is "
                      "searched in eight steps, each measured; a dash: it is not installed.",
                      {"input", "triangles", "left by simplify", "deviation", "left by libmeshoptimizer", "deviation"},
                      {}};
  std::size_t held = 0;
  for (const Case& c : state_->cases) {
    held += c.held ? 1u : 0u;
    const bool peer = c.peer_triangles > 0;
    table.rows.push_back({c.name, std::to_string(c.shape->mesh.triangles.size()), fmt::format("{:.0f}", c.triangles),
                          fmt::format("{:.2f}", c.deviation_mm / c.tolerance_mm),
                          peer ? fmt::format("{:.0f}", c.peer_triangles) : "-",
                          peer ? fmt::format("{:.2f}", c.peer_deviation_mm / c.tolerance_mm) : "-"});
  }
  report.table(std::move(table));
  report.target({"simplification holds its tolerance: no point of either surface is farther from the other",
                 fmt::format("{} of {} inputs", held, state_->cases.size()), held == state_->cases.size()});
}

}  // namespace papilla::bench
