// SPDX-License-Identifier: GPL-3.0-or-later
#include "weather/weather.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numeric>
#include <optional>

#include "papilla/core/error.hpp"
#include "papilla/core/units.hpp"
#include "papilla/haptic/sha256.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/io/vertex_normals.hpp"
#include "papilla/procedural/texture.hpp"
#include "papilla/texture/normal_map.hpp"
#include "recipe_source.hpp"

namespace papilla::app {
namespace {

/// Rings of texels around a chart that take over their neighbour's normal and position.
constexpr int k_gutter = 4;
constexpr unsigned k_maps = 1U << static_cast<unsigned>(Channel::color) | 1U << static_cast<unsigned>(Channel::bump) |
                            1U << static_cast<unsigned>(Channel::friction) |
                            1U << static_cast<unsigned>(Channel::stiffness);

/// What is known of the surface behind every texel of a material.
struct Texels {
  explicit Texels(int side) : size(side), covered(count(), 0), normals(3 * count(), 0), positions(3 * count(), 0) {}
  std::size_t count() const { return static_cast<std::size_t>(size) * static_cast<std::size_t>(size); }
  std::size_t at(int x, int y) const {
    const auto wrap = [this](int i) { return static_cast<std::size_t>(((i % size) + size) % size); };
    return wrap(y) * static_cast<std::size_t>(size) + wrap(x);
  }
  int size;
  std::vector<unsigned char> covered;
  std::vector<float> normals, positions;
  double area_mm2 = 0, area_uv = 0;
};

struct Corner {
  Vec2 uv;
  Vec3 position, normal;
};

void put(Texels& texels, std::size_t at, Vec3 normal, Vec3 position) {
  const Vec3 n = normalized(normal);
  const double values[2][3] = {{n.x, n.y, n.z}, {position.x, position.y, position.z}};
  for (std::size_t k = 0; k < 3; ++k) {
    texels.normals[3 * at + k] = static_cast<float>(values[0][k]);
    texels.positions[3 * at + k] = static_cast<float>(values[1][k]);
  }
}

/// Fills the texels whose centres the triangle covers.
void draw(Texels& texels, const std::array<Corner, 3>& c) {
  const double s = texels.size;
  Vec2 p[3];
  for (std::size_t k = 0; k < 3; ++k) p[k] = s * c[k].uv;
  const double area = cross(p[1] - p[0], p[2] - p[0]);
  texels.area_uv += std::abs(area) / (2 * s * s);
  texels.area_mm2 +=
      norm(cross(c[1].position - c[0].position, c[2].position - c[0].position)) / 2 * k_mm_per_metre * k_mm_per_metre;
  if (!(std::abs(area) > 1e-12) || !std::isfinite(area)) return;
  const auto [x0, x1] = std::minmax({p[0].x, p[1].x, p[2].x});
  const auto [y0, y1] = std::minmax({p[0].y, p[1].y, p[2].y});
  // Beyond one repeat every texel has been met already.
  const auto first = [](double v) { return std::floor(std::clamp(v, -1e8, 1e8)); };
  const int left = static_cast<int>(first(x0)), top = static_cast<int>(first(y0));
  const int right = static_cast<int>(std::min(first(x1) + 1, left + 2 * s)),
            bottom = static_cast<int>(std::min(first(y1) + 1, top + 2 * s));
  for (int y = top; y <= bottom; ++y)
    for (int x = left; x <= right; ++x) {
      const Vec2 q{x + 0.5, y + 0.5};
      const double b = cross(q - p[0], p[2] - p[0]) / area, d = cross(p[1] - p[0], q - p[0]) / area, a = 1 - b - d;
      if (a < -1e-9 || b < -1e-9 || d < -1e-9) continue;
      const std::size_t at = texels.at(x, y);
      if (texels.covered[at]) continue;
      texels.covered[at] = 1;
      put(texels, at, a * c[0].normal + b * c[1].normal + d * c[2].normal,
          a * c[0].position + b * c[1].position + d * c[2].position);
    }
}

/// Texels next to a chart take over what their neighbour knows; those farther off look upwards.
void grow_gutter(Texels& texels) {
  for (int ring = 0; ring < k_gutter; ++ring) {
    const std::vector<unsigned char> before = texels.covered;
    for (int y = 0; y < texels.size; ++y)
      for (int x = 0; x < texels.size; ++x) {
        const std::size_t at = texels.at(x, y);
        if (before[at]) continue;
        for (const std::size_t from :
             {texels.at(x - 1, y), texels.at(x + 1, y), texels.at(x, y - 1), texels.at(x, y + 1)}) {
          if (!before[from]) continue;
          std::copy_n(texels.normals.begin() + static_cast<std::ptrdiff_t>(3 * from), 3,
                      texels.normals.begin() + static_cast<std::ptrdiff_t>(3 * at));
          std::copy_n(texels.positions.begin() + static_cast<std::ptrdiff_t>(3 * from), 3,
                      texels.positions.begin() + static_cast<std::ptrdiff_t>(3 * at));
          texels.covered[at] = 1;
          break;
        }
      }
  }
  for (std::size_t at = 0; at < texels.count(); ++at)
    if (!texels.covered[at]) texels.normals[3 * at + 1] = 1;
}

/// Directions turn with the points; shear and unlike scales are not undone.
Vec3 turned(const Transform& t, Vec3 n) { return transform_point(t, n) - transform_point(t, {0, 0, 0}); }

Texels texels_of(const Scene& scene, std::uint32_t material, int size) {
  Texels texels(size);
  for (const Instance& instance : instances(scene)) {
    const Part& part = scene.parts[instance.part];
    if (part.mesh.uv.empty() ||
        std::find(part.materials.begin(), part.materials.end(), material) == part.materials.end())
      continue;
    const Transform world = multiply(to_y_up(scene.up), instance.world);
    const CornerAttribute<Vec3> normals = part.mesh.normals.empty() ? vertex_normals(part.mesh) : part.mesh.normals;
    for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
      const std::uint32_t slot = part.mesh.material.empty() ? 0 : part.mesh.material[t];
      if (slot >= part.materials.size() || part.materials[slot] != material || !part.mesh.uv.has_value(t)) continue;
      std::array<Corner, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) {
        corners[k].uv = part.mesh.uv.values[part.mesh.uv.indices[t][k]];
        corners[k].position = k_metres_per_mm * transform_point(world, part.mesh.corner(t, static_cast<int>(k)));
        corners[k].normal = turned(world, normals.has_value(t) ? normals.values[normals.indices[t][k]] : Vec3{0, 0, 1});
      }
      draw(texels, corners);
    }
  }
  return texels;
}

