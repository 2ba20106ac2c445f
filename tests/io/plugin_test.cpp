// SPDX-License-Identifier: MIT
#include "papilla/io/plugin.hpp"

#include <gtest/gtest.h>

#include <string>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

TEST(Plugin, StaysLoadedAndIsOfThisVersion) {
  const void* table = load_plugin("pictures");
  EXPECT_EQ(table, load_plugin("pictures"));
  EXPECT_STREQ(static_cast<const PluginHeader*>(table)->version, version());
}

TEST(Plugin, NamesTheFileThatIsNotThere) {
  try {
    load_plugin("nowhere");
    FAIL() << "was loaded";
  } catch (const IoError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("papilla_nowhere.so: cannot be loaded: ", 0), 0U) << error.what();
  }
}

}  // namespace
}  // namespace papilla
