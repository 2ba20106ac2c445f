// SPDX-License-Identifier: MIT
#include "papilla/core/atomic_file.hpp"

#include <fcntl.h>
#include <sched.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <mutex>
#include <optional>
#include <ostream>
#include <set>
#include <streambuf>
#include <string>
#include <system_error>
#include <vector>

#include "descriptor.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/file_guard.hpp"
#include "papilla/core/random_token.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, int reason) {
  throw IoError(path.string() + ": " + std::generic_category().message(reason));
}

/// Writes to a descriptor; throws IoError with the system's reason.
class FileBuffer final : public std::streambuf {
 public:
  FileBuffer(int file, const fs::path& path) : file_(file), path_(path), block_(k_block) { clear(); }

  void flush() {
    const std::size_t count = static_cast<std::size_t>(pptr() - pbase());
    clear();
    send(block_.data(), count);
  }

 protected:
  int_type overflow(int_type c) override {
    flush();
    return traits_type::eq_int_type(c, traits_type::eof()) ? traits_type::not_eof(c)
                                                           : sputc(traits_type::to_char_type(c));
  }
  std::streamsize xsputn(const char* text, std::streamsize count) override {
    if (count < epptr() - pptr()) return std::streambuf::xsputn(text, count);
    flush();
    send(text, static_cast<std::size_t>(count));
    return count;
  }
  int sync() override { return flush(), 0; }
  pos_type seekoff(off_type offset, std::ios::seekdir from, std::ios::openmode) override {
    flush();
    const off_t at = ::lseek(file_, offset,
                             from == std::ios::beg   ? SEEK_SET
                             : from == std::ios::cur ? SEEK_CUR
                                                     : SEEK_END);
    if (at < 0) fail(path_, errno);
    return at;
  }
  pos_type seekpos(pos_type position, std::ios::openmode mode) override {
    return seekoff(position, std::ios::beg, mode);
  }

 private:
  static constexpr std::size_t k_block = std::size_t{1} << 16;

  void clear() { setp(block_.data(), block_.data() + block_.size()); }

  void send(const char* bytes, std::size_t count) const {
    while (count > 0) {
      const ssize_t sent = ::write(file_, bytes, count);
      if (sent < 0 && errno == EINTR) continue;
      if (sent < 0) fail(path_, errno);
      bytes += sent;
      count -= static_cast<std::size_t>(sent);
    }
  }

  int file_;
  const fs::path& path_;
  std::vector<char> block_;
};

void fill(int file, const fs::path& path, const std::function<void(std::ostream&)>& write) {
  FileBuffer buffer(file, path);
  std::ostream out(&buffer);
  out.exceptions(std::ios::badbit | std::ios::failbit);  // So that what the buffer throws passes through.
  write(out);
  buffer.flush();
}

/// Names of the temporary files in use, in storage that a signal handler may read.
struct Slot {
  std::atomic<bool> taken{false};
  std::atomic<bool> named{false};
  char name[4096];
};
std::array<Slot, 64> g_slots;
std::atomic<bool> g_is_ending{false};
std::atomic<int> g_in_making{0};

/// What a thread would see of files that remove_temporaries() took away is no error of it.
void wait_if_ending() noexcept {
  while (g_is_ending) ::pause();
}

/// While a temporary file is made and listed: no signal handler interrupts this thread, remove_temporaries() on another
/// one waits, and after it none is made any more.
class Making {
 public:
  Making() {
    sigset_t all;
    sigfillset(&all);
    ::pthread_sigmask(SIG_BLOCK, &all, &before_);
    ++g_in_making;
    if (!g_is_ending) return;
    --g_in_making;
    wait_if_ending();
  }
  ~Making() {
    --g_in_making;
    ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  Making(const Making&) = delete;
  Making& operator=(const Making&) = delete;

 private:
  sigset_t before_;
};

/// Lists a temporary file for remove_temporaries() as long as it lives; made before the file and gone after it.
class Registration {
 public:
  explicit Registration(const fs::path& path) {
    const std::string& name = path.native();
    if (name.size() >= sizeof(Slot::name)) return;
    for (Slot& slot : g_slots) {
      if (slot.taken.exchange(true)) continue;
      std::memcpy(slot.name, name.c_str(), name.size() + 1);
      slot.named = true;
      slot_ = &slot;
      return;
    }
  }
  ~Registration() {
    if (!slot_) return;
    slot_->named = false;
    slot_->taken = false;
  }
  Registration(const Registration&) = delete;
  Registration& operator=(const Registration&) = delete;

