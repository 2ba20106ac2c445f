// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "blob_document.hpp"

namespace papilla::fuzz {

/// The members of glTF and of haptic tags.
const JsonGrammar& gltf_grammar();

/// Makes of a damaged glTF one that read_gltf() accepts in most cases: numbers of things that exist, views within
/// their buffers, accessors within their views and of the type of their use, vertex indices in range, a forest of
/// nodes, SHA-256 sums of the tags' pictures that are right.
void repair_gltf(BlobDocument& document, Json& gltf);

/// Body of LLVMFuzzerCustomMutator() for glTF, or for a JSON document with glTF as "scene": mutates JSON and bytes,
/// and mostly repairs the result.
std::size_t mutate_gltf(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed);
std::size_t mutate_scene(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed,
                         const JsonGrammar& grammar, void (*repair)(Json&));

}  // namespace papilla::fuzz
