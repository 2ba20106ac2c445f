// SPDX-License-Identifier: MIT
#pragma once

namespace papilla {

/// The coordinate axis that points up: z in CAD files, y in glTF.
enum class UpAxis { y, z };

}  // namespace papilla
