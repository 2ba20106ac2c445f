// SPDX-License-Identifier: GPL-3.0-or-later
#include <atomic>
#include <csignal>
#include <memory>
#include <optional>
#include <string>

#include "file_options.hpp"
#include "http/browser.hpp"
#include "option_checks.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/file_guard.hpp"
#include "studio/studio_session.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

std::atomic<bool> g_stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

struct Options {
  StudioOptions studio;
  bool no_open = false;
  std::vector<std::string> tls;  ///< Certificate and key.
  const CLI::App* verb = nullptr;
};

/// The words of the options that shape a bake, for its command line.
std::vector<std::string> bake_words(const CLI::App& verb) {
  CLI::App app;
  BakeArguments arguments;
  arguments.add_to(app);
  std::vector<std::string> words;
  for (const CLI::Option* option : verb.get_options()) {
    const std::string name = option->get_name();
    if (option->empty() || name == "SCENE" || name == "--materials" || name == "--help") continue;
    if (app.get_option_no_throw(name) == nullptr && name != "--cache" && name != "--threads" && name != "--seed")
      continue;
    words.push_back(name);
    if (option->get_expected_max() == 0) continue;
    for (const std::string& value : option->results()) words.push_back(value);
  }
  return words;
}

bool is_token(const std::string& token) {
  constexpr std::size_t k_least = 16, k_most = 128;
  return token.size() >= k_least && token.size() <= k_most &&
         token.find_first_not_of("0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ-_") ==
             std::string::npos;
}

Json run(const Options& options, VerbContext& context) {
  end_file_guard();  // People save what they opened.
  if (studio_template().empty()) throw InvalidInput("studio: this program was built without its pages");
  StudioOptions studio = options.studio;
  studio.more = bake_words(*options.verb);
  if (!options.tls.empty()) studio.tls = read_tls_files(options.tls[0], options.tls[1]);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, [](int) { g_stop = true; });
  StudioSession session(studio, context);
  Json json = {{"url", session.url()}, {"port", session.port()}};
  publish_result(json);
  context.console.print("studio: " + session.url() + "\n");
  std::optional<PageDoor> door;
  if (!options.no_open && !context.console.silent() && !open_in_browser(door.emplace(session.url()).file().string()))
    context.console.print("no browser could be started; open the page by hand\n");
  session.run([&] { return g_stop || context.deadline.passed(); });
  return json;
}

}  // namespace

void add_studio(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb =
      add_verb(program,
               {"studio", "Choose materials for a scene in the browser, see them on it, and bake the result.",
                "papilla studio data/cockpit.step -m examples/materials.json", VerbInfo::AtDeadline::ends,
                VerbInfo::Remembers::yes},
               [options](VerbContext& context) { return run(*options, context); });
  options->verb = verb;
  options->studio.arguments.add_to(*verb);
  verb->get_option("SCENE")->description("CAD, mesh or glTF file; without it one is opened in the page");
  verb->get_option("--materials")
      ->description("MATERIALS.json that is edited; default: SCENE.materials.json in the working folder");
  verb->add_option("--port", options->studio.port, "Of the page; 0 takes any that is free")
      ->type_name("N")
      ->check(in_range(0, 65535));
  verb->add_option("--token", options->studio.token,
                   "The secret of the page's address: 16 to 128 letters, digits, - and _; default: a random one")
      ->type_name("TEXT")
      ->check(CLI::Validator(
          [](const std::string& token) {
            return is_token(token) ? std::string() : "'" + token + "' is no token: 16 to 128 letters, digits, - and _";
          },
          "", "token"));
  reads(verb->add_option("--tls", options->tls,
                         "Serve by https, to every device of the network that has the address; PEM files"))
      ->type_name("CERT KEY")
      ->expected(2);
  verb->add_flag("--no-open", options->no_open, "Don't start a browser");
}

}  // namespace papilla::app
