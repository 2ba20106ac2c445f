// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace papilla {

/// The shortest text of a number for people: without exponent from 1e-6 to 1e12, "0.000001" and "1000000"; beyond that
/// with one. "inf", "-inf" and "nan" for those.
std::string plain_number(double value);

}  // namespace papilla
