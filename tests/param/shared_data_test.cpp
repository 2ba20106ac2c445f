// SPDX-License-Identifier: MIT
// Known results of other programs on known meshes; runs where PAPILLA_SHARED_DATA names the folder that has them.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "papilla/param/lscm.hpp"
#include "papilla/param/measure.hpp"
#include "support/formula_meshes.hpp"

namespace papilla {
namespace {

/// Positions and triangles of an OBJ file that has nothing else.
TriangleMesh read_plain_obj(const std::string& path) {
  TriangleMesh mesh;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      Vec3 p;
      words >> p.x >> p.y >> p.z;
      mesh.positions.push_back(p);
    } else if (kind == "f") {
      Triangle t{};
      words >> t[0] >> t[1] >> t[2];
      mesh.triangles.push_back({t[0] - 1, t[1] - 1, t[2] - 1});
    }
  }
  return mesh;
}

struct Known {
  const char* file;
  double symmetric_dirichlet, maillot;
};

TEST(SharedData, CgalLscmHasTheMeasuredDistortion) {
  const char* folder = std::getenv("PAPILLA_SHARED_DATA");
  if (!folder) GTEST_SKIP() << "PAPILLA_SHARED_DATA is not set";
  for (const Known& known : {Known{"dash_10k", 4.0372, 0.016}, Known{"hemi_10k", 4.3374, 0.18},
                             Known{"cyl_10k", 4.0000, 0}, Known{"handle_10k", 7.6832, 1.05}}) {
    const TriangleMesh mesh = read_plain_obj(std::string(folder) + "/param-bench/" + known.file + ".obj");
    ASSERT_FALSE(mesh.triangles.empty()) << known.file;
    LscmOptions options;
    options.solver = LscmSolver::cgal;
    const Flattening f = flatten_lscm(mesh, test::one_chart(mesh), options);
    EXPECT_TRUE(f.notes.empty());
    const DistortionReport r = measure_distortion(mesh, f.uv);
    EXPECT_NEAR(r.symmetric_dirichlet.mean, known.symmetric_dirichlet, 5.1e-5) << known.file;
    EXPECT_NEAR(r.maillot_length, known.maillot, 0.05 * known.maillot + 1e-9) << known.file;
  }
}

}  // namespace
}  // namespace papilla
