// SPDX-License-Identifier: MIT
#pragma once

/// A function is compiled for the processors named and for any, and the loader picks the version for the one that runs:
/// PAPILLA_CPU_CLONES("avx2") int sum(...). Versions without fused multiplication ("avx2") give the same bits
/// everywhere. Not with sanitizers, whose runtime is not set up when the loader picks.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define PAPILLA_CPU_CLONES(...) __attribute__((target_clones(__VA_ARGS__, "default")))
/// Where it is defined: for a function that is called after a look at the processor alone.
#define PAPILLA_CPU_VERSION(cpu) __attribute__((target(cpu)))
#else
#define PAPILLA_CPU_CLONES(...)
#endif
