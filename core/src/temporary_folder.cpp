// SPDX-License-Identifier: MIT
#include "papilla/core/temporary_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>

#include "papilla/core/error.hpp"

namespace papilla {

TemporaryFolder::TemporaryFolder(std::string_view purpose) {
  std::string name = std::filesystem::temp_directory_path() / (std::string(purpose) + "-XXXXXX");
  if (::mkdtemp(name.data()) == nullptr) throw IoError(name + ": " + std::strerror(errno));
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace papilla
