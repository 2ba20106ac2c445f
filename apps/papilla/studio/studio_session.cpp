// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_session.hpp"

#include <chrono>
#include <string_view>
#include <thread>
#include <utility>

#include "http/admission.hpp"
#include "json/embedded_json.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/random_token.hpp"
#include "papilla/pipeline/grain.hpp"
#include "studio/studio_answers.hpp"
#include "studio/studio_baking.hpp"
#include "studio/studio_card.hpp"
#include "studio/studio_desk.hpp"
#include "studio/studio_events.hpp"
#include "studio/studio_feel.hpp"
#include "studio/studio_files.hpp"
#include "studio/studio_library.hpp"
#include "studio/studio_makers.hpp"
#include "studio/studio_network.hpp"
#include "studio/studio_recipe.hpp"
#include "studio/studio_review.hpp"
#include "studio/studio_surfaces.hpp"

namespace papilla::app {
namespace {

constexpr std::chrono::milliseconds k_look{50};

}  // namespace

/// Puts the studio together: whom it serves, and what by which path. Later members use earlier ones and end first;
/// before them those who ask.
class StudioSession::Studio {
 public:
  Studio(const StudioOptions& options, const VerbContext& context)
      : options_(options),
        context_(context),
        files_(options.arguments.input, options.arguments.materials),
        bake_options_(options.arguments.options("studio.glb", context).bake),
        names_(served_names(options.tls)),
        events_(options.tls),
        http_(std::make_unique<StudioHttp>(options.port, options.tls)),
        admission_(http_->port(), options.token.empty() ? random_token() : options.token, 0, names_),
        socket_admission_(events_.port(), admission_.token(), http_->port(), names_),
        makers_(events_),
        desk_({files_, events_, makers_, bake_options_, options.arguments.options("studio.glb", context).read,
               options.arguments.material_library, options.more}),
        baking_(desk_, files_, events_),
        feel_({[this] { return desk_.made_surfaces(); }, [this] { return desk_.scene_file(); },
               [this](const Json& event) { events_.tell(event); }}),
        surfaces_(desk_, makers_.worker(), context.cache),
        library_(options.arguments.material_library, bake_options_.library, context.cache),
        recipe_({bake_options_.library, [this] { return desk_.folder(); },
                 [this](const std::string& material) { return desk_.rule(material); }, makers_.atlases()}),
        review_([this] { return desk_.folder() / "review.json"; }, [this] { return desk_.scene_file(); }) {
    events_.hear([this](const std::string& text) { feel_.message(text); });
    events_.start([this](const std::string& target, const std::string& host, const std::string& origin) {
      // A page always says where it comes from.
      return !origin.empty() && socket_admission_.admits({target, {host}, {origin}, {}});
    });
    // Pages are served under each name of this machine, and ask under the same.
    http_->start(routes(), admission_, socket_sources(names_, events_.port()));
  }

  ~Studio() {
    surfaces_.cancel();
    http_.reset();
    events_.hear({});
  }
  Studio(const Studio&) = delete;
  Studio& operator=(const Studio&) = delete;

  std::string url() const { return admission_.url(); }
  int port() const { return http_->port(); }

  void run(const std::function<bool()>& stops) {
    while (!stops() && !events_.are_gone_for(options_.close_s)) std::this_thread::sleep_for(k_look);
    baking_.end();
    desk_.save_if_changed();
  }

 private:
  PageAnswer page() const {
    const Json data = {{"program", std::string("papilla ") + version()}, {"socket", events_.port()}};
    std::string html(studio_template());
    constexpr std::string_view marker = "@PAPILLA_DATA@";
    html.replace(html.find(marker), marker.size(), embedded_json(data));
    return bytes_answer("text/html; charset=utf-8", std::make_shared<const std::string>(std::move(html)));
  }

  PageAnswer card(const Query& query) const {
    const auto rule = desk_.rule(required(query, "material"));
    if (!rule || rule->texture.empty()) throw InvalidInput("there is no such material with a picture");
    return json_answer(card_json(*rule, make_grain(*rule, bake_options_.library, {}, context_.cache)));
  }

  StudioRoutes routes() {
    StudioRoutes routes;
    routes.get["/"] = [this](const Query&) { return page(); };
    routes.get["/card"] = [this](const Query& query) { return card(query); };
    routes.get["/feel"] = [](const Query&) { return json_answer(feel_choices_json()); };
    add_desk_routes(routes, desk_);
    add_bake_routes(routes, baking_);
    add_surface_routes(routes, surfaces_);
    add_decal_routes(routes, makers_.decals());
    add_carrier_routes(routes, makers_.carriers());
    add_atlas_routes(routes, makers_.atlases());
    add_library_routes(routes, library_);
    add_recipe_routes(routes, recipe_);
    add_review_routes(routes, review_, [this] { events_.tell({{"event", "review"}}); });
    return routes;
  }

  const StudioOptions options_;
  const VerbContext& context_;
  StudioFiles files_;
  const BakeOptions bake_options_;
  const ServedNames names_;
  StudioEvents events_;
  std::unique_ptr<StudioHttp> http_;
  const Admission admission_, socket_admission_;
  StudioMakers makers_;
  StudioDesk desk_;
  StudioBaking baking_;
  StudioFeel feel_;
  StudioSurfaces surfaces_;
  StudioLibrary library_;
  StudioRecipe recipe_;
  StudioReview review_;
};

StudioSession::StudioSession(const StudioOptions& options, const VerbContext& context)
    : studio_(std::make_unique<Studio>(options, context)) {}
StudioSession::~StudioSession() = default;
std::string StudioSession::url() const { return studio_->url(); }
int StudioSession::port() const { return studio_->port(); }
void StudioSession::run(const std::function<bool()>& stops) { studio_->run(stops); }

}  // namespace papilla::app
