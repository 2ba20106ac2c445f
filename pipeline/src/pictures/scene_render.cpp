// SPDX-License-Identifier: MIT
#include "papilla/pipeline/pictures/scene_render.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <tuple>

#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/srgb.hpp"
#include "pictures/border_edges.hpp"
#include "pictures/mip_pyramid.hpp"

namespace papilla {
namespace {

constexpr Vec3 k_clay{0.42, 0.44, 0.47};
constexpr double k_field_of_view = 0.6;  // radians, vertical: about the perspective of a 50 mm lens

struct Camera {
  Vec3 position, right, up, forward;
  double focal = 1;  // in samples
  double center_x = 0, center_y = 0;
};

/// The inputs of shade() from one material.
struct ShadedMaterial {
  Vec3 color{1, 1, 1};
  double roughness = 0.8, metallic = 0;
  double opacity = 1;
  bool blends = false;      ///< Transparent places show what is behind.
  double alpha_cutoff = 0;  ///< Places of less alpha are left out, all others are opaque; 0: none.
  std::shared_ptr<const MipPyramid> color_map = {}, normal_map = {};
  int color_channel = 0, channel = 0;  ///< Of the uv for colour, and for all else.
  UvTransform color_transform = {}, normal_transform = {};
  double normal_scale = 1;
  Vec2 mm_per_uv = {};
  std::shared_ptr<const EnvironmentLight> environment = {};  ///< Of its own.
};

struct Vertex {
  Vec3 world, normal;
  Vec2 uv, color_uv;
  double x = 0, y = 0, inverse_depth = 0;
};

struct Sample {
  float inverse_depth = 0;
  float r = 0.93F, g = 0.94F, b = 0.95F;  // background, linear
};

/// A triangle on its way to the raster: corners, material, tangent frame and uv footprint of a sample.
struct TriangleSetup {
  Vertex v[3];
  const ShadedMaterial* material = nullptr;
  double doubled_area = 0;  // in samples, signed
  Vec3 tangent, bitangent;
  bool has_uv = false, has_color_uv = false;
  double uv_area_per_cubic_depth = 0, color_uv_area_per_cubic_depth = 0;  // Of a sample.
  std::array<bool, 3> border{};  ///< From corner k to the next one; of RenderMode::triangles.
};

/// Scales dark colours up, hue kept, so that the shading of relief is visible.
Vec3 brightened(Vec3 color) {
  constexpr double k_visible = 0.3;
  const double brightest = std::max({color.x, color.y, color.z, 1e-3});
  return brightest >= k_visible ? color : (k_visible / brightest) * color;
}

ShadedMaterial shaded_material(const Scene& scene, std::size_t index, const SceneViewOptions& options,
                               Pyramids& pyramids) {
  const Material& material = scene.materials[index];
  ShadedMaterial shaded;
  shaded.color = {material.base_color[0], material.base_color[1], material.base_color[2]};
  if (options.close_up) shaded.color = brightened(shaded.color);
  shaded.roughness = material.roughness;
  shaded.metallic = material.metallic;
  if (index < options.mm_per_uv.size()) shaded.mm_per_uv = options.mm_per_uv[index];
  if (options.mode == RenderMode::triangles) return {.color = k_clay};
  if (material.normal_texture) shaded.channel = material.normal_texture->tex_coord;
  if (material.haptic) shaded.channel = tex_coord_of(*material.haptic).value_or(shaded.channel);
  if (material.base_color_texture) shaded.color_channel = material.base_color_texture->tex_coord;
  if (options.mode != RenderMode::material) return shaded;
  if (const auto environment = environment_of(material))
    shaded.environment = std::make_shared<EnvironmentLight>(*environment);
  shaded.color_map = pyramids.get(material.base_color_texture, true);
  if (material.alpha_mode != "OPAQUE") shaded.opacity = std::clamp(material.base_color[3], 0.0, 1.0);
  if (material.alpha_mode == "MASK") shaded.alpha_cutoff = material.alpha_cutoff;
  shaded.blends =
      material.alpha_mode == "BLEND" && (shaded.opacity < 1 || (shaded.color_map && shaded.color_map->has_alpha()));
  shaded.normal_map = pyramids.get(material.normal_texture, false);
  if (material.base_color_texture && material.base_color_texture->transform)
    shaded.color_transform = *material.base_color_texture->transform;
  if (material.normal_texture) {
    shaded.normal_scale = material.normal_texture->factor;
    if (material.normal_texture->transform) shaded.normal_transform = *material.normal_texture->transform;
  }
  return shaded;
}

/// At `position`, looking along `forward`, with a level horizon.
Camera level_camera(Vec3 position, Vec3 forward, const SceneViewOptions& options) {
  Camera camera;
  camera.position = position;
  camera.forward = forward;
  const Vec3 pole = std::abs(forward.y) > 0.999 ? Vec3{0, 0, -1} : Vec3{0, 1, 0};
  camera.right = normalized(cross(forward, pole));
  camera.up = cross(camera.right, forward);
  camera.focal = 0.5 * options.height * options.samples / std::tan(0.5 * k_field_of_view);
  camera.center_x = 0.5 * options.width * options.samples;
  camera.center_y = 0.5 * options.height * options.samples;
  return camera;
}

/// Sets focal length and centre so that all vertices fill the picture except for a margin.
void fit_to_vertices(Camera& camera, const std::vector<TriangleSetup>& triangles, const SceneViewOptions& options) {
  constexpr double k_filled = 0.94;
  Bounds2 bounds;
  for (const TriangleSetup& t : triangles)
    for (const Vertex& v : t.v) {
      const Vec3 d = v.world - camera.position;
      const double depth = dot(d, camera.forward);
      bounds.add(Vec2{dot(d, camera.right) / depth, dot(d, camera.up) / depth});
    }
  const double width = options.width * options.samples, height = options.height * options.samples;
  const Vec2 extent = upper(bounds.size(), {1e-9, 1e-9}), middle = bounds.middle();
  camera.focal = k_filled * std::min(width / extent.x, height / extent.y);
  camera.center_x = 0.5 * width - camera.focal * middle.x;
  camera.center_y = 0.5 * height + camera.focal * middle.y;
}

Camera place_camera(const Scene& scene, const std::vector<TriangleSetup>& triangles, const SceneViewOptions& options) {
  if (options.close_up) {
    const Vec3 position = camera_position(*options.close_up, scene.up);
    const Vec3 point = transform_point(to_y_up(scene.up), options.close_up->point);
    return level_camera(position, normalized(point - position), options);
  }
  Bounds3 bounds;
  for (const TriangleSetup& t : triangles)
    for (const Vertex& v : t.v) bounds.add(v.world);
  const Vec3 towards = normalized(options.towards_camera);
  if (norm(towards) == 0) throw InvalidInput("render_scene: towards_camera is the zero vector");
  const double radius = std::max(0.5 * bounds.diagonal(), 1e-9);
  Camera camera =
      level_camera(bounds.middle() + (radius / std::sin(0.5 * k_field_of_view)) * towards, -towards, options);
  fit_to_vertices(camera, triangles, options);
  return camera;
}

Vertex between(const Vertex& a, const Vertex& b, double t) {
  const auto mix = [&](auto member) { return (1 - t) * (a.*member) + t * (b.*member); };
  return {mix(&Vertex::world), mix(&Vertex::normal), mix(&Vertex::uv), mix(&Vertex::color_uv)};
}

/// Clips all triangles at the plane `near` before the camera.
void clip_near(std::vector<TriangleSetup>& triangles, const Camera& camera, double near) {
  std::vector<TriangleSetup> cut;
  std::erase_if(triangles, [&](const TriangleSetup& t) {
    double ahead[3];
    for (std::size_t k = 0; k < 3; ++k) ahead[k] = dot(t.v[k].world - camera.position, camera.forward) - near;
    const auto inside = std::count_if(std::begin(ahead), std::end(ahead), [](double a) { return a > 0; });
    if (inside == 3) return false;
    if (inside == 0) return true;
    // `alone` is the only corner on its side of the plane; p and q are where its two edges cross the plane.
    std::size_t alone = 0;
    while ((ahead[alone] > 0) != (inside == 1)) ++alone;
    const std::size_t next = (alone + 1) % 3, last = (alone + 2) % 3;
    const Vertex p = between(t.v[alone], t.v[next], ahead[alone] / (ahead[alone] - ahead[next]));
    const Vertex q = between(t.v[alone], t.v[last], ahead[alone] / (ahead[alone] - ahead[last]));
    const auto add = [&](const Vertex& a, const Vertex& b, const Vertex& c, std::array<bool, 3> border) {
      TriangleSetup piece = t;
      piece.v[0] = a, piece.v[1] = b, piece.v[2] = c;
      piece.border = border;
      cut.push_back(piece);
    };
    if (inside == 1) {
      add(t.v[alone], p, q, {t.border[alone], false, t.border[last]});
    } else {
      add(p, t.v[next], t.v[last], {t.border[alone], t.border[next], false});
      add(p, t.v[last], q, {false, t.border[last], false});
    }
    return true;
  });
  triangles.insert(triangles.end(), cut.begin(), cut.end());
}

/// uv area under one sample, divided by depth³: on a plane at distance d a sample covers depth³ / (focal² d).
double uv_area_per_cubic_depth(const TriangleSetup& t, Vec2 Vertex::*uv, const Camera& camera) {
  const Vec3 twice = cross(t.v[1].world - t.v[0].world, t.v[2].world - t.v[0].world);
  const double volume = camera.focal * camera.focal * std::abs(dot(twice, t.v[0].world - camera.position));
  return volume > 0 ? std::abs(cross(t.v[1].*uv - t.v[0].*uv, t.v[2].*uv - t.v[0].*uv)) / volume : 0;
}

void project(const Camera& camera, Vertex& vertex) {
  const Vec3 d = vertex.world - camera.position;
  vertex.inverse_depth = 1 / dot(d, camera.forward);
  vertex.x = camera.center_x + camera.focal * dot(d, camera.right) * vertex.inverse_depth;
  vertex.y = camera.center_y - camera.focal * dot(d, camera.up) * vertex.inverse_depth;
}

/// Tangent (u grows) and bitangent (v grows): the x and y axes of the normal map.
void tangent_frame(TriangleSetup& t) {
  const Vec3 e1 = t.v[1].world - t.v[0].world, e2 = t.v[2].world - t.v[0].world;
  const Vec2 d1 = t.v[1].uv - t.v[0].uv, d2 = t.v[2].uv - t.v[0].uv;
  const double det = cross(d1, d2);
  if (det == 0) return;
  t.tangent = normalized((1 / det) * (d2.y * e1 - d1.y * e2));
  t.bitangent = normalized((1 / det) * (d1.x * e2 - d2.x * e1));
}

Vec3 checker_color(const TriangleSetup& t, Vec2 uv, double checker_mm) {
  if (!t.has_uv || t.material->mm_per_uv.x <= 0) return {0.55, 0.55, 0.57};
  const double x = uv.x * t.material->mm_per_uv.x / checker_mm, y = uv.y * t.material->mm_per_uv.y / checker_mm;
  const bool odd = (static_cast<long long>(std::floor(x)) + static_cast<long long>(std::floor(y))) & 1;
  return odd ? Vec3{0.85, 0.47, 0.09} : Vec3{0.05, 0.16, 0.32};
}

/// Light of an environment off a surface: matt below, mirrored above by Schlick's Fresnel term, as far as roughness
/// lets it.
Vec3 lit_by(const EnvironmentLight& light, const ShadedMaterial& material, Vec3 color, Vec3 normal, Vec3 view) {
  constexpr double k_dielectric = 0.04;
  const double facing = std::clamp(dot(normal, view), 0.0, 1.0), edge = std::pow(1 - facing, 5.0);
  const Vec3 matt = light.diffuse(normal);
  const Vec3 mirrored = light.reflection(2 * facing * normal - view, material.roughness);
  const auto channel = [&](double albedo, double diffuse, double reflected) {
    const double head_on = k_dielectric + (albedo - k_dielectric) * material.metallic;
    const double fresnel = head_on + (std::max(1 - material.roughness, head_on) - head_on) * edge;
    return albedo * (1 - material.metallic) * diffuse + fresnel * reflected;
  };
  return {channel(color.x, matt.x, mirrored.x), channel(color.y, matt.y, mirrored.y),
          channel(color.z, matt.z, mirrored.z)};
}

/// A colour of linear light, and how much of what is behind it covers.
struct Shade {
  Vec3 color;
  double alpha = 1;
};

Shade shade(const TriangleSetup& t, const double (&weight)[3], const Camera& camera, const SceneViewOptions& options) {
  const auto mix = [&](auto member) {
    return weight[0] * (t.v[0].*member) + weight[1] * (t.v[1].*member) + weight[2] * (t.v[2].*member);
  };
  const Vec3 position = mix(&Vertex::world);
  const Vec2 uv = mix(&Vertex::uv);
  Vec3 normal = normalized(mix(&Vertex::normal));
  const Vec3 view = normalized(camera.position - position);
  if (dot(normal, view) < 0) normal = -normal;

  const ShadedMaterial& material = *t.material;
  Vec3 color = material.color;
  double alpha = material.opacity;
  if (options.mode == RenderMode::checker) {
    color = checker_color(t, uv, options.checker_mm);
  } else {
    const double depth = dot(position - camera.position, camera.forward);
    if (material.color_map && t.has_color_uv) {
      const Vec2 color_uv = mix(&Vertex::color_uv);
      const double uv_area = t.color_uv_area_per_cubic_depth * depth * depth * depth;
      const UvTransform& map = material.color_transform;
      const double texels = uv_area * std::abs(map.scale.x * map.scale.y) * material.color_map->texel_count();
      const auto [texel, texel_alpha] = material.color_map->sample(transform_uv(map, color_uv), texels);
      color = {color.x * texel.x, color.y * texel.y, color.z * texel.z};
      alpha *= texel_alpha;
    }
    if (material.normal_map && t.has_uv && norm(t.tangent) > 0) {
      const double uv_area = t.uv_area_per_cubic_depth * depth * depth * depth;
      const UvTransform& map = material.normal_transform;
      const double texels = uv_area * std::abs(map.scale.x * map.scale.y) * material.normal_map->texel_count();
      const Vec3 texel = material.normal_map->sample(transform_uv(map, uv), texels).color;
      const Vec3 tangent = normalized(t.tangent - dot(t.tangent, normal) * normal);
      const Vec3 side = cross(normal, tangent);
      const Vec3 bitangent = dot(side, t.bitangent) < 0 ? -side : side;
      normal = normalized(material.normal_scale * (2 * texel.x - 1) * tangent +
                          material.normal_scale * (2 * texel.y - 1) * bitangent + (2 * texel.z - 1) * normal);
    }
  }

  const auto& environment = material.environment ? material.environment : options.environment;
  if (environment && options.mode == RenderMode::material)
    return {lit_by(*environment, material, color, normal, view), alpha};
  // A close-up is lit at a grazing angle, which makes relief visible.
  const double towards = options.close_up ? 0.45 : 0.6;
  const Vec3 key = normalized(0.5 * camera.right + 0.9 * camera.up - towards * camera.forward);
  const Vec3 fill = normalized(-0.9 * camera.right + 0.2 * camera.up - 0.5 * camera.forward);
  const double diffuse = 0.35 + 1.25 * std::max(0.0, dot(normal, key)) + 0.4 * std::max(0.0, dot(normal, fill));
  const double gloss = 1 - material.roughness;
  const double exponent = 8 + 120 * gloss * gloss;
  const double highlight =
      (0.05 + 0.5 * gloss) * std::pow(std::max(0.0, dot(normal, normalized(key + view))), exponent);
  return {(diffuse * (1 - 0.4 * material.metallic)) * color + highlight * Vec3{1, 1, 1}, alpha};
}

/// The colour of a sample with edges and borders drawn over it. @param screen barycentric coordinates on the screen.
Vec3 with_edges(const TriangleSetup& t, const double (&screen)[3], Vec3 color, int samples) {
  constexpr double k_border_px = 1.6, k_edge_px = 0.6, k_edge_share = 0.55;
  constexpr Vec3 k_border{0.75, 0.06, 0.02}, k_edge{0.02, 0.03, 0.05};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vertex &a = t.v[k], &b = t.v[(k + 1) % 3];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    const double distance_px = screen[(k + 2) % 3] * std::abs(t.doubled_area) / std::max(length, 1e-9) / samples;
    if (t.border[k] && distance_px < k_border_px) return k_border;
    if (distance_px < k_edge_px) color = (1 - k_edge_share) * color + k_edge_share * k_edge;
  }
  return color;
}

/// Fill rule: a sample on an edge belongs to exactly one of the two triangles that share the edge.
bool owns_edge(const Vertex& a, const Vertex& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; }

/// Shades the samples in rows [row_begin, row_end) that the triangle covers and that pass the depth test. Transparent
/// triangles are blended over what is there and write no depth: they must come last, the farthest first.
void rasterize(const TriangleSetup& t, const Camera& camera, const SceneViewOptions& options, int width, int row_begin,
               int row_end, std::vector<Sample>& samples) {
  const auto [low_x, high_x] = std::minmax({t.v[0].x, t.v[1].x, t.v[2].x});
  const auto [low_y, high_y] = std::minmax({t.v[0].y, t.v[1].y, t.v[2].y});
  if (high_x < 0 || low_x > width || high_y < row_begin || low_y > row_end) return;
  const int x_begin = std::max(0, static_cast<int>(std::ceil(low_x - 0.5)));
  const int x_end = std::min(width - 1, static_cast<int>(std::floor(high_x - 0.5)));
  const int y_begin = std::max(row_begin, static_cast<int>(std::ceil(low_y - 0.5)));
  const int y_end = std::min(row_end - 1, static_cast<int>(std::floor(high_y - 0.5)));
  for (int y = y_begin; y <= y_end; ++y) {
    for (int x = x_begin; x <= x_end; ++x) {
      const Vec2 p{x + 0.5, y + 0.5};
      double screen[3];
      bool inside = true;
      for (int k = 0; k < 3; ++k) {
        const Vertex &a = t.v[(k + 1) % 3], &b = t.v[(k + 2) % 3];
        screen[k] = cross(Vec2{a.x, a.y} - p, Vec2{b.x, b.y} - p) / t.doubled_area;
        inside = inside && (screen[k] > 0 || (screen[k] == 0 && owns_edge(a, b) == (t.doubled_area > 0)));
      }
      if (!inside) continue;
      double inverse_depth = 0;
      for (int k = 0; k < 3; ++k) inverse_depth += screen[k] * t.v[k].inverse_depth;
      Sample& sample =
          samples[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
      if (static_cast<float>(inverse_depth) <= sample.inverse_depth) continue;
      double weight[3];
      for (int k = 0; k < 3; ++k) weight[k] = screen[k] * t.v[k].inverse_depth / inverse_depth;
      auto [color, alpha] = shade(t, weight, camera, options);
      if (alpha < t.material->alpha_cutoff) continue;
      if (options.mode == RenderMode::triangles) color = with_edges(t, screen, color, options.samples);
      const auto mixed = [opacity = t.material->blends ? alpha : 1](float behind, double own) {
        return static_cast<float>((1 - opacity) * static_cast<double>(behind) + opacity * own);
      };
      sample = {t.material->blends ? sample.inverse_depth : static_cast<float>(inverse_depth), mixed(sample.r, color.x),
                mixed(sample.g, color.y), mixed(sample.b, color.z)};
    }
  }
}

std::vector<TriangleSetup> set_up_triangles(const Scene& scene, const std::vector<Instance>& uses,
                                            const std::vector<ShadedMaterial>& materials, const ShadedMaterial& plain,
                                            bool with_borders) {
  std::vector<TriangleSetup> triangles;
  const Transform turn = to_y_up(scene.up);
  for (const Instance& use : uses) {
    const Part& part = scene.parts[use.part];
    const TriangleMesh& mesh = part.mesh;
    const Transform world = multiply(turn, use.world);
    const Vec3 origin = transform_point(world, {});
    const auto borders = with_borders ? border_edges(mesh.triangles) : std::vector<std::array<bool, 3>>();
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      TriangleSetup t;
      const std::uint32_t slot = mesh.material.empty() ? 0 : mesh.material[i];
      t.material = slot < part.materials.size() ? &materials[part.materials[slot]] : &plain;
      const auto& uv = t.material->channel == 1 ? mesh.uv1 : mesh.uv;
      const auto& color_uv = t.material->color_channel == 1 ? mesh.uv1 : mesh.uv;
      t.has_uv = uv.has_value(i), t.has_color_uv = color_uv.has_value(i);
      for (std::size_t k = 0; k < 3; ++k) {
        t.v[k].world = transform_point(world, mesh.positions[mesh.triangles[i][k]]);
        if (t.has_uv) t.v[k].uv = uv.values[uv.indices[i][k]];
        if (t.has_color_uv) t.v[k].color_uv = color_uv.values[color_uv.indices[i][k]];
      }
      const Vec3 flat = normalized(cross(t.v[1].world - t.v[0].world, t.v[2].world - t.v[0].world));
      for (std::size_t k = 0; k < 3; ++k) {
        t.v[k].normal = flat;
        if (mesh.normals.has_value(i))
          t.v[k].normal = normalized(transform_point(world, mesh.normals.values[mesh.normals.indices[i][k]]) - origin);
      }
      if (with_borders) t.border = borders[i];
      tangent_frame(t);
      triangles.push_back(t);
    }
  }
  return triangles;
}

/// Moves transparent triangles to the end, the farthest first.
void sort_transparent(std::vector<TriangleSetup>& triangles) {
  const auto transparent = std::stable_partition(triangles.begin(), triangles.end(),
                                                 [](const TriangleSetup& t) { return !t.material->blends; });
  const auto nearness = [](const TriangleSetup& t) {
    return t.v[0].inverse_depth + t.v[1].inverse_depth + t.v[2].inverse_depth;
  };
  std::stable_sort(transparent, triangles.end(),
                   [&](const TriangleSetup& a, const TriangleSetup& b) { return nearness(a) < nearness(b); });
}

unsigned char encode(double linear) { return static_cast<unsigned char>(std::lround(255 * srgb_from_linear(linear))); }

ColorImage resolve(const std::vector<Sample>& samples, const SceneViewOptions& options) {
  ColorImage image{options.width, options.height, {}};
  image.pixels.reserve(3 * static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height));
  const auto stride = static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.samples);
  const auto n = static_cast<std::size_t>(options.samples);
  for (std::size_t y = 0; y < static_cast<std::size_t>(options.height); ++y) {
    for (std::size_t x = 0; x < static_cast<std::size_t>(options.width); ++x) {
      Vec3 sum;
      for (std::size_t dy = 0; dy < n; ++dy) {
        for (std::size_t dx = 0; dx < n; ++dx) {
          const Sample& s = samples[(y * n + dy) * stride + x * n + dx];
          sum = sum + Vec3{static_cast<double>(s.r), static_cast<double>(s.g), static_cast<double>(s.b)};
        }
      }
      const Vec3 mean = (1.0 / static_cast<double>(n * n)) * sum;
      image.pixels.insert(image.pixels.end(), {encode(mean.x), encode(mean.y), encode(mean.z)});
    }
  }
  return image;
}

}  // namespace

