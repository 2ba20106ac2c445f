// SPDX-License-Identifier: MIT
#include "papilla/core/append_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <string>

#include "papilla/core/error.hpp"
#include "papilla/core/temporary_folder.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

class AppendFileTest : public testing::Test {
 protected:
  std::string content() const {
    std::ifstream in(file_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::string reason() const {
    try {
      const AppendFile file(file_);
    } catch (const IoError& error) {
      return error.what();
    }
    return "no exception";
  }
  TemporaryFolder folder_{"papilla-test"};
  fs::path file_ = folder_.path() / "lines.csv";
};

TEST_F(AppendFileTest, AddsLinesToWhatIsThere) {
  {
    AppendFile file(file_);
    EXPECT_EQ(file.content(), "");
    file.append("one");
    file.append("");
  }
  AppendFile file(file_);
  EXPECT_EQ(file.content(), "one\n\n");
  file.append("two");
  EXPECT_EQ(content(), "one\n\ntwo\n");
  EXPECT_EQ(file.removed_bytes(), 0U);
}

TEST_F(AppendFileTest, RemovesALineThatHasNoEnd) {
  std::ofstream(file_) << "one\ntw";
  {
    const AppendFile file(file_);
    EXPECT_EQ(file.content(), "one\n");
    EXPECT_EQ(file.removed_bytes(), 2U);
  }
  EXPECT_EQ(content(), "one\n");
  std::ofstream(file_) << "no end";
  EXPECT_EQ(AppendFile(file_).removed_bytes(), 6U);
  EXPECT_EQ(content(), "");
}

TEST_F(AppendFileTest, IsOfOneProcessAtATime) {
  const AppendFile file(file_);
  EXPECT_NE(reason().find("another process appends to it"), std::string::npos) << reason();
}

TEST_F(AppendFileTest, RefusesWhatIsNoFile) {
  fs::create_directory(file_);
  EXPECT_NE(reason().find("lines.csv"), std::string::npos);
  file_ = "/dev/null";
  EXPECT_NE(reason().find("no regular file"), std::string::npos) << reason();
  file_ = folder_.path() / "nowhere" / "a.csv";
  EXPECT_NE(reason().find("No such file"), std::string::npos) << reason();
}

TEST_F(AppendFileTest, WhatWasAppendedIsThereAfterSigkill) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    AppendFile file(file_);
    for (int i = 0;; ++i) {
      file.append("answer " + std::to_string(i));
      if (::write(ends[1], &i, sizeof i) != sizeof i) ::_exit(1);
    }
  }
  int last = 0;
  while (last < 20) ASSERT_EQ(::read(ends[0], &last, sizeof last), static_cast<ssize_t>(sizeof last));
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  ::close(ends[1]);
  for (int seen = 0; ::read(ends[0], &seen, sizeof seen) == static_cast<ssize_t>(sizeof seen);) last = seen;
  ::close(ends[0]);
  const AppendFile file(file_);  // Its lock is gone with the process.
  EXPECT_NE(file.content().find("answer " + std::to_string(last) + "\n"), std::string::npos);
}

TEST_F(AppendFileTest, LeavesNothingOfALineThatCanNotBeWritten) {
  AppendFile file(file_);
  file.append("one");
  const rlimit few{8, 8};
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto old = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit = few;
  limit.rlim_max = before.rlim_max;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  EXPECT_THROW(file.append("a line that is longer than eight bytes"), IoError);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, old);
  EXPECT_EQ(content(), "one\n");
  file.append("two");
  EXPECT_EQ(content(), "one\ntwo\n");
}

}  // namespace
}  // namespace papilla
