// SPDX-License-Identifier: MIT
#include "bench/param_peer.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>

#include "bench/whole_process.hpp"
#include "papilla/core/error.hpp"

namespace papilla::bench {
namespace {

namespace fs = std::filesystem;

void write_off(const fs::path& file, const TriangleMesh& mesh) {
  std::ofstream out(file);
  out << "OFF\n" << mesh.positions.size() << ' ' << mesh.triangles.size() << " 0\n" << std::setprecision(17);
  for (const Vec3& p : mesh.positions) out << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (const Triangle& t : mesh.triangles) out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
}

std::optional<PeerMap> read_result(const fs::path& file, Values<Triangle> indices, std::size_t values) {
  std::ifstream in(file);
  PeerMap map;
  if (!(in >> map.cpu_seconds >> map.peak_mib)) return {};
  map.uv.values.resize(values);
  map.uv.indices = std::move(indices);
  for (Vec2& p : map.uv.values)
    if (!(in >> p.x >> p.y) || !is_finite(p)) return {};
  return map;
}

std::optional<PeerMap> run_peer(const std::string& method, const TriangleMesh& mesh, Values<Triangle> indices,
                                std::size_t values) {
  const char* program = std::getenv("PAPILLA_PARAM_PEER");
  if (!program) return {};
  const fs::path folder = fs::temp_directory_path() / ("papilla-peer-" + std::to_string(::getpid()));
  fs::create_directories(folder);
  write_off(folder / "mesh.off", mesh);
  std::optional<PeerMap> map;
  try {
    run_process({program, method, (folder / "mesh.off").string(), (folder / "uv").string()});
    map = read_result(folder / "uv", std::move(indices), values);
  } catch (const IoError&) {  // it refused the mesh
  }
  fs::remove_all(folder);
  return map;
}

}  // namespace

std::optional<PeerMap> peer_map(const std::string& method, const TriangleMesh& mesh) {
  return run_peer(method, mesh, mesh.triangles, mesh.positions.size());
}

std::optional<PeerMap> peer_atlas(const std::string& method, const TriangleMesh& mesh) {
  Values<Triangle> corners;
  for (Index t = 0; t < mesh.triangles.size(); ++t) corners.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  return run_peer(method, mesh, std::move(corners), 3 * mesh.triangles.size());
}

}  // namespace papilla::bench
