// SPDX-License-Identifier: MIT
#include "fuzz_input.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "papilla/core/error.hpp"

namespace papilla::fuzz {
namespace {

/// The process's folder, removed when the program ends properly.
class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / ("papilla-fuzz-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

struct PrintedCounts : Counts {
  ~PrintedCounts() { std::fprintf(stderr, "%zu of %zu inputs got past the reader\n", accepted, inputs); }
};

PrintedCounts& mutable_counts() {
  static PrintedCounts counts;
  return counts;
}

}  // namespace

std::filesystem::path write_input(const std::string& name, std::string_view content) {
  static const Folder folder;
  const std::filesystem::path path = folder.path() / name;
  std::ofstream(path, std::ios::binary).write(content.data(), static_cast<std::streamsize>(content.size()));
  return path;
}

bool expect_result_or_refusal(const std::function<void()>& read) {
  try {
    read();
    return true;
  } catch (const Error& error) {
    const std::string_view message = error.what();
    require(!message.empty() && message.find('\n') == std::string_view::npos, "a refusal is one line");
    if (std::getenv("PAPILLA_FUZZ_SAY") != nullptr) std::fprintf(stderr, "refused: %s\n", error.what());
    return false;
  }
}

bool expect_read(const std::function<void()>& read) {
  ++mutable_counts().inputs;
  const bool accepted = expect_result_or_refusal(read);
  if (accepted) ++mutable_counts().accepted;
  return accepted;
}

const Counts& counts() { return mutable_counts(); }

void require(bool condition, const char* promise) {
  if (condition) return;
  std::fprintf(stderr, "broken promise: %s\n", promise);
  std::abort();
}

}  // namespace papilla::fuzz
