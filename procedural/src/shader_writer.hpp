// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "node.hpp"
#include "papilla/procedural/shader.hpp"
#include "pattern_shader.hpp"

namespace papilla::procedural_detail {

/// A texture at the size at which another one shows it: octaves and edges depend on it.
struct ShaderInstance {
  int node = 0;
  double texel = 0, extent_x = 1, extent_y = 1;  ///< As of Block, in the coordinates that it is called with.
  auto operator<=>(const ShaderInstance&) const = default;
};

/// Functions that all shaders share: hashes, noise, kernels.
std::string_view shader_library() noexcept;
/// A kernel applied to expressions.
std::string kernel_call(std::string_view kernel, const std::vector<std::string>& in);
/// The text in WGSL. @pre it keeps to what PatternShader says.
std::string to_wgsl(std::string_view glsl);
std::string shader_constant_array(ShaderLanguage language, std::string_view name, std::string_view type,
                                  const std::vector<ShaderValue>& values);

/// Writes a graph as functions, those that are called before those that call them. Frames of the evaluator are private
/// variables of the shader, one set an instance.
class ShaderWriter {
 public:
  ShaderWriter(const Graph& graph, ShaderLanguage language)
      : graph_(graph), language_(language), has_colours_(graph.nodes.size(), false) {}

  /// Writes a function that gives the channels of the mask. @returns its name.
  std::string channels_function(const ShaderInstance& instance, unsigned mask);
  /// The text so far, without library, in the language.
  std::string text() const { return text_; }

  const Node& node(int index) const { return *graph_.nodes[static_cast<std::size_t>(index)]; }
  const ShaderInstance& instance(int number) const { return instances_[static_cast<std::size_t>(number)]; }
  /// Appends functions or variables.
  void append(std::string_view glsl);
  void append_array(std::string_view name, std::string_view type, const std::vector<ShaderValue>& values);
  /// Statements of a formula, and expressions of its results. `distances` stand for f1 … f4.
  std::vector<std::string> program(const Program& program, int instance, const std::vector<std::string>& distances,
                                   std::string& statements);
  [[noreturn]] void refuse(int node, const std::string& reason) const;

 private:
  int number_of(const ShaderInstance& instance);
  ShaderInstance inner(int instance, int node) const;
  std::string main_function(const ShaderInstance& instance);
  std::string texmap_function(int instance, unsigned mask);
  void write_frame(int instance);
  void write_prepare(int instance);
  void write_pattern(int instance);
  void write_main(int instance);
  std::string layers(int instance);
  std::string operand(const Operand& operand, int instance, const std::vector<std::string>& distances) const;
  std::string instruction(const Instruction& code, const Program& program, std::size_t place, int instance,
                          const std::vector<std::string>& distances);
  void assign(const Program& program, int instance, const std::vector<std::string>& targets, std::string& statements);

  const Graph& graph_;
  ShaderLanguage language_;
  std::string text_;
  std::vector<ShaderInstance> instances_;
  std::map<ShaderInstance, int> numbers_;
  std::map<std::pair<int, unsigned>, std::string> channels_, texmaps_;
  std::vector<bool> has_colours_;  ///< Of every node: its list is written.
  int programs_ = 0;               ///< For names.
};

}  // namespace papilla::procedural_detail
