// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formula.hpp"
#include "patterns.hpp"

namespace papilla::procedural_detail {

class Compiler;

/// The type that a name comes down to: itself, or that of the recipe; empty when there is none.
std::string_view bottom_type(std::string_view name, const RecipeLibrary& library);

/// Settings that a texture passes on to the textures within it.
struct InheritedSettings {
  double seed = 0, time = 0;
  bool seamless = false;
};

/// A parameter and the recipe that sets it.
struct Bound {
  Piece name, value;
  const Origin* origin;
};

/// The parameters of one texture.
class Arguments final : public TypeArguments {
 public:
  Arguments(Compiler& compiler, const TypeInfo& type, std::vector<Bound> bound, InheritedSettings inherited);
  double number(std::string_view name) const override;
  std::string text(std::string_view name) const override;
  Program formula(std::string_view name) override;
  std::vector<int> textures(std::string_view name) override;
  std::vector<int> matching_textures(std::size_t most) override;
  bool mentions(std::string_view word) const override;
  RecipePicture picture(const std::string& path) const override;
  const Graph& graph() const override;
  double time() const override { return time_; }
  int target_px() const override;
  [[noreturn]] void refuse(std::string_view name, const std::string& reason) const override;

  bool given(std::string_view name) const { return bound_.contains(name); }
  std::array<double, 3> vector(std::string_view name) const;
  std::vector<Rgb> colours(std::string_view name) const;
  Program colour_formula(std::string_view name);
  InheritedSettings settings_for_inner() const {
    return {seed_, time_, number("seamless") != 0 || inherited_.seamless};
  }
  void check_all();
  void use_textures(const std::vector<int>& nodes);
  FormulaScope& scope() { return scope_; }

 private:
  Bound of(std::string_view name) const;
  const ParameterInfo& info(std::string_view name) const;
  double constant(Piece text, const Origin& origin, double time) const;
  double checked(const ParameterInfo& p, double value, std::string_view name) const;
  void read_time_modifiers();
  void use(int node);
  void refuse_idle(const ParameterInfo& p) const;

  Compiler& compiler_;
  const TypeInfo& type_;
  std::map<std::string_view, Bound> bound_;
  InheritedSettings inherited_;
  double seed_ = 0, time_ = 0;
  std::map<std::string, double, std::less<>> modified_;
  FormulaScope scope_;
};

/// Makes a graph of textures from a recipe: resolves names, shares textures that are used twice, refuses recipes that
/// use themselves.
class Compiler {
 public:
  Compiler(const RecipeLibrary& library, const CompileOptions& options)
      : library_(library), options_(options), graph_(std::make_shared<Graph>()) {}

  std::shared_ptr<const Graph> compile(std::string_view recipe);
  /// The number of the recipe's node; nothing when neither a type nor a recipe has the name of its head.
  std::optional<int> texture(Piece recipe, const Origin& origin, const InheritedSettings& inherited);

  /// For suggestions.
  std::vector<std::string_view> known_names() const;
  const RecipeLibrary& library() const { return library_; }
  const CompileOptions& options() const { return options_; }
  Graph& graph() { return *graph_; }
  const Graph& graph() const { return *graph_; }
  const Node& node(int index) const { return *graph_->nodes[static_cast<std::size_t>(index)]; }
  const Origin& keep(Origin origin) { return origins_.emplace_back(std::move(origin)); }
  /// True while the named recipe is being compiled.
  bool is_open(std::string_view name) const;

 private:
  const TypeInfo& expand(const RecipeSyntax& syntax, const Origin& origin, std::vector<Bound>& bound);
  void open(std::string_view name, Piece place, const Origin& origin);
  int build(const TypeInfo& type, std::vector<Bound> bound, const InheritedSettings& inherited, const Origin& origin,
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
