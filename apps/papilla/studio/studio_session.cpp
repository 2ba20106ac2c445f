// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_session.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "bake/bake_arguments.hpp"
#include "http/admission.hpp"
#include "json/embedded_json.hpp"
#include "json/materials_json.hpp"
#include "json/texture_json.hpp"
#include "papilla/cache/stage_cache.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/random_token.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/io/node_places.hpp"
#include "papilla/pipeline/material_library.hpp"
#include "papilla/pipeline/pictures/material_picture.hpp"
#include "papilla/pipeline/recipe_source.hpp"
#include "papilla/pipeline/studio/parse_materials.hpp"
#include "papilla/pipeline/studio/studio_document.hpp"
#include "studio/studio_answers.hpp"
#include "studio/studio_atlases.hpp"
#include "studio/studio_bake.hpp"
#include "studio/studio_card.hpp"
#include "studio/studio_carriers.hpp"
#include "studio/studio_decals.hpp"
#include "studio/studio_edit.hpp"
#include "studio/studio_feel.hpp"
#include "studio/studio_files.hpp"
#include "studio/studio_network.hpp"
#include "studio/studio_recipe.hpp"
#include "studio/studio_review.hpp"
#include "studio/studio_socket.hpp"
#include "studio/studio_surface.hpp"
#include "studio/studio_worker.hpp"

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds k_look{50}, k_keep_after{400};
constexpr std::size_t k_most_edits = 1000;  ///< Of one step.

}  // namespace

/// State and routes. Members that several threads share are guarded by `mutex_`.
class StudioSession::Studio {
 public:
  Studio(const StudioOptions& options, const VerbContext& context)
      : options_(options),
        context_(context),
        files_(options.arguments.input, options.arguments.materials),
        bake_options_(options.arguments.options("studio.glb", context).bake),
        read_options_(options.arguments.options("studio.glb", context).read),
        names_(served_names(options.tls)),
        socket_(std::make_unique<StudioSocket>(options.tls)),
        http_(std::make_unique<StudioHttp>(options.port, options.tls)),
        admission_(http_->port(), options.token.empty() ? random_token() : options.token, 0, names_),
        socket_admission_(socket_->port(), admission_.token(), http_->port(), names_),
        history_(empty_studio_document()) {
    worker_ = std::make_unique<StudioWorker>(StudioWorker::Handlers{
        [this](const StudioSurface& surface, const std::string& name) { told_ready(surface, name); },
        [this](const std::string& label, const std::string& name, const std::string& problem) {
          tell({{"event", "failed"}, {"label", label}, {"surface", name}, {"problem", problem}});
        },
        [this](std::size_t left, const std::string& label) {
          tell({{"event", "working"}, {"left", left}, {"label", label}});
        }});
    decals_ = std::make_unique<StudioDecals>(*worker_);
    carriers_ = std::make_unique<StudioCarrierMaker>(*worker_);
    atlases_ = std::make_unique<StudioAtlases>([this] { tell({{"event", "recipe-atlas"}}); });
    recipe_ = std::make_unique<StudioRecipe>(
        StudioRecipe::Handlers{bake_options_.library, [this] { return review_file().parent_path(); },
                               [this](const std::string& material) { return rule_of_document(material); }, *atlases_});
    feel_ = std::make_unique<StudioFeel>(StudioFeel::Handlers{[this] { return made_surfaces(); },
                                                              [this] { return scene_file(); },
                                                              [this](const Json& event) { tell(event); }});
    open_document();
    socket_->start({[this](const std::string& target, const std::string& host, const std::string& origin) {
                      // A page always says where it comes from.
                      return !origin.empty() && socket_admission_.admits({target, {host}, {origin}, {}});
                    },
                    [this](const std::string& text) { feel_->message(text); },
                    [this](std::size_t clients) { note_clients(clients); }});
    // Pages are served under each name of this machine, and ask under the same.
    http_->start(routes(), admission_, socket_sources(names_, socket_->port()));
    keeper_ = std::thread([this] { keep_documents(); });
    if (!files_.scene().empty()) load(files_.scene());
  }

