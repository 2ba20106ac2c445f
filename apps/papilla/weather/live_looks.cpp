// SPDX-License-Identifier: GPL-3.0-or-later
#include "weather/live_looks.hpp"

#include <utility>

#include "json/json.hpp"

namespace papilla::app {
namespace {

/// Appends pixels and returns where they lie behind the text; null without any.
Json place_of(const std::vector<unsigned char>& pixels, std::string& all) {
  if (pixels.empty()) return nullptr;
  const Json place = {{"at", all.size()}, {"bytes", pixels.size()}};
  all.append(reinterpret_cast<const char*>(pixels.data()), pixels.size());
  return place;
}

struct PictureOfLook {
  const char* name;
  std::vector<unsigned char> WeatheredLook::*pixels;
};
constexpr PictureOfLook k_pictures[] = {
    {"color", &WeatheredLook::color}, {"normal", &WeatheredLook::normal}, {"shine", &WeatheredLook::shine}};

/// @param versions  since which the pictures are these. @param since  what the page shows.
Json look_json(std::size_t material, const WeatheredLook& look, const std::array<std::uint64_t, 3>& versions,
               std::uint64_t since, std::string& pixels) {
  Json json = {{"material", material},         {"width", look.width},       {"height", look.height},
               {"roughness", look.roughness},  {"metallic", look.metallic}, {"opacity", look.opacity},
               {"alpha_mode", look.alpha_mode}};
  for (std::size_t k = 0; k < versions.size(); ++k)
    if (versions[k] > since) json[k_pictures[k].name] = place_of(look.*k_pictures[k].pixels, pixels);
  return json;
}

}  // namespace

void LiveLooks::show(const std::function<std::string(std::uint64_t, std::uint64_t)>& html, const WeatherLooks& looks) {
  const std::uint64_t page = pages_ + 1, version = version_ + 1;  // Only the caller's thread changes them.
  const auto text = std::make_shared<const std::string>(html(page, version));
  const std::scoped_lock lock(mutex_);
  page_ = text, pages_ = page;
  looks_.clear();
  take(looks);
  taken_ = version_;
}

void LiveLooks::update(const WeatherLooks& looks) {
  const std::scoped_lock lock(mutex_);
  take(looks);
}

void LiveLooks::take(const WeatherLooks& looks) {
  ++version_, ++events_;
  problem_.clear();
  looks_.resize(looks.materials.size());
  for (std::size_t m = 0; m < looks_.size(); ++m) {
    if (looks_[m].look == looks.materials[m]) continue;
    const Look before = std::exchange(looks_[m], {looks.materials[m], version_, {}});
    for (std::size_t k = 0; k < before.pictures.size(); ++k) {
      const auto pixels = k_pictures[k].pixels;
      const bool same = before.look && looks_[m].look && *before.look.*pixels == *looks_[m].look.*pixels;
      looks_[m].pictures[k] = same ? before.pictures[k] : version_;
    }
  }
}

bool LiveLooks::is_taken() const {
  const std::scoped_lock lock(mutex_);
  return taken_ == version_;
}

void LiveLooks::tell(const std::string& problem) {
  const std::scoped_lock lock(mutex_);
  if (problem == problem_) return;
  problem_ = problem, ++events_;
}

PageRoutes LiveLooks::routes() {
  PageRoutes routes;
  routes.get["/"] = [this] {
    const std::scoped_lock lock(mutex_);
    return PageAnswer{200, "text/html; charset=utf-8", page_};
  };
  routes.post["/looks"] = [this](const std::string& body) {
    return PageAnswer{200, "application/octet-stream",
                      changed_since(Json::parse(body).at("since").get<std::uint64_t>())};
  };
  routes.streams["/live"] = [this](std::uint64_t& seen) { return event(seen); };
  return routes;
}

std::string LiveLooks::event(std::uint64_t& seen) const {
  const std::scoped_lock lock(mutex_);
  if (seen == events_) return {};
  seen = events_;
  const Json data = {{"page", pages_}, {"version", version_}, {"problem", problem_}};
  return "event: looks\ndata: " + data.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n\n";
}

SharedText LiveLooks::changed_since(std::uint64_t version) {
  std::vector<std::pair<std::size_t, Look>> changed;
  Json json;
  {
    const std::scoped_lock lock(mutex_);
    json = {{"page", pages_}, {"version", version_}};
    taken_ = version_;
    for (std::size_t m = 0; m < looks_.size(); ++m)
      if (looks_[m].look && looks_[m].version > version) changed.emplace_back(m, looks_[m]);
  }
  std::string pixels;
  json["materials"] = Json::array();
  for (const auto& [material, now] : changed)
    json["materials"].push_back(look_json(material, *now.look, now.pictures, version, pixels));
  const std::string text = json.dump();
  auto all = std::make_shared<std::string>();
  for (int k = 0; k < 4; ++k) all->push_back(static_cast<char>(text.size() >> 8 * k & 0xFF));
  *all += text, *all += pixels;
  return all;
}

}  // namespace papilla::app
