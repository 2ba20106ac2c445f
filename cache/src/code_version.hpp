// SPDX-License-Identifier: MIT
#pragma once

namespace papilla {

/// Digest of the sources, the compiler and the libraries: cmake/CodeVersion.cmake writes it.
extern const char* const k_code_version;

}  // namespace papilla