  /// Those who ask end first, then those who work, then those who are told.
  ~Studio() {
    cancel_levels_ = true;
    http_.reset();
    {
      const std::scoped_lock lock(mutex_);
      ends_ = true;
    }
    changed_.notify_all();
    cancel_loading_ = true;
    if (loader_.joinable()) loader_.join();
    keeper_.join();
    bake_.reset();
    feel_.reset();
    atlases_.reset();
    carriers_.reset();
    decals_.reset();
    worker_.reset();
    socket_.reset();
  }
  Studio(const Studio&) = delete;
  Studio& operator=(const Studio&) = delete;

  std::string url() const { return admission_.url(); }
  int port() const { return http_->port(); }

  void run(const std::function<bool()>& stops) {
    while (!stops() && !is_left()) std::this_thread::sleep_for(k_look);
    {
      const std::scoped_lock lock(bake_mutex_);
      bake_.reset();
    }
    const std::scoped_lock lock(mutex_);
    if (is_dirty()) save();
  }

 private:
  using Clock = std::chrono::steady_clock;

  void tell(const Json& event) { socket_->send(event.dump(-1, ' ', false, Json::error_handler_t::replace)); }

  /// A page that came is told so: what was told before that it did not hear.
  void note_clients(std::size_t clients) {
    bool is_new = false;
    {
      const std::scoped_lock lock(clients_mutex_);
      is_new = clients > clients_;
      clients_ = clients;
      had_client_ = had_client_ || clients > 0;
      left_at_ = Clock::now();
    }
    if (is_new) tell({{"event", "open"}});
  }

  bool is_left() {
    const std::scoped_lock lock(clients_mutex_);
    return had_client_ && clients_ == 0 && Clock::now() - left_at_ > std::chrono::duration<double>(options_.close_s);
  }

  // ---- The document.

  /// @pre locked, but in the constructor.
  void open_document() {
    saved_ = files_.read();
    history_ = StudioHistory(saved_);
    if (const auto kept = files_.restored(); kept && *kept != saved_) {
      history_.add(*kept, "what was not saved");
      is_restored_ = true;
    }
  }

  bool is_dirty() const { return history_.document() != saved_; }

  void save() {
    files_.save(history_.document());
    saved_ = history_.document();
  }

  /// Makes a document the newest, when it is one. @pre locked.
  void take(const std::string& document, const std::string& title) {
    files_.check(document);
    const auto plan = plan_of(document);
    history_.add(document, title);
    show(plan);
  }

  /// @pre locked. @throws as parse_materials().
  std::shared_ptr<const StudioPlan> plan_of(const std::string& document) const {
    const fs::path path = files_.materials();
    const std::string& library = options_.arguments.material_library;
    if (scene_) return std::make_shared<const StudioPlan>(scene_->plan(document, path, library));
    return std::make_shared<const StudioPlan>(StudioPlan{parse_materials(document, path, library), {}, {}, {}, {}});
  }

  /// @pre locked.
  void show(std::shared_ptr<const StudioPlan> plan) {
    plan_ = std::move(plan);
    ++version_;
    if (scene_) {
      worker_->want(scene_, plan_), decals_->want(scene_, plan_), carriers_->want(scene_, plan_);
      atlases_->want(scene_, plan_);
    }
    changed_.notify_all();
    tell({{"event", "state"}, {"version", version_}});
  }

  /// Keeps a document that is not saved, a moment after it was changed.
  void keep_documents() {
    std::unique_lock lock(mutex_);
    std::string kept = history_.document();
    while (!ends_) {
      changed_.wait(lock, [&] { return ends_ || history_.document() != kept; });
      if (ends_) return;
      changed_.wait_for(lock, k_keep_after, [&] { return ends_; });
      kept = history_.document();
      try {
        if (is_dirty())
          files_.keep(kept);
        else
          files_.forget_kept();
        keep_problem_.clear();
      } catch (const Error& error) {
        keep_problem_ = error.what();
        tell({{"event", "problem"}, {"text", keep_problem_}});
      }
    }
  }

