// SPDX-License-Identifier: MIT
#include "papilla/io/mesh_files.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "mesh_file_scene.hpp"
#include "mtl_reader.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/core/referenced_file.hpp"
#include "papilla/io/scene.hpp"
#include "polygon_triangulation.hpp"
#include "text_scanner.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

constexpr Index k_none = std::numeric_limits<Index>::max();
constexpr std::size_t k_max_elements = k_none - 1;
constexpr Triangle k_no_values = {k_no_value, k_no_value, k_no_value};

/// A face's corner: numbers into the file's lists, from 0, k_none when not given.
struct Corner {
  Index position = k_none, uv = k_none, normal = k_none;
};

/// The corners of faces, one list a number; those of uv and normals end with the last that is given.
class CornerList {
 public:
  std::size_t size() const noexcept { return position_.size(); }
  void reserve(std::size_t corners) { position_.reserve(corners); }

  void push_back(const Corner& corner) {
    position_.push_back(corner.position);
    add(uv_, corner.uv);
    add(normal_, corner.normal);
  }
  void resize(std::size_t size) {
    for (std::vector<Index>* list : {&position_, &uv_, &normal_}) list->resize(std::min(list->size(), size));
  }
  Corner operator[](std::size_t i) const noexcept {
    return {position_[i], i < uv_.size() ? uv_[i] : k_none, i < normal_.size() ? normal_[i] : k_none};
  }

 private:
  void add(std::vector<Index>& list, Index number) const {
    if (number == k_none) return;
    list.resize(position_.size() - 1, k_none);
    list.push_back(number);
  }

  std::vector<Index> position_, uv_, normal_;
};

struct Face {
  std::size_t first_corner;
  std::uint32_t corners, line;
};

/// Faces one after the other that belong together; the next run's first ones end them.
struct Run {
  std::size_t first_face, first_corner;
  std::uint32_t object, group, material;
};

/// The faces of a file in 8 bytes each.
class FaceList {
 public:
  void reserve(std::size_t faces) { sizes_.reserve(faces); }

  void push_back(const Face& face, std::uint32_t object, std::uint32_t group, std::uint32_t material) {
    if (runs_.empty() || runs_.back().object != object || runs_.back().group != group ||
        runs_.back().material != material)
      runs_.push_back({sizes_.size(), face.first_corner, object, group, material});
    sizes_.push_back({face.corners, face.line});
  }
  const std::vector<Run>& runs() const noexcept { return runs_; }

  /// Calls do_face(face) for those of a run.
  template <class DoFace>
  void each(const Run& run, const DoFace& do_face) const {
    const bool is_last = &run == &runs_.back();
    const std::size_t end = is_last ? sizes_.size() : (&run)[1].first_face;
    std::size_t corner = run.first_corner;
    for (std::size_t f = run.first_face; f < end; ++f) {
      do_face(Face{corner, sizes_[f].corners, sizes_[f].line});
      corner += sizes_[f].corners;
    }
  }

 private:
  struct Size {
    std::uint32_t corners, line;
  };
  std::vector<Size> sizes_;
  std::vector<Run> runs_;
};

/// A name's number in the order of first use.
class NameTable {
 public:
  std::uint32_t number(std::string_view name) {
    const auto [entry, is_new] = numbers_.try_emplace(std::string(name), static_cast<std::uint32_t>(names_.size()));
    if (is_new) names_.push_back(entry->first);
    return entry->second;
  }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::map<std::string, std::uint32_t> numbers_;
  std::vector<std::string> names_;
};

/// A mtllib statement.
struct Library {
  std::string names;
  std::size_t line;
};

/// The content of the lines, from which parts are assembled.
struct ObjContent {
  std::vector<Vec3> positions, normals;
  std::vector<Vec2> uv;
  std::vector<Color> colors;  ///< As many as positions, or none.
  CornerList corners;
  FaceList faces;
  NameTable objects, groups, materials;
  std::vector<Library> libraries;
};

class ObjParser {
 public:
  ObjParser(std::string_view text, const std::string& file, Scene& scene) : text_(text), file_(file), scene_(scene) {}

