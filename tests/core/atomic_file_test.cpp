// SPDX-License-Identifier: MIT
#include "papilla/core/atomic_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <ostream>
#include <stdexcept>
#include <thread>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/core/temporary_folder.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

class AtomicFile : public testing::Test {
 protected:
  static std::string content(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::vector<fs::path> files() const {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::directory_iterator(folder_.path())) paths.push_back(entry.path());
    return paths;
  }
  /// The temporary file while one is written.
  fs::path temporary() const {
    for (const fs::path& file : files())
      if (file.filename().native().starts_with(".papilla-")) return file;
    return {};
  }
  static mode_t mode(const fs::path& path) { return status(path).st_mode & 07777; }
  static struct stat status(const fs::path& path) {
    struct stat found {};
    EXPECT_EQ(::stat(path.c_str(), &found), 0) << path;
    return found;
  }
  static std::string reason(const fs::path& path, const std::string& text) {
    try {
      write_atomically(path, text);
    } catch (const IoError& error) {
      return error.what();
    }
    return "no exception";
  }
  /// Runs `act` in a process that ends itself with SIGKILL.
  template <class Act>
  static void killed(Act act) {
    const pid_t child = ::fork();
    if (child == 0) {
      act();
      ::kill(::getpid(), SIGKILL);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
  }

  const TemporaryFolder folder_{"papilla-atomic"};
};

TEST_F(AtomicFile, ReplacesTheOldContent) {
  write_atomically(folder_ / "a.txt", "old");
  write_atomically(folder_ / "a.txt", std::string_view("new\0er", 6));
  EXPECT_EQ(content(folder_ / "a.txt"), std::string("new\0er", 6));
  EXPECT_EQ(files().size(), 1U);
}

TEST_F(AtomicFile, WritesMoreThanABlockInAnyPieces) {
  std::string expected;
  write_atomically(folder_ / "a.bin", [&](std::ostream& out) {
    for (int i = 0; i < 100; ++i) {
      const std::string piece(static_cast<std::size_t>(i * 97), static_cast<char>('a' + i % 26));
      out << piece;
      out.put('|');
      expected += piece + '|';
    }
    const std::string large(300000, 'x');
    out.write(large.data(), static_cast<std::streamsize>(large.size()));
    out << std::flush << 42;
    expected += large + "42";
  });
  EXPECT_EQ(content(folder_ / "a.bin"), expected);
}

TEST_F(AtomicFile, WhatCanNotBeWrittenIsKnownBefore) {
  write_atomically(folder_ / "a.txt", "old");
  EXPECT_NO_THROW(require_writable(folder_ / "a.txt"));
  EXPECT_NO_THROW(require_writable(folder_ / "new.txt"));
  EXPECT_NO_THROW(require_writable("/dev/null"));
  EXPECT_EQ(content(folder_ / "a.txt"), "old");
  EXPECT_EQ(files().size(), 1U) << "it leaves nothing";
  EXPECT_THROW(require_writable(folder_ / "missing" / "a.txt"), IoError);
  EXPECT_THROW(require_writable(folder_.path()), IoError);
  EXPECT_THROW(require_writable("/proc/a.txt"), IoError) << "no file can be made there, not even by root";
}

TEST_F(AtomicFile, AFailureKeepsTheOldFileAndLeavesNothing) {
  write_atomically(folder_ / "a.txt", "old");
  const auto fail = [](std::ostream& out) {
    out << "half";
    throw std::runtime_error("stopped");
  };
  EXPECT_THROW(write_atomically(folder_ / "a.txt", fail), std::runtime_error);
  EXPECT_EQ(content(folder_ / "a.txt"), "old");
  EXPECT_EQ(files().size(), 1U);
}

TEST_F(AtomicFile, TemporaryNamesAreUnpredictableAndNothingIsFollowedThere) {
  std::vector<std::string> names;
  for (int i = 0; i < 2; ++i)
    write_atomically(folder_ / "b.glb", [&](std::ostream&) {
      const fs::path file = temporary();
      names.push_back(file.filename());
      EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(file)));
      if (i == 1) EXPECT_EQ(mode(file), 0600U) << "while it replaces a file, nobody else reads it";
    });
  ASSERT_EQ(names.size(), 2U);
  EXPECT_EQ(names[0].size(), 9U + 32 + 4);
  EXPECT_NE(names[0], names[1]);
}

TEST_F(AtomicFile, RemovesTemporariesOnRequest) {
  const auto interrupted = [&](std::ostream&) {
    const bool was_there = !temporary().empty();
    remove_temporaries();
    ::_exit(was_there && temporary().empty() ? 0 : 1);  // After it the process must end.
  };
  const pid_t child = ::fork();
  if (child == 0) write_atomically(folder_ / "c.txt", interrupted);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_TRUE(files().empty());
}

