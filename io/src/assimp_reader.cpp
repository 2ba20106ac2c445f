// SPDX-License-Identifier: MIT
#include "papilla/io/assimp_reader.hpp"

#include <assimp/MemoryIOWrapper.h>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cctype>
#include <charconv>
#include <cmath>
#include <exception>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "assimp_scene.hpp"
#include "assimp_text.hpp"
#include "mesh_file_scene.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/core/unit_name.hpp"
#include "papilla/core/units.hpp"
#include "papilla/haptic/material_tag_stream.hpp"
#include "papilla/io/isolated.hpp"
#include "papilla/io/pipe_stream.hpp"
#include "scene_pictures.hpp"

namespace papilla {
namespace {

struct Format {
  std::string_view extension;
  const char* name;
  UpAxis up;
  double millimetres_per_unit;  ///< Where the file does not say.
  bool is_assumed;              ///< The format states no unit that assimp hands on.
};

constexpr Format k_formats[] = {{".fbx", "FBX", UpAxis::y, 10, false},
                                {".3mf", "3MF", UpAxis::z, 1, false},
                                {".dae", "COLLADA", UpAxis::y, k_mm_per_metre, false},
                                {".ac", "AC3D", UpAxis::y, 1, true},
                                {".x3d", "X3D", UpAxis::y, k_mm_per_metre, false},
                                {".blend", "Blender", UpAxis::z, k_mm_per_metre, true}};

const Format* format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto* found = std::find_if(std::begin(k_formats), std::end(k_formats),
                                   [&](const Format& f) { return f.extension == extension; });
  return found == std::end(k_formats) ? nullptr : found;
}

/// Holds the file under one name; there are no others.
class OneFile : public Assimp::IOSystem {
 public:
  OneFile(std::string name, std::string_view bytes) : name_(std::move(name)), bytes_(bytes) {}

  bool Exists(const char* name) const override { return name_ == name; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    if (name_ != name || mode == nullptr || mode[0] != 'r') return nullptr;
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes_.data()), bytes_.size());
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  std::string name_;
  std::string_view bytes_;
};

/// Leaves only the reader of that extension.
void keep_reader(Assimp::Importer& importer, std::string_view extension) {
  const std::string wanted = " " + std::string(extension.substr(1)) + " ";
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    const aiImporterDesc* description = importer.GetImporterInfo(i);
    const std::string known = std::string(" ") + (description ? description->mFileExtensions : "") + " ";
    if (known.find(wanted) == std::string::npos) importer.UnregisterLoader(importer.GetImporter(i));
  }
}

/// The double of a float's shortest decimal form: 0.0254 of 0.0254f.
double shortest(float value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.begin(), digits.end(), value).ptr;
  double result = 0;
  std::from_chars(digits.begin(), end, result);
  return result;
}

/// Unit and upward axis as the file states them. assimp applies COLLADA's to the root, from which they are taken off.
class Frame {
 public:
  Frame(const Format& format, aiScene& from, std::string_view model) : up(format.up) {
    millimetres = format.millimetres_per_unit;
    if (format.extension == ".3mf") millimetres = millimetres_of_3mf(model);
    if (format.extension == ".fbx") take_fbx(from);
    if (format.extension == ".dae" && from.mRootNode != nullptr) take_collada(from.mRootNode->mTransformation);
    if (!std::isfinite(millimetres) || millimetres < 1e-9 || millimetres > 1e9)
      throw InvalidInput(fmt::format("the unit of {} mm is not in 1e-9 to 1e9", millimetres));
  }

  double millimetres = 1;
  UpAxis up;
  std::optional<std::string> warning;

 private:
  void take_fbx(const aiScene& from) {
    if (from.mMetaData == nullptr) return;
    float factor = 1;
    double precise = 1;
    if (from.mMetaData->Get("UnitScaleFactor", factor))
      millimetres = 10 * shortest(factor);
    else if (from.mMetaData->Get("UnitScaleFactor", precise))
      millimetres = 10 * precise;
    std::int32_t axis = 1, sign = 1;
    from.mMetaData->Get("UpAxis", axis);
    from.mMetaData->Get("UpAxisSign", sign);
    up = axis == 2 ? UpAxis::z : UpAxis::y;
    if (axis == 0 || sign < 0)
      warning = fmt::format("the file's upward axis is {}{}; {} is taken", sign < 0 ? "-" : "",
                            axis == 0   ? "x"
                            : axis == 1 ? "y"
                                        : "z",
                            up == UpAxis::z ? "z" : "y");
  }

  /// The root is the unit in metres times the turn to Y up.
  void take_collada(aiMatrix4x4& root) {
    const float scale = std::hypot(root.a1, root.b1, root.c1);
    millimetres = k_mm_per_metre * shortest(scale);
    if (root.c2 < 0) up = UpAxis::z;
    const bool is_x_up = root.b1 != 0;
    root = is_x_up ? aiMatrix4x4(0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1) : aiMatrix4x4();
  }
};

/// assimp's words on a file that it refuses.
std::string reason_of(const Assimp::Importer& importer) {
  if (const std::exception_ptr failure = importer.GetException()) try {
      std::rethrow_exception(failure);
    } catch (const std::bad_alloc&) {
      return "needs more memory than a file of its size may take";
    } catch (...) {
    }
  return shown(first_line(importer.GetErrorString()));
}

