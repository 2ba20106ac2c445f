// SPDX-License-Identifier: MIT
#include "glb_buffer.hpp"

#include <utility>

namespace papilla {

std::size_t GlbBuffer::add_view(std::span<const std::byte> bytes, Target target) {
  bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');
  Json view = {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}};
  if (target != Target::none) view["target"] = static_cast<int>(target);
  bytes_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  views_.push_back(std::move(view));
  return views_.size() - 1;
}

std::size_t GlbBuffer::add_accessor(std::size_t view, Json accessor) {
  Json entry = {{"bufferView", view}};
  entry.update(accessor);
  accessors_.push_back(std::move(entry));
  return accessors_.size() - 1;
}

}  // namespace papilla
