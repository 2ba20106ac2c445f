// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/core.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <memory>

#include "page/page_file.hpp"
#include "page/page_scene.hpp"
#include "papilla/io/scene_file.hpp"
#include "scene_options.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string input, output;
  bool no_open = false;
  PageSceneOptions page;
  SceneOptions scene;
};

/// Gives the page to the desktop's browser. The browser outlives this program: it belongs to a child of a child.
bool open_in_browser(const fs::path& page) {
  const std::string file = fs::absolute(page).string();
  const pid_t child = ::fork();
  if (child < 0) return false;
  if (child == 0) {
    if (!::freopen("/dev/null", "w", stdout) || !::freopen("/dev/null", "w", stderr)) ::_exit(127);
    ::execlp("xdg-open", "xdg-open", file.c_str(), nullptr);
    ::_exit(127);
  }
  int status = 0;
  return ::waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

Json run(const Options& options, VerbContext& context) {
  const fs::path page =
      options.output.empty() ? fs::path(options.input).replace_extension(".html") : fs::path(options.output);
  const Scene scene = read_scene(options.input, options.scene.read_options(), context.progress);
  PageContent content{fs::path(options.input).filename().string(),
                      page_scene_json(scene, options.input, options.page, context.progress), nullptr};
  const std::size_t bytes = write_page(content, page);
  const Json& triangles = content.scene["triangles"];
  const Json& shown = content.scene["triangles_shown"];
  context.console.print(fmt::format("{}: {} of {} triangles shown, {:.1f} MB\n", page.string(),
                                    shown.get<std::size_t>(), triangles.get<std::size_t>(),
                                    static_cast<double>(bytes) / 1e6));
  const bool opened = !options.no_open && !context.console.silent() && open_in_browser(page);
  if (!options.no_open && !opened && !context.console.silent())
    context.console.print("no browser could be started; open the page by hand\n");
  return {{"page", page.string()},    {"triangles", triangles},
          {"triangles_shown", shown}, {"simplification_error_mm", content.scene["error_mm"]},
          {"bytes", bytes},           {"opened", opened}};
}

}  // namespace

void add_view(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb =
      add_verb(program,
               {"view", "Write a page that shows a scene, its uv and how it feels, and open it in the browser.",
                "papilla view cockpit.glb -o cockpit.html --no-open"},
               [options](VerbContext& context) { return run(*options, context); });
  verb->add_option("FILE", options->input, "GLB of any producer, or another file that is read")->required();
  verb->add_option("-o,--output", options->output, "Page to write; beside FILE when not given")->type_name("HTML");
  verb->add_flag("--no-open", options->no_open, "Write the page only");
  verb->add_option("--triangles", options->page.triangles, "Triangles to show; more are simplified for the page")
      ->type_name("N")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  options->scene.add_to(*verb);
}

}  // namespace papilla::app
