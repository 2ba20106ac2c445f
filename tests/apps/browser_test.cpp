// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/browser.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>

#include "papilla/core/read_file.hpp"
#include "papilla/core/temporary_folder.hpp"

namespace papilla::app {
namespace {

TEST(PageDoor, LeadsThisUserToTheAddress) {
  const TemporaryFolder runtime("papilla-door");
  ::setenv("XDG_RUNTIME_DIR", runtime.path().c_str(), 1);
  std::filesystem::path file;
  {
    const PageDoor door("http://127.0.0.1:1/?token=abc&x=\"y");
    file = door.file();
    EXPECT_NE(read_file(file).find("content=\"0; url=http://127.0.0.1:1/?token=abc&amp;x=&quot;y\">"),
              std::string::npos);
    struct stat about {};
    ASSERT_EQ(::stat(file.parent_path().c_str(), &about), 0);
    EXPECT_EQ(about.st_mode & 07777, 0700U);
  }
  EXPECT_FALSE(std::filesystem::exists(file));
  ::unsetenv("XDG_RUNTIME_DIR");
}

}  // namespace
}  // namespace papilla::app
