// SPDX-License-Identifier: MIT
#include <string>

#include "code_version.hpp"
#include "papilla/cache/stage_key.hpp"

namespace papilla {
namespace {

/// FFTW, for one, has code for several kinds of processors, which round differently.
std::string processor_level() {
#if defined(__x86_64__)
  std::string level = "x86-64";
  if (__builtin_cpu_supports("avx")) level += " avx";
  if (__builtin_cpu_supports("avx2")) level += " avx2";
  if (__builtin_cpu_supports("fma")) level += " fma";
  if (__builtin_cpu_supports("avx512f")) level += " avx512f";
  return level;
#else
  return "other";
#endif
}

}  // namespace

const Digest& code_digest() {
  static const Digest digest = [] {
    const std::string text = std::string(k_code_version) + processor_level();
    return sha256(text.data(), text.size());
  }();
  return digest;
}

}  // namespace papilla