  /// The document after the edits of a request. @pre locked.
  std::string edited(const Json& json) const {
    const Json edits = json.contains("edits") ? json.at("edits") : Json::array({json});
    if (!edits.is_array() || edits.empty() || edits.size() > k_most_edits)
      throw InvalidInput("there is nothing to change");
    std::string document = history_.document();
    for (const Json& one : edits) document = edited_document(document, edit_of(one, scene_.get()), files_.materials());
    return document;
  }

  Json edit(const std::string& body) {
    const Json json = parsed(body);
    const std::scoped_lock lock(mutex_);
    take(edited(json), json.value("title", std::string("change")));
    return state();
  }

  /// The surfaces that edits would change, which are made without changing the document.
  Json try_edits(const std::string& body) {
    const Json json = parsed(body);
    const std::scoped_lock lock(mutex_);
    if (!scene_ || !plan_) throw InvalidInput("there is no scene");
    const std::string document = edited(json);
    files_.check(document);
    StudioPlan plan = *plan_of(document);
    std::set<std::string> shown;
    for (const StudioWish& wish : plan_->wishes) shown.insert(wish.key);
    std::erase_if(plan.wishes, [&](const StudioWish& wish) { return shown.contains(wish.key); });
    const auto tried = std::make_shared<const StudioPlan>(std::move(plan));
    worker_->try_also(tried);
    decals_->try_also(tried);
    return {{"surfaces", surfaces_json(*tried)}, {"decals", StudioDecals::changed(*tried, *plan_)}};
  }

  Json step(bool back) {
    const std::scoped_lock lock(mutex_);
    StudioHistory moved = history_;
    if (back)
      moved.undo();
    else
      moved.redo();
    const auto plan = plan_of(moved.document());
    history_ = std::move(moved);
    show(plan);
    return state();
  }

  Json save_now() {
    const std::scoped_lock lock(mutex_);
    save();
    tell({{"event", "state"}, {"version", ++version_}});
    return state();
  }

  // ---- The scene.

  /// Reads a scene in a thread, with progress.
  void load(const std::string& file) {
    cancel_loading_ = true;
    if (loader_.joinable()) loader_.join();
    cancel_loading_ = false;
    is_loading_ = true;
    loader_ = std::thread([this, file, number = ++loads_] {
      const auto report = [&](const Progress& done) {
        tell_progress(
            {{"event", "loading"}, {"file", file}, {"stage", std::string(done.stage)}, {"fraction", done.fraction}});
        return !cancel_loading_;
      };
      std::string problem;
      try {
        const Stopwatch clock;
        Scene scene = read_scene(file, read_options_, report);
        BakeFileOptions way;
        way.read = read_options_;
        way.bake = bake_options_;
        const auto made = std::make_shared<StudioScene>(std::move(scene), bake_options_, bake_way(file, way).in_place,
                                                        std::to_string(number));
        const std::scoped_lock lock(mutex_);
        if (file != files_.scene()) {
          if (is_dirty()) save();
          files_.open(file);
          open_document();
        }
        scene_ = made;
        scene_number_ = number;
        show(plan_of(history_.document()));
        read_seconds_ = clock.seconds();
      } catch (const Cancelled&) {
        problem = "cancelled";
      } catch (const std::exception& error) {
        problem = error.what();
      }
      is_loading_ = false;
      {
        const std::scoped_lock lock(mutex_);
        load_problem_ = problem;
      }
      tell({{"event", "loaded"}, {"file", file}, {"problem", problem}});
    });
  }

  /// Not more often than pages draw.
  void tell_progress(const Json& event) {
    const auto now = Clock::now();
    const std::scoped_lock lock(clients_mutex_);
    if (now - told_at_ < k_look) return;
    told_at_ = now;
    tell(event);
  }

