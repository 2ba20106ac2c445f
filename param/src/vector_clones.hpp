// SPDX-License-Identifier: MIT
#pragma once

// The loader picks the version for processors with fused multiplication when there is such a processor.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define PAPILLA_VECTOR_CLONES __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define PAPILLA_VECTOR_CLONES
#endif
