// SPDX-License-Identifier: MIT
#pragma once

// The loader picks the version for processors with AVX2. Without fused multiplication: both give the same bits.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define PAPILLA_TEXTURE_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define PAPILLA_TEXTURE_WIDE
#endif