  void told_ready(const StudioSurface& surface, const std::string& name) {
    tell({{"event", "ready"}, {"surface", name}, {"label", surface.label}, {"seconds", surface.seconds}});
  }

  Json upload(const Query& query, const BodySource& body, bool is_scene) {
    cancel_upload_ = false;
    const std::string file =
        files_.receive(required(query, "name"), is_scene ? scene_extensions() : picture_extensions(), body,
                       [this] { return !cancel_upload_; });
    if (is_scene) {
      const std::scoped_lock lock(load_mutex_);
      load(file);
    }
    return {{"file", file}};
  }

  // ---- What pages ask for.

  Json surfaces_json(const StudioPlan& plan) const {
    Json list = Json::array();
    for (const StudioWish& wish : plan.wishes) {
      const std::string name = short_name(wish.key);
      const auto made = worker_->find(name);
      list.push_back({{"part", wish.part},
                      {"slot", wish.slot},
                      {"uses", wish.uses},
                      {"label", wish.label},
                      {"material", wish.material.empty() ? Json(nullptr) : Json(wish.material)},
                      {"name", name},
                      {"ready", made != nullptr},
                      {"problem", worker_->problem_of(name)}});
    }
    return list;
  }

  Json scene_json() const {
    if (!scene_) return nullptr;
    const Scene& scene = scene_->scene();
    Json parts = Json::array(), uses = Json::array();
    for (const Part& part : scene.parts)
      parts.push_back({{"name", shown_name(part)}, {"triangles", part.mesh.triangles.size()}});
    for (const StudioUse& use : scene_->uses())
      uses.push_back({{"part", use.part}, {"path", use.path}, {"world", use.world}});
    const auto& eye = scene_->eye();
    return {{"file", files_.scene()},
            {"z_up", scene.up == UpAxis::z},
            {"eye", eye ? Json{eye->x, eye->y, eye->z} : Json(nullptr)},
            {"parts", parts},
            {"uses", uses},
            {"warnings", scene.warnings},
            {"losses", scene.losses}};
  }

  std::vector<std::string> bake_words(const std::string& output, const std::string& report) const {
    std::vector<std::string> words = {"papilla", "bake", files_.scene(), "-m", files_.materials(), "-o", output};
    if (!report.empty()) words.insert(words.end(), {"--report", report});
    words.insert(words.end(), options_.more.begin(), options_.more.end());
    return words;
  }

  std::string default_output() const {
    if (files_.scene().empty()) return {};
    return files_.scene_stem() + (is_gltf_file(files_.scene()) ? "-baked.glb" : ".glb");
  }

  /// @pre locked.
  Json state() const {
    Json rules = Json::array();
    if (plan_)
      for (const RuleUse& use : plan_->uses)
        rules.push_back({{"selector", use.selector}, {"surfaces", use.surfaces}, {"problem", use.problem}});
    return {{"version", version_},
            {"scene_file", files_.scene()},
            {"scene_number", scene_number_},
            {"loading", is_loading_.load()},
            {"load_problem", load_problem_},
            {"read_seconds", read_seconds_},
            {"document", Json::parse(history_.document(), nullptr, false)},
            {"file", files_.materials()},
            {"saved", !is_dirty()},
            {"restored", is_restored_},
            {"undo", history_.can_undo() ? Json(history_.undo_title()) : Json(nullptr)},
            {"redo", history_.can_redo() ? Json(history_.redo_title()) : Json(nullptr)},
            {"surfaces", plan_ && scene_ ? surfaces_json(*plan_) : Json::array()},
            {"decals", plan_ ? StudioDecals::list(*plan_) : Json::array()},
            {"carriers", plan_ && scene_ ? StudioCarrierMaker::wanted(*plan_) : Json(nullptr)},
            {"rules", rules},
            {"output", default_output()},
            {"command", scene_ ? shell_line(bake_words(default_output(), {})) : std::string()},
            {"problem", keep_problem_}};
  }