 private:
  Slot* slot_ = nullptr;
};

// A temporary file is ".papilla-" + 32 hexadecimal digits + ".tmp". As long as its process lives it is locked (flock),
// whatever the container or machine it runs in; the system drops the lock when the process dies.
constexpr std::size_t k_least_space = 4096;  ///< Bytes without which no file is begun: a block.
constexpr std::string_view k_prefix = ".papilla-", k_suffix = ".tmp", k_hex = "0123456789abcdef";

std::string temporary_name() { return std::string(k_prefix).append(random_token()).append(k_suffix); }

bool is_temporary_name(std::string_view name) {
  if (name.size() != k_prefix.size() + 2 * k_random_token_bytes + k_suffix.size()) return false;
  return name.starts_with(k_prefix) && name.ends_with(k_suffix) &&
         name.substr(k_prefix.size(), 2 * k_random_token_bytes).find_first_not_of(k_hex) == std::string_view::npos;
}

/// Removes a temporary file of this user whose process is dead.
void remove_if_dead(int folder, const char* name) {
  const int opened = ::openat(folder, name, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (opened < 0) return;
  const Descriptor file(opened);
  struct stat status {};
  const bool ours = ::fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == ::geteuid();
  if (ours && ::flock(file, LOCK_EX | LOCK_NB) == 0) ::unlinkat(folder, name, 0);
}

/// Once a process and folder.
void remove_dead_temporaries(int folder, const fs::path& path) {
  static std::mutex mutex;
  static std::set<fs::path> cleaned;
  std::error_code error;
  {
    const fs::path canonical = fs::canonical(path, error);
    const std::scoped_lock lock(mutex);
    if (error || !cleaned.insert(canonical).second) return;
  }
  fs::directory_iterator entry(path, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error))
    if (const fs::path name = entry->path().filename(); is_temporary_name(name.native()))
      remove_if_dead(folder, name.c_str());
}

/// Where a file is written: what the path leads to, and what is there now.
struct Place {
  fs::path target, folder;
  std::optional<struct stat> old;
  /// A device or a pipe (/dev/stdout, /dev/null) can't be replaced by renaming.
  bool is_replaced() const noexcept { return !old || S_ISREG(old->st_mode); }
};

/// A new temporary file in a folder; it is removed with the object unless it was renamed.
class Temporary {
 public:
  /// @param place  of the file that it will become.
  Temporary(int folder, const Place& place, mode_t mode) : folder_(folder), path_(place.target) {
    for (int attempt = 0; attempt < k_attempts; ++attempt) {
      const Making making;
      try {
        name_ = temporary_name();
      } catch (const IoError& error) {
        throw IoError(path_.string() + ": " + error.what());
      }
      listed_.emplace(place.folder / name_);
      file_ = ::openat(folder, name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
      if (file_ < 0) {
        const int reason = errno;
        listed_.reset();  // It is another's.
        if (reason == EEXIST) continue;
        fail(path_, reason);
      }
      if (is_locked()) return;
      remove();
    }
    throw IoError(path_.string() + ": no temporary file can be made beside it");
  }
  ~Temporary() { remove(); }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  int file() const noexcept { return file_; }

  /// Takes over mode bits and, where permitted, the owner of the file that is replaced.
  void adopt(const struct stat& old) const {
    mode_t mode = old.st_mode & 07777;
    const bool is_owned = ::fchown(file_, old.st_uid, old.st_gid) == 0;
    if (!is_owned && ::fchown(file_, static_cast<uid_t>(-1), old.st_gid) != 0)
      mode = (mode & ~static_cast<mode_t>(070)) | (mode & 07) << 3;  // Another group gets what everyone has.
    if (!is_owned) mode &= 0777;
    if (::fchmod(file_, mode) != 0) fail(path_, errno);
  }

  void rename(Durability durability) {
    // Forces the data to the disk, so that the rename can't overtake it.
    if (durability == Durability::synced && ::fsync(file_) != 0 && errno != EINVAL) fail(path_, errno);
    if (::renameat(folder_, name_.c_str(), folder_, path_.filename().c_str()) != 0) {
      const int reason = errno;
      wait_if_ending();
      fail(path_, reason);
    }
    name_.clear();
  }

 private:
  static constexpr int k_attempts = 100;

  /// False when another process took it for that of a dead one, between opening and locking.
  bool is_locked() const {
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0) return errno != EWOULDBLOCK;  // Some file systems know no locks.
    struct stat status {};
    return ::fstat(file_, &status) == 0 && status.st_nlink > 0;
  }

  void remove() noexcept {
    if (!name_.empty()) ::unlinkat(folder_, name_.c_str(), 0);
    if (file_ >= 0) ::close(file_);
    name_.clear();
    file_ = -1;
  }

