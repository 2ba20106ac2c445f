// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

namespace papilla {

/// The binary chunk of a GLB under construction, with its bufferViews and accessors.
class GlbBuffer {
 public:
  using Json = nlohmann::ordered_json;

  enum class Target { none = 0, vertices = 34962, indices = 34963 };

  /// Appends bytes, aligned to 4, and returns the number of their bufferView.
  std::size_t add_view(std::span<const std::byte> bytes, Target target);

  /// Appends an accessor over a whole bufferView and returns its number. `accessor` holds its other properties.
  std::size_t add_accessor(std::size_t view, Json accessor);

  const std::string& bytes() const noexcept { return bytes_; }
  const Json& views() const noexcept { return views_; }
  const Json& accessors() const noexcept { return accessors_; }

 private:
  std::string bytes_;
  Json views_ = Json::array(), accessors_ = Json::array();
};

}  // namespace papilla