  /// The surface that a query names: one that was made, or one as it was read.
  std::shared_ptr<const StudioSurface> asked_surface(const Query& query) const {
    if (query.contains("id")) {
      const auto made = worker_->find(query.at("id"));
      if (!made) throw InvalidInput("the surface is not there yet");
      return made;
    }
    const auto scene = current_scene();
    const std::uint32_t part = number_of(query, "part"), slot = number_of(query, "slot");
    if (!scene || part >= scene->scene().parts.size()) throw InvalidInput("there is no such surface");
    return std::make_shared<const StudioSurface>(scene->as_read(part, slot));
  }

  PageAnswer surface(const Query& query) const {
    return bytes_answer("application/octet-stream", surface_bytes(*asked_surface(query)));
  }

  /// Levels of detail of a surface that was made, by the code of the bake and with its cache; none of one that is gone.
  PageAnswer levels(const Query& query) const {
    const auto surface = worker_->find(required(query, "id"));
    std::vector<ShownLevel> levels;
    if (surface) {
      const std::scoped_lock lock(levels_mutex_);  // One after the other: each uses all processors.
      levels = shown_levels(surface->mesh, context_.cache, [this](const Progress&) { return !cancel_levels_; });
    }
    return bytes_answer("application/octet-stream", level_bytes(levels));
  }

  PageAnswer height(const Query& query) const {
    const fs::path file = [this] {
      const std::scoped_lock lock(mutex_);
      return fs::path(files_.scene());
    }();
    return bytes_answer("image/png", height_bytes(*asked_surface(query), file));
  }

  std::shared_ptr<StudioScene> current_scene() const {
    const std::scoped_lock lock(mutex_);
    return scene_;
  }

  PageAnswer picture(const Query& query) const {
    const auto made = query.contains("id") ? worker_->find(query.at("id")) : nullptr;
    std::shared_ptr<const Scene> look = made ? made->look : nullptr;
    if (!look)
      if (const auto scene = current_scene(); scene && query.contains("part")) {
        const std::uint32_t part = number_of(query, "part");
        if (part < scene->scene().parts.size()) look = scene->as_read(part, number_of(query, "slot")).look;
      }
    const std::uint32_t number = number_of(query, "image");
    if (!look) throw InvalidInput("there is no such picture");
    return picture_answer(*look, number);
  }

  std::string scene_file() const {
    const std::scoped_lock lock(mutex_);
    return files_.scene();
  }

  fs::path review_file() const {
    const std::scoped_lock lock(mutex_);
    return fs::path(files_.materials()).parent_path() / "review.json";
  }

  std::optional<MaterialRule> rule_of_document(const std::string& material) const {
    const std::scoped_lock lock(mutex_);
    if (!plan_) return std::nullopt;
    const auto found = plan_->rules.materials.find(material);
    return found == plan_->rules.materials.end() ? std::nullopt : std::optional(found->second);
  }

  std::vector<FeltSurface> made_surfaces() const {
    const std::scoped_lock lock(mutex_);
    if (!scene_ || !plan_) return {};
    std::vector<FeltSurface> placed = placed_surfaces(*scene_, *plan_, *worker_);
    for (const std::vector<FeltSurface>& more : {decals_->placed(), carriers_->placed()})
      placed.insert(placed.end(), more.begin(), more.end());
    return placed;
  }

  fs::path library_folder() const {
    const std::string& folder = options_.arguments.material_library;
    return folder.empty() ? find_material_library() : fs::path(folder);
  }

  PageAnswer library() const {
    Json list = Json::array();
    for (const LibraryMaterial& material : MaterialLibrary(library_folder()).materials())
      list.push_back(library_material_json(material));
    return json_answer(list);
  }

