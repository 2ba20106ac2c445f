// SPDX-License-Identifier: MIT
// Long computations that their ProgressCallback cancels, most of them inside a parallel loop.
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <string>

#include "io/temporary_folder.hpp"
#include "meshing/shapes.hpp"
#include "papilla/core/progress.hpp"
#include "papilla/io/cad_reader.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/meshing/repair.hpp"
#include "papilla/meshing/segmentation.hpp"
#include "papilla/procedural/texture.hpp"
#include "papilla/texture/feature_matrix.hpp"
#include "papilla/texture/shape_from_shading.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

struct Work {
  const char* name;
  std::function<void(const ProgressCallback&)> run;
  const char* stage;    ///< Of the parallel loop.
  double fraction = 0;  ///< From which the loop runs.
};

/// Spheres of unlike sizes apart from each other, every triangle on its own, and surfaces that need repair.
TriangleMesh soup() {
  TriangleMesh mesh = test::lattice_soup(300, 1);
  for (int k = 1; k < 8; ++k) mesh = test::joined(mesh, test::moved(test::sphere(2 + k), {20.0 * k, 0, 0}));
  return test::soup_of(mesh);
}

void read_cockpit(const ProgressCallback& progress) {
  ReadOptions options;
  options.chord_mm = 1;
  read_scene(PAPILLA_COCKPIT, options, progress);
}

void read_cockpit_in_this_process(const ProgressCallback& progress) {
  CadReadOptions options;
  options.chord_mm = 1;
  options.isolated = false;
  read_cad(PAPILLA_COCKPIT, options, nullptr, progress);
}

const Work k_works[] = {
    {"repair", [](const auto& progress) { repair(soup(), {.progress = progress}); }, "repair"},
    {"segmentation", [](const auto& progress) { segment_charts(test::double_torus(), {.progress = progress}); },
     "charts", 0.3},
    {"feature_matrix", [](const auto& progress) { absolute_feature_matrix(test::noise_image(200, 150, 1), progress); },
     "symmetry"},
    {"shape_from_shading",
     [](const auto& progress) {
       shape_from_shading_variational(test::noise_image(300, 200, 2),
                                      {.iterations = 4, .largest_piece_px = 64, .progress = progress});
     },
     "shape from shading", 0.1},
    {"texture",
     [](const auto& progress) {
       RenderOptions options;
       options.width = options.height = 400;
       options.progress = progress;
       render_texture(compile_texture("fbm|scale=.2|bumpfunction=nearmean(main,.05)", {}), options);
     },
     "texture"},
    {"read_scene", read_cockpit, "tessellate", 0.5},
    {"read_scene_from_the_start", read_cockpit, "read"},
    {"read_in_this_process", read_cockpit_in_this_process, "tessellate", 0.5},
    {"read_in_this_process_from_the_start", read_cockpit_in_this_process, "read"}};

class Cancel : public testing::TestWithParam<Work> {
 protected:
  Cancel() : before_(fs::current_path()) {
    fs::current_path(folder_.path());
    ::setenv("TMPDIR", folder_.path().c_str(), 1);
  }
  ~Cancel() override {
    ::unsetenv("TMPDIR");
    fs::current_path(before_);
  }

  test::TemporaryFolder folder_;
  fs::path before_;
};

TEST_P(Cancel, LeavesAsCancelledAndWritesNothing) {
  const Work& work = GetParam();
  bool asked = false;
  const ProgressCallback cancel = [&](const Progress& progress) {
    asked |= progress.stage == work.stage && progress.fraction >= work.fraction && progress.fraction < 1;
    return !asked;
  };
  EXPECT_THROW(work.run(cancel), Cancelled);
  EXPECT_TRUE(asked);
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

INSTANTIATE_TEST_SUITE_P(Work, Cancel, testing::ValuesIn(k_works),
                         [](const testing::TestParamInfo<Work>& work) { return std::string(work.param.name); });

}  // namespace
}  // namespace papilla
