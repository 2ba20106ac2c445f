// SPDX-License-Identifier: MIT
#include "fields_of_work.hpp"
#include "function.hpp"
#include "papilla/io/cad_reader.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/pipeline/part_statistics.hpp"
#include "uv_input.hpp"

namespace papilla::python {

void add_corner_attributes(py::module_& module) {
  Record<CornerAttribute<Vec2>>(module, "CornerVec2",
                                "A (u, v) per triangle corner, stored once and indexed, so that it may jump over a "
                                "seam while positions stay welded. -1 in indices: this triangle has none.")
      .field<&CornerAttribute<Vec2>::values>("values", "NDArray[np.float64]", "Of (n, 2).")
      .field<&CornerAttribute<Vec2>::indices>("indices", "NDArray[np.int32]", "Of (triangles, 3), or empty.")
      .done();
  Record<CornerAttribute<Vec3>>(module, "CornerVec3",
                                "A vector per triangle corner, stored once and indexed. -1 in indices: none.")
      .field<&CornerAttribute<Vec3>::values>("values", "NDArray[np.float64]", "Of (n, 3).")
      .field<&CornerAttribute<Vec3>::indices>("indices", "NDArray[np.int32]", "Of (triangles, 3), or empty.")
      .done();
  Record<CornerAttribute<Color>>(module, "CornerColor",
                                 "A linear RGBA colour per triangle corner, stored once and indexed. -1 in indices: "
                                 "none.")
      .field<&CornerAttribute<Color>::values>("values", "NDArray[np.float32]", "Of (n, 4), in [0, 1].")
      .field<&CornerAttribute<Color>::indices>("indices", "NDArray[np.int32]", "Of (triangles, 3), or empty.")
      .done();
}

void add_scenes(py::module_& module) {
  define(
      module, "mesh(V: ArrayLike, F: ArrayLike, uv: ArrayLike | CornerVec2 | None = None) -> TriangleMesh",
      "A mesh of arrays: positions V (n, 3) in millimetres, triangles F (m, 3) counter-clockwise seen from outside, "
      "and texture coordinates (n, 2) per position or (m, 3, 2) per corner. Arrays of float64 and int32 that are "
      "contiguous and may be written to become the mesh's own without a copy: changes show on both sides. Others are "
      "converted.",
      [](Values<Vec3>& positions, Values<Triangle>& triangles, UvInput& uv) {
        TriangleMesh mesh;
        mesh.positions = std::move(positions);
        mesh.triangles = std::move(triangles);
        mesh.uv = uv.on(mesh);
        return mesh;
      });
  define<ReadOptions>(module, "read_scene(path: str | os.PathLike[str]) -> Scene", docs::read_scene,
                      [](const std::filesystem::path& path, const ReadOptions& options,
                         const ProgressCallback& progress) { return read_scene(path, options, progress); });
  define<WriteOptions>(module, "write_scene(scene: Scene, path: str | os.PathLike[str]) -> list[str]",
                       docs::write_scene,
                       [](const Scene& scene, const std::filesystem::path& path, const WriteOptions& options) {
                         return write_scene(scene, path, options);
                       });
  define<CadReadOptions>(
      module, "read_cad(path: str | os.PathLike[str]) -> tuple[Scene, CadReport]", docs::read_cad,
      [](const std::filesystem::path& path, const CadReadOptions& options, const ProgressCallback& progress) {
        std::pair<Scene, CadReport> result;
        result.first = read_cad(path, options, &result.second, progress);
        return result;
      });
  define(module, "instances(scene: Scene) -> list[Instance]", docs::instances,
         [](const Scene& scene) { return instances(scene); });
  define(module, "single_part_scene(part: Part, format: str) -> Scene", docs::single_part_scene,
         [](Part part, const std::string& format) { return single_part_scene(std::move(part), format); });
  define(module, "part_statistics(scene: Scene) -> list[MeshStatistics]", docs::part_statistics,
         [](const Scene& scene, const ProgressCallback& progress) { return part_statistics(scene, progress); });
  define(module, "parse_material_tag(json: str) -> tuple[MaterialTag, list[HapticWarning]]", docs::parse_material_tag,
         [](const std::string& json) {
           std::pair<MaterialTag, std::vector<HapticWarning>> result;
           result.first = parse_material_tag(json, result.second);
           return result;
         });
  define(module, "material_tag_json(tag: MaterialTag) -> str",
         "The tag as compact JSON; parse_material_tag() gives the same value back, bit for bit.",
         [](const MaterialTag& tag) { return to_json(tag); });
}

}  // namespace papilla::python
