// SPDX-License-Identifier: MIT
#include "obj_parts.hpp"

#include <fmt/core.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <exception>
#include <map>
#include <string>
#include <vector>

#include "mtl_reader.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/referenced_file.hpp"
#include "polygon_triangulation.hpp"
#include "text_scanner.hpp"

namespace papilla::io_detail {
namespace {

constexpr Triangle k_no_values = {k_no_value, k_no_value, k_no_value};

/// Materials of the libraries by name; an unknown name becomes a material with default values.
class MaterialTable {
 public:
  MaterialTable(const ObjContent& content, const std::filesystem::path& obj, Scene& scene) : scene_(scene) {
    for (const ObjLibrary& library : content.libraries) read_library(library, obj);
    for (std::uint32_t i = 0; i < scene.materials.size(); ++i) by_name_.try_emplace(scene.materials[i].name, i);
  }

  std::uint32_t number(const std::string& name) {
    const auto found = by_name_.find(name);
    if (found != by_name_.end()) return found->second;
    if (!name.empty()) scene_.warnings.push_back("material '" + shown(name) + "' is not defined");
    Material material;
    material.name = name.empty() ? "default" : name;
    scene_.materials.push_back(std::move(material));
    return by_name_[name] = static_cast<std::uint32_t>(scene_.materials.size() - 1);
  }

 private:
  /// The whole rest of the line is a name with spaces, or else a list of names.
  void read_library(const ObjLibrary& library, const std::filesystem::path& obj) {
    const std::string place = fmt::format("{}: line {}", obj.string(), library.line);
    const auto find = [&](std::string_view name) {
      return resolve_reference({obj.parent_path(), place, std::string(name)});
    };
    if (const auto file = find(library.names)) return read_mtl(*file, scene_);
    std::string_view rest = library.names;
    for (std::string_view name = next_word(rest); !name.empty(); name = next_word(rest)) {
      if (const auto file = find(name))
        read_mtl(*file, scene_);
      else
        scene_.warnings.push_back("material library '" + shown(name) + "' is missing");
    }
  }

  Scene& scene_;
  std::map<std::string, std::uint32_t> by_name_;
};

/// From the least to the greatest of some indices.
struct IndexRange {
  Index low = k_no_index, high = 0;

  void include(Index index) {
    if (index == k_no_index) return;
    low = std::min(low, index);
    high = std::max(high, index);
  }
  std::size_t size() const { return low == k_no_index ? 0 : std::size_t{high} - low + 1; }
};

/// Which of a file list's entries a part uses, renumbered in their order. Used for one part after the other.
class Renumbering {
 public:
  void begin(const IndexRange& range) {
    low_ = range.low;
    if (numbers_.size() < range.size()) numbers_.resize(range.size(), k_no_index);
  }

  void use(Index index) {
    Index& number = numbers_[index - low_];
    if (number != k_no_index) return;
    number = 0;
    used_.push_back(index);
  }

  template <class T>
  Values<T> finish(const std::vector<T>& list) {
    std::sort(used_.begin(), used_.end());
    Values<T> result;
    result.reserve(used_.size());
    for (const Index index : used_) {
      numbers_[index - low_] = static_cast<Index>(result.size());
      result.push_back(list[index]);
    }
    return result;
  }

  Index operator[](Index index) const { return numbers_[index - low_]; }

  void clear() {
    for (const Index index : used_) numbers_[index - low_] = k_no_index;
    used_.clear();
  }

 private:
  Index low_ = 0;
  std::vector<Index> numbers_, used_;
};

class PartAssembler {
 public:
  PartAssembler(const ObjContent& content, const std::string& file, double unit)
      : content_(content), file_(file), unit_(unit) {}

