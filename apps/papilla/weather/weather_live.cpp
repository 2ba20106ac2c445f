// SPDX-License-Identifier: GPL-3.0-or-later
#include "weather/weather_live.hpp"

#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <optional>
#include <thread>
#include <utility>

#include "http/browser.hpp"
#include "http/page_server.hpp"
#include "page/page_file.hpp"
#include "page/page_scene.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/file_guard.hpp"
#include "papilla/core/trace.hpp"
#include "shown_format.hpp"
#include "weather/file_watch.hpp"
#include "weather/live_looks.hpp"

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds k_look{10};
constexpr std::chrono::milliseconds k_half_written{50};  ///< In which a file that is being saved is whole.
constexpr double k_rest_s = 1;                           ///< Without an edit, until files are built.
constexpr double k_uninterrupted_s = 0.5;                ///< What takes no longer is finished.
constexpr double k_longest_wait_s = 0.5;                 ///< For a page to take what is new, if there is one.

std::atomic<bool> g_stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

/// The loop of follow_weather().
class Follower {
 public:
  Follower(const WeatherBuildOptions& options, WeatherBuilder& builder, const VerbContext& context, WeatherBuild& build)
      : options_(options), builder_(builder), context_(context), build_(build), watch_([this] { return files(); }) {
    show(builder_.looks(options_, context_.progress));
  }

  PageRoutes routes() { return looks_.routes(); }

  void run() {
    Stopwatch rest;
    while (!g_stop && !context_.deadline.passed()) {
      if (edited() && (looks_.is_taken() || rest.seconds() > k_longest_wait_s)) {
        pending_ = false;
        if (in_time([&] { update(); })) is_stale_ = true;
        rest = Stopwatch();
      } else if (is_stale_ && rest.seconds() > k_rest_s) {
        is_stale_ = false;
        if (!in_time([&] { rebuild(); })) is_stale_ = true;
      }
      std::this_thread::sleep_for(k_look);
    }
    // The last edit is built, too, unless the signal comes again.
    if (is_stale_ && g_stop.exchange(false)) in_time([&] { rebuild(); });
  }

 private:
  std::vector<fs::path> files() const {
    std::vector<fs::path> files(builder_.files().begin(), builder_.files().end());
    files.emplace_back(options_.config);
    return files;
  }

  bool edited() {
    if (watch_.changed()) pending_ = true;
    return pending_;
  }

  /// Ends what runs when the program is to end, or for a newer edit.
  ProgressCallback progress(const Stopwatch& clock) {
    return [this, &clock](const Progress& done) {
      if (context_.progress && !context_.progress(done)) return false;
      if (g_stop) return false;
      return was_interrupted_ || clock.seconds() < k_uninterrupted_s || !edited();
    };
  }

  /// @return false when a newer edit interrupted the work. Mistakes are told.
  template <class Work>
  bool in_time(const Work& work) {
    try {
      work();
      was_interrupted_ = false;
    } catch (const Cancelled&) {
      if (!pending_ && !g_stop) throw;
      was_interrupted_ = true;
      return false;
    } catch (const Error& error) {
      was_interrupted_ = false;
      std::this_thread::sleep_for(k_half_written);
      if (edited()) return true;  // It was being written.
      context_.console.print(shown_format("{}\n", error.what()));
      looks_.tell(error.what());
      is_stale_ = false;
      return true;
    }
    return true;
  }

  /// Shows what was edited, on the same page where its layout stays.
  void update() {
    const Stopwatch clock;
    const WeatherLooks looks = builder_.looks(options_, progress(clock));
    if (looks.layout != layout_) {
      rebuild();
      show(looks);
    } else {
      looks_.update(looks);
      context_.console.print(shown_format("{} painted anew in {:.2f} s\n", looks.painted, clock.seconds()));
    }
  }

  void rebuild() {
    const Stopwatch clock;
    forget_written_outputs();
    build_ = builder_.build(options_, true,
                            {context_.console, progress(clock), context_.threads, context_.deadline,
                             context_.read_deadline, context_.seed});
  }

  /// A page of the scene as built last.
  void show(const WeatherLooks& looks) {
    const std::string& file = build_.files.back().file;
    Json scene = page_scene(*build_.shown, file, {}, context_.progress).json;
    looks_.show(
        [&](std::uint64_t page, std::uint64_t version) {
          PageContent content{fs::path(file).filename().string(), std::move(scene), nullptr};
          content.looks = {{"page", page}, {"version", version}};
          return page_html(content);
        },
        looks);
    layout_ = looks.layout;
  }

  const WeatherBuildOptions& options_;
  WeatherBuilder& builder_;
  const VerbContext& context_;
  WeatherBuild& build_;
  LiveLooks looks_;
  std::string layout_;
  FileWatch watch_;
  bool pending_ = false;   ///< An edit that nothing was made of.
  bool is_stale_ = false;  ///< The files are older than the last edit.
  bool was_interrupted_ = false;
};

}  // namespace

std::string follow_weather(const WeatherBuildOptions& options, const WeatherLiveOptions& live, WeatherBuilder& builder,
                           const VerbContext& context, WeatherBuild& build) {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { g_stop = true; });
  Follower follower(options, builder, context, build);
  const PageServer server(follower.routes(), live.port);
  context.console.print("showing the scene at " + server.url() + " until Ctrl-C\n");
  std::optional<PageDoor> door;
  if (!live.no_open && !context.console.silent() && !open_in_browser(door.emplace(server.url()).file().string()))
    context.console.print("no browser could be started; open the page by hand\n");
  follower.run();
  return server.url();
}

}  // namespace papilla::app
