// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/io/scene.hpp"

namespace papilla {

/// Options of read_cad().
struct CadReadOptions {
  double chord_mm = 0.1;        ///< Largest distance between a triangle and the surface it stands for.
  double angle_deg = 20;        ///< Largest turn of the surface's normal along a triangle's edge, in (0, 90]; not asked
                                ///< of edges shorter than a tenth of the chord.
  double max_edge_mm = 0;       ///< Longest edge of a triangle; 0: any.
  bool relative = false;        ///< `chord_mm` is a fraction of each part's diagonal instead of millimetres, in (0, 1].
  double brep_mm_per_unit = 1;  ///< BREP files carry no unit.
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
  double max_deviation_mm = 0;   ///< Largest distance from a triangle to the exact surface at its (u, v), on samples
                                 ///< that the refinement did not use: 9 inside of each triangle, and all nodes on edges.
  double max_angle_deg = 0;      ///< Largest turn of the surface's normal along an edge that the angle is asked of.
  std::size_t added_nodes = 0;   ///< Nodes that refinement put on edges and faces beyond the mesher's.
};

/// What read_cad() met. Counters are over the parts of the scene, each shape once however often it is used.
struct CadReport {
  std::size_t solids = 0, faces = 0, triangles = 0, added_nodes = 0;
  std::size_t dropped_triangles = 0;        ///< Collapsed onto an edge or a point by the parametrization.
  std::vector<CadFaceNote> failed_faces;    ///< Left without triangles, or with a gap to their neighbours.
  std::vector<CadFaceNote> repaired_faces;  ///< Refused by the mesher, triangulated in another way, without gap.
  std::vector<CadFaceNote> off_faces;       ///< Further off than the chord, or with folds.
  std::vector<CadPartReport> parts;         ///< One per part of the scene.
  double max_deviation_mm = 0, max_angle_deg = 0;  ///< Largest of the parts.
  double seconds_read = 0, seconds_tessellate = 0, seconds_convert = 0;
};

/// Reads STEP (AP203, AP214, AP242), IGES or OpenCASCADE BREP and tessellates it.
///
/// The kind of file is told by its content. Units become millimetres, axes stay (Z up). The assembly tree becomes
/// nodes; a shape used several times becomes one Part used by several nodes. Names are UTF-8. Per part:
///  - `positions` are welded along the edges and vertices that the CAD topology shares between faces, whatever their
///    coordinates; shapes that merely touch stay apart. A closed, sewn solid therefore gives a closed mesh, counter-
///    clockwise seen from outside. What the CAD file left unsewn (IGES surfaces) stays unsewn.
///  - `face` numbers the CAD faces from 0 in the order of the file's shape; equal numbers over re-import.
///  - `cad_uv` holds the parameters (u, v) of the CAD surface at each corner, which jump at the surface's own seam.
///  - `normals` are those of the CAD surface, outward, of unit length; where it has none (a cone's apex) the mean of
///  the
///    triangles around.
///  - Colours become materials named "#RRGGBB" (sRGB; "#RRGGBBAA" when translucent), `base_color` linear as glTF wants
///    it, and `extras_json` {"cad_colour": "#RRGGBB"}. A face's colour wins over an instance's, that over its part's,
///    that over the assembly's. A part of which nothing is coloured has no material.
///  - Layers, materials with density, and visibility go into `extras_json` of the part or node.
///
/// Chord and angle steer OpenCASCADE's mesher, which keeps them on edges and nearly so inside of faces:
/// CadReport::max_deviation_mm tells what was reached.
/// Good input: closed solids in millimetres of real size. A part with faces that the mesher refuses is tried again in
/// other sizes, then those faces healed and alone; what fails then is reported in `failed_faces` and left out.
/// Cost: a second per MB of STEP to read, then about 30 µs of one core and 600 bytes per triangle; the time of a single
/// large face grows faster than its triangles.
/// Deterministic, for any number of threads; takes as many as TBB may (tbb::global_control). Calls from several threads
/// run one after the other.
///
/// @param options chord_mm at least 1e-6 of the model's diagonal, angle_deg in (0, 90].
/// @throws IoError when the file can't be opened; InvalidInput when options are out of range, or the file is of another
///         kind, truncated, damaged, or holds no face.
Scene read_cad(const std::filesystem::path& path, const CadReadOptions& options = {}, CadReport* report = nullptr,
               const Progress& progress = {});

/// True for the extensions of the formats read_cad() reads, in any case: .step .stp .p21 .iges .igs .brep .brp.
bool is_cad_extension(const std::filesystem::path& path);

}  // namespace papilla