  /// @param slots  the part's slot of every material number of the content.
  void assemble(const std::vector<const ObjRun*>& runs, const std::map<std::uint32_t, std::uint32_t>& slots,
                Part& part) {
    TriangleMesh& mesh = part.mesh;
    collect(runs, mesh);
    const bool several_groups = differ(runs, &ObjOwner::group), several_slots = differ(runs, &ObjOwner::material);
    for (const ObjRun* run : runs) {
      content_.faces.each(*run, [&](const ObjFace& face) { append_face(face, mesh); });
      if (several_groups) mesh.face.resize(mesh.triangles.size(), run->owner.group);
      if (several_slots) mesh.material.resize(mesh.triangles.size(), slots.at(run->owner.material));
    }
    if (!content_.colors.empty()) mesh.colors.indices = mesh.triangles;
    positions_.clear();
    uv_.clear();
    normals_.clear();
  }

 private:
  static bool differ(const std::vector<const ObjRun*>& runs, std::uint32_t ObjOwner::*number) {
    return std::any_of(runs.begin(), runs.end(),
                       [&](const ObjRun* run) { return run->owner.*number != runs.front()->owner.*number; });
  }

  /// Fills the value lists and makes room for the triangles. Faces without uv or normals have no value there; where
  /// only some corners lack one, these use a neutral value behind the others.
  void collect(const std::vector<const ObjRun*>& runs, TriangleMesh& mesh) {
    has_uv_ = has_normals_ = false;
    find_ranges(runs);
    bool lacks_uv = false, lacks_normals = false;
    std::size_t triangles = 0;
    const auto collect_face = [&](const ObjFace& face) {
      std::uint32_t with_uv = 0, with_normal = 0;
      for (std::size_t i = face.first_corner; i < face.first_corner + face.corners; ++i) {
        const ObjCorner corner = content_.corners[i];
        positions_.use(corner.position);
        if (corner.uv != k_no_index) uv_.use(corner.uv);
        if (corner.normal != k_no_index) normals_.use(corner.normal);
        with_uv += corner.uv != k_no_index;
        with_normal += corner.normal != k_no_index;
      }
      has_uv_ |= with_uv > 0;
      has_normals_ |= with_normal > 0;
      lacks_uv |= with_uv > 0 && with_uv < face.corners;
      lacks_normals |= with_normal > 0 && with_normal < face.corners;
      triangles += face.corners - 2;
    };
    for (const ObjRun* run : runs) content_.faces.each(*run, collect_face);
    mesh.positions = positions_.finish(content_.positions);
    for (Vec3& position : mesh.positions) position = unit_ * position;
    if (!content_.colors.empty()) mesh.colors.values = positions_.finish(content_.colors);
    mesh.uv.values = uv_.finish(content_.uv);
    mesh.normals.values = normals_.finish(content_.normals);
    no_uv_ = static_cast<Index>(mesh.uv.values.size());
    no_normal_ = static_cast<Index>(mesh.normals.values.size());
    if (has_uv_ && lacks_uv) mesh.uv.values.emplace_back();
    if (has_normals_ && lacks_normals) mesh.normals.values.emplace_back();
    mesh.triangles.reserve(triangles);
    if (has_uv_) mesh.uv.indices.reserve(triangles);
    if (has_normals_) mesh.normals.indices.reserve(triangles);
  }

  void find_ranges(const std::vector<const ObjRun*>& runs) {
    IndexRange positions, uv, normals;
    for (const ObjRun* run : runs)
      content_.faces.each(*run, [&](const ObjFace& face) {
        for (std::size_t i = face.first_corner; i < face.first_corner + face.corners; ++i) {
          const ObjCorner corner = content_.corners[i];
          positions.include(corner.position);
          uv.include(corner.uv);
          normals.include(corner.normal);
        }
      });
    positions_.begin(positions);
    uv_.begin(uv);
    normals_.begin(normals);
  }

  void append_face(const ObjFace& face, TriangleMesh& mesh) {
    if (face.corners == 3) return append_triangle(face, {0, 1, 2}, mesh);
    points_.clear();
    for (std::size_t i = 0; i < face.corners; ++i)
      points_.push_back(content_.positions[content_.corners[face.first_corner + i].position]);
    for (const auto& triangle : cut(face)) append_triangle(face, triangle, mesh);
  }

