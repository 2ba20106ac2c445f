// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "papilla/io/read_options.hpp"
#include "papilla/io/scene.hpp"

namespace papilla::app {

/// A place of a scene where one of several levels of detail is shown (MSFT_lod), by how large it is on the screen.
struct PageLevels {
  std::vector<std::uint32_t> nodes;  ///< The finest first; each with all below it.
  std::vector<double>
      coverages;  ///< Of the picture's height: level k is shown down to that of k; below the last nothing.
};

/// A glTF scene for pages: haptic tags and pictures on channel 1, and levels of detail stand where they are shown.
/// @throws as read_gltf().
Scene read_for_page(const std::filesystem::path& file, const ReadOptions& options, std::vector<PageLevels>& levels);

/// A level of one of the places.
struct PageLevel {
  std::size_t place = 0, number = 0;  ///< 0: the finest.
};

/// The innermost level that shows each instance, if there is one.
std::vector<std::optional<PageLevel>> levels_of(const Scene& scene, std::span<const Instance> instances,
                                                std::span<const PageLevels> levels);

}  // namespace papilla::app
