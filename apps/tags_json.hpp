// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include "papilla/io/scene.hpp"

namespace papilla::app {

/// How many tags the file had, and what became of those that are missing.
inline nlohmann::ordered_json tags_json(const TagSurvival& tags) {
  nlohmann::ordered_json restored = nlohmann::ordered_json::array(), lost = restored;
  for (const MissingTag& tag : tags.missing)
    if (tag.restored_by.empty())
      lost.push_back(tag.material);
    else
      restored.push_back({{"material", tag.material}, {"by", tag.restored_by}});
  return {{"expected", tags.expected}, {"restored", restored}, {"lost", lost}};
}

}  // namespace papilla::app
