// SPDX-License-Identifier: MIT
#include <papilla/core/error.hpp>
#include <papilla/io/plugin.hpp>
#include <string_view>

int main() {
  const auto* header = static_cast<const papilla::PluginHeader*>(papilla::load_plugin("pictures"));
  return std::string_view(header->version) == papilla::version() ? 0 : 1;
}