  /// @param triangle  of the face's corners.
  void append_triangle(const ObjFace& face, const std::array<std::size_t, 3>& triangle, TriangleMesh& mesh) {
    Triangle positions{}, uv{}, normals{};
    for (std::size_t k = 0; k < 3; ++k) {
      const ObjCorner corner = content_.corners[face.first_corner + triangle[k]];
      positions[k] = positions_[corner.position];
      uv[k] = corner.uv == k_no_index ? no_uv_ : uv_[corner.uv];
      normals[k] = corner.normal == k_no_index ? no_normal_ : normals_[corner.normal];
    }
    mesh.triangles.push_back(positions);
    if (has_uv_) mesh.uv.indices.push_back(lacks_all(face, &ObjCorner::uv) ? k_no_values : uv);
    if (has_normals_) mesh.normals.indices.push_back(lacks_all(face, &ObjCorner::normal) ? k_no_values : normals);
  }

  bool lacks_all(const ObjFace& face, Index ObjCorner::*index) const {
    for (std::size_t i = face.first_corner; i < face.first_corner + face.corners; ++i)
      if (ObjCorner corner = content_.corners[i]; corner.*index != k_no_index) return false;
    return true;
  }

  std::vector<std::array<std::size_t, 3>> cut(const ObjFace& face) const {
    try {
      return triangulate_polygon(points_);
    } catch (const InvalidInput& error) {
      throw InvalidInput(fmt::format("{}: line {}: {}", file_, face.line, error.what()));
    }
  }

  const ObjContent& content_;
  const std::string& file_;
  double unit_;
  Renumbering positions_, uv_, normals_;
  bool has_uv_ = false, has_normals_ = false;
  Index no_uv_ = 0, no_normal_ = 0;
  std::vector<Vec3> points_;
};

/// The runs of a part, and the slot of every material number in it.
struct PartRuns {
  std::vector<const ObjRun*> runs;
  std::map<std::uint32_t, std::uint32_t> slots;
  Part part;  ///< Its name and materials.
};

/// Faces by object, or by group in a file without objects, in the order of first use.
std::vector<PartRuns> runs_of_parts(const ObjContent& content, const std::filesystem::path& path, Scene& scene) {
  const bool by_object = content.objects.names().size() > 1;
  const auto& names = by_object ? content.objects.names() : content.groups.names();
  std::vector<PartRuns> parts(names.size());
  for (const ObjRun& run : content.faces.runs())
    parts[by_object ? run.owner.object : run.owner.group].runs.push_back(&run);

  MaterialTable materials(content, path, scene);
  const bool has_materials = content.materials.names().size() > 1;
  for (std::size_t i = 0; i < names.size(); ++i) {
    PartRuns& its = parts[i];
    its.part.name = names[i];
    for (const ObjRun* run : its.runs) {
      const std::uint32_t number = run->owner.material;
      const auto [slot, is_new] = its.slots.try_emplace(number, static_cast<std::uint32_t>(its.slots.size()));
      if (is_new && has_materials) its.part.materials.push_back(materials.number(content.materials.names()[number]));
    }
  }
  std::erase_if(parts, [](const PartRuns& part) { return part.runs.empty(); });
  return parts;
}

}  // namespace

void assemble_obj_parts(ObjContent content, const std::filesystem::path& path, Scene& scene) {
  content.colors.resize(content.colors.empty() ? 0 : content.positions.size());
  const std::string file = path.string();
  std::vector<PartRuns> parts = runs_of_parts(content, path, scene);
  std::vector<std::exception_ptr> errors(parts.size());
  oneapi::tbb::enumerable_thread_specific<PartAssembler> assemblers(
      [&] { return PartAssembler(content, file, scene.millimetres_per_unit); });
  oneapi::tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
    try {
      assemblers.local().assemble(parts[i].runs, parts[i].slots, parts[i].part);
    } catch (...) {
      errors[i] = std::current_exception();
    }
  });
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
  for (PartRuns& part : parts) scene.parts.push_back(std::move(part.part));
}

}  // namespace papilla::io_detail