  int folder_;
  const fs::path& path_;
  std::string name_;
  std::optional<Registration> listed_;
  int file_ = -1;
};

fs::path folder_of(const fs::path& path) { return path.parent_path().empty() ? fs::path(".") : path.parent_path(); }

/// Where a chain of symbolic links ends. In a folder like /tmp anyone can make a link to any file; there only one's own
/// and the folder's owner's are followed, as the kernel does with fs.protected_symlinks.
fs::path link_target(const fs::path& path) {
  constexpr int k_most_links = 40;
  fs::path target = path;
  for (int i = 0; i < k_most_links; ++i) {
    struct stat link {
    }, folder{};
    if (::lstat(target.c_str(), &link) != 0 || !S_ISLNK(link.st_mode)) return target;
    if (::stat(folder_of(target).c_str(), &folder) != 0) fail(path, errno);
    if ((folder.st_mode & S_ISVTX) != 0 && (folder.st_mode & S_IWOTH) != 0 && link.st_uid != ::geteuid() &&
        link.st_uid != folder.st_uid)
      throw IoError(path.string() + ": is another user's symbolic link in a folder that everyone may write to");
    std::error_code error;
    const fs::path next = fs::read_symlink(target, error);
    if (error) throw IoError(path.string() + ": " + error.message());
    target = target.parent_path() / next;
  }
  fail(path, ELOOP);
}

Place place_of(const fs::path& path) {
  if (path.filename().empty()) throw IoError("'" + path.string() + "': is not the name of a file");
  Place place;
  place.target = link_target(path);
  place.folder = folder_of(place.target);
  std::error_code error;
  if (!fs::is_directory(place.folder, error))
    throw IoError(path.string() + ": the folder " + place.folder.string() + " does not exist");
  struct stat old {};
  if (::stat(place.target.c_str(), &old) == 0) place.old = old;
  if (place.old && S_ISDIR(old.st_mode)) throw IoError(path.string() + ": is a directory");
  return place;
}

Descriptor open_folder(const Place& place, const fs::path& path) {
  const int opened = ::open(place.folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
  if (opened < 0) fail(path, errno);
  return Descriptor(opened);
}

/// The old file stays until the new one is there, so that its space does not count.
void require_space(const Place& place, const fs::path& path, std::uintmax_t bytes) {
  std::error_code error;
  const fs::space_info space = fs::space(place.folder, error);
  const bool is_known = !error && space.capacity > 0;  // Some file systems have none.
  if (is_known && space.available < bytes)
    throw IoError(path.string() + ": takes " + std::to_string(bytes) + " bytes, " + std::to_string(space.available) +
                  " are free on its file system");
}

}  // namespace

void write_atomically(const fs::path& path, const std::function<void(std::ostream&)>& write, std::uintmax_t bytes,
                      Durability durability) {
  const Place place = place_of(path);
  if (durability == Durability::synced) note_output(path);  // What can be made again may be written twice.
  if (!place.is_replaced()) {
    const int opened = ::open(place.target.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
    if (opened < 0) fail(path, errno);
    const Descriptor device(opened);
    return fill(device, path, write);
  }
  require_space(place, path, bytes);
  const Descriptor directory = open_folder(place, path);
  remove_dead_temporaries(directory, place.folder);
  Temporary temporary(directory, place, place.old ? 0600 : 0666);  // A new file gets what umask leaves.
  fill(temporary.file(), path, write);
  if (place.old) temporary.adopt(*place.old);
  temporary.rename(durability);
}

void require_writable(const fs::path& path) {
  const Place place = place_of(path);
  if (!place.is_replaced()) {
    if (::access(place.target.c_str(), W_OK) != 0) fail(path, errno);
    return;
  }
  const Descriptor directory = open_folder(place, path);
  const Temporary temporary(directory, place, 0600);
  fill(temporary.file(), path, [](std::ostream& out) { out << std::string(k_least_space, '\0'); });
}

void write_atomically(const fs::path& path, std::string_view content) {
  write_atomically(
      path, [&](std::ostream& out) { out.write(content.data(), static_cast<std::streamsize>(content.size())); },
      content.size());
}

void remove_temporaries() noexcept {
  g_is_ending = true;
  while (g_in_making > 0) ::sched_yield();
  for (const Slot& slot : g_slots)
    if (slot.named) ::unlink(slot.name);
}

bool make_folder(const fs::path& path) {
  std::error_code error;
  const bool is_new = fs::create_directories(path, error);
  if (error) throw IoError(path.string() + ": cannot be made a folder: " + error.message());
  return is_new;
}

}  // namespace papilla
