// SPDX-License-Identifier: MIT
#include "papilla/core/child_process.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace papilla {
namespace {

TEST(ChildProcess, HasNoOpenFilesOfItsParent) {
  const int file = ::open("/dev/null", O_RDONLY);  // Without O_CLOEXEC, as libraries do.
  ASSERT_GE(file, 0);
  const ChildEnd end = ChildProcess({"sh", "-c", "ls /proc/self/fd >&2"}).wait();
  ::close(file);
  EXPECT_EQ(end.exit_code, 0);
  EXPECT_EQ(end.messages, "0\n1\n2\n3");  // The last is what ls lists.
}

}  // namespace
}  // namespace papilla
