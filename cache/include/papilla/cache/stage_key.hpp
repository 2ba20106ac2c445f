// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "papilla/cache/digest.hpp"
#include "papilla/core/value_stream.hpp"

namespace papilla {

/// Digest of everything that results depend on beside inputs and options: the sources of the computing folders, the
/// compiler with its options, the libraries' versions, and the instructions of the processor that libraries choose
/// their code by.
const Digest& code_digest();

namespace stage_key {

/// Computes digests of values.
struct Sink {
  static constexpr bool leaves_out_transient = true;
  void write(const void* data, std::size_t size) { sum.write(data, size); }
  Sha256 sum;
};

}  // namespace stage_key

/// The key of a stage's result: a digest of the code, the stage's name, and all that goes into it. Field by field
/// (value_stream.hpp), so that options that get a new field make new keys; what is transient is left out.
template <class... Inputs>
Digest key_of(std::string_view stage, const Inputs&... inputs) {
  stage_key::Sink sink;
  ValueWriter write(sink);
  write(code_digest(), std::string(stage), inputs...);
  return sink.sum.finish();
}

}  // namespace papilla
