// SPDX-License-Identifier: MIT
#include "object_textures/part_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "papilla/core/bounds.hpp"
#include "papilla/core/srgb.hpp"

namespace papilla {
namespace {

constexpr int k_samples = 3;  ///< Of a pixel, per axis.

struct Sample {
  double height = -std::numeric_limits<double>::infinity();
  Vec3 color, normal;
  bool is_covered() const { return std::isfinite(height); }
};

std::size_t at(int x, int y, int width) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

/// The samples of a picture, rows from the top.
class Raster {
 public:
  Raster(const CarrierFrame& frame, int width, int height)
      : frame_(frame), width_(width), height_(height), samples_(at(0, height, width)) {}

  /// @param corners  in the mesh's coordinates. @param shade  colour and normal in the mesh by barycentric weights.
  template <class Shade>
  void draw(const std::array<Vec3, 3>& corners, const Shade& shade) {
    std::array<Vec3, 3> p;  // Sample columns and rows, and height over the plane.
    Bounds2 bounds;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 d = corners[k] - frame_.middle;
      p[k] = {(0.5 + dot(d, frame_.axes.right) / frame_.width_mm) * width_,
              (0.5 - dot(d, frame_.axes.up) / frame_.height_mm) * height_, -dot(d, frame_.axes.forward)};
      bounds.add(Vec2{p[k].x, p[k].y});
    }
    const auto edge = [&](std::size_t a, std::size_t b, Vec2 q) {
      return cross(Vec2{p[b].x - p[a].x, p[b].y - p[a].y}, Vec2{q.x - p[a].x, q.y - p[a].y});
    };
    const double doubled = edge(0, 1, {p[2].x, p[2].y});
    if (doubled == 0) return;
    const int left = std::max(0, static_cast<int>(std::floor(bounds.low.x)));
    const int right = std::min(width_ - 1, static_cast<int>(std::ceil(bounds.high.x)));
    const int top = std::max(0, static_cast<int>(std::floor(bounds.low.y)));
    const int bottom = std::min(height_ - 1, static_cast<int>(std::ceil(bounds.high.y)));
    for (int y = top; y <= bottom; ++y) {
      for (int x = left; x <= right; ++x) {
        const Vec2 q{x + 0.5, y + 0.5};
        const std::array weights{edge(1, 2, q) / doubled, edge(2, 0, q) / doubled, edge(0, 1, q) / doubled};
        if (weights[0] < 0 || weights[1] < 0 || weights[2] < 0) continue;
        const double height = weights[0] * p[0].z + weights[1] * p[1].z + weights[2] * p[2].z;
        Sample& sample = samples_[at(x, y, width_)];
        if (height <= sample.height) continue;
        if (const auto shaded = shade(weights, std::abs(doubled))) {
          sample = *shaded;
          sample.height = height;
        }
      }
    }
  }

  const Sample& sample(int x, int y) const { return samples_[at(x, y, width_)]; }

