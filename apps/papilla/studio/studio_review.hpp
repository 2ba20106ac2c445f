// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <string>

#include "json/json.hpp"
#include "studio/studio_http.hpp"

namespace papilla::app {

/// The notes of people who look at a scene: review.json beside the document (docs/vr.md). Read and written anew with
/// every change, so that nothing is lost and another program may change it, too.
class StudioReview {
 public:
  /// @param place of the file, and the scene that it is of: asked each time, as both may change.
  StudioReview(std::function<std::filesystem::path()> place, std::function<std::string()> scene);

  /// {"papilla_review": 1, "scene", "notes": []}; every note has an "id". No file: no notes.
  /// @throws InvalidInput when the file is no review of this version, IoError.
  Json read() const;
  /// Adds a note, or replaces the one of its id. @throws InvalidInput quoting what is wrong with it; as read().
  Json put(const Json& note);
  /// @throws as read(). No note of that id: nothing changes.
  Json remove(const std::string& id);

 private:
  Json read_file_now() const;
  void write(const Json& review) const;

  std::function<std::filesystem::path()> place_;
  std::function<std::string()> scene_;
  mutable std::mutex mutex_;
};

/// GET /review; POST /review {"put": note} or {"remove": id}. All answer with the review.
/// @param changed is called after a change.
void add_review_routes(StudioRoutes& routes, StudioReview& review, std::function<void()> changed);

/// A report page that keeps its notes by GET and POST /review of the server that it comes from.
std::string with_review(std::string page);

}  // namespace papilla::app