// Two threads make and remove temporary files all the time; the signal meets them at any place.
TEST_F(AtomicFile, LeavesNoTemporaryWhereverASignalMeetsIt) {
  for (int k = 0; k < 200; ++k) {
    int ready[2];
    ASSERT_EQ(::pipe(ready), 0);
    const pid_t child = ::fork();
    if (child == 0) {
      std::signal(SIGTERM, [](int signal) {
        remove_temporaries();
        std::signal(signal, SIG_DFL);
        std::raise(signal);
      });
      const std::jthread second([&] {
        while (true)
          write_atomically(
              folder_ / "a.txt", [](std::ostream& out) { out << "x"; }, 1, Durability::unsynced);
      });
      while (true) {
        require_writable(folder_ / "b.txt");
        if (::write(ready[1], "x", 1) != 1) ::_exit(1);
      }
    }
    ::close(ready[1]);
    char seen;
    for (int turn = 0; turn <= k % 3; ++turn) ASSERT_EQ(::read(ready[0], &seen, 1), 1);
    ::kill(child, SIGTERM);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ::close(ready[0]);
    ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM);
    ASSERT_TRUE(temporary().empty()) << "in turn " << k;
  }
}

TEST_F(AtomicFile, NamesTheMissingFolder) {
  EXPECT_NE(reason(folder_ / "missing" / "a.txt", "x").find("missing"), std::string::npos);
  EXPECT_THROW(write_atomically(folder_.path(), "x"), IoError);
}

TEST_F(AtomicFile, KeepsModeAndOwnerOfWhatItReplaces) {
  const fs::path file = folder_ / "a.txt";
  for (const mode_t kept : {0600U, 0640U, 0444U, 0755U}) {
    std::ofstream(file) << "old";
    ASSERT_EQ(::chmod(file.c_str(), kept), 0);
    write_atomically(file, "new");
    EXPECT_EQ(mode(file), kept);
    EXPECT_EQ(content(file), "new");
    fs::remove(file);
  }
  if (::geteuid() != 0) GTEST_SKIP() << "only root gives files away";
  std::ofstream(file) << "old";
  ASSERT_EQ(::chown(file.c_str(), 12345, 54321), 0);
  write_atomically(file, "new");
  EXPECT_EQ(status(file).st_uid, 12345U);
  EXPECT_EQ(status(file).st_gid, 54321U);
}

TEST_F(AtomicFile, ANewFileGetsWhatUmaskLeaves) {
  const mode_t before = ::umask(027);
  write_atomically(folder_ / "a.txt", "x");
  ::umask(before);
  EXPECT_EQ(mode(folder_ / "a.txt"), 0640U);
}

TEST_F(AtomicFile, ALinkStaysAndItsTargetIsReplaced) {
  fs::create_directory(folder_ / "there");
  std::ofstream(folder_ / "there" / "real.txt") << "old";
  fs::create_symlink("there/real.txt", folder_ / "link.txt");
  fs::create_symlink(folder_ / "link.txt", folder_ / "second.txt");
  write_atomically(folder_ / "second.txt", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.txt"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "second.txt"));
  EXPECT_EQ(content(folder_ / "there" / "real.txt"), "new");
  fs::create_symlink("there/none.txt", folder_ / "dangling.txt");
  write_atomically(folder_ / "dangling.txt", "made");
  EXPECT_EQ(content(folder_ / "there" / "none.txt"), "made");
  fs::create_symlink("round.txt", folder_ / "round.txt");
  EXPECT_THROW(write_atomically(folder_ / "round.txt", "x"), IoError);
}

TEST_F(AtomicFile, AnotherUsersLinkIsNotFollowedWhereEveryoneMayWrite) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root gives files away";
  const fs::path common = folder_ / "common", link = common / "out.txt", victim = folder_ / "victim.txt";
  fs::create_directory(common);
  ASSERT_EQ(::chmod(common.c_str(), 01777), 0);
  std::ofstream(victim) << "mine";
  fs::create_symlink(victim, link);
  ASSERT_EQ(::lchown(link.c_str(), 12345, 12345), 0);
  EXPECT_NE(reason(link, "theirs").find("another user's symbolic link"), std::string::npos);
  EXPECT_EQ(content(victim), "mine");
}

