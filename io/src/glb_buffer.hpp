// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <iosfwd>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>
#include <vector>

namespace papilla {

/// The binary chunk of a GLB under construction, with its bufferViews and accessors. The bytes stay where they are
/// until write() puts them out, one view after the other.
class GlbBuffer {
 public:
  using Json = nlohmann::ordered_json;

  enum class Target { none = 0, vertices = 34962, indices = 34963 };

  /// Adds bytes that outlive the buffer, aligned to 4, and returns the number of their bufferView.
  std::size_t add_view(std::span<const std::byte> bytes, Target target);

  /// The same with values that the buffer keeps.
  template <class T>
  std::size_t add_view(std::vector<T>&& values, Target target) {
    auto owned = std::make_shared<const std::vector<T>>(std::move(values));
    const auto bytes = std::as_bytes(std::span(*owned));
    owners_.push_back(std::move(owned));
    return add_view(bytes, target);
  }

  /// Appends an accessor over a whole bufferView and returns its number. `accessor` holds its other properties.
  std::size_t add_accessor(std::size_t view, Json accessor);

  std::size_t size() const noexcept { return size_; }
  const Json& views() const noexcept { return views_; }
  const Json& accessors() const noexcept { return accessors_; }

  /// All bytes, size() in number.
  void write(std::ostream& out) const;

 private:
  std::vector<std::span<const std::byte>> contents_;
  std::vector<std::shared_ptr<const void>> owners_;
  std::size_t size_ = 0;
  Json views_ = Json::array(), accessors_ = Json::array();
};

}  // namespace papilla
