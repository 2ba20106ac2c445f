// SPDX-License-Identifier: MIT
#include "bench/model_files.hpp"

#include <algorithm>
#include <set>

namespace papilla::bench {
namespace {

namespace fs = std::filesystem;

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return extension;
}

}  // namespace

bool is_cad_file(const fs::path& file) {
  static const std::set<std::string> k_cad = {".step", ".stp", ".p21", ".igs", ".iges", ".brep", ".brp"};
  return k_cad.contains(lower_extension(file));
}

std::vector<fs::path> model_files(const std::vector<std::string>& inputs) {
  static const std::set<std::string> k_mesh = {".stl", ".obj", ".ply", ".off", ".glb", ".gltf"};
  std::vector<fs::path> files;
  for (const std::string& input : inputs) {
    if (!fs::is_directory(input)) {
      files.emplace_back(input);
      continue;
    }
    for (const auto& entry : fs::recursive_directory_iterator(input))
      if (entry.is_regular_file() && (k_mesh.contains(lower_extension(entry.path())) || is_cad_file(entry.path())))
        files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace papilla::bench
