// SPDX-License-Identifier: MIT
#include "papilla/cache/content_store.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/core/temporary_folder.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

Digest key(std::uint8_t number) {
  Digest digest{};
  digest[0] = number, digest[31] = 7;
  return digest;
}

std::string content(std::size_t bytes, unsigned seed) {
  std::string text(bytes, '\0');
  for (char& c : text) c = static_cast<char>((seed = seed * 1664525u + 1013904223u) >> 24);
  return text;
}

void put(const ContentStore& store, std::uint8_t number, const std::string& text) {
  store.write("stage", key(number), [&](EntrySink& sink) { sink.write(text.data(), text.size()); });
}

std::optional<std::string> get(const ContentStore& store, std::uint8_t number) {
  std::string text;
  const bool found = store.read("stage", key(number), [&](EntrySource& source) {
    text.resize(source.most_bytes());
    source.read(text.data(), text.size());
  });
  return found ? std::optional(text) : std::nullopt;
}

void change_byte(const fs::path& path, std::streamoff at) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekg(at);
  const char old = static_cast<char>(file.get());
  file.seekp(at);
  file.put(static_cast<char>(old ^ 1));
}

void set_age(const fs::path& path, std::time_t seconds) {
  const std::timespec times[2] = {{std::time(nullptr) - seconds, 0}, {std::time(nullptr) - seconds, 0}};
  ASSERT_EQ(::utimensat(AT_FDCWD, path.c_str(), times, 0), 0);
}

TEST(ContentStore, KeepsWhatWasWritten) {
  const TemporaryFolder folder("store");
  const ContentStore store(folder.path() / "made" / "on demand");
  EXPECT_EQ(get(store, 1), std::nullopt);
  // Around the size of a buffer, and beyond it.
  for (const std::size_t bytes : {0u, 1u, 65535u, 65536u, 65537u, 1000000u}) {
    put(store, 1, content(bytes, 5));
    EXPECT_TRUE(store.contains("stage", key(1)));
    EXPECT_EQ(get(store, 1), content(bytes, 5)) << bytes;
  }
  EXPECT_FALSE(store.contains("other", key(1)));
  EXPECT_FALSE(store.contains("stage", key(2)));
}

TEST(ContentStore, ReadsInPiecesOfAnySize) {
  const TemporaryFolder folder("store");
  const ContentStore store(folder.path());
  const std::string text = content(400000, 9);
  put(store, 1, text);
  std::string read;
  ASSERT_TRUE(store.read("stage", key(1), [&](EntrySource& source) {
    for (std::size_t piece = 1; source.most_bytes() > 0; piece = piece * 3 + 1) {
      std::string part(std::min<std::size_t>(piece, source.most_bytes()), '\0');
      source.read(part.data(), part.size());
      read += part;
    }
    EXPECT_THROW(source.read(read.data(), 1), IoError);
  }) || read == text);
  EXPECT_EQ(read, text);
}

TEST(ContentStore, AnyDamagedByteIsFoundAndTheEntryRemoved) {
  const TemporaryFolder folder("store");
  const ContentStore store(folder.path());
  const std::string text = content(70000, 3);
  const fs::path path = store.path_of("stage", key(1));
  const auto size = static_cast<std::streamoff>(text.size() + 48);
  for (const std::streamoff at :
       {std::streamoff{0}, std::streamoff{15}, std::streamoff{16}, size / 2, size - 33, size - 32, size - 1}) {
    put(store, 1, text);
    change_byte(path, at);
    EXPECT_EQ(get(store, 1), std::nullopt) << at;
    EXPECT_FALSE(fs::exists(path)) << at;
  }
  for (const std::streamoff left : {size - 1, size - 40, std::streamoff{17}, std::streamoff{0}}) {
    put(store, 1, text);
    fs::resize_file(path, static_cast<std::uintmax_t>(left));
    EXPECT_EQ(get(store, 1), std::nullopt) << left;
    EXPECT_FALSE(fs::exists(path)) << left;
  }
}

TEST(ContentStore, VerifyNamesTheDamagedOnes) {
  const TemporaryFolder folder("store");
  const ContentStore store(folder.path());
  for (std::uint8_t i = 0; i < 5; ++i) put(store, i, content(1000u * i, i));
  change_byte(store.path_of("stage", key(3)), 100);
  const StoreVerification verified = store.verify();
  EXPECT_EQ(verified.whole, 4u);
  EXPECT_EQ(verified.damaged, std::vector<fs::path>{store.path_of("stage", key(3))});
  EXPECT_EQ(store.verify().whole, 4u);
  EXPECT_TRUE(store.verify().damaged.empty());
}

TEST(ContentStore, CountsAndClearsEntriesOnly) {
  const TemporaryFolder folder("store");
  const ContentStore store(folder.path());
  put(store, 1, content(100, 1));
  put(store, 2, content(200, 1));
  std::ofstream(folder.path() / "stage" / "notes.txt") << "not ours";
  std::ofstream(folder.path() / "stage" / "01" / "notes.txt") << "not ours";
  const StoreStatistics statistics = store.statistics();
  EXPECT_EQ(statistics.total.entries, 2u);
  EXPECT_EQ(statistics.total.bytes, 300u + 2 * 48);
  EXPECT_EQ(statistics.stages.at("stage").entries, 2u);
  EXPECT_EQ(store.clear().entries, 2u);
  EXPECT_EQ(store.statistics().total.entries, 0u);
  EXPECT_TRUE(fs::exists(folder.path() / "stage" / "notes.txt"));
  EXPECT_TRUE(fs::exists(folder.path() / "stage" / "01" / "notes.txt"));
}