/// The material's own colour at every texel, as stored (sRGB).
std::vector<float> own_colour(const Scene& scene, const Material& material, int size) {
  std::array<float, 3> tint{};
  for (std::size_t k = 0; k < 3; ++k)
    tint[k] = static_cast<float>(std::pow(std::clamp(material.base_color[k], 0.0, 1.0), 1 / 2.2));
  std::optional<ColorImage> picture;
  if (material.base_color_texture)
    if (const auto image = scene.textures[material.base_color_texture->texture].image)
      picture = decode_color_image(scene.images[*image].bytes, scene.images[*image].name);
  std::vector<float> out;
  out.reserve(3 * static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      for (std::size_t k = 0; k < 3; ++k) {
        float value = tint[k];
        if (picture) {
          const int px = static_cast<int>((x + 0.5) / size * picture->width),
                    py = static_cast<int>((y + 0.5) / size * picture->height);
          value *= static_cast<float>(
                       picture->pixels[3 * (static_cast<std::size_t>(py) * static_cast<std::size_t>(picture->width) +
                                            static_cast<std::size_t>(px)) +
                                       k]) /
                   255.0F;
        }
        out.push_back(value);
      }
  return out;
}

double mean_of(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Adds pictures to a scene, the same bytes once.
class Pictures {
 public:
  explicit Pictures(WeatherResult& result) : result_(result) {}
  std::uint32_t add(const std::string& name, std::vector<std::byte> png) {
    ++result_.images;
    const auto [it, is_new] = known_.try_emplace(sha256_hex(png), 0);
    if (!is_new) {
      ++result_.duplicates_removed;
      return it->second;
    }
    Scene& scene = result_.scene;
    EncodedImage image;
    image.name = name, image.mime_type = "image/png", image.bytes = std::move(png);
    scene.images.push_back(std::move(image));
    Texture texture;
    texture.image = static_cast<std::uint32_t>(scene.images.size() - 1), texture.name = name;
    scene.textures.push_back(std::move(texture));
    return it->second = static_cast<std::uint32_t>(scene.textures.size() - 1);
  }

 private:
  WeatherResult& result_;
  std::map<std::string, std::uint32_t> known_;
};

std::string layered(const WeatherConfig& config, const std::string& material) {
  std::string recipe = "multi|textures=[base|colorfunction=currentcolor|bumpfunction=.5]";
  bool any = false;
  for (const WeatherLayer& layer : config.layers)
    for (const std::string& pattern : layer.materials)
      if (::fnmatch(pattern.c_str(), material.c_str(), 0) == 0) {
        recipe += ",[" + layer.recipe + "]";
        any = true;
        break;
      }
  return any ? recipe : "";
}

Json age(WeatherResult& result, const Scene& scene, std::uint32_t index, const WeatherConfig& config,
         const RecipeLibrary& library, double time, Pictures& pictures) {
  Material& material = result.scene.materials[index];
  const std::string recipe = layered(config, material.name);
  Json json{{"name", material.name}, {"recipe", recipe}};
  if (recipe.empty()) return json;
  CompileOptions options = recipe_options(config.folder);
  options.time = time, options.seamless = false, options.source = "weather, material '" + material.name + "'";
  const ProceduralTexture texture = compile_texture(recipe, library, options);
  Texels texels = texels_of(scene, index, config.size);
  if (texels.area_uv <= 0) {
    json["skipped"] = "no surface with uv shows it";
    return json;
  }
  grow_gutter(texels);
  std::vector<double> x, y;
  for (int row = 0; row < config.size; ++row)
    for (int column = 0; column < config.size; ++column)
      x.push_back((column + 0.5) / config.size), y.push_back((row + 0.5) / config.size);
  const std::vector<float> colour = own_colour(scene, material, config.size);
  const TextureValues values =
      evaluate_texture(texture, {x, y, texels.normals, texels.positions, {}, colour}, k_maps, 1.0 / config.size);
  const double pitch = std::sqrt(texels.area_mm2 / texels.area_uv) / config.size;
  HeightMap relief{config.size, config.size, values[Channel::bump], pitch, pitch, true};
  for (float& h : relief.mm) h *= static_cast<float>(config.depth_mm);
  TextureReference reference;
  reference.texture = pictures.add("color." + material.name,
                                   encode_png(to_color_image(values[Channel::color], config.size, config.size)));
  material.base_color_texture = reference;
  material.base_color = {1, 1, 1, material.base_color[3]};
  reference.texture = pictures.add("normal." + material.name, encode_png(normal_map(relief)));
  material.normal_texture = reference;
  json["normal_dependent"] = texture.depends_on_normal();
  json["uses"] = texture.recipes_used();
  json["mm_per_texel"] = pitch;
  json["friction"] = mean_of(values[Channel::friction]);
  json["stiffness"] = mean_of(values[Channel::stiffness]);
  return json;
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& key, const std::string& reason) {
  throw InvalidInput(path.string() + ": at /" + key + ": " + reason);
}

}  // namespace

WeatherConfig read_weather_config(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw IoError(path.string() + ": cannot be opened");
  const Json json = Json::parse(in, nullptr, false);
  if (json.is_discarded() || !json.is_object()) throw InvalidInput(path.string() + ": is no JSON object");
  WeatherConfig config;
  config.folder = path.parent_path();
  const auto number = [&](const Json& value, const std::string& key, double low, double high) {
    if (!value.is_number() || !(value.get<double>() >= low && value.get<double>() <= high))
      refuse(path, key, "must be a number from " + std::to_string(low) + " to " + std::to_string(high));
    return value.get<double>();
  };
  const auto strings = [&](const Json& value, const std::string& key) {
    if (!value.is_array() || !std::all_of(value.begin(), value.end(), [](const Json& s) { return s.is_string(); }))
      refuse(path, key, "must be an array of strings");
    return value.get<std::vector<std::string>>();
  };
  for (const auto& [key, value] : json.items()) {
    if (key == "size")
      config.size = static_cast<int>(number(value, key, 16, 8192));
    else if (key == "depth_mm")
      config.depth_mm = number(value, key, 1e-6, 100);
    else if (key == "time" && value.is_array() && !value.empty()) {
      config.times.clear();
      for (const Json& t : value) config.times.push_back(number(t, key, 0, 1));
    } else if (key == "time")
      config.times = {number(value, key, 0, 1)};
    else if (key == "libraries")
      config.libraries = strings(value, key);
    else if (key == "layers" && value.is_array()) {
      for (const Json& entry : value) {
        const std::string place = key + "/" + std::to_string(config.layers.size());
        if (!entry.is_object() || !entry.contains("recipe") || !entry["recipe"].is_string())
          refuse(path, place, "must be an object with the string 'recipe'");
        WeatherLayer layer{entry["recipe"].get<std::string>(), {"*"}};
        for (const auto& [name, unused] : entry.items())
          if (name != "recipe" && name != "materials")
            refuse(path, place + "/" + name, "unknown key; known are recipe, materials");
        if (entry.contains("materials")) layer.materials = strings(entry["materials"], place + "/materials");
        config.layers.push_back(std::move(layer));
      }
    } else if (key != "$comment")
      refuse(path, key, "unknown key or wrong type; known are size, time, depth_mm, libraries, layers");
  }
  if (config.layers.empty()) refuse(path, "layers", "at least one layer is needed");
  return config;
}

WeatherResult weather(const Scene& scene, const WeatherConfig& config, double time) {
  RecipeLibrary library = RecipeLibrary::builtin();
  for (const std::string& file : config.libraries) library.read_file(config.folder / file);
  WeatherResult result;
  result.scene = scene;
  Pictures pictures(result);
  for (std::uint32_t m = 0; m < scene.materials.size(); ++m)
    result.materials.push_back(age(result, scene, m, config, library, time, pictures));
  return result;
}

}  // namespace papilla::app
