// SPDX-License-Identifier: MIT
#include "papilla/pipeline/study/study_stimuli.hpp"

#include <fmt/format.h>

#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/temporary_folder.hpp"
#include "papilla/haptic/stimulus.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/pipeline/bake_scene.hpp"
#include "papilla/pipeline/synthesis.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

constexpr double k_tile_mm = 40;  ///< On which relief_mm is meant.
constexpr const char* k_material = "stimulus";

/// A square that lies face up, with uv in millimetres.
Scene plate(double size_mm) {
  Part part;
  part.name = "plate";
  part.materials = {0};
  TriangleMesh& mesh = part.mesh;
  mesh.positions = {{0, 0, 0}, {size_mm, 0, 0}, {size_mm, size_mm, 0}, {0, size_mm, 0}};
  mesh.uv.values = {{0, 0}, {size_mm, 0}, {size_mm, size_mm}, {0, size_mm}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.uv.indices = mesh.triangles;
  Scene scene = single_part_scene(std::move(part), "plate");
  scene.materials.resize(1);
  return scene;
}

/// A fractal surface as a picture of its heights.
void write_fractal(const StudyStimulus& stimulus, std::uint64_t seed, const fs::path& file) {
  write_grey_image(
      file, synthesize_texture({.dimension = stimulus.dimension, .size_mm = stimulus.size_mm, .seed = seed}).picture,
      16);
}

MaterialRule rule_of(const StudyStimulus& stimulus, const Study& study, const StudyStimulusOptions& options,
                     const fs::path& folder) {
  MaterialRule rule;
  rule.name = k_material;
  rule.size_mm[0] = rule.size_mm[1] = stimulus.size_mm;
  rule.stiffness = options.stiffness;
  rule.static_friction = rule.dynamic_friction = options.friction;
  rule.unwrap = "keep";
  rule.show = "relief";
  rule.height.depth_mm = options.relief_mm * stimulus.size_mm / k_tile_mm;
  rule.height.scale = stimulus.height;
  if (!stimulus.dimension) {
    rule.recipe = std::string(k_grain_prefix) + stimulus.grain;
    rule.texture = rule.recipe;
    return rule;
  }
  rule.texture = folder / fmt::format("fractal-{}.png", *stimulus.dimension);
  write_fractal(stimulus, study.seed, rule.texture);
  // The picture is the relief, and its slopes are felt as added forces only.
  PictureReliefOptions& relief = rule.height.relief;
  relief.height.method = HeightMethod::intensity;
  relief.height.periodic = false;
  relief.roughness = HeightRoughness::whole;
  relief.tile = false;
  relief.part = false;
  relief.source = ReliefSource::picture;
  constexpr double k_any_slope = 1000;
  rule.height.max_slope = k_any_slope;
  return rule;
}

BakeResult baked(const StudyStimulus& stimulus, const Study& study, const StudyStimulusOptions& options) {
  const TemporaryFolder folder("papilla-study");
  Materials rules;
  rules.materials[k_material] = rule_of(stimulus, study, options, folder.path());
  AssignRule all;
  all.part = "*";
  all.material = k_material;
  rules.assign.push_back(std::move(all));
  return bake_scene(plate(stimulus.size_mm), rules);
}

/// N a grey level [Schulze 2005, 6.4.2.1 to 6.4.2.4].
double amplitude_of(ForceModel model) { return model == ForceModel::orthogonal ? 0.005 : 0.01; }

/// The tag of the plate with the stimulus's model.
void set_model(const StudyStimulus& stimulus, Scene& scene) {
  const ForceModel model = *force_model(stimulus.model);
  for (Material& material : scene.materials) {
    if (!material.haptic) continue;
    material.haptic->force_model.reset();
    if (model == ForceModel::heightfield) continue;
    ForceModelTag& tag = material.haptic->force_model.emplace();
    tag.name = name_of(model);
    if (is_stimulus(model)) tag.amplitude = amplitude_of(model) * stimulus.height;
    if (is_graph(model) && stimulus.dimension && material.haptic->roughness)
      material.haptic->roughness->fractal_dimension = stimulus.dimension;
  }
}

void write_pictures(const Study& study, const fs::path& folder, int side_px) {
  std::set<std::string> written;
  for (const StudyTrial& trial : study.trials)
    for (const std::string& name : trial.pictures) {
      if (!written.insert(name).second) continue;
      make_folder((folder / name).parent_path());
      const GrainKind kind = grain_kind(fs::path(name).stem().string());
      write_grey_image(folder / name,
                       synthesize_texture({.grain = kind, .size_px = side_px, .seed = study.seed}).picture, 8);
    }
}

}  // namespace

Study write_stimuli(Study study, const fs::path& folder, const StudyStimulusOptions& options,
                    const ProgressCallback& progress) {
  using Relief = std::tuple<std::string, double, double, double>;  // Grain, height, size, dimension.
  std::map<Relief, std::vector<StudyStimulus*>> by_relief;
  for (StudyStimulus& stimulus : study.stimuli)
    by_relief[{stimulus.grain, stimulus.height, stimulus.size_mm, stimulus.dimension.value_or(0)}].push_back(&stimulus);
  double done = 0;
  for (const auto& [relief, stimuli] : by_relief) {
    report_progress(progress, "stimuli", done++ / static_cast<double>(by_relief.size()));
    BakeResult result = baked(*stimuli.front(), study, options);
    const GrainHeight& height = result.grains.at(k_material).height;
    for (StudyStimulus* stimulus : stimuli) {
      set_model(*stimulus, result.scene);
      make_folder((folder / stimulus->file).parent_path());
      write_scene(result.scene, folder / stimulus->file);
      stimulus->depth_mm = height.depth_mm;
      stimulus->limited_share = height.slopes.share_before;
    }
  }
  write_pictures(study, folder, options.picture_px);
  return study;
}

}  // namespace papilla
