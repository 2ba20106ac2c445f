// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "json_mutator.hpp"

namespace papilla::fuzz {

/// A JSON document whose data: URIs, and the binary chunk of a GLB, stand outside of it, so that text and bytes can be
/// mutated each in their own way.
struct BlobDocument {
  bool glb = false;
  Json json;  ///< Where a data: URI was stands "blob:NUMBER".
  struct Blob {
    std::string mime_type, bytes;
  };
  std::vector<Blob> blobs;

  /// The blob that a value names, or nullptr.
  Blob* blob_of(const Json& value);
};

/// Nothing when the bytes are neither JSON nor a GLB.
std::optional<BlobDocument> parse_blob_document(std::string_view bytes);
/// A GLB with chunks of the right lengths when it was one, else JSON.
std::string to_bytes(const BlobDocument& document);

/// Changes bytes of a blob: of pictures as mutate_png(), of others numbers of 1, 2 and 4 bytes.
void mutate_blob(BlobDocument& document, Random& random);

}  // namespace papilla::fuzz
