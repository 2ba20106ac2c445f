// SPDX-License-Identifier: MIT
#pragma once

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "papilla/core/error.hpp"
#include "papilla/haptic/contact_mesh.hpp"

namespace papilla::bench {

/// Distance to a mesh by Embree's point query, in single precision, with the textbook's closest point of a triangle.
class EmbreeClosest {
 public:
  explicit EmbreeClosest(const ContactMesh& mesh) : mesh_(&mesh), device_(rtcNewDevice("threads=1")) {
    scene_ = rtcNewScene(device_);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), mesh.positions.size()));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(unsigned), mesh.triangles.size()));
    if (vertices == nullptr || indices == nullptr) throw SolverFailure("EmbreeClosest: out of memory");
    for (const Vec3& p : mesh.positions)
      for (const double value : {p.x, p.y, p.z}) *vertices++ = static_cast<float>(value);
    for (const auto& triangle : mesh.triangles)
      for (const unsigned v : triangle) *indices++ = v;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~EmbreeClosest() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeClosest(const EmbreeClosest&) = delete;
  EmbreeClosest& operator=(const EmbreeClosest&) = delete;

  /// Distance from `p` to the mesh, or `radius` when that is nearer.
  double distance(Vec3 p, double radius) const {
    Search search{mesh_, p, radius};
    RTCPointQuery query{};
    query.x = static_cast<float>(p.x);
    query.y = static_cast<float>(p.y);
    query.z = static_cast<float>(p.z);
    query.radius = static_cast<float>(radius);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_, &query, &context, visit, &search);
    return search.best;
  }

 private:
  struct Search {
    const ContactMesh* mesh;
    Vec3 p;
    double best;
  };

  static bool visit(RTCPointQueryFunctionArguments* arguments) {
    Search& search = *static_cast<Search*>(arguments->userPtr);
    const auto& t = search.mesh->triangles[arguments->primID];
    const double d = triangle_distance(search.p, search.mesh->positions[t[0]], search.mesh->positions[t[1]],
                                       search.mesh->positions[t[2]]);
    if (d >= search.best) return false;
    search.best = d;
    arguments->query->radius = static_cast<float>(d);
    return true;
  }

  static double segment_distance(Vec3 p, Vec3 a, Vec3 b) {
    const Vec3 ab = b - a;
    const double length2 = dot(ab, ab);
    const double t = length2 > 0 ? std::clamp(dot(p - a, ab) / length2, 0.0, 1.0) : 0;
    return norm(p - (a + t * ab));
  }

  static double triangle_distance(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 n = cross(b - a, c - a);
    const bool inside =
        dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 && dot(cross(a - c, p - c), n) >= 0;
    if (inside && dot(n, n) > 0) return std::abs(dot(p - a, n)) / norm(n);
    return std::min({segment_distance(p, a, b), segment_distance(p, b, c), segment_distance(p, c, a)});
  }

  const ContactMesh* mesh_;
  RTCDevice device_;
  RTCScene scene_;
};

}  // namespace papilla::bench
