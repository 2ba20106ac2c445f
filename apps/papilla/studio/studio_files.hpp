// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "papilla/pipeline/studio/allowed_folders.hpp"
#include "studio/studio_http.hpp"

namespace papilla::app {

/// Of files that a scene can be opened from here, one each, and of pictures: in lower case, with dot.
const std::set<std::string>& scene_extensions();
const std::set<std::string>& picture_extensions();

/// The files of a studio: a scene, the MATERIALS.json that is edited, what is kept of it until it is saved, and what
/// people bring. Names of files stay as they were given, for the command line that is shown.
class StudioFiles {
 public:
  /// @param scene empty: none yet. @param materials empty: SCENE.materials.json in the working folder.
  /// @throws IoError, InvalidInput for a scene that is no file, and folders that are none.
  StudioFiles(std::string scene, std::string materials);

  const std::string& scene() const noexcept { return scene_; }
  const std::string& materials() const noexcept { return materials_; }
  /// Of a bake of the scene; empty without one.
  std::string default_output() const;
  /// The command line of a bake. @param report  folder; empty: none. @param more  words behind.
  std::vector<std::string> bake_words(const std::string& output, const std::string& report,
                                      const std::vector<std::string>& more) const;

  /// Another scene, with materials of its own: SCENE.materials.json in the working folder.
  void open(const std::string& scene);

  /// The document on the disk; empty_studio_document() where there is none. What it names may be read from now on.
  /// @throws IoError.
  std::string read();
  /// What was kept and is newer than the file; removed where it is older.
  std::optional<std::string> restored() const;
  /// Atomically. @throws IoError.
  void save(const std::string& document) const;
  void keep(const std::string& document) const;
  void forget_kept() const;

  /// @throws InvalidInput quoting the first path of the document that is not in the folders, unless the file named it
  /// when it was read.
  void check(const std::string& document) const;

  /// A path in the folders, as the page gave it: relative ones start in the working folder. @throws InvalidInput.
  std::filesystem::path checked(const std::string& path) const;

  /// Takes an upload into the working folder, under its own name where that is free, else with a number behind it; an
  /// upload that is under way has its name. Thread-safe.
  /// @param extensions allowed ones, in lower case, with dot. @return the path.
  /// @throws InvalidInput for names that are none, IoError.
  std::string receive(const std::string& name, const std::set<std::string>& extensions, const BodySource& body,
                      const std::function<bool()>& goes_on) const;

 private:
  std::filesystem::path kept_file() const;

  std::string scene_, materials_;
  AllowedFolders folders_;
  std::set<std::string> trusted_;  ///< Paths that the file named.
  mutable std::mutex coming_mutex_;
  mutable std::set<std::string> coming_;  ///< Names of uploads that are under way.
};

}  // namespace papilla::app
