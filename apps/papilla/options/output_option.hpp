// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "papilla/io/scene_file.hpp"

namespace papilla::app {

/// How a verb's glTF output is stored: --compress, --compress-precision and --images. Shared by every verb that writes
/// a scene.
struct OutputOptions {
  MeshCoding meshes = MeshCoding::none;
  PictureCoding pictures = PictureCoding::as_is;
  double most_rounding_mm = 0;

  void add_to(CLI::App& verb);
  /// @throws UsageError naming the option when `output` is no glTF file, or this build lacks the codec.
  WriteOptions write_options(const std::string& output) const;
};

}  // namespace papilla::app
