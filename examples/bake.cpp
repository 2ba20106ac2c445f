// SPDX-License-Identifier: MIT
// From a CAD file to a GLB that can be seen and felt: bake SCENE.step MATERIALS.json OUT.glb
#include <cstdio>

#include <papilla/pipeline/pipeline.hpp>

static int run(char** argv) {
  using namespace papilla;
  ReadOptions read;
  read.chord_mm = 0.5;
  const ProgressCallback progress = [](const Progress& done) {
    std::fprintf(stderr, "\r%.*s %3.0f %%  ", static_cast<int>(done.stage.size()), done.stage.data(),
                 100 * done.fraction);
    return true;
  };
  const Materials materials = read_materials(argv[2]);
  const BakeResult result = bake_scene(read_scene(argv[1], read, progress), materials, {}, progress);
  for (const BakedSurface& surface : result.surfaces)
    std::printf("%s: %s, %u charts, symmetric Dirichlet %.4f\n", surface.label.c_str(), surface.method.c_str(),
                surface.distortion.charts, surface.distortion.symmetric_dirichlet.mean);
  for (const std::string& loss : write_scene(result.scene, argv[3])) std::printf("left out: %s\n", loss.c_str());
  return 0;
}

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: bake SCENE MATERIALS.json OUT.glb\n");
    return 2;
  }
  try {
    return run(argv);
  } catch (const papilla::Error& error) {
    std::fprintf(stderr, "bake: %s\n", error.what());
    return 3;
  }
}
