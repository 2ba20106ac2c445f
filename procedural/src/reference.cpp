// SPDX-License-Identifier: MIT
#include "papilla/procedural/reference.hpp"

#include <array>
#include <string>

namespace papilla {
namespace {

constexpr double k_open = 1e300;

template <class Entry>
const Entry* find_in(std::span<const Entry> table, std::string_view name) noexcept {
  for (const auto& entry : table)
    if (entry.name == name) return &entry;
  return nullptr;
}

std::string range_text(const ParameterInfo& p) {
  if (p.kind != ParameterKind::number && p.kind != ParameterKind::integer) return "";
  const auto side = [](double v) {
    if (v <= -k_open || v >= k_open) return std::string("open");
    std::string s = std::to_string(v);
    while (s.back() == '0') s.pop_back();
    if (s.back() == '.') s.pop_back();
    return s;
  };
  return side(p.low) + " to " + side(p.high);
}

void table_of(std::string& out, std::span<const ParameterInfo> parameters) {
  out += "| parameter | takes | range | default | meaning |\n|---|---|---|---|---|\n";
  for (const ParameterInfo& p : parameters) {
    out += "| `" + std::string(p.name) + "` | " + std::string(to_string(p.kind)) + " | " + range_text(p) + " | ";
    out += (p.preset.empty() ? std::string() : "`" + std::string(p.preset) + "`") + " | ";
    for (const char ch : p.note) out += ch == '|' ? std::string("\\|") : std::string(1, ch);
    if (!p.refusal.empty()) out += "; another value is refused: " + std::string(p.refusal);
    out += " |\n";
  }
  out += '\n';
}

}  // namespace

const TypeInfo* find_type(std::string_view name) noexcept { return find_in(texture_types(), name); }
const FunctionInfo* find_function(std::string_view name) noexcept { return find_in(expression_functions(), name); }

const ParameterInfo* find_parameter(const TypeInfo& type, std::string_view name) noexcept {
  if (const ParameterInfo* own = find_in(type.parameters, name)) return own;
  return find_in(common_parameters(), name);
}

std::string_view to_string(ParameterKind kind) noexcept {
  constexpr std::array<std::string_view, 10> names = {"number", "integer", "flag",    "expression", "colour expression",
                                                      "text",   "choice",  "colours", "recipes",    "vector"};
  return names[static_cast<std::size_t>(kind)];
}

std::string reference_markdown() {
  std::string out = "## Types\n\n";
  for (const TypeInfo& type : texture_types()) {
    out += "### " + std::string(type.name) + "\n\n" + std::string(type.note) + ". Seamless ";
    out += type.seamless == Seamless::four_corner ? "by blending four corners" : "by construction";
    out += ".\n\n";
    if (!type.parameters.empty()) table_of(out, type.parameters);
  }
  out += "## Parameters of every type\n\n";
  table_of(out, common_parameters());
  out += "## Functions\n\n| function | gives | meaning |\n|---|---|---|\n";
  for (const FunctionInfo& f : expression_functions()) {
    out += "| `" + std::string(f.name);
    if (f.arity > 0) {
      out += '(';
      for (int i = 0; i < f.arity; ++i)
        out += (i ? ", " : "") + std::string(f.arguments[static_cast<std::size_t>(i)] == 'c' ? "colour" : "number");
      out += ')';
    }
    out += "` | " + std::string(f.colour ? "colour" : "number") + " | ";
    for (const char ch : f.note) out += ch == '|' ? std::string("\\|") : std::string(1, ch);
    out += " |\n";
  }
  return out;
}

}  // namespace papilla
