// SPDX-License-Identifier: MIT
#include "papilla/io/cad_reader.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "cad_plugin.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/io/sample_solids.hpp"

namespace papilla {
namespace {

const cad::Plugin& plugin() {
  static const auto* loaded = static_cast<const cad::Plugin*>(load_plugin("cad"));
  return *loaded;
}

}  // namespace

Scene read_cad(const std::filesystem::path& path, const CadReadOptions& options, CadReport* report,
               const ProgressCallback& progress) {
  return plugin().read(path, options, report, progress);
}

bool is_cad_extension(const std::filesystem::path& path) {
  static constexpr std::array<std::string_view, 7> k_extensions = {".step", ".stp",  ".p21", ".iges",
                                                                   ".igs",  ".brep", ".brp"};
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(k_extensions.begin(), k_extensions.end(), extension) != k_extensions.end();
}

void write_sample_solids(const std::filesystem::path& path) { write_atomically(path, plugin().sample_solids()); }

}  // namespace papilla
