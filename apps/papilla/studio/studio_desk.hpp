// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "json/json.hpp"
#include "papilla/pipeline/studio/studio_document.hpp"
#include "papilla/pipeline/studio/studio_scene.hpp"
#include "studio/studio_events.hpp"
#include "studio/studio_files.hpp"
#include "studio/studio_http.hpp"
#include "studio/studio_loader.hpp"
#include "studio/studio_makers.hpp"

namespace papilla::app {

/// The scene and the document that is edited for it: one for all pages. Thread-safe.
class StudioDesk {
 public:
  struct Setting {
    StudioFiles& files;
    StudioEvents& events;
    StudioMakers& makers;
    BakeOptions bake;
    ReadOptions read;
    std::string material_library;   ///< As parse_materials().
    std::vector<std::string> more;  ///< Words of the command line of a bake.
  };

  /// Reads the document, and the scene in a thread. @throws IoError, InvalidInput.
  explicit StudioDesk(Setting setting);
  ~StudioDesk();  ///< Ends what runs.
  StudioDesk(const StudioDesk&) = delete;
  StudioDesk& operator=(const StudioDesk&) = delete;

  // What pages ask for: docs/studio.md has requests and answers.
  Json state() const;
  Json scene_json() const;
  Json edit(const Json& wanted);
  /// The surfaces that edits would change, which are made without changing the document.
  Json try_edits(const Json& wanted);
  Json step(bool back);
  Json save();
  /// @param body of a file. @param is_scene it is opened; else it is a picture.
  Json upload(const Query& query, const BodySource& body, bool is_scene);
  void cancel_upload() noexcept;

  /// Where it differs from the file. @throws IoError.
  void save_if_changed();

  /// The newest; null: there is none.
  std::shared_ptr<StudioScene> scene() const;
  std::string scene_file() const;
  /// Of the document.
  std::filesystem::path folder() const;
  /// A material of the document as it is now; nothing when there is none of that name.
  std::optional<MaterialRule> rule(const std::string& material) const;
  /// What can be felt now.
  std::vector<FeltSurface> made_surfaces() const;
  /// StudioFiles::bake_words().
  std::vector<std::string> bake_words(const std::string& output, const std::string& report) const;
  std::string default_output() const;

 private:
  /// @pre locked, but in the constructor.
  void open_document();
  /// These @pre locked.
  bool is_changed() const { return history_.document() != saved_; }
  void save_now();
  void take(const std::string& document, const std::string& title);
  std::string edited(const Json& wanted) const;
  /// @throws as parse_materials().
  std::shared_ptr<const StudioPlan> plan_of(const std::string& document) const;
  void show(std::shared_ptr<const StudioPlan> plan);
  void tell_state();
  Json state_now() const;

  void take_scene(const StudioLoader::Loaded& loaded);
  /// Keeps a document that is not saved, a moment after it was changed.
  void keep_documents();

  const Setting setting_;
  StudioFiles& files_;
  StudioMakers& makers_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool ends_ = false;
  StudioHistory history_;
  std::string saved_;
  bool is_restored_ = false;
  std::string keep_problem_, load_problem_;
  double read_seconds_ = 0;
  std::uint64_t version_ = 1;
  std::shared_ptr<StudioScene> scene_;
  std::uint64_t scene_number_ = 0;  ///< Another one for each time that a scene was read.
  std::shared_ptr<const StudioPlan> plan_;
  std::atomic<bool> is_upload_cancelled_{false};
  std::unique_ptr<StudioLoader> loader_;
  std::thread keeper_;
};

/// GET /state, /scene; POST /edit, /try, /undo, /redo, /save, /open-cancel; uploads /open and /photograph.
void add_desk_routes(StudioRoutes& routes, StudioDesk& desk);

}  // namespace papilla::app
