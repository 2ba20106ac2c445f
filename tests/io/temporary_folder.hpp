// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "papilla/core/temporary_folder.hpp"

namespace papilla::test {

/// A folder that lives as long as the object, with what tests do in one.
class TemporaryFolder : public papilla::TemporaryFolder {
 public:
  TemporaryFolder() : papilla::TemporaryFolder("papilla-test") {}

  std::filesystem::path write(const std::filesystem::path& name, std::string_view content) const {
    std::ofstream(path() / name, std::ios::binary) << content;
    return path() / name;
  }

  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(path()), std::filesystem::directory_iterator()));
  }
};

inline std::string content_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The message of the exception of type E that `call` throws; empty when it throws none.
template <class E, class Call>
std::string message_of(Call call) {
  try {
    call();
  } catch (const E& error) {
    return error.what();
  }
  return {};
}

}  // namespace papilla::test