  /// A lit ball and the relief. The grain is remembered, so that the material is there at once when it is used.
  PageAnswer library_picture(const Query& query) const {
    constexpr int k_side = 128;
    const std::string& id = required(query, "id");
    const LibraryMaterial material = MaterialLibrary(library_folder()).material(id);
    const auto make = [&] {
      MaterialPictureOptions options;
      options.side_px = k_side;
      options.library = bake_options_.library;
      options.cache = context_.cache;
      const std::scoped_lock lock(picture_mutex_);  // One after the other: what is edited goes before.
      return text_of(encode_png(material_picture(rule_of(material, id), options)));
    };
    const std::string text = read_file(material.file);
    return bytes_answer("image/png",
                        std::make_shared<const std::string>(
                            remembered(context_.cache, "studio-picture", CacheUse::read_write, make, text).value));
  }

  Json bake(const std::string& body) {
    const Json wanted = parsed(body);
    const std::scoped_lock lock(mutex_);
    if (!scene_) throw InvalidInput("there is no scene to bake");
    const std::string output = wanted.value("output", default_output()), report = wanted.value("report", std::string());
    const std::string extension = files_.checked(output).extension().string();
    if (extension != ".glb" && extension != ".gltf") throw InvalidInput("'" + output + "' must end in .glb or .gltf");
    if (!report.empty()) files_.checked((fs::path(report) / "index.html").string());
    save();
    const std::scoped_lock bake_lock(bake_mutex_);
    if (bake_ && bake_->is_running()) throw InvalidInput("a bake is under way");
    bake_.reset();
    const std::vector<std::string> words = bake_words(output, report);
    report_ = report;
    bake_ = std::make_unique<StudioBake>(words, [this, output, report](const StudioBake::News& news) {
      static constexpr const char* names[] = {"running", "done", "failed", "cancelled"};
      Json event = {{"event", "bake"},           {"state", names[static_cast<std::size_t>(news.state)]},
                    {"stage", news.stage},       {"fraction", news.fraction},
                    {"messages", news.messages}, {"output", output},
                    {"report", report}};
      std::error_code error;
      if (const auto bytes = fs::file_size(output, error); !error && news.state == StudioBake::News::State::done)
        event["bytes"] = bytes;
      tell(event);
    });
    tell({{"event", "state"}, {"version", ++version_}});
    return {{"command", shell_line(words)}, {"state", state()}};
  }

  Json cancel_bake() {
    const std::scoped_lock lock(bake_mutex_);
    if (bake_) bake_->cancel();
    return Json::object();
  }

  PageAnswer report_page() const {
    const std::scoped_lock lock(bake_mutex_);
    if (report_.empty()) throw InvalidInput("no report was written");
    return bytes_answer(
        "text/html; charset=utf-8",
        std::make_shared<const std::string>(with_review(read_file(files_.checked(report_ + "/index.html")))));
  }

  PageAnswer page() const {
    const Json data = {{"program", std::string("papilla ") + version()}, {"socket", socket_->port()}};
    std::string html(studio_template());
    constexpr std::string_view marker = "@PAPILLA_DATA@";
    html.replace(html.find(marker), marker.size(), embedded_json(data));
    return bytes_answer("text/html; charset=utf-8", std::make_shared<const std::string>(std::move(html)));
  }

  PageAnswer card(const Query& query) const {
    const auto rule = rule_of_document(required(query, "material"));
    if (!rule || rule->texture.empty()) throw InvalidInput("there is no such material with a picture");
    return json_answer(card_json(*rule, make_grain(*rule, bake_options_.library, {}, context_.cache)));
  }

