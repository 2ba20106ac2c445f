// SPDX-License-Identifier: MIT
#include "papilla/io/plugin.hpp"

#include <dlfcn.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

/// Folders of the program, and of the library that this function was linked into where it is none of the program.
std::vector<fs::path> folders_of_this_code() {
  std::vector<fs::path> folders;
  std::error_code error;
  if (const fs::path program = fs::read_symlink("/proc/self/exe", error); !error)
    folders.push_back(program.parent_path());
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&load_plugin), &info) != 0 && info.dli_fname != nullptr)
    if (const fs::path library = fs::canonical(info.dli_fname, error); !error) folders.push_back(library.parent_path());
  return folders;
}

void* open_plugin(const std::string& file) {
  for (const fs::path& folder : folders_of_this_code()) {
    const fs::path path = (folder / PAPILLA_PLUGIN_FOLDER / file).lexically_normal();
    std::error_code error;
    if (!fs::exists(path, error)) continue;
    if (void* plugin = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL)) return plugin;
    throw IoError(path.string() + ": cannot be loaded: " + first_line(dlerror()));
  }
  if (void* plugin = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL)) return plugin;
  throw IoError(file + ": cannot be loaded: " + first_line(dlerror()));
}

}  // namespace

const void* load_plugin(const std::string& name) {
  const std::string file = "papilla_" + name + ".so";
  const void* table = dlsym(open_plugin(file), ("papilla_" + name).c_str());
  if (!table) throw IoError(file + ": is no plug-in of papilla");
  const std::string_view built = static_cast<const PluginHeader*>(table)->version;
  if (built != version())
    throw IoError(file + ": is of version " + std::string(built) + ", the program of " + version());
  return table;
}

}  // namespace papilla
