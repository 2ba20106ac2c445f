// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "json/json.hpp"
#include "papilla/haptic/contact_surface.hpp"
#include "papilla/pipeline/studio/felt_scene.hpp"
#include "studio/feel_loop.hpp"
#include "studio/hand_path.hpp"
#include "studio/studio_worker.hpp"

namespace papilla::app {

/// Every force model and simulated device that can be chosen, with what limits the devices: {"models": [{"name",
/// "stimulus"}], "devices": [{"name", "title", "max_force_n", "probe_radius_mm", "mass_kg", "damping", "friction_n",
/// "encoder_step_mm", "delay_ms"}]}.
Json feel_choices_json();

/// The surfaces of a plan that are made, at every place of theirs.
std::vector<FeltSurface> placed_surfaces(const StudioScene& scene, const StudioPlan& plan, const StudioWorker& worker);

/// Lets a page feel the surfaces: docs/studio.md has the messages. One page at a time.
class StudioFeel {
 public:
  struct Handlers {
    std::function<std::vector<FeltSurface>()> surfaces;  ///< Those that are there now.
    std::function<std::string()> file;                   ///< Of the scene.
    std::function<void(const Json&)> tell;
  };

  explicit StudioFeel(Handlers handlers);
  ~StudioFeel();  ///< Ends what runs.
  StudioFeel(const StudioFeel&) = delete;
  StudioFeel& operator=(const StudioFeel&) = delete;

  /// A message of a page, from the socket's thread: does not wait. What is none of its own is left alone.
  void message(const std::string& text) noexcept;

 private:
  struct Press {
    std::string id, device, model;
    Vec3 point_mm;
  };
  /// A surface with what limits it, kept for the next press on it.
  struct Prepared {
    std::vector<FeltSurface> of;
    std::string device, model;
    std::shared_ptr<const ContactSurface> surface;
    Json about;  ///< {"materials", "warnings", "triangles"}
  };

  void take(const Json& message);
  void press(const Json& message);
  void follow(const Json& message);
  void run();
  /// @returns how it ended.
  std::string feel(const Press& press);
  void prepare(const Press& press);
  bool wait_for_path();
  void tell(const std::string& id, const std::string& state, const std::string& problem);

  Handlers handlers_;
  HandPath path_;
  std::atomic<bool> stops_{false};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Press> wanted_;  ///< Not begun.
  std::string running_;          ///< Id of the press that is felt; empty: none.
  Prepared prepared_;
  std::thread thread_;
};

}  // namespace papilla::app