  StudioRoutes routes() {
    StudioRoutes routes;
    add_decal_routes(routes, *decals_);
    add_carrier_routes(routes, *carriers_);
    add_recipe_routes(routes, *recipe_);
    add_atlas_routes(routes, *atlases_);
    add_review_routes(routes, review_, [this] { tell({{"event", "review"}}); });
    routes.get["/card"] = [this](const Query& query) { return card(query); };
    routes.get["/"] = [this](const Query&) { return page(); };
    routes.get["/state"] = [this](const Query&) {
      const std::scoped_lock lock(mutex_);
      return json_answer(state());
    };
    routes.get["/scene"] = [this](const Query&) {
      const std::scoped_lock lock(mutex_);
      return json_answer(scene_json());
    };
    routes.get["/surface"] = [this](const Query& query) { return surface(query); };
    routes.get["/levels"] = [this](const Query& query) { return levels(query); };
    routes.get["/height"] = [this](const Query& query) { return height(query); };
    routes.get["/picture"] = [this](const Query& query) { return picture(query); };
    routes.get["/library"] = [this](const Query&) { return library(); };
    routes.get["/library-picture"] = [this](const Query& query) { return library_picture(query); };
    routes.get["/feel"] = [](const Query&) { return json_answer(feel_choices_json()); };
    routes.get["/report"] = [this](const Query&) { return report_page(); };
    routes.post["/edit"] = [this](const Query&, const std::string& body) { return json_answer(edit(body)); };
    routes.post["/try"] = [this](const Query&, const std::string& body) { return json_answer(try_edits(body)); };
    routes.post["/undo"] = [this](const Query&, const std::string&) { return json_answer(step(true)); };
    routes.post["/redo"] = [this](const Query&, const std::string&) { return json_answer(step(false)); };
    routes.post["/save"] = [this](const Query&, const std::string&) { return json_answer(save_now()); };
    routes.post["/bake"] = [this](const Query&, const std::string& body) { return json_answer(bake(body)); };
    routes.post["/bake-cancel"] = [this](const Query&, const std::string&) { return json_answer(cancel_bake()); };
    routes.post["/open-cancel"] = [this](const Query&, const std::string&) {
      cancel_upload_ = cancel_loading_ = true;
      return json_answer(Json::object());
    };
    routes.uploads["/open"] = [this](const Query& query, const BodySource& body) {
      return json_answer(upload(query, body, true));
    };
    routes.uploads["/photograph"] = [this](const Query& query, const BodySource& body) {
      return json_answer(upload(query, body, false));
    };
    return routes;
  }

  const StudioOptions options_;
  const VerbContext& context_;
  StudioFiles files_;
  const BakeOptions bake_options_;
  const ReadOptions read_options_;
  const ServedNames names_;
  std::unique_ptr<StudioSocket> socket_;
  std::unique_ptr<StudioHttp> http_;
  const Admission admission_, socket_admission_;

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

  std::mutex clients_mutex_;
  std::size_t clients_ = 0;
  bool had_client_ = false;
  Clock::time_point left_at_, told_at_;

  std::mutex load_mutex_;
  std::uint64_t loads_ = 0;
  std::atomic<bool> cancel_loading_{false}, cancel_upload_{false}, cancel_levels_{false}, is_loading_{false};
  std::thread loader_, keeper_;
  mutable std::mutex picture_mutex_, levels_mutex_, bake_mutex_;
  std::string report_;
  std::unique_ptr<StudioBake> bake_;
  std::unique_ptr<StudioWorker> worker_;
  std::unique_ptr<StudioDecals> decals_;
  std::unique_ptr<StudioCarrierMaker> carriers_;
  std::unique_ptr<StudioFeel> feel_;
  std::unique_ptr<StudioAtlases> atlases_;
  std::unique_ptr<StudioRecipe> recipe_;
  StudioReview review_{[this] { return review_file(); }, [this] { return scene_file(); }};
};

StudioSession::StudioSession(const StudioOptions& options, const VerbContext& context)
    : studio_(std::make_unique<Studio>(options, context)) {}
StudioSession::~StudioSession() = default;
std::string StudioSession::url() const { return studio_->url(); }
int StudioSession::port() const { return studio_->port(); }
void StudioSession::run(const std::function<bool()>& stops) { studio_->run(stops); }

}  // namespace papilla::app
