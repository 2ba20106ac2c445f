// SPDX-License-Identifier: MIT
#include "papilla/pipeline/shared_data.hpp"

#include <vector>

#include "papilla/core/error.hpp"

namespace papilla {

std::filesystem::path find_shared_data(const std::string& name, const std::string& hint) {
  namespace fs = std::filesystem;
  std::vector<fs::path> places;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) places.push_back(program.parent_path().parent_path() / "share/papilla" / name);
  places.push_back(fs::path(PAPILLA_INSTALLED_SHARE) / name);
  std::string looked;
  for (const fs::path& place : places) {
    if (fs::is_directory(place, error)) return place;
    looked += (looked.empty() ? "" : ", ") + place.string();
  }
  throw IoError("the folder of " + name + " is not found: looked for " + looked + (hint.empty() ? "" : "; " + hint));
}

}  // namespace papilla
