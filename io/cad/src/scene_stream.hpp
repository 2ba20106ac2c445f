// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/io/cad_reader.hpp"

namespace papilla::cad {

/// Writes what read_cad() made to a pipe, as memory has it: for a reader of the same program only.
/// @throws IoError when the other end is closed.
void send_scene(int pipe, const Scene& scene, const CadReport& report);

/// The other end.
/// @throws IoError when the pipe ends early or its data is no valid scene.
void receive_scene(int pipe, Scene& scene, CadReport& report);

/// Raw bytes; both @throw IoError when the other end is gone.
void send_bytes(int pipe, const void* data, std::size_t size);
void receive_bytes(int pipe, void* data, std::size_t size);

}  // namespace papilla::cad