  ObjContent parse() {
    make_room();
    object_ = content_.objects.number("");
    group_ = content_.groups.number("");
    material_ = content_.materials.number("");
    std::string joined;
    for (std::string_view line = next_line(joined); !at_end_; line = next_line(joined)) parse_line(line);
    warn_of("faces of fewer than three corners are ignored", short_faces_);
    warn_of("normals are not finite and are ignored", bad_normals_);
    warn_of("colours are not finite and read as white", bad_colors_);
    for (const std::string& keyword : losses_) scene_.losses.push_back("'" + keyword + "' statements");
    return std::move(content_);
  }

 private:
  /// How often something unusual was found, and the first line.
  struct Oddity {
    std::size_t count = 0, line = 0;
  };

  /// For positions and faces as many as there are lines that begin with them: growing lists take twice their memory.
  void make_room() {
    std::size_t positions = 0, faces = 0;
    for (std::size_t at = 0; at < text_.size(); at = std::min(text_.find('\n', at), text_.size()) + 1) {
      const std::string_view line = text_.substr(at, 2);
      positions += line == "v ";
      faces += line == "f ";
    }
    content_.positions.reserve(positions);
    content_.faces.reserve(faces);
    content_.corners.reserve(3 * faces);
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw InvalidInput(fmt::format("{}: line {}: {}", file_, line_, reason));
  }

  void note(Oddity& oddity) const {
    if (oddity.count++ == 0) oddity.line = line_;
  }

  void warn_of(const char* what, const Oddity& oddity) {
    if (oddity.count > 0)
      scene_.warnings.push_back(fmt::format("{} {} (first in line {})", oddity.count, what, oddity.line));
  }

