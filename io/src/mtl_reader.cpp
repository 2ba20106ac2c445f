// SPDX-License-Identifier: MIT
#include "mtl_reader.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/io/image_file.hpp"
#include "scene_pictures.hpp"
#include "text_scanner.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

/// The options before the file name of a map statement.
struct MapOptions {
  Vec2 offset{0, 0}, scale{1, 1};
  double bump_factor = 1;
  bool clamp = false;
};

/// glTF's form of vt' = scale · vt + offset, where v runs up.
std::optional<UvTransform> to_texture_transform(const MapOptions& options) {
  if (options.offset == Vec2{0, 0} && options.scale == Vec2{1, 1}) return std::nullopt;
  return UvTransform{{options.offset.x, 1 - options.scale.y - options.offset.y}, 0, options.scale};
}

/// The typical colours of a tangent-space normal map: bluish on average.
bool looks_like_normal_map(const ColorImage& image) {
  std::array<double, 3> mean{};
  for (std::size_t i = 0; i < image.pixels.size(); ++i) mean[i % 3] += image.pixels[i];
  for (double& m : mean) m /= 255.0 * static_cast<double>(image.pixels.size() / 3);
  return std::abs(mean[0] - 0.5) < 0.15 && std::abs(mean[1] - 0.5) < 0.15 && mean[2] > 0.65;
}

class MtlReader {
 public:
  MtlReader(const fs::path& path, Scene& scene)
      : path_(path), text_(read_file(path)), scene_(scene), pictures_(path, scene) {}

