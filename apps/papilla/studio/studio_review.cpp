// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_review.hpp"

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "studio/studio_answers.hpp"

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

constexpr int k_version = 1;
constexpr std::size_t k_longest_text = 10000, k_most_notes = 10000;

bool is_point(const Json& json) {
  return json.is_array() && json.size() == 3 && std::all_of(json.begin(), json.end(), [](const Json& x) {
           return x.is_number() && std::isfinite(x.get<double>());
         });
}

void check(bool holds, const std::string& what) {
  if (!holds) throw InvalidInput(std::string("review.json: the note's ") + what);
}

bool is_text(const Json& note, const char* key) {
  const auto found = note.find(key);
  return found != note.end() && found->is_string() && found->get_ref<const std::string&>().size() <= k_longest_text;
}

/// Of a note that a page sends.
void check_note(const Json& note) {
  if (!note.is_object()) throw InvalidInput("review.json: a note is an object");
  for (const char* key : {"id", "text", "part", "view"})
    check(is_text(note, key), std::string(key) + " is missing or too long");
  check(note.contains("place_m") && is_point(note["place_m"]), "place_m is no place");
  const bool has_camera = note.contains("camera") && note["camera"].is_object();
  for (const char* key : {"position_m", "look"})
    check(has_camera && note["camera"].contains(key) && is_point(note["camera"][key]),
          "camera has no position and look");
  const auto picture = note.find("picture");
  check(picture == note.end() || picture->is_null() ||
            (picture->is_string() && picture->get_ref<const std::string&>().starts_with("data:image/")),
        "picture is no data URL of a picture");
}

}  // namespace

StudioReview::StudioReview(std::function<fs::path()> place, std::function<std::string()> scene)
    : place_(std::move(place)), scene_(std::move(scene)) {}

Json StudioReview::read_file_now() const {
  const fs::path file = place_();
  std::error_code error;
  if (!fs::exists(file, error)) return {{"papilla_review", k_version}, {"scene", scene_()}, {"notes", Json::array()}};
  Json review = Json::parse(read_file(file), nullptr, false);
  if (!review.is_object() || review.value("papilla_review", Json()) != k_version || !review.contains("notes") ||
      !review["notes"].is_array())
    throw InvalidInput(file.string() + ": is no review of version " + std::to_string(k_version));
  std::size_t number = 0;
  for (Json& note : review["notes"]) {
    ++number;
    if (note.is_object() && !is_text(note, "id")) note["id"] = "note-" + std::to_string(number);
  }
  return review;
}

void StudioReview::write(const Json& review) const {
  write_atomically(place_(), review.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

Json StudioReview::read() const {
  const std::scoped_lock lock(mutex_);
  return read_file_now();
}

Json StudioReview::put(const Json& note) {
  check_note(note);
  const std::scoped_lock lock(mutex_);
  Json review = read_file_now();
  Json& notes = review["notes"];
  const auto same = std::find_if(notes.begin(), notes.end(), [&](const Json& other) {
    return other.is_object() && other.at("id") == note.at("id");
  });
  if (same != notes.end())
    *same = note;
  else if (notes.size() < k_most_notes)
    notes.push_back(note);
  else
    throw InvalidInput("review.json: has " + std::to_string(k_most_notes) + " notes already");
  write(review);
  return review;
}

Json StudioReview::remove(const std::string& id) {
  const std::scoped_lock lock(mutex_);
  Json review = read_file_now(), kept = Json::array();
  for (const Json& note : review["notes"])
    if (!note.is_object() || note.at("id") != id) kept.push_back(note);
  if (kept.size() == review["notes"].size()) return review;
  review["notes"] = std::move(kept);
  write(review);
  return review;
}

void add_review_routes(StudioRoutes& routes, StudioReview& review, std::function<void()> changed) {
  routes.get["/review"] = [&review](const Query&) { return json_answer(review.read()); };
  routes.post["/review"] = [&review, changed = std::move(changed)](const Query&, const std::string& body) {
    const Json wanted = parsed(body);
    if (!wanted.is_object() || wanted.contains("put") == wanted.contains("remove"))
      throw InvalidInput("the request must be {\"put\": note} or {\"remove\": id}");
    Json made = wanted.contains("put") ? review.put(wanted["put"]) : review.remove(wanted["remove"].get<std::string>());
    changed();
    return json_answer(made);
  };
}

std::string with_review(std::string page) {
  constexpr std::string_view k_tag = "<html";
  if (const auto at = page.find(k_tag); at != std::string::npos)
    page.insert(at + k_tag.size(), " data-review=\"review\"");
  return page;
}

}  // namespace papilla::app
