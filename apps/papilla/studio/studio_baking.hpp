// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "json/json.hpp"
#include "studio/studio_bake.hpp"
#include "studio/studio_desk.hpp"
#include "studio/studio_events.hpp"
#include "studio/studio_files.hpp"
#include "studio/studio_http.hpp"

namespace papilla::app {

/// Bakes of the document, one at a time, and the report of the last.
class StudioBaking {
 public:
  StudioBaking(StudioDesk& desk, const StudioFiles& files, StudioEvents& events)
      : desk_(desk), files_(files), events_(events) {}

  /// Saves the document and begins. @param wanted {"output", "report"}. @return {"command", "state"}.
  /// @throws InvalidInput when there is no scene, for names that are none, and while a bake is under way; IoError.
  Json start(const Json& wanted);
  void cancel();
  /// Waits until it has been cancelled.
  void end();
  /// The page of the last bake's report, which keeps its notes here. @throws InvalidInput when none was written.
  PageAnswer report_page() const;

 private:
  void tell(const StudioBake::News& news, const std::string& output, const std::string& report);

  StudioDesk& desk_;
  const StudioFiles& files_;
  StudioEvents& events_;
  mutable std::mutex mutex_;
  std::string report_;
  std::unique_ptr<StudioBake> bake_;
};

/// POST /bake, /bake-cancel; GET /report.
void add_bake_routes(StudioRoutes& routes, StudioBaking& baking);

}  // namespace papilla::app
