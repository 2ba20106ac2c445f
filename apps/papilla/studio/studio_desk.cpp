// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_desk.hpp"

#include <chrono>
#include <set>
#include <utility>

#include "papilla/core/error.hpp"
#include "papilla/io/node_places.hpp"
#include "papilla/pipeline/studio/parse_materials.hpp"
#include "studio/studio_answers.hpp"
#include "studio/studio_bake.hpp"
#include "studio/studio_edit.hpp"

namespace papilla::app {
namespace {

constexpr std::chrono::milliseconds k_keep_after{400};
constexpr std::size_t k_most_edits = 1000;  ///< Of one step.

}  // namespace

StudioDesk::StudioDesk(Setting setting)
    : setting_(std::move(setting)),
      files_(setting_.files),
      makers_(setting_.makers),
      history_(empty_studio_document()) {
  loader_ = std::make_unique<StudioLoader>(
      setting_.bake, setting_.read, setting_.events,
      StudioLoader::Handlers{[this](const StudioLoader::Loaded& loaded) { take_scene(loaded); },
                             [this](const std::string& problem) {
                               const std::scoped_lock lock(mutex_);
                               load_problem_ = problem;
                             }});
  open_document();
  try {
    plan_ = plan_of(history_.document());
  } catch (const Error& error) {
    load_problem_ = error.what();
  }
  keeper_ = std::thread([this] { keep_documents(); });
  if (!files_.scene().empty()) loader_->load(files_.scene());
}

StudioDesk::~StudioDesk() {
  {
    const std::scoped_lock lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  loader_.reset();
  keeper_.join();
}

// ---- The document.

void StudioDesk::open_document() {
  saved_ = files_.read();
  history_ = StudioHistory(saved_);
  if (const auto kept = files_.restored(); kept && *kept != saved_) {
    history_.add(*kept, "what was not saved");
    is_restored_ = true;
  }
}

void StudioDesk::save_now() {
  files_.save(history_.document());
  saved_ = history_.document();
}

void StudioDesk::save_if_changed() {
  const std::scoped_lock lock(mutex_);
  if (is_changed()) save_now();
}

Json StudioDesk::save() {
  const std::scoped_lock lock(mutex_);
  save_now();
  ++version_;
  tell_state();
  return state_now();
}

void StudioDesk::take(const std::string& document, const std::string& title) {
  files_.check(document);
  const auto plan = plan_of(document);
  history_.add(document, title);
  show(plan);
}

std::shared_ptr<const StudioPlan> StudioDesk::plan_of(const std::string& document) const {
  const std::filesystem::path path = files_.materials();
  const std::string& library = setting_.material_library;
  if (scene_) return std::make_shared<const StudioPlan>(scene_->plan(document, path, library));
  return std::make_shared<const StudioPlan>(StudioPlan{parse_materials(document, path, library), {}, {}, {}, {}});
}

void StudioDesk::show(std::shared_ptr<const StudioPlan> plan) {
  plan_ = std::move(plan);
  ++version_;
  if (scene_) makers_.want(scene_, plan_);
  changed_.notify_all();
  tell_state();
}

void StudioDesk::tell_state() { setting_.events.tell({{"event", "state"}, {"version", version_}}); }

void StudioDesk::keep_documents() {
  std::unique_lock lock(mutex_);
  std::string kept = history_.document();
  while (!ends_) {
    changed_.wait(lock, [&] { return ends_ || history_.document() != kept; });
    if (ends_) return;
    changed_.wait_for(lock, k_keep_after, [&] { return ends_; });
    kept = history_.document();
    try {
      if (is_changed())
        files_.keep(kept);
      else
        files_.forget_kept();
      keep_problem_.clear();
    } catch (const Error& error) {
      keep_problem_ = error.what();
      setting_.events.tell({{"event", "problem"}, {"text", keep_problem_}});
    }
  }
}

/// The document after the edits of a request.
std::string StudioDesk::edited(const Json& wanted) const {
  const Json edits = wanted.contains("edits") ? wanted.at("edits") : Json::array({wanted});
  if (!edits.is_array() || edits.empty() || edits.size() > k_most_edits)
    throw InvalidInput("there is nothing to change");
  std::string document = history_.document();
  for (const Json& one : edits) document = edited_document(document, edit_of(one, scene_.get()), files_.materials());
  return document;
}

Json StudioDesk::edit(const Json& wanted) {
  const std::scoped_lock lock(mutex_);
  take(edited(wanted), wanted.value("title", std::string("change")));
  return state_now();
}

Json StudioDesk::try_edits(const Json& wanted) {
  const std::scoped_lock lock(mutex_);
  if (!scene_ || !plan_) throw InvalidInput("there is no scene");
  const std::string document = edited(wanted);
  files_.check(document);
  StudioPlan plan = *plan_of(document);
  std::set<std::string> shown;
  for (const StudioWish& wish : plan_->wishes) shown.insert(wish.key);
  std::erase_if(plan.wishes, [&](const StudioWish& wish) { return shown.contains(wish.key); });
  const auto tried = std::make_shared<const StudioPlan>(std::move(plan));
  makers_.try_also(tried);
  return {{"surfaces", makers_.surfaces_json(*tried)}, {"decals", StudioDecals::changed(*tried, *plan_)}};
}

Json StudioDesk::step(bool back) {
  const std::scoped_lock lock(mutex_);
  StudioHistory moved = history_;
  if (back)
    moved.undo();
  else
    moved.redo();
  const auto plan = plan_of(moved.document());
  history_ = std::move(moved);
  show(plan);
  return state_now();
}

// ---- The scene.

void StudioDesk::take_scene(const StudioLoader::Loaded& loaded) {
  const std::scoped_lock lock(mutex_);
  if (loaded.file != files_.scene()) {
    if (is_changed()) save_now();
    files_.open(loaded.file);
    open_document();
  }
  scene_ = loaded.scene;
  scene_number_ = loaded.number;
  read_seconds_ = loaded.seconds;
  show(plan_of(history_.document()));
}

Json StudioDesk::upload(const Query& query, const BodySource& body, bool is_scene) {
  is_upload_cancelled_ = false;
  const std::string file = files_.receive(required(query, "name"), is_scene ? scene_extensions() : picture_extensions(),
                                          body, [this] { return !is_upload_cancelled_; });
  if (is_scene) loader_->load(file);
  return {{"file", file}};
}

void StudioDesk::cancel_upload() noexcept {
  is_upload_cancelled_ = true;
  loader_->cancel();
}

// ---- What is there.

Json StudioDesk::scene_json() const {
  const std::scoped_lock lock(mutex_);
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

Json StudioDesk::state() const {
  const std::scoped_lock lock(mutex_);
  return state_now();
}

Json StudioDesk::state_now() const {
  Json rules = Json::array();
  if (plan_)
    for (const RuleUse& use : plan_->uses)
      rules.push_back({{"selector", use.selector}, {"surfaces", use.surfaces}, {"problem", use.problem}});
  const std::string output = files_.default_output();
  return {{"version", version_},
          {"scene_file", files_.scene()},
          {"scene_number", scene_number_},
          {"loading", loader_->is_loading()},
          {"load_problem", load_problem_},
          {"read_seconds", read_seconds_},
          {"document", Json::parse(history_.document(), nullptr, false)},
          {"file", files_.materials()},
          {"saved", !is_changed()},
          {"restored", is_restored_},
          {"undo", history_.can_undo() ? Json(history_.undo_title()) : Json(nullptr)},
          {"redo", history_.can_redo() ? Json(history_.redo_title()) : Json(nullptr)},
          {"surfaces", plan_ && scene_ ? makers_.surfaces_json(*plan_) : Json::array()},
          {"decals", plan_ ? StudioDecals::list(*plan_) : Json::array()},
          {"carriers", plan_ && scene_ ? StudioCarrierMaker::wanted(*plan_) : Json(nullptr)},
          {"rules", rules},
          {"output", output},
          {"command", scene_ ? shell_line(files_.bake_words(output, {}, setting_.more)) : std::string()},
          {"problem", keep_problem_}};
}

std::shared_ptr<StudioScene> StudioDesk::scene() const {
  const std::scoped_lock lock(mutex_);
  return scene_;
}

std::string StudioDesk::scene_file() const {
  const std::scoped_lock lock(mutex_);
  return files_.scene();
}

std::filesystem::path StudioDesk::folder() const {
  const std::scoped_lock lock(mutex_);
  return std::filesystem::path(files_.materials()).parent_path();
}

std::optional<MaterialRule> StudioDesk::rule(const std::string& material) const {
  const std::scoped_lock lock(mutex_);
  if (!plan_) return std::nullopt;
  const auto found = plan_->rules.materials.find(material);
  return found == plan_->rules.materials.end() ? std::nullopt : std::optional(found->second);
}

std::vector<FeltSurface> StudioDesk::made_surfaces() const {
  const std::scoped_lock lock(mutex_);
  if (!scene_ || !plan_) return {};
  return makers_.placed(*scene_, *plan_);
}

std::vector<std::string> StudioDesk::bake_words(const std::string& output, const std::string& report) const {
  const std::scoped_lock lock(mutex_);
  return files_.bake_words(output, report, setting_.more);
}

std::string StudioDesk::default_output() const {
  const std::scoped_lock lock(mutex_);
  return files_.default_output();
}

void add_desk_routes(StudioRoutes& routes, StudioDesk& desk) {
  routes.get["/state"] = [&desk](const Query&) { return json_answer(desk.state()); };
  routes.get["/scene"] = [&desk](const Query&) { return json_answer(desk.scene_json()); };
  const auto add = [&](const char* path, const std::function<Json(const std::string& body)>& work) {
    routes.post[path] = [work](const Query&, const std::string& body) { return json_answer(work(body)); };
  };
  add("/edit", [&desk](const std::string& body) { return desk.edit(parsed(body)); });
  add("/try", [&desk](const std::string& body) { return desk.try_edits(parsed(body)); });
  add("/undo", [&desk](const std::string&) { return desk.step(true); });
  add("/redo", [&desk](const std::string&) { return desk.step(false); });
  add("/save", [&desk](const std::string&) { return desk.save(); });
  add("/open-cancel", [&desk](const std::string&) {
    desk.cancel_upload();
    return Json::object();
  });
  for (const auto& [path, is_scene] : {std::pair("/open", true), std::pair("/photograph", false)})
    routes.uploads[path] = [&desk, is_scene](const Query& query, const BodySource& body) {
      return json_answer(desk.upload(query, body, is_scene));
    };
}

}  // namespace papilla::app
