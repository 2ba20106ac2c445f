// SPDX-License-Identifier: MIT
// Distortions that another program measured of CGAL's least squares conformal maps, on meshes given by formula.
#include <gtest/gtest.h>

#include <random>

#include "papilla/param/lscm.hpp"
#include "papilla/param/measure.hpp"
#include "support/formula_meshes.hpp"

namespace papilla {
namespace {

/// grid_mesh() with a jitter of 0.15 cells drawn as that program draws it.
TriangleMesh reference_grid(int columns, int rows, const test::Surface& surface) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  return test::grid_mesh(columns, rows, [&](double s, double t) {
    const double a = uniform(generator), b = uniform(generator);
    if (s > 0 && s < 1) s += 0.15 * a / columns;
    if (t > 0 && t < 1) t += 0.15 * b / rows;
    return surface(s, t);
  });
}

struct Known {
  const char* name;
  TriangleMesh mesh;
  double symmetric_dirichlet, maillot;
};

TEST(Lscm, HasTheDistortionThatAnotherProgramMeasured) {
  for (const Known& known : {Known{"dashboard", reference_grid(118, 42, test::dashboard), 4.0372, 0.016},
                             Known{"hemisphere", test::hemisphere_mesh(50, 101), 4.3374, 0.18},
                             Known{"cylinder", reference_grid(100, 50, test::open_cylinder), 4.0000, 0},
                             Known{"handle", reference_grid(32, 160, test::grab_handle), 7.6832, 1.05}}) {
    LscmOptions options;
    options.solver = LscmSolver::cgal;
    const Flattening f = flatten_lscm(known.mesh, test::one_chart(known.mesh), options);
    EXPECT_TRUE(f.notes.empty());
    const DistortionReport r = measure_distortion(known.mesh, f.uv);
    EXPECT_NEAR(r.symmetric_dirichlet.mean, known.symmetric_dirichlet, 5.1e-5) << known.name;
    EXPECT_NEAR(r.maillot_length, known.maillot, 0.05 * known.maillot + 1e-9) << known.name;
  }
}

}  // namespace
}  // namespace papilla
