// SPDX-License-Identifier: GPL-3.0-or-later
#include "options/texture_option.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "exit_code.hpp"
#include "file_options.hpp"
#include "option_checks.hpp"
#include "options/vector_option.hpp"
#include "papilla/procedural/ageing.hpp"

namespace papilla::app {
namespace {

std::vector<Channel> channels_named(const std::string& list) {
  std::vector<Channel> channels;
  if (list == "all") {
    for (int c = 0; c < k_channels; ++c) channels.push_back(static_cast<Channel>(c));
    return channels;
  }
  for (std::size_t start = 0; start <= list.size();) {
    const std::size_t end = std::min(list.find(',', start), list.size());
    channels.push_back(channel_named(list.substr(start, end - start)));
    start = end + 1;
  }
  return channels;
}

}  // namespace

void HeightOption::add_to(CLI::App& verb) {
  writes(verb.add_option("--normal", normal_, "Write the glTF normal map of the relief too"))->type_name("FILE");
  verb.add_option("--pitch", options_.height.pitch_mm, "Millimetres per pixel; default from the file's resolution")
      ->type_name("MM")
      ->check(positive());
  verb.add_option("--depth", options_.height.depth_mm, "Peak to valley")
      ->type_name("MM")
      ->check(positive())
      ->capture_default_str();
  verb.add_option("--method", method_, "How grey becomes height")
      ->transform(one_of({"auto", "wiener", "variational", "pentland", "tsai-shah", "intensity"}))
      ->capture_default_str();
  verb.add_option("--light", light_, "Direction to the light: x right, y down, z to the viewer")
      ->type_name("X,Y,Z|{auto}")
      ->capture_default_str();
  verb.add_option("--transfer", transfer_,
                  "Curve of the picture, for shading; auto: by its colour profile, else sRGB with 8 bits")
      ->transform(one_of({"auto", "srgb", "linear"}))
      ->capture_default_str();
  verb.add_option("--periodic", periodic_, "Whether the height shall tile; auto looks whether the picture does")
      ->transform(one_of({"auto", "yes", "no"}))
      ->capture_default_str();
  roughness_given_ =
      verb.add_option("--roughness", roughness_,
                      "With a lattice: relief and roughness as one (whole), or the relief of the symmetric part with "
                      "no roughness, the residual, or a synthesized surface like it")
          ->transform(one_of({"whole", "none", "residual", "synthesized"}))
          ->capture_default_str();
  verb.add_option("--cut", cut_, "Leave out shorter waves; auto: two ticks of the device at --speed")
      ->type_name("MM|{auto,none}")
      ->capture_default_str();
  verb.add_option("--rate", rate_hz_, "Of the device, for --cut auto")
      ->type_name("HZ")
      ->check(positive())
      ->capture_default_str();
  verb.add_option("--speed", speed_mm_per_s_, "Of the hand, for --cut auto")
      ->type_name("MM/S")
      ->check(positive())
      ->capture_default_str();
  verb.add_flag("--tile", options_.height.tile,
                "One tile of the lattice, exactly periodic whatever its angle; its roughness is synthesized");
  CLI::Option* by_class = verb.add_flag(
      "--by-class", by_class_,
      "Carry out the plan of the picture's class as bake does: an exact tile of a lattice, roughness apart, or a "
      "synthesized surface; --tile and --roughness overrule it");
  verb.add_option("--source", source_, "With --by-class, the relief of a disordered picture")
      ->transform(one_of({"auto", "picture", "synthesis"}))
      ->capture_default_str()
      ->needs(by_class);
  verb.add_flag("--alternative", options_.opposite,
                "Write the relief that the opposite light would make of the same picture too");
  verb.add_flag("--variants", options_.deeper, "Write the relief twice and four times as deep too");
  writes_into(
      verb.add_option("--pictures", pictures_, "Write the lit relief, its opposite and the cross-section into DIR"),
      {"relief.png", "relief-opposite.png", "section.svg"})
      ->type_name("DIR");
}

double HeightOption::cut_mm() const {
  if (cut_ == "none") return 0;
  if (cut_ == "auto") return shortest_playable_wavelength_mm(speed_mm_per_s_, rate_hz_);
  double value = 0;
  const char* end = cut_.data() + cut_.size();
  const auto parsed = std::from_chars(cut_.data(), end, value);
  if (parsed.ec != std::errc() || parsed.ptr != end || !(value > 0) || !std::isfinite(value))
    throw UsageError("--cut " + cut_ + " is not auto, none or a positive number of millimetres");
  return value;
}

HeightFileOptions HeightOption::options(std::uint64_t seed, const ProgressCallback& progress) const {
  HeightFileOptions options = options_;
  options.height.method = height_method(method_);
  if (light_ != "auto") options.height.light = parse_vector("--light", light_);
  options.height.transfer = transfer(transfer_);
  if (periodic_ != "auto") options.height.periodic = periodic_ == "yes";
  options.height.roughness = height_roughness(roughness_);
  options.height.shortest_wavelength_mm = cut_mm();
  if (by_class_) {
    PictureReliefOptions& relief = options.by_class.emplace();
    if (options.height.tile) relief.tile = true;
    if (roughness_given_->count() > 0) relief.roughness = options.height.roughness;
    relief.source = relief_source(source_);
  }
  options.height.seed = seed;
  options.height.progress = progress;
  options.normal_map = normal_;
  options.pictures = pictures_;
  return options;
}

void TextureOption::add_to(CLI::App& verb) {
  verb.add_option("recipe", recipe, "Recipe: type|parameter=value|..., or the name of one")->type_name("RECIPE");
  writes_into(verb.add_option("-o,--output", output, "Folder of the pictures"))->type_name("DIR");
  CLI::Option* placed =
      reads(
          verb.add_option("--on", on,
                          "Put the recipe on all surfaces of a scene: DIR gets scene.glb and its pictures, an atlas of "
                          "recipes that read posx, posy, posz, normaldot or sky, else a tile of --size-mm"))
          ->type_name("SCENE");
  verb.add_option("--size", size_, "Texels a side, or width and height")
      ->expected(1, 2)
      ->delimiter('x')
      ->check(in_range(1, 65536))
      ->type_name("N[xN]");
  std::string channel_names = "all";
  for (int c = 0; c < k_channels; ++c) channel_names += "," + std::string(to_string(static_cast<Channel>(c)));
  verb.add_option("--channels", channels_, "Channels separated by commas, or all")
      ->type_name("LIST|{" + channel_names + "}")
      ->capture_default_str();
  verb.add_option("--bits", files.bits, "8 or 16 (PNG), 32 (EXR); colours have 8")
      ->transform(one_of({"8", "16", "32"}))
      ->capture_default_str();
  verb.add_flag("--normalize", files.normalize, "Stretch every channel to its full range");
  CLI::Option* normal = verb.add_flag("--normal", files.normal_map, "Write the glTF normal map of the height too");
  CLI::Option* preview =
      verb.add_flag("--preview", files.preview,
                    "Write preview.png too: the texture in the light of its recipe (lightx, ambient, pointlight, ...)");
  verb.add_option("--size-mm", files.size_mm, "Side of the picture, for the normal map and the preview")
      ->check(positive())
      ->type_name("MM")
      ->capture_default_str();
  verb.add_option("--depth-mm", files.depth_mm, "Height of 1, for the normal map and the preview")
      ->check(positive())
      ->type_name("MM")
      ->capture_default_str();
  verb.add_option("--age", age_, "Layers for words, e.g. \"very rusty and dusty 0.4\"; as --list ageing has them")
      ->type_name("WORDS");
  time_ = verb.add_option("--time", files.time, "0 new to 1 worn; with --age 1 unless given")
              ->check(in_range(0.0, 1.0))
              ->type_name("T")
              ->capture_default_str();
  CLI::Option* steps = verb.add_option("--steps", files.steps, "A series of pictures from time 0 to 1")
                           ->check(in_range(1, 9999))
                           ->type_name("N");
  verb.add_flag("--video", files.video, "The series as an animated GIF, lit, too")->needs(steps);
  verb.add_flag("--seamless", files.seamless, "The pictures tile");
  wang_ = verb.add_option("--wang", wang_side_,
                          "Write 8 Wang tiles of N texels a side in place of the picture, a quarter of it by default, "
                          "and a plane laid with them")
              ->check(in_range(16, 4096))
              ->type_name("N")
              ->expected(0, 1)
              ->excludes(steps)
              ->excludes(normal)
              ->excludes(preview);
  CLI::Option* as_glsl =
      writes(verb.add_option("--glsl", glsl, "Write the recipe as a fragment shader in GLSL ES 3.00 too"))
          ->type_name("FILE");
  CLI::Option* as_wgsl = writes(verb.add_option("--wgsl", wgsl, "The same in WGSL"))->type_name("FILE");
  for (CLI::Option* of_a_picture : {normal, preview, steps, wang_, as_glsl, as_wgsl}) placed->excludes(of_a_picture);
  reads(verb.add_option("--library", libraries, "Files of named recipes, on top of the built-in ones"))
      ->type_name("FILE");
  verb.add_option("--sheet", sheet, "A contact sheet: of all types, or of the library")
      ->transform(one_of({"types", "library"}));
  verb.add_option("--tile", tile_px, "Texels a side of a picture on the sheet")
      ->check(in_range(8, 1024))
      ->type_name("N")
      ->capture_default_str();
  verb.add_option(
          "--list", list,
          "Print types, functions, recipes, categories of recipes, words of ageing, reference, or the parameters of a "
          "type")
      ->type_name("WHAT|{types,functions,recipes,categories,ageing,glsl,reference}")
      ->expected(0, 1)
      ->default_str("types");
  verb.add_option("--suggest", suggest,
                  "Print recipes that suit a material of this name, and layers for words of its age")
      ->type_name("NAME");
  verb.add_option("--mutate", files.mutation, "Change the recipe's numbers by up to this share; --seed chooses")
      ->check(in_range(0.0, 1.0))
      ->type_name("SHARE");
}

TextureFileOptions TextureOption::options(std::uint64_t seed, const ProgressCallback& progress) const {
  TextureFileOptions options = files;
  options.width = size_[0], options.height = size_.size() > 1 ? size_[1] : size_[0];
  options.channels = channels_named(channels_);
  options.seed = seed;
  options.progress = progress;
  if (!age_.empty() && time_->count() == 0) options.time = 1;
  return options;
}

std::optional<int> TextureOption::wang_side() const {
  return wang_->count() > 0 ? std::optional(wang_side_) : std::nullopt;
}

std::string TextureOption::aged_recipe() const {
  return age_.empty() ? recipe : papilla::aged_recipe(recipe, ageing_layers(age_));
}

}  // namespace papilla::app
