// SPDX-License-Identifier: MIT
#include "glb_document.hpp"

#include <ostream>

namespace papilla {
namespace {

std::size_t padding_of(std::size_t size) { return (4 - size % 4) % 4; }

}  // namespace

std::size_t GlbBuffer::add_view(std::span<const std::byte> bytes, Target target) {
  size_ += padding_of(size_);
  Json view = {{"buffer", 0}, {"byteOffset", size_}, {"byteLength", bytes.size()}};
  if (target != Target::none) view["target"] = static_cast<int>(target);
  contents_.push_back(bytes);
  size_ += bytes.size();
  views_.push_back(std::move(view));
  return views_.size() - 1;
}

std::size_t GlbBuffer::add_accessor(std::size_t view, Json accessor) {
  Json entry = {{"bufferView", view}};
  entry.update(accessor);
  accessors_.push_back(std::move(entry));
  return accessors_.size() - 1;
}

void GlbBuffer::write(std::ostream& out) const {
  std::size_t written = 0;
  for (const auto& bytes : contents_) {
    out.write("\0\0\0", static_cast<std::streamsize>(padding_of(written)));
    written += padding_of(written);
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    written += bytes.size();
  }
}

}  // namespace papilla
