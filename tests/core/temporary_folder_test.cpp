// SPDX-License-Identifier: MIT
#include "papilla/core/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace papilla {
namespace {

namespace fs = std::filesystem;

TEST(TemporaryFolder, IsNewPrivateAndGoesWithItsContent) {
  fs::path first;
  {
    const TemporaryFolder one("papilla-test"), other("papilla-test");
    first = one.path();
    EXPECT_NE(one.path(), other.path());
    EXPECT_TRUE(fs::is_empty(one.path()));
    EXPECT_EQ(fs::status(one.path()).permissions(), fs::perms::owner_all);
    fs::create_directories(one / "a" / "b");
    std::ofstream(one / "a" / "b" / "file") << "content";
    EXPECT_TRUE(fs::exists(first / "a/b/file"));
  }
  EXPECT_FALSE(fs::exists(first));
}

}  // namespace
}  // namespace papilla
