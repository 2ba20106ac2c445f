// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "papilla/pipeline/surface_selector.hpp"

namespace papilla {

/// What people change in MATERIALS.json, as a value. The document is the file's text: whatever is made of it, the
/// command line makes of the file, too.
struct StudioEdit {
  enum class Kind {
    assign,         ///< The surfaces get `material`; empty: they are left alone.
    vary,           ///< The surfaces, which have `material`, get a material of their own that differs by `values`.
    set,            ///< `values` of `material`, for all surfaces that have it.
    add,            ///< A new material of the name `material` with `values`.
    remove,         ///< `material` and the rules that assign it.
    add_decal,      ///< A new decal with `values`, the last of them.
    set_decal,      ///< `values` of the decal of the number `number`.
    remove_decal,   ///< The decal of the number `number`.
    add_carrier,    ///< A new entry of "replace" with `values`, the last of them.
    set_carrier,    ///< `values` of the entry of the number `number`.
    remove_carrier  ///< The entry of the number `number`.
  };
  Kind kind = Kind::assign;
  std::vector<SurfaceSelector> surfaces;
  std::string material;
  std::size_t number = 0;  ///< Of a decal or carrier, from 0.
  /// Of decals and carriers: the surfaces that it is for from now on, a selector without any key for all; null: as
  /// before.
  std::optional<SurfaceSelector> onto;
  /// By JSON pointer within the material, decal or carrier ("/size_mm"): a value as JSON; "null" takes the key away.
  std::map<std::string, std::string> values;
  std::string title;  ///< For people: what is undone.
};

/// "{"materials": {}, "assign": []}", which leaves every surface as it came.
std::string empty_studio_document();

/// The document after an edit: keys that it does not mean stay as they are, in their order. A rule for surfaces goes
/// before all others and replaces an earlier one for the same. A material that `vary` made for these surfaces alone is
/// varied itself, not once more.
/// @param document valid JSON of MATERIALS.json. @param name stands for the file in messages.
/// @throws InvalidInput when the document is no such JSON, a material, decal or carrier is missing, or a material of
/// that name is there already. What values may be is parse_materials()' affair. Cost: O(document).
std::string edited_document(const std::string& document, const StudioEdit& edit, const std::string& name);

/// Documents one after the other, with a way back and forth.
class StudioHistory {
 public:
  explicit StudioHistory(std::string document);

  const std::string& document() const noexcept { return *steps_[now_].document; }
  /// Makes a document the newest; what was undone is forgotten. The same one again is no step.
  void add(std::string document, std::string title);
  bool can_undo() const noexcept { return now_ > 0; }
  bool can_redo() const noexcept { return now_ + 1 < steps_.size(); }
  void undo() noexcept { now_ -= can_undo() ? 1U : 0U; }
  void redo() noexcept { now_ += can_redo() ? 1U : 0U; }
  /// Titles of what undo() and redo() would do; empty where there is nothing.
  std::string undo_title() const { return can_undo() ? steps_[now_].title : std::string(); }
  std::string redo_title() const { return can_redo() ? steps_[now_ + 1].title : std::string(); }

 private:
  /// Documents that are kept: the oldest go.
  static constexpr std::size_t k_most_steps = 1000;
  struct Step {
    std::shared_ptr<const std::string> document;
    std::string title;
  };
  std::vector<Step> steps_;
  std::size_t now_ = 0;
};

}  // namespace papilla
