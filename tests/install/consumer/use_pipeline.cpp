// SPDX-License-Identifier: MIT
// The example as a stranger builds it.
#include "../../../examples/bake.cpp"
