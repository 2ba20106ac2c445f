// SPDX-License-Identifier: MIT
#include "papilla/cache/content_store.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <fstream>
#include <optional>
#include <ostream>
#include <string_view>
#include <system_error>
#include <utility>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view k_head = "papilla cache 1\n";
constexpr std::size_t k_frame = k_head.size() + sizeof(Digest);
constexpr std::size_t k_hex_digits = 2 * sizeof(Digest), k_folder_digits = 2;
constexpr std::time_t k_seconds_between_marks = 3600;
constexpr std::size_t k_buffer = std::size_t{1} << 16;

class File {
 public:
  explicit File(const fs::path& path) : file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW)) {}
  ~File() {
    if (file_ >= 0) ::close(file_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  operator int() const noexcept { return file_; }

 private:
  int file_;
};

/// False at the end of the file.
bool read_fully(int file, void* data, std::size_t size) {
  char* at = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = ::read(file, at, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got, size -= static_cast<std::size_t>(got);
  }
  return true;
}

/// Opens an entry at its content. @return the content's bytes; nothing when it is no entry.
std::optional<std::uint64_t> open_content(int file, struct stat& about) {
  if (::fstat(file, &about) != 0 || !S_ISREG(about.st_mode)) return std::nullopt;
  std::array<char, k_head.size()> head{};
  if (static_cast<std::uint64_t>(about.st_size) < k_frame || !read_fully(file, head.data(), head.size()) ||
      std::string_view(head.data(), head.size()) != k_head)
    return std::nullopt;
  return static_cast<std::uint64_t>(about.st_size) - k_frame;
}

bool is_hex(std::string_view text) { return text.find_first_not_of("0123456789abcdef") == std::string_view::npos; }

struct Entry {
  fs::path path;
  std::string stage;
  std::uintmax_t bytes = 0;
  std::timespec used{};
};

/// What a folder holds; nothing when there is none, or while it is being removed.
std::vector<fs::path> children_of(const fs::path& folder) {
  std::vector<fs::path> result;
  std::error_code error;
  for (fs::directory_iterator at(folder, error); !error && at != fs::directory_iterator(); at.increment(error))
    result.push_back(at->path());
  return result;
}

/// All entries, in no order. Folders and files of other names are not looked into.
std::vector<Entry> entries_of(const fs::path& folder) {
  std::vector<Entry> result;
  for (const fs::path& stage : children_of(folder))
    for (const fs::path& part : children_of(stage)) {
      const std::string first = part.filename().string();
      if (first.size() != k_folder_digits || !is_hex(first)) continue;
      for (const fs::path& file : children_of(part)) {
        const std::string rest = file.filename().string();
        struct stat about {};
        if (rest.size() != k_hex_digits - k_folder_digits || !is_hex(rest)) continue;
        if (::lstat(file.c_str(), &about) != 0 || !S_ISREG(about.st_mode)) continue;
        result.push_back({file, stage.filename().string(), static_cast<std::uintmax_t>(about.st_size), about.st_mtim});
      }
    }
  return result;
}

bool is_earlier(const std::timespec& a, const std::timespec& b) {
  return std::pair(a.tv_sec, a.tv_nsec) < std::pair(b.tv_sec, b.tv_nsec);
}

std::chrono::system_clock::time_point time_point(const std::timespec& time) {
  return std::chrono::system_clock::from_time_t(time.tv_sec);
}

/// Reads all that is left, for the sum.
void skip_content(EntrySource& source) {
  std::vector<char> block(k_buffer);
  while (source.most_bytes() > 0)
    source.read(block.data(), static_cast<std::size_t>(std::min<std::uint64_t>(block.size(), source.most_bytes())));
}

void remove_entry(const Entry& entry, StoreCount& removed) {
  std::error_code error;
  if (!fs::remove(entry.path, error)) return;  // Another process was faster.
  ++removed.entries;
  removed.bytes += entry.bytes;
}

}  // namespace

EntrySource::EntrySource(int file, std::uint64_t bytes) : file_(file), left_(bytes) {}

void EntrySource::refill() {
  // What is left of the content, and nothing behind it: the sum follows.
  buffer_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(k_buffer, left_)));
  at_ = 0;
  if (!read_fully(file_, buffer_.data(), buffer_.size())) throw IoError("a cache entry ends early");
  sum_.write(buffer_.data(), buffer_.size());
}

void EntrySource::read(void* data, std::size_t size) {
  if (size > left_) throw IoError("a cache entry ends early");
  char* to = static_cast<char*>(data);
  while (size > 0) {
    const std::size_t buffered = std::min(size, buffer_.size() - at_);
    if (buffered > 0) {
      std::memcpy(to, buffer_.data() + at_, buffered);
      at_ += buffered;
    }
    const bool is_direct = buffered == 0 && size >= k_buffer;
    if (is_direct) {
      if (!read_fully(file_, to, size)) throw IoError("a cache entry ends early");
      sum_.write(to, size);
    }
    const std::size_t got = is_direct ? size : buffered;
    to += got, size -= got, left_ -= got;
    if (size > 0 && size < k_buffer) refill();
  }
}

bool EntrySource::is_whole(const Digest& expected) { return left_ == 0 && sum_.finish() == expected; }

