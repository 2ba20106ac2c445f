// SPDX-License-Identifier: MIT
#include "papilla/core/atomic_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

class AtomicFile : public testing::Test {
 protected:
  AtomicFile() { fs::create_directories(folder_); }
  ~AtomicFile() override { fs::remove_all(folder_); }

  static std::string content(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  const fs::path folder_ = fs::temp_directory_path() / ("papilla-atomic-" + std::to_string(::getpid()));
};

TEST_F(AtomicFile, ReplacesTheOldContent) {
  write_atomically(folder_ / "a.txt", "old");
  write_atomically(folder_ / "a.txt", std::string_view("new\0er", 6));
  EXPECT_EQ(content(folder_ / "a.txt"), std::string("new\0er", 6));
  EXPECT_EQ(files(), 1U);
}

TEST_F(AtomicFile, AFailureKeepsTheOldFileAndLeavesNothing) {
  write_atomically(folder_ / "a.txt", "old");
  const auto fail = [](const fs::path& temporary) {
    std::ofstream(temporary) << "half";
    throw std::runtime_error("disk full");
  };
  EXPECT_THROW(write_atomically(folder_ / "a.txt", fail), std::runtime_error);
  EXPECT_EQ(content(folder_ / "a.txt"), "old");
  EXPECT_EQ(files(), 1U);
}

TEST_F(AtomicFile, TheTemporaryFileIsInTheSameFolderWithTheSameExtension) {
  write_atomically(folder_ / "b.glb", [&](const fs::path& temporary) {
    EXPECT_EQ(temporary.parent_path(), folder_);
    EXPECT_EQ(temporary.extension(), ".glb");
    EXPECT_NE(temporary, folder_ / "b.glb");
    std::ofstream(temporary) << "x";
  });
  EXPECT_TRUE(fs::exists(folder_ / "b.glb"));
}

TEST_F(AtomicFile, RemovesTemporariesOnRequest) {
  const auto interrupted = [](const fs::path& temporary) {
    std::ofstream(temporary) << "half";
    remove_temporaries();
    EXPECT_FALSE(fs::exists(temporary));
    throw std::runtime_error("interrupted");
  };
  EXPECT_THROW(write_atomically(folder_ / "c.txt", interrupted), std::runtime_error);
  EXPECT_EQ(files(), 0U);
}

TEST_F(AtomicFile, NamesTheMissingFolder) {
  try {
    write_atomically(folder_ / "missing" / "a.txt", "x");
    FAIL() << "no exception";
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("missing"), std::string::npos);
  }
  EXPECT_THROW(write_atomically(folder_, "x"), IoError);
}

}  // namespace
}  // namespace papilla