  std::string_view raw_line() {
    at_end_ = text_.empty();
    const std::size_t end = std::min(text_.find('\n'), text_.size());
    std::string_view line = text_.substr(0, end);
    text_.remove_prefix(std::min(end + 1, text_.size()));
    ++line_;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  /// A line; a backslash at its end joins the next one.
  std::string_view next_line(std::string& joined) {
    std::string_view line = raw_line();
    if (!line.ends_with('\\')) return line;
    joined.clear();
    for (; line.ends_with('\\') && !text_.empty(); line = raw_line()) {
      joined += line.substr(0, line.size() - 1);
      joined += ' ';
    }
    joined += line;
    return joined;
  }

  void parse_line(std::string_view line) {
    const std::string_view keyword = next_word(line);
    if (keyword.empty() || keyword.front() == '#') return;
    if (keyword == "v")
      parse_position(line);
    else if (keyword == "vt")
      parse_uv(line);
    else if (keyword == "vn")
      parse_normal(line);
    else if (keyword == "f" || keyword == "fo")
      parse_face(line);
    else if (keyword == "o")
      object_ = content_.objects.number(trimmed(line));
    else if (keyword == "g")
      group_ = content_.groups.number(trimmed(line));
    else if (keyword == "usemtl")
      material_ = content_.materials.number(trimmed(line));
    else if (keyword == "mtllib")
      content_.libraries.push_back({std::string(trimmed(line)), line_});
    else if (is_unsupported(keyword))
      losses_.insert(std::string(keyword));
    else if (keyword != "s")
      fail(fmt::format("unknown keyword '{}'", printable(keyword)));
  }

  /// Statements of the format that carry no triangles.
  static bool is_unsupported(std::string_view keyword) {
    static const std::set<std::string_view> k_keywords = {
        "p",        "l",    "vp",   "cstype", "deg",    "bmat",   "step",  "curv",  "curv2",      "surf",
        "parm",     "trim", "hole", "scrv",   "sp",     "end",    "con",   "mg",    "bevel",      "c_interp",
        "d_interp", "lod",  "call", "csh",    "maplib", "usemap", "ctech", "stech", "shadow_obj", "trace_obj"};
    return k_keywords.contains(keyword);
  }

  double number(std::string_view word) const {
    double value = 0;
    if (!parse_number(word, value)) fail(fmt::format("'{}' is not a number", printable(word)));
    return value;
  }

  /// Up to `limit` numbers of a line; returns how many there are.
  std::size_t numbers(std::string_view line, double* values, std::size_t limit) const {
    std::size_t count = 0;
    for (std::string_view word = next_word(line); !word.empty() && word.front() != '#'; word = next_word(line)) {
      if (count == limit) fail(fmt::format("more than {} numbers", limit));
      values[count++] = number(word);
    }
    return count;
  }

  template <class T>
  void append(std::vector<T>& list, T value) const {
    if (list.size() >= k_max_elements) fail("more than 2^32 - 2 elements");
    list.push_back(value);
  }

  void parse_position(std::string_view line) {
    double n[8] = {};
    const std::size_t count = numbers(line, n, 8);
    if (count < 3) fail(fmt::format("a vertex needs 3 numbers, found {}", count));
    const Vec3 position{n[0], n[1], n[2]};
    if (!is_finite(position)) fail(fmt::format("vertex {} is not finite", content_.positions.size() + 1));
    append(content_.positions, position);
    if (count >= 6) {
      content_.colors.resize(content_.positions.size() - 1);
      const double* c = n + (count == 6 ? 3 : 4);
      const bool good = std::isfinite(c[0]) && std::isfinite(c[1]) && std::isfinite(c[2]);
      if (!good) note(bad_colors_);
      content_.colors.push_back(good ? color_from_srgb(c[0], c[1], c[2]) : Color{});
    }
  }

  void parse_uv(std::string_view line) {
    double n[3] = {};
    if (numbers(line, n, 3) < 1) fail("a texture vertex needs numbers");
    const Vec2 uv{n[0], n[1]};
    if (!is_finite(uv)) fail(fmt::format("texture vertex {} is not finite", content_.uv.size() + 1));
    append(content_.uv, uv);
  }

  void parse_normal(std::string_view line) {
    double n[3] = {};
    if (const std::size_t count = numbers(line, n, 3); count != 3)
      fail(fmt::format("a normal needs 3 numbers, found {}", count));
    Vec3 normal{n[0], n[1], n[2]};
    if (!is_finite(normal)) {
      note(bad_normals_);
      normal = {};
    }
    append(content_.normals, normalized(normal));
  }

  /// 1 is the first of the list, −1 the last so far. Indices that point ahead are checked at the end.
  Index resolve(std::string_view text, std::size_t list_size, const char* what) const {
    long long index = 0;
    if (!parse_number(text, index)) fail(fmt::format("'{}' is not an index", printable(text)));
    if (index < 0) index += static_cast<long long>(list_size) + 1;
    if (index < 1 || index > static_cast<long long>(k_max_elements))
      fail(fmt::format("{} {} does not exist", what, printable(text)));
    return static_cast<Index>(index - 1);
  }

  Corner parse_corner(std::string_view word) const {
    Corner corner;
    const std::size_t first = std::min(word.find('/'), word.size());
    corner.position = resolve(word.substr(0, first), content_.positions.size(), "vertex");
    if (first == word.size()) return corner;
    word.remove_prefix(first + 1);
    const std::size_t second = std::min(word.find('/'), word.size());
    if (second > 0) corner.uv = resolve(word.substr(0, second), content_.uv.size(), "texture vertex");
    if (second + 1 < word.size()) corner.normal = resolve(word.substr(second + 1), content_.normals.size(), "normal");
    return corner;
  }

  void parse_face(std::string_view line) {
    const std::size_t first = content_.corners.size();
    for (std::string_view word = next_word(line); !word.empty() && word.front() != '#'; word = next_word(line))
      content_.corners.push_back(parse_corner(word));
    const std::size_t count = content_.corners.size() - first;
    if (count < 3) {
      note(short_faces_);
      content_.corners.resize(first);
      return;
    }
    content_.faces.push_back({first, static_cast<std::uint32_t>(count), static_cast<std::uint32_t>(line_)}, object_,
                             group_, material_);
  }

  std::string_view text_;
  const std::string& file_;
  Scene& scene_;
  ObjContent content_;
  std::size_t line_ = 0;
  bool at_end_ = false;
  std::uint32_t object_ = 0, group_ = 0, material_ = 0;
  Oddity short_faces_, bad_normals_, bad_colors_;
  std::set<std::string> losses_;
};

void check_indices(const ObjContent& content, const std::string& file) {
  const auto check = [&](const Face& face, Index index, std::size_t size, const char* what) {
    if (index != k_none && index >= size)
      throw InvalidInput(
          fmt::format("{}: line {}: {} {} of {} does not exist", file, face.line, what, std::size_t{index} + 1, size));
  };
  const auto check_face = [&](const Face& face) {
    for (std::size_t i = face.first_corner; i < face.first_corner + face.corners; ++i) {
      const Corner corner = content.corners[i];
      check(face, corner.position, content.positions.size(), "vertex");
      check(face, corner.uv, content.uv.size(), "texture vertex");
      check(face, corner.normal, content.normals.size(), "normal");
    }
  };
  for (const Run& run : content.faces.runs()) content.faces.each(run, check_face);
}

/// Materials of the libraries by name; an unknown name becomes a material with default values.
class MaterialTable {
 public:
  MaterialTable(const ObjContent& content, const std::filesystem::path& obj, Scene& scene) : scene_(scene) {
    for (const Library& library : content.libraries) read_library(library, obj);
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
  void read_library(const Library& library, const std::filesystem::path& obj) {
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

/// Which of a file list's entries a part uses, renumbered in their order.
class Renumbering {
 public:
  explicit Renumbering(std::size_t size) : numbers_(size, k_none) {}

  void use(Index index) {
    if (numbers_[index] != k_none) return;
    numbers_[index] = 0;
    used_.push_back(index);
  }

  template <class T>
  std::vector<T> finish(const std::vector<T>& list) {
    std::sort(used_.begin(), used_.end());
    std::vector<T> result;
    result.reserve(used_.size());
    for (const Index index : used_) {
      numbers_[index] = static_cast<Index>(result.size());
      result.push_back(list[index]);
    }
    return result;
  }

  Index operator[](Index index) const { return numbers_[index]; }

  void clear() {
    for (const Index index : used_) numbers_[index] = k_none;
    used_.clear();
  }

 private:
  std::vector<Index> numbers_, used_;
};

class PartAssembler {
 public:
  PartAssembler(const ObjContent& content, const std::string& file, double unit)
      : content_(content),
        file_(file),
        unit_(unit),
        positions_(content.positions.size()),
        uv_(content.uv.size()),
        normals_(content.normals.size()) {}

  /// @param slots  the part's slot of every material number of the content.
  Part assemble(const std::vector<const Run*>& runs, const std::map<std::uint32_t, std::uint32_t>& slots) {
    Part part;
    TriangleMesh& mesh = part.mesh;
    collect(runs, mesh);
    const bool several_groups = differ(runs, &Run::group), several_slots = differ(runs, &Run::material);
    for (const Run* run : runs) {
      content_.faces.each(*run, [&](const Face& face) { append_face(face, mesh); });
      if (several_groups) mesh.face.resize(mesh.triangles.size(), run->group);
      if (several_slots) mesh.material.resize(mesh.triangles.size(), slots.at(run->material));
    }
    if (!content_.colors.empty()) mesh.colors.indices = mesh.triangles;
    positions_.clear();
    uv_.clear();
    normals_.clear();
    return part;
  }

 private:
  static bool differ(const std::vector<const Run*>& runs, std::uint32_t Run::*number) {
    return std::any_of(runs.begin(), runs.end(), [&](const Run* run) { return run->*number != runs.front()->*number; });
  }

  /// Fills the value lists and makes room for the triangles. Faces without uv or normals have no value there; where
  /// only some corners lack one, these use a neutral value behind the others.
  void collect(const std::vector<const Run*>& runs, TriangleMesh& mesh) {
    has_uv_ = has_normals_ = false;
    bool lacks_uv = false, lacks_normals = false;
    std::size_t triangles = 0;
    const auto collect_face = [&](const Face& face) {
      std::uint32_t with_uv = 0, with_normal = 0;
      for (std::size_t i = face.first_corner; i < face.first_corner + face.corners; ++i) {
        const Corner corner = content_.corners[i];
        positions_.use(corner.position);
        if (corner.uv != k_none) uv_.use(corner.uv);
        if (corner.normal != k_none) normals_.use(corner.normal);
        with_uv += corner.uv != k_none;
        with_normal += corner.normal != k_none;
      }
      has_uv_ |= with_uv > 0;
      has_normals_ |= with_normal > 0;
      lacks_uv |= with_uv > 0 && with_uv < face.corners;
      lacks_normals |= with_normal > 0 && with_normal < face.corners;
      triangles += face.corners - 2;
    };
    for (const Run* run : runs) content_.faces.each(*run, collect_face);
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

  void append_face(const Face& face, TriangleMesh& mesh) {
    points_.clear();
    for (std::size_t i = 0; i < face.corners; ++i)
      points_.push_back(content_.positions[content_.corners[face.first_corner + i].position]);
    for (const auto& triangle : cut(face)) {
      Triangle positions{}, uv{}, normals{};
      for (std::size_t k = 0; k < 3; ++k) {
        const Corner corner = content_.corners[face.first_corner + triangle[k]];
        positions[k] = positions_[corner.position];
        uv[k] = corner.uv == k_none ? no_uv_ : uv_[corner.uv];
        normals[k] = corner.normal == k_none ? no_normal_ : normals_[corner.normal];
      }
      mesh.triangles.push_back(positions);
      if (has_uv_) mesh.uv.indices.push_back(lacks_all(face, &Corner::uv) ? k_no_values : uv);
      if (has_normals_) mesh.normals.indices.push_back(lacks_all(face, &Corner::normal) ? k_no_values : normals);
    }
  }

  bool lacks_all(const Face& face, Index Corner::*index) const {
    for (std::size_t i = face.first_corner; i < face.first_corner + face.corners; ++i)
      if (Corner corner = content_.corners[i]; corner.*index != k_none) return false;
    return true;
  }

  std::vector<std::array<std::size_t, 3>> cut(const Face& face) const {
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

/// Faces by object, or by group in a file without objects, in the order of first use.
void assemble_parts(ObjContent content, const std::filesystem::path& path, const std::string& file, double unit,
                    Scene& scene) {
  content.colors.resize(content.colors.empty() ? 0 : content.positions.size());
  const bool by_object = content.objects.names().size() > 1;
  const auto& names = by_object ? content.objects.names() : content.groups.names();
  std::vector<std::vector<const Run*>> runs(names.size());
  for (const Run& run : content.faces.runs()) runs[by_object ? run.object : run.group].push_back(&run);

  MaterialTable materials(content, path, scene);
  const bool has_materials = content.materials.names().size() > 1;
  PartAssembler assembler(content, file, unit);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (runs[i].empty()) continue;
    std::map<std::uint32_t, std::uint32_t> slots;
    std::vector<std::uint32_t> part_materials;
    for (const Run* run : runs[i]) {
      const auto [slot, is_new] = slots.try_emplace(run->material, static_cast<std::uint32_t>(slots.size()));
      if (is_new && has_materials) part_materials.push_back(materials.number(content.materials.names()[run->material]));
    }
    Part part = assembler.assemble(runs[i], slots);
    part.name = names[i];
    part.materials = std::move(part_materials);
    scene.parts.push_back(std::move(part));
  }
}

/// The content without the text.
ObjContent parse_file(const std::filesystem::path& path, const std::string& file, Scene& scene) {
  const std::string text = read_file(path);
  if (text.empty()) throw InvalidInput(file + ": is empty");
  return ObjParser(text, file, scene).parse();
}

}  // namespace

Scene read_obj(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string file = path.string();
  Scene scene = unitless_scene("OBJ", options, UpAxis::y);
  ObjContent content = parse_file(path, file, scene);
  if (content.positions.empty()) throw InvalidInput(file + ": holds no vertices; is it an OBJ file?");
  check_indices(content, file);
  assemble_parts(std::move(content), path, file, scene.millimetres_per_unit, scene);
  add_part_nodes(scene, path.stem().string());
  return scene;
}

}  // namespace papilla
