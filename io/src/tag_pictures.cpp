// SPDX-License-Identifier: MIT
#include "glb_document.hpp"

namespace papilla {
namespace {

using Json = GlbBuffer::Json;

/// Calls `use` with the number of the material and "height" or "maps" of its tag.
template <class AnyJson, class Use>
void for_each_picture(AnyJson& materials, const Use& use) {
  std::size_t number = 0;
  for (auto& material : materials) {
    const auto extras = material.find("extras");
    if (extras != material.end() && extras->is_object())
      if (const auto tag = extras->find("haptic"); tag != extras->end() && tag->is_object())
        for (const char* name : {"height", "maps"})
          if (const auto picture = tag->find(name); picture != tag->end() && picture->is_object())
            use(number, *picture);
    ++number;
  }
}

const std::string* text_in(const Json& picture, const char* name) {
  const auto found = picture.find(name);
  return found == picture.end() || !found->is_string() ? nullptr : &found->get_ref<const std::string&>();
}

/// The picture itself, where the tag holds it.
const std::string* data_uri_in(const Json& picture) {
  const std::string* uri = text_in(picture, "uri");
  return uri != nullptr && uri->starts_with("data:") ? uri : nullptr;
}

}  // namespace

TagPictures tag_pictures_in(const Json& materials) {
  TagPictures result;
  for_each_picture(materials, [&](std::size_t, const Json& picture) {
    ++result.uses;
    const std::string* uri = data_uri_in(picture);
    if (uri == nullptr) return;
    ++result.copies;
    result.bytes += uri->size();
  });
  return result;
}

void share_tag_pictures(Json& materials, const std::optional<std::set<std::size_t>>& edited,
                        const std::map<std::string, std::string>& known) {
  std::map<std::string, std::string> held;  // Pictures that may not be dropped, by SHA-256.
  const auto is_edited = [&](std::size_t number) { return !edited || edited->contains(number); };
  for_each_picture(materials, [&](std::size_t number, const Json& picture) {
    const std::string *uri = data_uri_in(picture), *sum = text_in(picture, "sha256");
    if (!is_edited(number) && uri != nullptr && sum != nullptr) held.try_emplace(*sum, *uri);
  });
  for_each_picture(materials, [&](std::size_t number, Json& picture) {
    const std::string *uri = data_uri_in(picture), *sum = text_in(picture, "sha256");
    if (!is_edited(number) || uri == nullptr || sum == nullptr) return;
    const auto [first, is_new] = held.try_emplace(*sum, *uri);
    if (!is_new && first->second == *uri) picture.erase("uri");
  });
  for_each_picture(materials, [&](std::size_t, Json& picture) {
    const std::string* sum = text_in(picture, "sha256");
    if (sum == nullptr || picture.contains("uri") || picture.contains("image") || held.contains(*sum)) return;
    const auto found = known.find(*sum);
    if (found == known.end()) return;
    picture["uri"] = found->second;
    held.insert(*found);
  });
}

std::map<std::string, std::string> held_tag_pictures(const Json& materials) {
  std::map<std::string, std::string> held;
  for_each_picture(materials, [&](std::size_t, const Json& picture) {
    const std::string *uri = data_uri_in(picture), *sum = text_in(picture, "sha256");
    if (uri != nullptr && sum != nullptr) held.try_emplace(*sum, *uri);
  });
  return held;
}

const std::string* tag_picture_uri(const Json& materials, const Json& picture) {
  if (const std::string* own = data_uri_in(picture)) return own;
  const std::string *sum = text_in(picture, "sha256"), *result = nullptr;
  if (sum == nullptr) return nullptr;
  for_each_picture(materials, [&](std::size_t, const Json& other) {
    const std::string* others = text_in(other, "sha256");
    if (result == nullptr && others != nullptr && *others == *sum) result = data_uri_in(other);
  });
  return result;
}

}  // namespace papilla
