// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/pipeline/library_material.hpp"
#include "record.hpp"

namespace papilla::python {

template <class T>
struct RecordTraits<Sourced<T>> : IsRecord<false> {};

}  // namespace papilla::python