TEST_F(AtomicFile, WhatAKilledProcessLeftIsRemovedByTheNext) {
  const fs::path file = folder_ / "a.txt";
  killed([&] {
    write_atomically(file, [](std::ostream& out) {
      out << std::string(100000, 'x') << std::flush;
      ::kill(::getpid(), SIGKILL);
    });
  });
  const fs::path left = temporary();
  ASSERT_FALSE(left.empty());
  // Names that only look alike, and those that are no files, are nobody's to remove.
  const std::string name = left.filename();
  const std::vector<fs::path> others = {folder_ / ".papilla-notes.tmp", folder_ / (name + "~"),
                                        folder_ / (name.substr(0, 9) + std::string(32, 'g') + ".tmp")};
  for (const fs::path& other : others) std::ofstream(other) << "mine";
  const fs::path link = folder_ / (name.substr(0, 9) + std::string(32, '0') + ".tmp");
  fs::create_symlink("victim", link);
  std::ofstream(folder_ / "victim") << "mine";
  fs::path foreign;
  if (::geteuid() == 0) {
    foreign = folder_ / (name.substr(0, 9) + std::string(32, '1') + ".tmp");
    std::ofstream(foreign) << "theirs";
    ASSERT_EQ(::chown(foreign.c_str(), 12345, 12345), 0);
  }
  write_atomically(file, "new");
  EXPECT_FALSE(fs::exists(left));
  for (const fs::path& other : others) EXPECT_TRUE(fs::exists(other)) << other;
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(content(folder_ / "victim"), "mine");
  if (!foreign.empty()) EXPECT_TRUE(fs::exists(foreign));
}

TEST_F(AtomicFile, WhatALivingProcessWritesIsLeftAlone) {
  int ready[2], go[2];
  ASSERT_EQ(::pipe(ready), 0);
  ASSERT_EQ(::pipe(go), 0);
  char byte = 'x';
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(go[1]);  // So that the child ends when the test does.
    write_atomically(folder_ / "slow.txt", [&](std::ostream& out) {
      out << "slow" << std::flush;
      if (::write(ready[1], &byte, 1) != 1 || ::read(go[0], &byte, 1) != 1) ::_exit(1);
    });
    ::_exit(0);
  }
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  const fs::path theirs = temporary();
  write_atomically(folder_ / "fast.txt", "fast");
  EXPECT_TRUE(fs::exists(theirs));
  ASSERT_EQ(::write(go[1], &byte, 1), 1);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(content(folder_ / "slow.txt"), "slow");
  for (const int end : {ready[0], ready[1], go[0], go[1]}) ::close(end);
}

TEST_F(AtomicFile, AFullDiskIsNamedWithTheSystemsReason) {
  EXPECT_EQ(reason("/dev/full", "x"), "/dev/full: No space left on device");
  EXPECT_EQ(reason("/dev/full", std::string(200000, 'x')), "/dev/full: No space left on device");
  const fs::path disk = folder_ / "disk";
  fs::create_directory(disk);
  if (::mount("none", disk.c_str(), "tmpfs", 0, "size=64k") != 0) GTEST_SKIP() << "no right to mount a small disk";
  write_atomically(disk / "a.txt", "old");
  EXPECT_EQ(reason(disk / "a.txt", std::string(200000, 'x')),
            (disk / "a.txt").string() + ": takes 200000 bytes, 61440 are free on its file system");
  const auto unknown_size = [](std::ostream& out) { out << std::string(200000, 'x'); };
  EXPECT_THROW(write_atomically(disk / "a.txt", unknown_size), IoError);
  EXPECT_EQ(content(disk / "a.txt"), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(disk), fs::directory_iterator()), 1);
  EXPECT_EQ(::umount(disk.c_str()), 0);
}

TEST_F(AtomicFile, WhatHasNoSpaceIsNotBegun) {
  const std::uintmax_t bytes = std::uintmax_t{1} << 62;
  bool is_begun = false;
  try {
    write_atomically(
        folder_ / "a.txt", [&](std::ostream&) { is_begun = true; }, bytes);
    FAIL() << "no exception";
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("a.txt: takes 4611686018427387904 bytes, "), std::string::npos);
  }
  EXPECT_FALSE(is_begun);
  EXPECT_TRUE(files().empty());
  EXPECT_NO_THROW(write_atomically(
      "/dev/null", [](std::ostream&) {}, bytes));
}

TEST_F(AtomicFile, WritesToPipesAndDevicesAsTheyAre) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  write_atomically(pipe, "through");
  char text[16] = "";
  EXPECT_EQ(::read(reader, text, sizeof text), 7);
  EXPECT_STREQ(text, "through");
  EXPECT_TRUE(fs::is_fifo(pipe));
  ::close(reader);
  EXPECT_NO_THROW(write_atomically("/dev/null", "x"));
}

TEST_F(AtomicFile, AFolderThatCantBeMadeSaysWhy) {
  EXPECT_TRUE(make_folder(folder_ / "a" / "b"));
  EXPECT_FALSE(make_folder(folder_ / "a" / "b"));
  write_atomically(folder_ / "file", "x");
  try {
    make_folder(folder_ / "file" / "below");
    FAIL() << "no exception";
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("cannot be made a folder: Not a directory"), std::string::npos);
  }
}

}  // namespace
}  // namespace papilla
