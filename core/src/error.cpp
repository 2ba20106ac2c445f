// SPDX-License-Identifier: MIT
#include "papilla/core/error.hpp"

namespace papilla {

const char* version() noexcept { return PAPILLA_VERSION; }

}  // namespace papilla
