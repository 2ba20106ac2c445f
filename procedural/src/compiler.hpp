// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "arguments.hpp"

namespace papilla::procedural_detail {

/// Makes a graph of textures from a recipe: follows names, keeps what is used twice, refuses what would not end.
class Compiler {
 public:
  Compiler(const RecipeLibrary& library, const CompileOptions& options)
      : library_(library), options_(options), graph_(std::make_shared<Graph>()) {}

  std::shared_ptr<const Graph> compile(std::string_view recipe);
  /// Nothing when neither a type nor a recipe has the name of the head.
  std::optional<int> texture(Piece recipe, const Origin& origin, const Heritage& heritage);

  /// For suggestions.
  std::vector<std::string_view> known_names() const;
  const RecipeLibrary& library() const { return library_; }
  const CompileOptions& options() const { return options_; }
  Graph& graph() { return *graph_; }
  const Graph& graph() const { return *graph_; }
  const Node& node(int index) const { return *graph_->nodes[static_cast<std::size_t>(index)]; }
  const Origin& keep(Origin origin) { return origins_.emplace_back(std::move(origin)); }
  /// The named recipe is being compiled.
  bool is_open(std::string_view name) const;
  /// The type at the bottom of a named recipe.
  std::string_view bottom_type(std::string_view name) const;

 private:
  const TypeInfo& expand(const RecipeSyntax& syntax, const Origin& origin, std::vector<Bound>& bound);
  void open(std::string_view name, Piece place, const Origin& origin);
  int build(const TypeInfo& type, std::vector<Bound> bound, const Heritage& heritage, const Origin& origin,
            std::size_t position);

  const RecipeLibrary& library_;
  const CompileOptions& options_;
  std::shared_ptr<Graph> graph_;
  std::deque<Origin> origins_;
  std::vector<std::string> open_;
  std::map<std::string, int> made_;
  std::size_t depth_ = 0;
};

}  // namespace papilla::procedural_detail
