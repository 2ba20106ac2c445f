// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <memory>
#include <optional>

#include "exit_code.hpp"
#include "file_options.hpp"
#include "http/browser.hpp"
#include "live/follow.hpp"
#include "option_checks.hpp"
#include "options/environment_option.hpp"
#include "options/scene_option.hpp"
#include "page/page_file.hpp"
#include "page/page_scene.hpp"
#include "papilla/io/scene_file.hpp"
#include "shown_format.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string input, output, environment;
  std::optional<std::string> follow;  ///< The player's socket; empty for the default one.
  int port = 0;
  bool no_open = false;
  PageSceneOptions page;
  SceneOptions scene;
};

PageScene scene_of(const std::string& file, const Options& options, const VerbContext& context) {
  ReadOptions read = options.scene.read_options(context.cache);
  PageSceneOptions page = options.page;
  if (!options.environment.empty()) page.environment = read_environment(options.environment, k_scene_environment_width);
  const Scene scene =
      is_gltf_file(file) ? read_for_page(file, read, page.levels) : read_scene(file, read, context.progress);
  return page_scene(scene, file, page, context.progress);
}

PageContent content_of(const std::string& file, Json scene) {
  return {fs::path(file).filename().string(), std::move(scene), nullptr};
}

bool wants_browser(const Options& options, const VerbContext& context) {
  return !options.no_open && !context.console.silent();
}

bool open(const std::string& page, const VerbContext& context) {
  const bool opened = open_in_browser(page);
  if (!opened) context.console.print("no browser could be started; open the page by hand\n");
  return opened;
}

Json run_follow(const Options& options, const VerbContext& context) {
  bool opened = false;
  std::optional<PageDoor> door;
  Json json = follow_player(
      {*options.follow, options.input, options.port, context.deadline},
      [&](const std::string& file) { return content_of(file, scene_of(file, options, context).json); },
      [&](const std::string& url) {
        context.console.print("following the player at " + url + " until Ctrl-C\n");
        if (wants_browser(options, context)) opened = open(door.emplace(url).file().string(), context);
      });
  json["opened"] = opened;
  return json;
}

Json run(const Options& options, VerbContext& context) {
  if (options.follow) return run_follow(options, context);
  if (options.input.empty()) throw UsageError("a FILE is required");
  const fs::path page =
      options.output.empty() ? fs::path(options.input).replace_extension(".html") : fs::path(options.output);
  PageScene scene = scene_of(options.input, options, context);
  const std::size_t bytes = write_page(content_of(options.input, std::move(scene.json)), page);
  context.console.print(shown_format("{}: {} of {} triangles shown, {:.1f} MB\n", page.string(), scene.triangles_shown,
                                     scene.triangles, static_cast<double>(bytes) / 1e6));
  const bool opened = wants_browser(options, context) && open(fs::absolute(page).string(), context);
  return {{"page", page.string()},
          {"triangles", scene.triangles},
          {"triangles_shown", scene.triangles_shown},
          {"simplification_error_mm", scene.error_mm},
          {"bytes", bytes},
          {"opened", opened}};
}

}  // namespace

void add_view(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb =
      add_verb(program,
               {"view", "Write a page that shows a scene, its uv and how it feels, and open it in the browser.",
                "papilla view cockpit.glb -o cockpit.html --no-open", VerbInfo::AtDeadline::is_cancelled,
                VerbInfo::Remembers::yes},
               [options](VerbContext& context) { return run(*options, context); });
  reads(verb->add_option("FILE", options->input,
                         "GLB of any producer, or another file that is read; with --follow what the player plays, "
                         "and known from it when not given"));
  auto* const output =
      writes(verb->add_option("-o,--output", options->output, "Page to write; beside FILE when not given"))
          ->type_name("HTML");
  verb->add_flag("--no-open", options->no_open, "Don't start a browser");
  auto* const follow =
      verb->add_option(
              "--follow", options->follow,
              "Serve the page on this machine, at an address with a secret token, with probe, proxy and force of a "
              "player that was started with --live; without SOCKET at its default")
          ->type_name("[SOCKET]")
          ->expected(0, 1)
          ->excludes(output);
  verb->add_option("--port", options->port, "Of the page that follows; 0 takes any that is free")
      ->type_name("N")
      ->check(in_range(0, 65535))
      ->needs(follow);
  verb->add_option("--triangles", options->page.triangles, "Triangles to show; more are simplified for the page")
      ->type_name("N")
      ->check(positive())
      ->capture_default_str();
  add_environment(*verb, options->environment);
  options->scene.add_to(*verb);
}

}  // namespace papilla::app
