// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "papilla/pipeline/height_file.hpp"
#include "papilla/pipeline/synthesis.hpp"
#include "papilla/pipeline/texture_files.hpp"
#include "papilla/pipeline/texture_survey.hpp"

namespace papilla::app {

// The longer option lists of verbs on pictures. Each is added in the order of the help and returns what the pipeline
// takes.

/// Of `analyze`.
class SurveyOption {
 public:
  void add_to(CLI::App& verb);
  SurveyOptions options() const;

 private:
  SurveyOptions options_;
  std::vector<std::string> only_ = {"fractal", "symmetry", "class"};
  std::string pictures_, lattice_ = "best", feature_ = "squared", pattern_ = "plane";
  bool force_lattice_ = false;
};

/// Of `height`.
class HeightOption {
 public:
  void add_to(CLI::App& verb);
  /// @throws UsageError for --light and --cut that are neither a word of theirs nor numbers.
  HeightFileOptions options(std::uint64_t seed, const ProgressCallback& progress) const;

 private:
  double cut_mm() const;

  HeightFileOptions options_;
  std::string normal_, pictures_;
  std::string method_ = "auto", light_ = "auto", periodic_ = "auto", roughness_ = "whole", cut_ = "none";
  double rate_hz_ = 1000, speed_mm_per_s_ = 100;
};

/// Of `synthesize`.
class SynthesisOption {
 public:
  void add_to(CLI::App& verb);
  /// @param what grain or fractal. @throws UsageError for a --light of a grain that is not three numbers.
  SynthesisOptions options(const std::string& what, std::uint64_t seed, const ProgressCallback& progress) const;

 private:
  SynthesisOptions options_;
  std::string kind_ = "spheres8", light_, method_ = "exact", like_;
};

/// Of `texture`: pictures of a recipe, or a contact sheet, or a list.
class TextureOption {
 public:
  std::string recipe, output, list, sheet, suggest;
  std::vector<std::string> libraries;
  int tile_px = 128;
  TextureFileOptions files;  ///< Without size and channels: see options().

  void add_to(CLI::App& verb);
  /// @throws InvalidInput for a channel that there is not.
  TextureFileOptions options(std::uint64_t seed, const ProgressCallback& progress) const;

 private:
  std::string channels_ = "color,bump";
  std::vector<int> size_{512};
};

}  // namespace papilla::app
