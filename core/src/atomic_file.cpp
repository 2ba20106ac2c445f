// SPDX-License-Identifier: MIT
#include "papilla/core/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

fs::path temporary_name(const fs::path& path) {
  static std::atomic<unsigned> counter{0};
  fs::path name = ".";
  name += path.stem();
  name += "." + std::to_string(::getpid()) + "-" + std::to_string(counter++);
  name += path.extension();
  return path.parent_path() / name;
}

/// Names of the temporary files in use, in storage that a signal handler may read.
struct Slot {
  std::atomic<bool> taken{false};
  std::atomic<bool> named{false};
  char name[4096];
};
std::array<Slot, 64> g_slots;

/// Lists a temporary file for remove_temporaries() as long as it lives.
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

/// Forces the data to the disk, so that the rename can't overtake it.
void synchronize(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw IoError(path.string() + ": was not written");
  const int result = ::fsync(descriptor);
  const int reason = errno;
  ::close(descriptor);
  if (result != 0 && reason != EINVAL) throw IoError(path.string() + ": " + std::generic_category().message(reason));
}

}  // namespace

void write_atomically(const fs::path& path, const std::function<void(const fs::path&)>& write) {
  if (path.filename().empty()) throw IoError("'" + path.string() + "': is not the name of a file");
  std::error_code error;
  const fs::path folder = path.parent_path().empty() ? fs::path(".") : path.parent_path();
  if (!fs::is_directory(folder, error))
    throw IoError(path.string() + ": the folder " + folder.string() + " does not exist");
  if (fs::is_directory(path, error)) throw IoError(path.string() + ": is a directory");
  // A device or a pipe (/dev/stdout, /dev/null) can't be replaced by renaming.
  if (fs::exists(path, error) && !fs::is_regular_file(path, error)) return write(path);
  const fs::path temporary = temporary_name(path);
  const Registration registration(temporary);
  try {
    write(temporary);
    synchronize(temporary);
    fs::rename(temporary, path, error);
    if (error) throw IoError(path.string() + ": " + error.message());
  } catch (...) {
    fs::remove(temporary, error);
    throw;
  }
}

void write_atomically(const fs::path& path, std::string_view content) {
  write_atomically(path, [&](const fs::path& temporary) {
    errno = 0;
    std::ofstream out(temporary, std::ios::binary);
    out.write(content.data(), static_cast<std::streamsize>(content.size()));
    out.close();
    const std::string reason = errno == 0 ? "" : ": " + std::generic_category().message(errno);
    if (!out) throw IoError(path.string() + ": cannot be written" + reason);
  });
}

void remove_temporaries() noexcept {
  for (const Slot& slot : g_slots)
    if (slot.named) ::unlink(slot.name);
}

}  // namespace papilla
