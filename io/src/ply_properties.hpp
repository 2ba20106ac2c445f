// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <vector>

#include "ply_header.hpp"

namespace papilla {

/// Finds the properties of an element by name, and tells in the end which nobody asked for. Places are numbers into
/// PlyElement::properties.
class PlyProperties {
 public:
  explicit PlyProperties(const PlyElement& element) : element_(element), used_(element.properties.size(), false) {}

  /// The places of several scalars, under the first of several namings of which the element has all.
  template <std::size_t N>
  std::optional<std::array<std::size_t, N>> scalars(std::initializer_list<std::array<std::string_view, N>> namings) {
    for (const auto& names : namings) {
      std::array<std::size_t, N> places{};
      bool has_all = true;
      for (std::size_t i = 0; i < N; ++i) has_all = has_all && find(names[i], false, places[i]);
      if (!has_all) continue;
      for (const std::size_t place : places) used_[place] = true;
      return places;
    }
    return std::nullopt;
  }

  std::optional<std::size_t> scalar(std::string_view name) { return one(name, false); }
  std::optional<std::size_t> list(std::string_view name) { return one(name, true); }

  std::vector<std::string_view> unused() const {
    std::vector<std::string_view> names;
    for (std::size_t i = 0; i < used_.size(); ++i)
      if (!used_[i]) names.push_back(element_.properties[i].name);
    return names;
  }

 private:
  bool find(std::string_view name, bool is_list, std::size_t& place) const {
    const auto& all = element_.properties;
    const auto found = std::find_if(all.begin(), all.end(), [&](const PlyProperty& property) {
      return property.is_list == is_list && property.name == name;
    });
    place = static_cast<std::size_t>(found - all.begin());
    return found != all.end();
  }

  std::optional<std::size_t> one(std::string_view name, bool is_list) {
    std::size_t place = 0;
    if (!find(name, is_list, place)) return std::nullopt;
    used_[place] = true;
    return place;
  }

  const PlyElement& element_;
  std::vector<bool> used_;
};

}  // namespace papilla
