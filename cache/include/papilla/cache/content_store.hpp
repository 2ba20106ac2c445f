// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/cache/digest.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/progress.hpp"

namespace papilla {

/// The content of an entry on its way from the file, for ValueReader.
class EntrySource {
 public:
  EntrySource(int file, std::uint64_t bytes);
  /// @throws IoError when the entry ends before.
  void read(void* data, std::size_t size);
  std::uint64_t most_bytes() const noexcept { return left_; }
  /// Whether everything was read and its sum is `expected`.
  bool is_whole(const Digest& expected);

 private:
  void refill();

  int file_;
  std::uint64_t left_;  ///< Not handed out yet.
  std::vector<char> buffer_;
  std::size_t at_ = 0;
  Sha256 sum_;
};

/// The same on its way into the file, for ValueWriter.
class EntrySink {
 public:
  explicit EntrySink(std::ostream& out) : out_(out) {}
  void write(const void* data, std::size_t size);
  Digest finish() { return sum_.finish(); }
  std::uint64_t bytes() const noexcept { return bytes_; }

 private:
  std::ostream& out_;
  Sha256 sum_;
  std::uint64_t bytes_ = 0;
};

/// Lets `take` read an entry; all of it has to be taken. What was taken is worth something only when this returns true.
/// @return false when the file is absent, no entry, or its sum is wrong.
bool read_entry(const std::filesystem::path& path, const std::function<void(EntrySource&)>& take);

/// Lets `give` write an entry, atomically. @return the file's bytes. @throws IoError as write_atomically().
std::uint64_t write_entry(const std::filesystem::path& path, const std::function<void(EntrySink&)>& give,
                          Durability durability);

/// Reads all of an entry for its sum.
bool is_entry_whole(const std::filesystem::path& path);

/// Of the entries of one stage.
struct StoreCount {
  std::size_t entries = 0;
  std::uintmax_t bytes = 0;
};

struct StoreStatistics {
  std::map<std::string, StoreCount> stages;
  StoreCount total;
  std::chrono::system_clock::time_point least_recent, most_recent;  ///< Uses; of nothing when it is empty.
};

struct StoreVerification {
  std::size_t whole = 0;
  std::vector<std::filesystem::path> damaged;  ///< Have been removed.
};

/// Files that are named by the digest of what their content was made from: FOLDER/STAGE/ab/cdef... (64 digits in all).
///
/// An entry is a line of 16 bytes that says what it is, the content, and the content's SHA-256. Entries come into being
/// whole under their name (a temporary file is renamed) and never change, so that any number of processes, on any
/// machines that share the folder, read and write at once without a lock. Two that write the same entry write the same
/// bytes, and the later one stays. An entry whose sum is wrong counts as absent and is removed.
///
/// The time of last modification of an entry is that of its last use, to the hour.
class ContentStore {
 public:
  explicit ContentStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  const std::filesystem::path& folder() const noexcept { return folder_; }
  std::filesystem::path path_of(std::string_view stage, const Digest& key) const;

  bool contains(std::string_view stage, const Digest& key) const;

  /// Lets `take` read an entry; all of it has to be taken. What was taken is worth something only when this returns
  /// true. @return false when it is absent or damaged.
  bool read(std::string_view stage, const Digest& key, const std::function<void(EntrySource&)>& take) const;

  /// Lets `give` write an entry. @return its bytes. @throws IoError when the folder or the disk refuse.
  std::uint64_t write(std::string_view stage, const Digest& key, const std::function<void(EntrySink&)>& give) const;

  /// Takes over an entry of another store: as one more name of the same file where one disk holds both, else as a copy.
  /// @return the bytes of its content; nothing when `from` has no whole one. @throws IoError as write().
  std::optional<std::uint64_t> adopt(const ContentStore& from, std::string_view stage, const Digest& key) const;

  StoreStatistics statistics() const;
  /// Reads every entry and removes those whose sum is wrong. Cost: as reading all bytes.
  StoreVerification verify(const ProgressCallback& progress = {}) const;
  /// Removes every entry. Files that are no entries stay. @return what was removed.
  StoreCount clear() const;
  /// Removes the entries that were not used for longest until the others have at most `most_bytes`.
  /// @return what was removed.
  StoreCount evict(std::uintmax_t most_bytes) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace papilla