/// In the child: textures name pictures that are still to be read.
Scene read_in_child(const std::filesystem::path& path, const Format& format, const ReadOptions& options) {
  const std::string file = path.string();
  const std::string bytes = read_file(path);
  if (bytes.empty()) throw InvalidInput(file + ": is empty");
  const auto size = static_cast<double>(bytes.size());
  constexpr double k_memory = 1 << 30, k_memory_per_byte = 300, k_seconds = 30, k_seconds_per_byte = 60e-6;
  allow_memory(k_memory + k_memory_per_byte * size);
  allow_processor_time(k_seconds + k_seconds_per_byte * size);

  Scene scene = unitless_scene(format.name, options, format.up);
  try {
    const std::string model = format.extension == ".3mf" ? unpack_3mf_model(bytes) : std::string();
    Assimp::Importer importer;
    keep_reader(importer, format.extension);
    const std::string name = "scene" + std::string(format.extension);
    const std::string x3d = format.extension == ".x3d" ? x3d_for_assimp(bytes) : std::string();
    importer.SetIOHandler(new OneFile(name, x3d.empty() ? bytes : x3d));
    importer.SetPropertyBool(AI_CONFIG_IMPORT_AC_EVAL_SUBDIVISION, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_EMBEDDED_TEXTURES_LEGACY_NAMING, true);
    if (importer.ReadFile(name, 0) == nullptr)
      throw InvalidInput(fmt::format("{} data can't be read: {}{}", format.name, reason_of(importer),
                                     format.extension == ".blend" ? " (Blender writes glTF, too)" : ""));
    const std::unique_ptr<aiScene> from(importer.GetOrphanedScene());
    const Frame frame(format, *from, model);
    scene.up = options.up.value_or(frame.up);
    if (frame.warning && !options.up) scene.warnings.push_back(*frame.warning);
    if (!options.millimetres_per_unit) {
      scene.millimetres_per_unit = frame.millimetres;
      scene.unit = unit_name(frame.millimetres) + (format.is_assumed ? " (assumed)" : "");
    }
    for (std::string& line : unread_by_assimp(format.extension, model.empty() ? bytes : model, from->mNumMeshes))
      scene.losses.push_back(std::move(line));
    convert_assimp_scene(*from, file, scene);
  } catch (const InvalidInput& error) {
    const std::string_view what = error.what();
    if (what.starts_with(file)) throw;
    throw InvalidInput(file + ": " + std::string(what));
  }
  return scene;
}

/// Reads the pictures that the child found names of; a texture without one goes.
class PictureReader {
 public:
  PictureReader(const std::filesystem::path& path, Scene& scene)
      : scene_(scene),
        textures_(std::exchange(scene.textures, {})),
        images_(std::exchange(scene.images, {})),
        pictures_(path, scene) {}

  void read() {
    for (Material& material : scene_.materials)
      for (auto* slot : {&material.base_color_texture, &material.metallic_roughness_texture, &material.normal_texture,
                         &material.occlusion_texture, &material.emissive_texture})
        if (*slot) replace(*slot, "material '" + shown(material.name) + "'");
  }

 private:
  void replace(std::optional<TextureReference>& slot, const std::string& where) {
    Texture texture = textures_.at(slot->texture);
    texture.image = image(texture.image.value(), where);
    if (!texture.image) {
      slot.reset();
      return;
    }
    texture.name = scene_.images[*texture.image].name;
    slot->texture = static_cast<std::uint32_t>(scene_.textures.size());
    scene_.textures.push_back(std::move(texture));
  }

  std::optional<std::uint32_t> image(std::uint32_t number, const std::string& where) {
    EncodedImage& image = images_.at(number);
    if (const auto known = embedded_.find(number); known != embedded_.end()) return known->second;
    if (image.bytes.empty()) return pictures_.add_image(image.uri, where);
    image.uri.clear();
    scene_.images.push_back(std::move(image));
    return embedded_[number] = static_cast<std::uint32_t>(scene_.images.size() - 1);
  }

  Scene& scene_;
  std::vector<Texture> textures_;
  std::vector<EncodedImage> images_;
  std::map<std::uint32_t, std::uint32_t> embedded_;
  ScenePictures pictures_;
};

}  // namespace

Scene read_assimp(const std::filesystem::path& path, const ReadOptions& options, const ProgressCallback& progress) {
  const Format* format = format_of(path);
  if (format == nullptr) throw InvalidInput(path.string() + ": is of no format that assimp reads for Papilla");
  require_file(path);
  Scene scene;
  const auto run = [&](const ProgressCallback&) { scene = read_in_child(path, *format, options); };
  run_isolated({path, "the library assimp", run, [&](int pipe) { send_values(pipe, scene); },
                [&](int pipe) { receive_values(pipe, scene); }},
               progress);
  PictureReader(path, scene).read();
  if (format->is_assumed && !options.millimetres_per_unit && scene.millimetres_per_unit == 1)
    hint_at_unit(scene, path.stem().string());
  return scene;
}

bool is_assimp_extension(const std::filesystem::path& path) { return format_of(path) != nullptr; }

}  // namespace papilla
