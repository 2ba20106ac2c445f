// SPDX-License-Identifier: MIT
#include "picture_codec.hpp"

namespace papilla::io_detail {

const PicturesPlugin& pictures_plugin() {
  static const auto* loaded = static_cast<const PicturesPlugin*>(load_plugin("pictures"));
  return *loaded;
}

}  // namespace papilla::io_detail
