// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "papilla/pipeline/height_file.hpp"
#include "papilla/pipeline/texture_files.hpp"

namespace papilla::app {

/// Options of `height`, in the order of its help.
class HeightOption {
 public:
  void add_to(CLI::App& verb);
  /// @throws UsageError for --light and --cut that are neither a word of theirs nor numbers.
  HeightFileOptions options(std::uint64_t seed, const ProgressCallback& progress) const;

 private:
  double cut_mm() const;

  HeightFileOptions options_;
  std::string normal_, pictures_;
  std::string method_ = "auto", light_ = "auto", periodic_ = "auto", roughness_ = "whole", cut_ = "none",
              transfer_ = "auto", source_ = "auto";
  bool by_class_ = false;
  const CLI::Option* roughness_given_ = nullptr;
  double rate_hz_ = k_device_rate_hz, speed_mm_per_s_ = k_hand_speed_mm_per_s;
};

/// Options of `texture`, in the order of its help: pictures of a recipe, or a contact sheet, or a list.
class TextureOption {
 public:
  std::string recipe, output, on, list, sheet, suggest;
  std::string glsl, wgsl;  ///< Files; empty: none.
  std::vector<std::string> libraries;
  int tile_px = 128;
  TextureFileOptions files;  ///< Without size and channels: see options().

  void add_to(CLI::App& verb);
  /// @throws InvalidInput for a channel that there is not.
  TextureFileOptions options(std::uint64_t seed, const ProgressCallback& progress) const;
  /// The recipe under the layers that --age asks for. @throws InvalidInput as ageing_layers().
  std::string aged_recipe() const;
  /// Texels a side of the Wang tiles that are asked for; 0: as the picture has it.
  std::optional<int> wang_side() const;
  bool has_shaders() const { return !glsl.empty() || !wgsl.empty(); }

 private:
  std::string age_;
  const CLI::Option* time_ = nullptr;
  CLI::Option* wang_ = nullptr;
  int wang_side_ = 0;
  std::string channels_ = "color,bump";
  std::vector<int> size_{512};
};

}  // namespace papilla::app