void EntrySink::write(const void* data, std::size_t size) {
  sum_.write(data, size);
  out_.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
  bytes_ += size;
}

fs::path ContentStore::path_of(std::string_view stage, const Digest& key) const {
  const std::string hex = to_hex(key);
  return folder_ / stage / hex.substr(0, k_folder_digits) / hex.substr(k_folder_digits);
}

bool ContentStore::contains(std::string_view stage, const Digest& key) const {
  return ::access(path_of(stage, key).c_str(), R_OK) == 0;
}

bool read_entry(const fs::path& path, const std::function<void(EntrySource&)>& take) try {
  const File file(path);
  struct stat about {};
  const auto bytes = file < 0 ? std::nullopt : open_content(file, about);
  if (!bytes) return false;
  EntrySource source(file, *bytes);
  take(source);
  Digest expected{};
  return read_fully(file, expected.data(), expected.size()) && source.is_whole(expected);
} catch (const IoError&) {
  return false;
}

std::uint64_t write_entry(const fs::path& path, const std::function<void(EntrySink&)>& give, Durability durability) {
  std::uint64_t bytes = 0;
  write_atomically(
      path,
      [&](std::ostream& out) {
        out.write(k_head.data(), static_cast<std::streamsize>(k_head.size()));
        EntrySink sink(out);
        give(sink);
        bytes = sink.bytes() + k_frame;
        const Digest sum = sink.finish();
        out.write(reinterpret_cast<const char*>(sum.data()), static_cast<std::streamsize>(sum.size()));
      },
      0, durability);
  return bytes;
}

bool is_entry_whole(const fs::path& path) { return read_entry(path, skip_content); }

bool ContentStore::read(std::string_view stage, const Digest& key,
                        const std::function<void(EntrySource&)>& take) const {
  const fs::path path = path_of(stage, key);
  struct stat about {};
  if (::stat(path.c_str(), &about) != 0) return false;
  if (!read_entry(path, take)) {
    ::unlink(path.c_str());
    return false;
  }
  if (about.st_mtim.tv_sec + k_seconds_between_marks < std::time(nullptr))
    ::utimensat(AT_FDCWD, path.c_str(), nullptr, 0);
  return true;
}

std::uint64_t ContentStore::write(std::string_view stage, const Digest& key,
                                  const std::function<void(EntrySink&)>& give) const {
  const fs::path path = path_of(stage, key);
  make_folder(path.parent_path());
  return write_entry(path, give, Durability::unsynced);
}

std::optional<std::uint64_t> ContentStore::adopt(const ContentStore& from, std::string_view stage,
                                                 const Digest& key) const {
  std::uint64_t bytes = 0;
  const bool whole = from.read(stage, key, [&](EntrySource& source) {
    bytes = source.most_bytes();
    skip_content(source);
  });
  if (!whole) return std::nullopt;
  const fs::path theirs = from.path_of(stage, key), ours = path_of(stage, key);
  make_folder(ours.parent_path());
  // Of another disk, of a user whose files may not be linked to, or there already.
  if (::link(theirs.c_str(), ours.c_str()) == 0) return bytes;
  write_atomically(
      ours, [&](std::ostream& out) { out << std::ifstream(theirs, std::ios::binary).rdbuf(); }, 0,
      Durability::unsynced);
  return bytes;
}

StoreStatistics ContentStore::statistics() const {
  StoreStatistics result;
  std::timespec first{}, last{};
  for (const Entry& entry : entries_of(folder_)) {
    for (StoreCount* count : {&result.stages[entry.stage], &result.total}) {
      ++count->entries;
      count->bytes += entry.bytes;
    }
    if (result.total.entries == 1 || is_earlier(entry.used, first)) first = entry.used;
    if (result.total.entries == 1 || is_earlier(last, entry.used)) last = entry.used;
  }
  result.least_recent = time_point(first), result.most_recent = time_point(last);
  return result;
}

StoreVerification ContentStore::verify(const ProgressCallback& progress) const {
  StoreVerification result;
  const std::vector<Entry> entries = entries_of(folder_);
  for (const Entry& entry : entries) {
    report_progress(progress, "verify",
                    static_cast<double>(result.whole + result.damaged.size()) / static_cast<double>(entries.size()));
    if (is_entry_whole(entry.path)) {
      ++result.whole;
    } else {
      result.damaged.push_back(entry.path);
      ::unlink(entry.path.c_str());
    }
  }
  return result;
}

StoreCount ContentStore::clear() const {
  StoreCount removed;
  for (const Entry& entry : entries_of(folder_)) remove_entry(entry, removed);
  return removed;
}

StoreCount ContentStore::evict(std::uintmax_t most_bytes) const {
  std::vector<Entry> entries = entries_of(folder_);
  std::uintmax_t bytes = 0;
  for (const Entry& entry : entries) bytes += entry.bytes;
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return is_earlier(a.used, b.used) || (!is_earlier(b.used, a.used) && a.path < b.path);
  });
  StoreCount removed;
  for (const Entry& entry : entries) {
    if (bytes <= most_bytes) break;
    remove_entry(entry, removed);
    bytes -= entry.bytes;
  }
  return removed;
}

}  // namespace papilla
