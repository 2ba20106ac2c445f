// SPDX-License-Identifier: MIT
#include "papilla/io/read_file.hpp"

#include <cerrno>
#include <fstream>
#include <system_error>

#include "papilla/core/error.hpp"

namespace papilla {

void require_file(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw IoError(path.string() + ": does not exist");
  if (std::filesystem::is_directory(status)) throw IoError(path.string() + ": is a directory");
  if (!std::filesystem::is_regular_file(status)) throw IoError(path.string() + ": is not a regular file");
}

std::string read_file(const std::filesystem::path& path) {
  require_file(path);
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error) throw IoError(path.string() + ": " + error.message());
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) throw IoError(path.string() + ": " + std::generic_category().message(errno));
  std::string bytes(static_cast<std::size_t>(size), '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (in.gcount() != static_cast<std::streamsize>(bytes.size())) throw IoError(path.string() + ": cannot be read");
  return bytes;
}

}  // namespace papilla
