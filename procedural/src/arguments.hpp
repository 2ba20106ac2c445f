// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "formula.hpp"
#include "patterns.hpp"

namespace papilla::procedural_detail {

class Compiler;

/// What a texture hands to those within it.
struct Heritage {
  double seed = 0, time = 0;
  bool seamless = false;
};

/// A parameter as some recipe gave it.
struct Bound {
  Piece name, value;
  const Origin* origin;
};

/// The parameters of one texture.
class Arguments final : public TypeArguments {
 public:
  Arguments(Compiler& compiler, const TypeInfo& type, std::vector<Bound> bound, Heritage heritage);
  double number(std::string_view name) const override;
  std::string text(std::string_view name) const override;
  Program formula(std::string_view name) override;
  std::vector<int> textures(std::string_view name) override;
  std::vector<int> matching_textures(std::size_t most) override;
  bool mentions(std::string_view word) const override;
  RecipePicture picture(const std::string& path) const override;
  const Graph& graph() const override;
  double time() const override { return time_; }
  [[noreturn]] void refuse(std::string_view name, const std::string& reason) const override;

  bool given(std::string_view name) const { return bound_.contains(name); }
  std::array<double, 3> vector(std::string_view name) const;
  std::vector<Rgb> colours(std::string_view name) const;
  Program colour_formula(std::string_view name);
  Heritage handed_down() const { return {seed_, time_, number("seamless") != 0 || heritage_.seamless}; }
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

  Compiler& compiler_;
  const TypeInfo& type_;
  std::map<std::string_view, Bound> bound_;
  Heritage heritage_;
  double seed_ = 0, time_ = 0;
  std::map<std::string, double, std::less<>> modified_;
  FormulaScope scope_;
};

}  // namespace papilla::procedural_detail