  void read() {
    std::string_view rest = text_;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      ++line_;
      read_line(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    if (!open_ && !unused_.empty()) fail("no newmtl stands in the file; is it a material library?");
    for (const std::string& keyword : unused_)
      scene_.losses.push_back(path_.filename().string() + ": " + printable(keyword));
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw InvalidInput(fmt::format("{}: line {}: {}", path_.string(), line_, reason));
  }

  std::string here() const { return fmt::format("line {}", line_); }

  double number(std::string_view& text) const {
    const std::string_view word = next_word(text);
    double value = 0;
    if (!parse_number(word, value) || !std::isfinite(value)) fail(fmt::format("'{}' is not a number", printable(word)));
    return value;
  }

  std::array<double, 3> color(std::string_view& text) const {
    if (trimmed(text).starts_with("spectral") || trimmed(text).starts_with("xyz")) return {1, 1, 1};
    const double r = number(text);
    if (trimmed(text).empty()) return {r, r, r};
    const double g = number(text);
    return {r, g, number(text)};
  }

  Material& current() {
    if (!open_) fail("a property stands before the first newmtl");
    return scene_.materials.back();
  }

  void read_line(std::string_view line) {
    const std::string_view keyword = next_word(line);
    if (keyword.empty() || keyword.front() == '#') return;
    if (keyword == "newmtl") {
      Material material;
      material.name = std::string(trimmed(line));
      scene_.materials.push_back(std::move(material));
      open_ = true;
      has_roughness_ = false;
    } else if (keyword == "Kd") {
      const auto c = color(line);
      std::copy(c.begin(), c.end(), current().base_color.begin());
    } else if (keyword == "Ke") {
      current().emissive = color(line);
    } else if (keyword == "d" || keyword == "Tr") {
      read_opacity(keyword, line);
    } else if (keyword == "Ns") {
      const double exponent = std::clamp(number(line), 0.0, 1000.0);
      if (!has_roughness_) current().roughness = 1 - std::sqrt(exponent / 1000);
    } else if (keyword == "Pr") {
      current().roughness = std::clamp(number(line), 0.0, 1.0);
      has_roughness_ = true;
    } else if (keyword == "Pm") {
      current().metallic = std::clamp(number(line), 0.0, 1.0);
    } else if (keyword.starts_with("map_") || keyword == "bump" || keyword == "norm") {
      read_map(keyword, line);
    } else if (keyword == "Ka" || keyword == "Ks" || keyword == "Ni" || keyword == "illum") {
      current();  // Defaults of the Phong model that glTF's has no counterpart for.
    } else {
      unused_.insert(std::string(keyword));
    }
  }

  void read_opacity(std::string_view keyword, std::string_view line) {
    if (trimmed(line).starts_with("-halo")) next_word(line);
    const double value = number(line);
    Material& material = current();
    material.base_color[3] = std::clamp(keyword == "d" ? value : 1 - value, 0.0, 1.0);
    material.alpha_mode = material.base_color[3] < 1 ? "BLEND" : "OPAQUE";
  }

  void read_map(std::string_view keyword, std::string_view line) {
    MapOptions options = read_options(line);
    const std::string name(trimmed(line));
    Material& material = current();
    if (name.empty()) fail(fmt::format("{} names no file", keyword));
    if (keyword == "map_Kd") {
      if (const auto texture = pictures_.add_texture(name, here(), options.clamp))
        material.base_color_texture = TextureReference{*texture, 0, 1, to_texture_transform(options)};
    } else if (keyword == "map_Ke") {
      if (const auto texture = pictures_.add_texture(name, here(), options.clamp))
        material.emissive_texture = TextureReference{*texture, 0, 1, to_texture_transform(options)};
    } else if (keyword == "norm" || keyword == "bump" || keyword == "map_Bump" || keyword == "map_bump") {
      if (keyword != "norm" && !is_normal_map(name)) return;
      if (const auto texture = pictures_.add_texture(name, here(), options.clamp))
        material.normal_texture = TextureReference{*texture, 0, options.bump_factor, to_texture_transform(options)};
    } else {
      unused_.insert(std::string(keyword));
    }
  }

  /// The options of "map_Kd -o 0 0 0 -s 2 2 1 file name.png"; leaves the file name.
  MapOptions read_options(std::string_view& line) const {
    static const std::map<std::string_view, int> k_arguments = {{"-blendu", 1}, {"-blendv", 1},  {"-boost", 1},
                                                                {"-cc", 1},     {"-imfchan", 1}, {"-mm", 2},
                                                                {"-texres", 1}, {"-type", 1}};
    MapOptions options;
    for (;;) {
      std::string_view rest = line;
      const std::string_view word = next_word(rest);
      if (word == "-o" || word == "-t") {
        const Vec2 pair = read_pair(rest, 0);
        if (word == "-o") options.offset = pair;
      } else if (word == "-s") {
        options.scale = read_pair(rest, 1);
      } else if (word == "-clamp") {
        options.clamp = next_word(rest) == "on";
      } else if (word == "-bm") {
        options.bump_factor = number(rest);
      } else if (const auto known = k_arguments.find(word); known != k_arguments.end()) {
        for (int i = 0; i < known->second; ++i) next_word(rest);
      } else {
        return options;
      }
      line = rest;
    }
  }

  /// One to three numbers, of which the first two count.
  Vec2 read_pair(std::string_view& text, double fallback) const {
    Vec2 pair{number(text), fallback};
    double third = 0;
    for (double* target : {&pair.y, &third}) {
      std::string_view rest = text;
      double value = 0;
      if (!parse_number(next_word(rest), value) || !std::isfinite(value)) break;
      *target = value;
      text = rest;
    }
    return pair;
  }

  bool is_normal_map(const std::string& name) {
    const fs::path file = pictures_.locate(name, here());
    if (file.empty()) return false;
    try {
      if (looks_like_normal_map(read_color_image(file))) return true;
      scene_.losses.push_back("bump map '" + shown(name) + "' (it is no normal map)");
    } catch (const InvalidInput& error) {
      pictures_.note_undecoded(file, here(), error.what());
    }
    return false;
  }

  fs::path path_;
  std::string text_;
  Scene& scene_;
  std::size_t line_ = 0;
  bool open_ = false, has_roughness_ = false;
  ScenePictures pictures_;
  std::set<std::string> unused_;
};

}  // namespace

void read_mtl(const fs::path& path, Scene& scene) { MtlReader(path, scene).read(); }

}  // namespace papilla
