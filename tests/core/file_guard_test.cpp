// SPDX-License-Identifier: MIT
#include "papilla/core/file_guard.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <ostream>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/core/temporary_folder.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

/// The guard belongs to the process: every case has paths of its own.
class FileGuard : public testing::Test {
 protected:
  FileGuard() { start_file_guard(); }
  fs::path make(const char* name) const {
    std::ofstream(folder_ / name) << name;
    return folder_ / name;
  }
  static std::string refusal(const std::function<void()>& act) {
    try {
      act();
    } catch (const OverwriteRefused& error) {
      return error.what();
    }
    return "";
  }
  const TemporaryFolder folder_{"papilla-guard"};
};

TEST_F(FileGuard, WhatCanBeMadeAgainMayBeWrittenTwice) {
  const auto write = [&](Durability durability) {
    return refusal([&] {
      write_atomically(
          folder_ / "entry", [](std::ostream& out) { out << "x"; }, 0, durability);
    });
  };
  for (int i = 0; i < 2; ++i) EXPECT_EQ(write(Durability::unsynced), "");
  EXPECT_EQ(write(Durability::synced), "");
  EXPECT_NE(write(Durability::synced), "");
}

TEST_F(FileGuard, AnOutputIsNoInput) {
  const fs::path in = make("in");
  declare_input(in, "SCENE");
  EXPECT_EQ(refusal([&] { declare_output(in, "--output"); }),
            "--output " + in.string() + ": would be written over SCENE " + in.string() + ", which is read");
  declare_output(folder_ / "new", "--json");
  EXPECT_NE(refusal([&] { declare_input(folder_ / "new", "SCENE"); }), "") << "before it is there";
}

TEST_F(FileGuard, FilesAreComparedByWhatTheyAreNotByName) {
  const fs::path in = make("in");
  fs::create_hard_link(in, folder_ / "hard");
  fs::create_symlink("in", folder_ / "soft");
  fs::create_directory(folder_ / "below");
  fs::create_directory_symlink("below", folder_ / "way");
  declare_input(in, "");
  for (const fs::path& same : {folder_ / "hard", folder_ / "soft", folder_ / "below" / ".." / "in"})
    EXPECT_NE(refusal([&] { declare_output(same, "--json"); }), "") << same;
  declare_output(folder_ / "below" / "new", "--json");
  EXPECT_NE(refusal([&] { declare_output(folder_ / "way" / "new", "--csv"); }), "") << "not there yet";
  EXPECT_EQ(refusal([&] { declare_output(folder_ / "other", "--trace"); }), "");
}

TEST_F(FileGuard, WhatIsFoundToBeReadIsNotWritten) {
  const fs::path picture = make("picture.png"), output = make("output.png");
  read_file(picture);
  EXPECT_NE(refusal([&] { write_atomically(picture, "x"); }), "");
  EXPECT_EQ(read_file(picture), "picture.png");
  declare_output(output, "--picture");
  EXPECT_NE(refusal([&] { require_file(output); }), "");
}

TEST_F(FileGuard, NoFileIsWrittenTwiceAndOnesOwnMayBeRead) {
  const fs::path file = folder_ / "a.glb";
  declare_output(file, "--output");
  write_atomically(file, "first");
  EXPECT_EQ(read_file(file), "first");
  EXPECT_NE(refusal([&] { write_atomically(file, "second"); }), "");
  EXPECT_EQ(read_file(file), "first");
  forget_written_outputs();
  write_atomically(file, "again");
  EXPECT_EQ(read_file(file), "again");
}

TEST_F(FileGuard, DevicesAreNoFiles) {
  declare_output("/dev/null", "--json");
  EXPECT_EQ(refusal([] { declare_output("/dev/null", "--csv"); }), "");
}

}  // namespace
}  // namespace papilla
