// SPDX-License-Identifier: MIT
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <system_error>
#include <utility>

#include "cad_document.hpp"
#include "cad_parallel.hpp"
#include "cad_plugin.hpp"
#include "cad_tree.hpp"
#include "meshed_shape.hpp"
#include "occt_session.hpp"
#include "papilla/cache/stage_cache.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/core/unit_name.hpp"
#include "papilla/haptic/material_tag_stream.hpp"
#include "papilla/io/isolated.hpp"
#include "papilla/io/pipe_stream.hpp"

namespace papilla {
namespace {

void check_options(const CadReadOptions& options) {
  const auto refuse = [](const std::string& what, double value) {
    throw InvalidInput("read_cad: " + what + ", got " + std::to_string(value));
  };
  if (!(options.chord_mm > 0) || !std::isfinite(options.chord_mm)) refuse("chord_mm must be > 0", options.chord_mm);
  if (!(options.angle_deg > 0 && options.angle_deg <= 90)) refuse("angle_deg must be in (0, 90]", options.angle_deg);
  if (const double unit = options.millimetres_per_unit.value_or(1); !(unit > 0) || !std::isfinite(unit))
    refuse("millimetres_per_unit must be > 0", unit);
  if (!(options.max_edge_mm >= 0) || !std::isfinite(options.max_edge_mm))
    refuse("max_edge_mm must be >= 0", options.max_edge_mm);
  if (options.relative && options.chord_mm > 1) refuse("a relative chord must be in (0, 1]", options.chord_mm);
}

/// A chord this far below the model's size would need more triangles than fit into memory.
constexpr double k_least_relative_chord = 1e-6;
constexpr double k_least_relative_edge = 1e-4;

void check_size(const std::filesystem::path& path, const std::vector<TopoDS_Shape>& shapes,
                const CadReadOptions& options) {
  if (shapes.empty()) throw InvalidInput(path.string() + ": holds no face");
  const double diagonal = cad::diagonal_of(shapes);
  if (!std::isfinite(diagonal)) throw InvalidInput(path.string() + ": holds geometry that is not finite");
  if (options.max_edge_mm > 0 && options.max_edge_mm < k_least_relative_edge * diagonal)
    throw InvalidInput(path.string() + ": longest edge " + std::to_string(options.max_edge_mm) +
                       " mm is below 1e-4 of the model's diagonal, " + std::to_string(diagonal) + " mm");
  if (!options.relative && options.chord_mm < k_least_relative_chord * diagonal)
    throw InvalidInput(path.string() + ": chord " + std::to_string(options.chord_mm) +
                       " mm is below 1e-6 of the model's diagonal, " + std::to_string(diagonal) + " mm");
}

std::size_t count_solids(const TopoDS_Shape& shape) {
  std::size_t count = 0;
  for (TopExp_Explorer solids(shape, TopAbs_SOLID); solids.More(); solids.Next()) ++count;
  return count;
}

/// @param face_materials slot of each CAD face, by number, or empty.
void add_mesh(Part& part, cad::MeshedShape shape, const std::vector<std::uint32_t>& face_materials, CadReport& report) {
  for (const cad::FaceTrouble& trouble : shape.troubles)
    (trouble.solved ? report.repaired_faces : report.failed_faces)
        .push_back({part.id, trouble.number, trouble.reason, trouble.tried});
  for (const cad::FaceOff& off : shape.off) report.off_faces.push_back({part.id, off.number, off.reason, {}});
  report.parts.push_back({part.id, shape.max_deviation_mm, shape.max_angle_deg, shape.added_nodes});
  report.faces += shape.faces;
  report.added_nodes += shape.added_nodes;
  report.max_deviation_mm = std::max(report.max_deviation_mm, shape.max_deviation_mm);
  report.max_angle_deg = std::max(report.max_angle_deg, shape.max_angle_deg);
  report.triangles += shape.mesh.triangles.size();
  report.dropped_triangles += shape.dropped_triangles;
  part.mesh = std::move(shape.mesh);
  if (face_materials.empty()) return;
  part.mesh.material.reserve(part.mesh.face.size());
  for (const std::uint32_t face : part.mesh.face) part.mesh.material.push_back(face_materials[face]);
}

void warn_of_faces(const CadReport& report, Scene& scene) {
  const auto place = [](const CadFaceNote& note) {
    return "face " + std::to_string(note.face) + " of part '" + note.part + "' ";
  };
  for (const CadFaceNote& note : report.failed_faces)
    scene.losses.push_back(place(note) + "has no triangles or gaps: " + note.reason);
  for (const CadFaceNote& note : report.repaired_faces)
    scene.warnings.push_back(place(note) + "was refused by the mesher and triangulated in another way: " + note.reason);
  for (const CadFaceNote& note : report.off_faces) scene.warnings.push_back(place(note) + note.reason);
}

/// Processor time that no sound file needs to be read: the slowest real files take 2 s per MB.
double reading_seconds(const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  constexpr double k_base = 5, k_per_byte = 30e-6;
  return k_base + (error ? 0 : k_per_byte * static_cast<double>(bytes));
}

/// The same for the mesher: the slowest real faces take a few seconds at the finest chord that is allowed.
double tessellating_seconds(const std::vector<TopoDS_Shape>& shapes) {
  std::size_t faces = 0;
  for (const TopoDS_Shape& shape : shapes)
    for (TopExp_Explorer all(shape, TopAbs_FACE); all.More(); all.Next()) ++faces;
  constexpr double k_base = 600, k_per_face = 60;
  return k_base + k_per_face * static_cast<double>(faces);
}

/// Tolerances for shapes that are still to be scaled.
CadReadOptions in_file_units(CadReadOptions options, double scale) {
  if (!options.relative) options.chord_mm /= scale;
  options.max_edge_mm /= scale;
  return options;
}

/// Takes the file's numbers as ones of another unit.
void rescale(Scene& scene, CadReport& report, double millimetres_per_unit) {
  const double scale = millimetres_per_unit / scene.millimetres_per_unit;
  scene.millimetres_per_unit = millimetres_per_unit;
  scene.unit = unit_name(millimetres_per_unit);
  for (Part& part : scene.parts)
    for (Vec3& p : part.mesh.positions) p = scale * p;
  for (Node& node : scene.nodes)
    for (const std::size_t k : {3u, 7u, 11u}) node.local[k] *= scale;
  report.max_deviation_mm *= scale;
  for (CadPartReport& part : report.parts) part.max_deviation_mm *= scale;
}

Scene read(const std::filesystem::path& path, const CadReadOptions& options, CadReport& report,
           const ProgressCallback& progress) {
  Stopwatch watch;
  report_progress(progress, "read", 0);
  allow_processor_time(reading_seconds(path));
  cad::CadTree tree = cad::build_tree(cad::read_document(path, progress));
  const double unit = options.millimetres_per_unit.value_or(tree.scene.millimetres_per_unit);
  if (tree.scene.format == "BREP" && !options.millimetres_per_unit)
    tree.scene.warnings.push_back("BREP carries no unit: taken as mm");
  const CadReadOptions unscaled = in_file_units(options, unit / tree.scene.millimetres_per_unit);
  check_size(path, tree.shapes, unscaled);
  report.seconds_read = watch.restart();

  allow_processor_time(tessellating_seconds(tree.shapes));
  std::vector<cad::MeshedShape> shapes = cad::mesh_shapes(tree.shapes, unscaled, progress);
  report.seconds_tessellate = watch.restart();

  for (std::size_t i = 0; i < shapes.size(); ++i) {
    report_progress(progress, "convert", 0.9 + 0.1 * static_cast<double>(i) / static_cast<double>(shapes.size()));
    report.solids += count_solids(tree.shapes[i]);
    add_mesh(tree.scene.parts[i], std::move(shapes[i]), tree.face_materials[i], report);
  }
  if (report.triangles == 0) throw InvalidInput(path.string() + ": none of its faces can be tessellated");
  warn_of_faces(report, tree.scene);
  if (options.millimetres_per_unit) rescale(tree.scene, report, unit);
  report.seconds_convert = watch.restart();
  report_progress(progress, "convert", 1);
  return std::move(tree.scene);
}

/// The library's exceptions are not the standard's.
Scene read_in_this_process(const std::filesystem::path& path, const CadReadOptions& options, int threads,
                           CadReport& report, const ProgressCallback& progress) {
  try {
    cad::set_up_threads(threads);
    return read(path, options, report, progress);
  } catch (const Standard_Failure& failure) {
    std::string what = failure.GetMessageString();
    std::replace(what.begin(), what.end(), '\n', ' ');
    throw InvalidInput(path.string() + ": damaged CAD data (" + failure.DynamicType()->Name() +
                       (what.empty() ? "" : ": " + what) + ")");
  }
}

}  // namespace

Scene cad::read_file(const std::filesystem::path& path, const CadReadOptions& options, CadReport* report,
                     const ProgressCallback& progress) {
  check_options(options);
  const cad::OcctSession session;
  CadReport own;
  CadReport& filled = report ? *report : own;
  filled = {};
  const int threads = cad::wanted_threads();
  if (!options.isolated) return read_in_this_process(path, options, threads, filled, progress);
  Scene scene;
  CacheCounts counts;  // Of the child's copy of the cache.
  run_isolated({path, "the CAD library",
                [&](const ProgressCallback& child_progress) {
                  cad::after_fork();
                  const auto cache = options.cache != nullptr ? options.cache->for_child() : nullptr;
                  CadReadOptions own_options = options;
                  own_options.cache = cache.get();
                  scene = read_in_this_process(path, own_options, threads, filled, child_progress);
                  if (cache) counts = cache->counts();
                },
                [&](int pipe) { send_values(pipe, scene, filled, counts); },
                [&](int pipe) { receive_values(pipe, scene, filled, counts); }},
               progress);
  if (options.cache != nullptr)
    for (const auto& [stage, count] : counts) options.cache->add(stage, count);
  return scene;
}

}  // namespace papilla