TEST(ContentStore, EvictsWhatWasNotUsedForLongest) {
  const TemporaryFolder folder("store");
  const ContentStore store(folder.path());
  for (std::uint8_t i = 0; i < 4; ++i) put(store, i, content(1000 - 48, i));
  for (std::uint8_t i = 0; i < 4; ++i) set_age(store.path_of("stage", key(i)), 100000 + 1000 * i);
  ASSERT_TRUE(get(store, 3));  // The oldest, which is used now.
  const StoreCount removed = store.evict(2500);
  EXPECT_EQ(removed.entries, 2u);
  EXPECT_EQ(removed.bytes, 2000u);
  EXPECT_TRUE(get(store, 3));
  EXPECT_TRUE(get(store, 0));
  EXPECT_FALSE(get(store, 1));
  EXPECT_FALSE(get(store, 2));
  EXPECT_EQ(store.evict(2500).entries, 0u);
}

TEST(ContentStore, AtItsLimitKeepsAll) {
  const TemporaryFolder folder("store");
  const ContentStore store(folder.path());
  for (std::uint8_t i = 0; i < 2; ++i) put(store, i, content(1000 - 48, i));
  EXPECT_EQ(store.evict(2000).entries, 0u);
  EXPECT_EQ(store.evict(1999).entries, 1u);
}

TEST(ContentStore, TellsItsFirstAndItsLastUse) {
  const TemporaryFolder folder("store");
  const ContentStore store(folder.path());
  const auto now = std::chrono::system_clock::now();
  constexpr int ages_h[] = {50, 70, 30, 60};
  for (std::uint8_t i = 0; i < 4; ++i) {
    put(store, i, content(10, i));
    set_age(store.path_of("stage", key(i)), 3600 * ages_h[i]);
  }
  const StoreStatistics statistics = store.statistics();
  EXPECT_NEAR(std::chrono::duration<double>(now - statistics.least_recent).count() / 3600, 70, 0.1);
  EXPECT_NEAR(std::chrono::duration<double>(now - statistics.most_recent).count() / 3600, 30, 0.1);
}

TEST(ContentStore, MayBeUsedByManyAtOnce) {
  const TemporaryFolder folder("store");
  std::atomic<int> wrong = 0;
  std::vector<std::thread> users;
  for (unsigned user = 0; user < 8; ++user)
    users.emplace_back([&, user] {
      const ContentStore store(folder.path());
      for (unsigned round = 0; round < 100; ++round) {
        const auto number = static_cast<std::uint8_t>((round + user) % 7);
        const std::string text = content(20000u + number, number);
        if (const auto found = get(store, number); found && *found != text) ++wrong;
        put(store, number, text);
        if (round % 25 == user) store.clear();
      }
    });
  for (std::thread& user : users) user.join();
  EXPECT_EQ(wrong, 0);
  const ContentStore store(folder.path());
  EXPECT_TRUE(store.verify().damaged.empty());
}

TEST(ContentStore, AdoptsTheEntriesOfAnother) {
  const TemporaryFolder folder("store");
  const ContentStore from(folder.path() / "from"), to(folder.path() / "to");
  const std::string text = content(100000, 2);
  EXPECT_EQ(to.adopt(from, "stage", key(1)), std::nullopt);
  put(from, 1, text);
  EXPECT_EQ(to.adopt(from, "stage", key(1)), text.size());
  struct stat about {};
  ASSERT_EQ(::stat(to.path_of("stage", key(1)).c_str(), &about), 0);
  EXPECT_EQ(about.st_nlink, 2u);  // One file, which counts once on the disk.
  from.clear();
  EXPECT_EQ(get(to, 1), text);

  // What is in the place of the entry is replaced, by a copy.
  put(from, 1, text);
  change_byte(to.path_of("stage", key(1)), 500);
  EXPECT_EQ(to.adopt(from, "stage", key(1)), text.size());
  EXPECT_EQ(get(to, 1), text);
  EXPECT_EQ(fs::hard_link_count(to.path_of("stage", key(1))), 1u);

  change_byte(from.path_of("stage", key(1)), 500);
  EXPECT_EQ(ContentStore(folder.path() / "third").adopt(from, "stage", key(1)), std::nullopt);
  EXPECT_FALSE(from.contains("stage", key(1)));
  std::ofstream(folder.path() / "file") << "x";
  EXPECT_THROW(ContentStore(folder.path() / "file").adopt(to, "stage", key(1)), IoError);
}

TEST(ContentStore, AFolderThatCannotBeMadeIsAnError) {
  const TemporaryFolder folder("store");
  std::ofstream(folder.path() / "file") << "x";
  const ContentStore store(folder.path() / "file");
  EXPECT_FALSE(get(store, 1));
  EXPECT_THROW(put(store, 1, "x"), IoError);
}

}  // namespace
}  // namespace papilla
