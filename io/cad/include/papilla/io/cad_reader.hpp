// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/io/scene.hpp"

namespace papilla {

class StageCache;

/// Who decides where triangles go. `mesher` is for comparison.
enum class CadMeshing {
  refined,  ///< Refined until chord and angle hold, measured against the exact surface.
  mesher,   ///< As OpenCASCADE's incremental mesher leaves them.
};

/// Options of read_cad().
struct CadReadOptions {
  double chord_mm = 0.1;   ///< Largest distance between a triangle and the surface it stands for.
  double angle_deg = 20;   ///< Largest turn of the surface's normal along a triangle's edge, in (0, 90]; not asked
                           ///< of edges shorter than a tenth of the chord.
  double max_edge_mm = 0;  ///< Longest edge of a triangle; 0: any.
  bool relative = false;   ///< `chord_mm` is a fraction of each part's diagonal instead of millimetres, in (0, 1].
  std::optional<double> millimetres_per_unit;  ///< Instead of the file's unit. BREP states none: 1 then.
  CadMeshing meshing = CadMeshing::refined;
  bool isolated = true;  ///< Read in a child process, so that no file can crash, hang or starve the caller.
  const StageCache* cache = nullptr;  ///< Remembers the triangles of every shape.
};

/// A CAD face that made trouble.
struct CadFaceNote {
  std::string part;                ///< Part::id.
  std::uint32_t face = 0;          ///< As in TriangleMesh::face.
  std::string reason;              ///< One clause.
  std::vector<std::string> tried;  ///< What was done about it, in order.
};

/// Deviation of one part.
struct CadPartReport {
  std::string part;             ///< Part::id.
  double max_deviation_mm = 0;  ///< Largest distance from a triangle to the exact surface around its (u, v), on 9
                                ///< points inside of it that the refinement did not use, 3 on each edge, and corners.
  double max_angle_deg = 0;     ///< Largest turn of the surface's normal along an edge that the angle is asked of.
  std::size_t added_nodes = 0;  ///< Nodes that refinement put on edges and faces beyond the mesher's.
};

/// What read_cad() met. Counters are over the parts of the scene, each shape once however often it is used.
struct CadReport {
  std::size_t solids = 0, faces = 0, triangles = 0, added_nodes = 0;
  std::size_t dropped_triangles = 0;               ///< Collapsed onto an edge or a point by the parametrization.
  std::vector<CadFaceNote> failed_faces;           ///< Left without triangles, or with a gap to their neighbours.
  std::vector<CadFaceNote> repaired_faces;         ///< Refused by the mesher, triangulated in another way, without gap.
  std::vector<CadFaceNote> off_faces;              ///< Further off than the chord, or with folds.
  std::vector<CadPartReport> parts;                ///< One per part of the scene.
  double max_deviation_mm = 0, max_angle_deg = 0;  ///< Largest of the parts.
  double seconds_read = 0, seconds_tessellate = 0, seconds_convert = 0;
};

/// Reads STEP (AP203, AP214, AP242), IGES or OpenCASCADE BREP and tessellates it.
///
/// The format is found from the file's content. Units become millimetres, axes stay (Z up). The assembly tree becomes
/// nodes; a shape used several times becomes one Part used by several nodes. A product of several solids becomes a node
/// with one Part per solid ("product/body"), since solids may touch; what belongs to no solid is one Part more. Names
/// are UTF-8. Per part:
///  - `positions` are welded along the edges and vertices that the CAD topology shares between faces, whatever their
///    coordinates. A closed, sewn solid therefore gives a closed manifold mesh, counter-clockwise seen from outside,
///    also when mirrored. What the CAD file left unsewn (IGES surfaces) stays unsewn.
///  - `face` numbers the CAD faces from 0 in the order of the file's shape; equal numbers over re-import.
///  - `cad_uv` holds the parameters (u, v) of the CAD surface at each corner, which jump at the surface's own seam; at
///    points where a parameter means nothing (a cone's apex, a sphere's pole) each triangle has its own.
///  - `normals` are those of the CAD surface, outward, of unit length; at an apex each triangle's own limit.
///  - Colours become materials named "#RRGGBB" (sRGB; "#RRGGBBAA" when translucent), `base_color` linear as glTF wants
///    it, and `extras_json` {"cad_colour": "#RRGGBB"}. A face's colour wins over an instance's, that over its part's,
///    that over the assembly's. A part of which nothing is coloured has no material.
///  - `extras_json`, and that of the nodes that use it: "layers", "cad_material" (name, density as in the file),
///    "hidden", "properties" (names and values given by the user), "validation" (area, volume, centroid as the sending
///    system had them), "pmi" (dimensions, tolerances and datums as text, with the numbers of their faces). A node's
///    also holds "id": the names from the root to it, joined by '/', "#2" where siblings share a name.
/// The scene's `extras_json` holds "source" (format, unit, schema, author, ...) and "annotations", the names of notes
/// that are only drawn. What is not kept is named in Scene::losses.
///
/// Chord and angle: d(p) ≤ chord_mm for points p of a triangle and d the distance to the surface around the triangle's
/// (u, v); ∠(n(a), n(b)) ≤ angle_deg for the surface's normals n at the ends of an edge longer than a tenth of the
/// chord. Both are kept on edges and inside of faces on dense samples, not proved between them;
/// CadReport::max_deviation_mm is measured on others. Edges that lie off their surfaces by more than the chord in the
/// CAD file can't be helped: `off_faces` names them. Good input: closed solids in millimetres of real size. A face
/// that the mesher refuses is triangulated between the polylines of its edges, as it is or with its wires put in order,
/// and so joins its neighbours (`repaired_faces`); if that fails it is healed and meshed alone, which leaves gaps
/// (`failed_faces`).
/// Cost: a second per MB of STEP to read, then about 5 µs of one core and 400 bytes per triangle.
/// Deterministic, for any number of threads; takes as many as TBB may (tbb::global_control). Calls from several threads
/// run one after the other. With `isolated` the work is done by a forked child that may use four fifths of the
/// machine's memory and processor time by the size of the file.
///
/// @param options chord_mm at least 1e-6 of the model's diagonal, angle_deg in (0, 90], max_edge_mm 0 or at least 1e-4
///        of the diagonal.
/// @throws IoError when the file can't be opened; InvalidInput when options are out of range, or the file is of another
///         kind, truncated, damaged, holds no face, or makes the library crash, hang or run out of memory.
Scene read_cad(const std::filesystem::path& path, const CadReadOptions& options = {}, CadReport* report = nullptr,
               const ProgressCallback& progress = {});

/// True for the extensions of the formats read_cad() reads, in any case: .step .stp .p21 .iges .igs .brep .brp.
bool is_cad_extension(const std::filesystem::path& path);

}  // namespace papilla