 private:
  const CarrierFrame& frame_;
  int width_, height_;
  std::vector<Sample> samples_;
};

/// What shade() needs of a material.
struct PartMaterial {
  Vec3 color{1, 1, 1};
  double opacity = 1, cutoff = 0;
  bool double_sided = false;
  int channel = 0;
  UvTransform transform;
  std::shared_ptr<const MipPyramid> picture;
};

PartMaterial part_material(const Scene& scene, Pyramids& pyramids, std::uint32_t number) {
  const Material& material = scene.materials[number];
  PartMaterial part;
  part.color = {material.base_color[0], material.base_color[1], material.base_color[2]};
  part.double_sided = material.double_sided;
  part.picture = pyramids.get(material.base_color_texture, true);
  if (material.alpha_mode != "OPAQUE") {
    part.opacity = material.base_color[3];
    part.cutoff = material.alpha_mode == "MASK" ? material.alpha_cutoff : 0.5;
  }
  if (material.base_color_texture) {
    part.channel = material.base_color_texture->tex_coord;
    part.transform = material.base_color_texture->transform.value_or(UvTransform{});
  }
  return part;
}

template <class T>
T mixed(const std::array<double, 3>& w, const T& a, const T& b, const T& c) {
  return w[0] * a + w[1] * b + w[2] * c;
}

void draw_triangle(const TriangleMesh& mesh, Index t, const PartMaterial& material, const CarrierFrame& frame,
                   Raster& raster) {
  const std::array corners{mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
  Vec3 flat = normalized(cross(corners[1] - corners[0], corners[2] - corners[0]));
  const bool looks_away = dot(flat, frame.axes.forward) > 0;
  if (looks_away && !material.double_sided) return;
  const CornerAttribute<Vec2>& uv = material.channel == 1 ? mesh.uv1 : mesh.uv;
  const bool has_picture = material.picture && uv.has_value(t);
  std::array<Vec2, 3> place{};
  for (std::size_t k = 0; has_picture && k < 3; ++k)
    place[k] = transform_uv(material.transform, uv.values[uv.indices[t][k]]);
  const double doubled_uv = std::abs(cross(place[1] - place[0], place[2] - place[0]));
  raster.draw(corners, [&](const std::array<double, 3>& w, double doubled_samples) -> std::optional<Sample> {
    Sample sample;
    sample.color = material.color;
    double alpha = material.opacity;
    if (has_picture) {
      const auto [texel, texel_alpha] = material.picture->sample(
          mixed(w, place[0], place[1], place[2]), doubled_uv / doubled_samples * material.picture->texel_count());
      sample.color = {sample.color.x * texel.x, sample.color.y * texel.y, sample.color.z * texel.z};
      alpha *= texel_alpha;
    }
    if (alpha < material.cutoff) return std::nullopt;
    const auto normal = [&](std::size_t k) { return mesh.normals.values[mesh.normals.indices[t][k]]; };
    Vec3 n = mesh.normals.has_value(t) ? normalized(mixed(w, normal(0), normal(1), normal(2))) : flat;
    if (looks_away) n = -n;
    sample.normal = {dot(n, frame.axes.right), dot(n, frame.axes.up), -dot(n, frame.axes.forward)};
    return sample;
  });
}

unsigned char byte_of(double share) {
  return static_cast<unsigned char>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
}

/// Gives pixels that nothing covers the mean colour of their covered neighbours, ring by ring.
void spread_colors(RgbaImage& image) {
  constexpr int k_rings = 8;
  std::vector<std::uint8_t> known(image.pixels.size() / 4, 0);
  for (std::size_t i = 0; i < known.size(); ++i) known[i] = image.pixels[4 * i + 3] != 0;
  for (int ring = 0; ring < k_rings; ++ring) {
    std::vector<std::uint8_t> next = known;
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        if (known[at(x, y, image.width)] != 0) continue;
        std::array<int, 3> sum{};
        int count = 0;
        for (int j = std::max(0, y - 1); j <= std::min(image.height - 1, y + 1); ++j)
          for (int i = std::max(0, x - 1); i <= std::min(image.width - 1, x + 1); ++i) {
            if (known[at(i, j, image.width)] == 0) continue;
            ++count;
            for (std::size_t c = 0; c < 3; ++c) sum[c] += image.at(i, j)[c];
          }
        if (count == 0) continue;
        for (std::size_t c = 0; c < 3; ++c) image.at(x, y)[c] = static_cast<unsigned char>(sum[c] / count);
        next[at(x, y, image.width)] = 1;
      }
    }
    known = std::move(next);
  }
}

PartPicture resolved(const Raster& raster, const CarrierFrame& frame, int width, int height) {
  PartPicture picture;
  picture.color = {width, height, {}};
  picture.normals = {width, height, {}};
  picture.relief = {width, height, {}, frame.width_mm / width, frame.height_mm / height, false};
  Values<float>& heights = picture.relief.mm;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      Vec3 color, normal;
      double sum = 0;
      int covered = 0;
      for (int j = 0; j < k_samples; ++j)
        for (int i = 0; i < k_samples; ++i) {
          const Sample& sample = raster.sample(x * k_samples + i, y * k_samples + j);
          if (!sample.is_covered()) continue;
          ++covered;
          color = color + sample.color, normal = normal + sample.normal;
          sum += sample.height;
        }
      const double share = covered > 0 ? 1.0 / covered : 0;
      color = share * color;
      normal = covered > 0 ? normalized(normal) : Vec3{0, 0, 1};
      for (const double c : {color.x, color.y, color.z}) picture.color.pixels.push_back(byte_of(srgb_from_linear(c)));
      picture.color.pixels.push_back(byte_of(static_cast<double>(covered) / (k_samples * k_samples)));
      for (const double c : {normal.x, normal.y, normal.z}) picture.normals.pixels.push_back(byte_of(0.5 * (c + 1)));
      heights.push_back(covered > 0 ? static_cast<float>(share * sum) : std::numeric_limits<float>::infinity());
    }
  }
  const float lowest = *std::min_element(heights.begin(), heights.end());
  for (float& h : heights)
    if (!std::isfinite(h)) h = std::isfinite(lowest) ? lowest : 0;
  spread_colors(picture.color);
  return picture;
}

}  // namespace

PartPicture picture_of_part(const Scene& scene, Pyramids& pyramids, const TriangleMesh& mesh,
                            const std::vector<Index>& triangles, const std::vector<std::uint32_t>& materials,
                            const CarrierFrame& frame, int pixels) {
  const double longer = std::max(frame.width_mm, frame.height_mm);
  const auto whole = [&](double side) { return std::max(1, static_cast<int>(std::lround(pixels * side / longer))); };
  const int width = whole(frame.width_mm), height = whole(frame.height_mm);
  Raster raster(frame, k_samples * width, k_samples * height);
  std::vector<std::optional<PartMaterial>> made(materials.size());
  const PartMaterial plain;
  for (const Index t : triangles) {
    const std::uint32_t slot = mesh.material.empty() ? 0 : mesh.material[t];
    if (slot < made.size() && !made[slot])
      made[slot] = materials[slot] < scene.materials.size() ? part_material(scene, pyramids, materials[slot]) : plain;
    draw_triangle(mesh, t, slot < made.size() ? *made[slot] : plain, frame, raster);
  }
  return resolved(raster, frame, width, height);
}

}  // namespace papilla
