// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_files.hpp"

#include <algorithm>
#include <cctype>
#include <mutex>
#include <ostream>
#include <system_error>
#include <vector>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/progress.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/pipeline/studio/studio_document.hpp"

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

fs::path folder_of(const std::string& file) {
  const fs::path folder = fs::path(file).parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

std::string materials_beside(const std::string& scene) {
  return (scene.empty() ? std::string("studio") : fs::path(scene).stem().string()) + ".materials.json";
}

std::vector<fs::path> folders_of(const std::string& scene, const std::string& materials) {
  std::vector<fs::path> folders{fs::path("."), folder_of(materials)};
  if (!scene.empty()) folders.push_back(folder_of(scene));
  return folders;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// A bare name that every file system has a place for.
void check_name(const std::string& name, const std::set<std::string>& extensions) {
  constexpr std::size_t k_longest = 200;
  const bool is_bare =
      !name.empty() && name.size() <= k_longest && name.front() != '.' && name.front() != '-' &&
      std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < ' ' || c == '/' || c == '\\'; });
  if (!is_bare) throw InvalidInput("'" + name + "' is no name of a file");
  if (extensions.contains(lower(fs::path(name).extension().string()))) return;
  std::string known;
  for (const std::string& extension : extensions) known += (known.empty() ? "" : " ") + extension;
  throw InvalidInput("'" + name + "' must end in one of " + known);
}

/// A name that is free in the working folder, for as long as a file of that name is under way.
class ComingName {
 public:
  ComingName(const std::string& wanted, std::mutex& mutex, std::set<std::string>& coming)
      : mutex_(mutex), coming_(coming), name_(wanted) {
    const std::scoped_lock lock(mutex_);
    const fs::path plain(wanted);
    std::error_code error;
    for (int i = 2; coming_.contains(name_) || fs::exists(fs::symlink_status(name_, error)); ++i)
      name_ = plain.stem().string() + "-" + std::to_string(i) + plain.extension().string();
    coming_.insert(name_);
  }
  ~ComingName() {
    const std::scoped_lock lock(mutex_);
    coming_.erase(name_);
  }
  ComingName(const ComingName&) = delete;
  ComingName& operator=(const ComingName&) = delete;
  const std::string& name() const noexcept { return name_; }

 private:
  std::mutex& mutex_;
  std::set<std::string>& coming_;
  std::string name_;
};

}  // namespace

const std::set<std::string>& scene_extensions() {
  static const std::set<std::string> names = {".step", ".stp", ".p21", ".iges", ".igs", ".brep", ".brp", ".stl", ".obj",
                                              ".ply",  ".off", ".glb", ".gltf", ".fbx", ".3mf",  ".dae", ".x3d"};
  return names;
}

const std::set<std::string>& picture_extensions() {
  static const std::set<std::string> names = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp", ".exr", ".bmp"};
  return names;
}

StudioFiles::StudioFiles(std::string scene, std::string materials)
    : scene_(std::move(scene)),
      materials_(materials.empty() ? materials_beside(scene_) : std::move(materials)),
      folders_(folders_of(scene_, materials_)) {
  if (!scene_.empty()) require_file(scene_);
}

std::string StudioFiles::default_output() const {
  if (scene_.empty()) return {};
  return fs::path(scene_).stem().string() + (is_gltf_file(scene_) ? "-baked.glb" : ".glb");
}

std::vector<std::string> StudioFiles::bake_words(const std::string& output, const std::string& report,
                                                 const std::vector<std::string>& more) const {
  std::vector<std::string> words = {"papilla", "bake", scene_, "-m", materials_, "-o", output};
  if (!report.empty()) words.insert(words.end(), {"--report", report});
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

void StudioFiles::open(const std::string& scene) {
  scene_ = scene;
  materials_ = materials_beside(scene);
  trusted_.clear();
}

std::string StudioFiles::read() {
  std::error_code error;
  if (!fs::exists(materials_, error)) return empty_studio_document();
  std::string document = read_file(materials_);
  trusted_ = paths_of_materials(document, materials_);
  return document;
}

fs::path StudioFiles::kept_file() const { return materials_ + ".autosave"; }

std::optional<std::string> StudioFiles::restored() const {
  std::error_code error;
  const auto kept = fs::last_write_time(kept_file(), error);
  if (error) return std::nullopt;
  const auto saved = fs::last_write_time(materials_, error);
  if (error || kept > saved) return read_file(kept_file());
  forget_kept();
  return std::nullopt;
}

void StudioFiles::save(const std::string& document) const {
  write_atomically(materials_, document);
  forget_kept();
}

void StudioFiles::keep(const std::string& document) const { write_atomically(kept_file(), document); }

void StudioFiles::forget_kept() const {
  std::error_code ignored;
  fs::remove(kept_file(), ignored);
}

void StudioFiles::check(const std::string& document) const {
  for (const std::string& path : paths_of_materials(document, materials_))
    if (!trusted_.contains(path)) folders_.file(path, folder_of(materials_));
}

fs::path StudioFiles::checked(const std::string& path) const { return folders_.file(path, "."); }

std::string StudioFiles::receive(const std::string& name, const std::set<std::string>& extensions,
                                 const BodySource& body, const std::function<bool()>& goes_on) const {
  check_name(name, extensions);
  const ComingName coming(name, coming_mutex_, coming_);
  const std::string& free = coming.name();
  checked(free);
  write_atomically(free, [&](std::ostream& out) {
    bool cancelled = false;
    const bool whole = body([&](std::string_view piece) {
      cancelled = !goes_on();
      if (!cancelled) out.write(piece.data(), static_cast<std::streamsize>(piece.size()));
      return !cancelled;
    });
    if (cancelled) throw Cancelled("'" + name + "': cancelled");
    if (!whole) throw IoError(name + ": the upload ended before its end");
  });
  return free;
}

}  // namespace papilla::app