Vec3 camera_position(const CloseUp& close_up, UpAxis up) {
  const Transform turn = to_y_up(up);
  const Vec3 normal = normalized(transform_point(turn, close_up.normal));
  const Vec3 towards = normalized(normal + Vec3{0.25, 0.45, 0.25});
  return transform_point(turn, close_up.point) + (0.5 * close_up.extent_mm / std::tan(0.5 * k_field_of_view)) * towards;
}

ColorImage render_scene(const Scene& scene, const SceneViewOptions& options) {
  if (options.width < 1 || options.height < 1 || options.samples < 1 || options.width > 16384 || options.height > 16384)
    throw InvalidInput("render_scene: width and height must be 1 to 16384, samples at least 1");
  Pyramids pyramids(scene);
  std::vector<ShadedMaterial> materials;
  for (std::size_t m = 0; m < scene.materials.size(); ++m)
    materials.push_back(shaded_material(scene, m, options, pyramids));
  const ShadedMaterial plain{.color = options.mode == RenderMode::triangles ? k_clay : Vec3{1, 1, 1}};
  std::vector<TriangleSetup> triangles =
      set_up_triangles(scene, instances(scene), materials, plain, options.mode == RenderMode::triangles);
  if (triangles.empty()) throw InvalidInput("render_scene: the scene has no triangle");

  const Camera camera = place_camera(scene, triangles, options);
  clip_near(triangles, camera, options.close_up ? 0.05 * options.close_up->extent_mm : 0);
  for (TriangleSetup& t : triangles) {
    for (Vertex& v : t.v) project(camera, v);
    t.doubled_area =
        cross(Vec2{t.v[1].x - t.v[0].x, t.v[1].y - t.v[0].y}, Vec2{t.v[2].x - t.v[0].x, t.v[2].y - t.v[0].y});
    if (t.has_uv) t.uv_area_per_cubic_depth = uv_area_per_cubic_depth(t, &Vertex::uv, camera);
    if (t.has_color_uv) t.color_uv_area_per_cubic_depth = uv_area_per_cubic_depth(t, &Vertex::color_uv, camera);
  }
  std::erase_if(triangles, [](const TriangleSetup& t) { return !(std::abs(t.doubled_area) > 0); });
  sort_transparent(triangles);

  const int width = options.width * options.samples, height = options.height * options.samples;
  std::vector<Sample> samples(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  constexpr int k_band = 64;  // rows of one task
  oneapi::tbb::parallel_for(0, (height + k_band - 1) / k_band, [&](int band) {
    for (const TriangleSetup& t : triangles)
      rasterize(t, camera, options, width, band * k_band, std::min(height, (band + 1) * k_band), samples);
  });
  return resolve(samples, options);
}

}  // namespace papilla
