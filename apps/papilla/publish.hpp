// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "json/json.hpp"

namespace papilla::app {

/// Gives the machine-readable result of the verb that runs now, for one that goes on: what its body returns is not
/// written any more. In verb.cpp.
void publish_result(const Json& result);

}  // namespace papilla::app
