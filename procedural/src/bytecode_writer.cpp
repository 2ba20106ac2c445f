// SPDX-License-Identifier: MIT
#include "formula_compiler.hpp"

#include <algorithm>
#include <cmath>

namespace papilla::procedural_detail {
namespace {

constexpr std::size_t k_most_instructions = 20000;
constexpr std::size_t k_most_constants = 16384;

double folded(const KernelInfo& info, const std::vector<Scalar>& in) {
  std::array<const double*, k_most_arguments> rows{};
  for (std::size_t k = 0; k < in.size(); ++k) rows[k] = &in[k].number;
  double out = 0;
  info.kernel(&out, rows.data(), 1);
  return std::isfinite(out) ? out : 0;
}

int deepest(const std::vector<Scalar>& in) {
  int level = 0;
  for (const Scalar& s : in) level = std::max(level, s.level);
  return level;
}

}  // namespace

Value Value::of(double number) {
  Value v;
  v.part[0].number = number;
  return v;
}

Value Value::of(const Scalar& scalar) {
  Value v;
  v.part[0] = scalar;
  return v;
}

int BytecodeWriter::new_registers(int count) {
  if (count == 1 && !free_.empty()) {
    const int reg = free_.back();
    free_.pop_back();
    return reg;
  }
  registers_ += count;
  return registers_ - count;
}

Operand BytecodeWriter::place_of(const Scalar& s) {
  if (!s.fixed) return s.place;
  auto& pool = scope_.graph->constants;
  auto it = std::find(pool.begin(), pool.end(), s.number);
  if (it == pool.end()) {
    if (pool.size() >= k_most_constants)
      fail_at(*scope_.origin, position_,
              "the recipe has more than " + std::to_string(k_most_constants) + " different constants");
    it = pool.insert(pool.end(), std::isfinite(s.number) ? s.number : 0);
  }
  return {Operand::Where::constant, static_cast<int>(it - pool.begin())};
}

Instruction& BytecodeWriter::add(Action action, const std::vector<Scalar>& in, int outs) {
  if (program_.code.size() >= k_most_instructions)
    fail_at(*scope_.origin, position_, "the formula has more than " + std::to_string(k_most_instructions) + " steps");
  Instruction code;
  code.action = action;
  code.arguments = static_cast<int>(in.size());
  for (std::size_t k = 0; k < in.size(); ++k) code.in[k] = place_of(in[k]);
  code.out = new_registers(outs);
  program_.code.push_back(code);
  return program_.code.back();
}

Scalar BytecodeWriter::apply(std::string_view name, const std::vector<Scalar>& in, bool keep) {
  const KernelInfo* info = find_kernel(name);
  std::vector<Scalar> all = in;
  if (info->extra == "uv")
    for (const FrameRow row : {FrameRow::u, FrameRow::v})
      all.push_back({false, 0, {Operand::Where::frame, static_cast<int>(row)}, 0});
  if (std::all_of(all.begin(), all.end(), [](const Scalar& s) { return s.fixed; }))
    return {true, folded(*info, all), {}, 0};
  Instruction& code = add(Action::kernel, all, 1);
  code.kernel = info->kernel;
  const int out = code.out;
  for (const Scalar& s : in)
    if (!keep && !s.fixed && s.place.where == Operand::Where::reg) free_.push_back(s.place.index);
  return {false, 0, {Operand::Where::reg, out}, deepest(in)};
}

Scalar BytecodeWriter::emit(Action action, const std::vector<Scalar>& in, int index) {
  Instruction& code = add(action, in, 1);
  code.index = index;
  return {false, 0, {Operand::Where::reg, code.out}, deepest(in)};
}

Value BytecodeWriter::emit_colour(Action action, const std::vector<Scalar>& in, int index) {
  Instruction& code = add(action, in, 3);
  code.index = index;
  Value v;
  v.colour = true;
  for (int k = 0; k < 3; ++k)
    v.part[static_cast<std::size_t>(k)] = {false, 0, {Operand::Where::reg, code.out + k}, deepest(in)};
  return v;
}

Program BytecodeWriter::finish(const Value& value, bool colour) {
  program_.present = true;
  program_.colour = colour;
  program_.registers = registers_;
  program_.constant = program_.code.empty();
  for (std::size_t k = 0; k < (colour ? 3U : 1U); ++k) {
    program_.constant = program_.constant && value.part[k].fixed;
    program_.value[k] = std::isfinite(value.part[k].number) ? value.part[k].number : 0;
    program_.result[k] = place_of(value.part[k]);
  }
  return std::move(program_);
}

}  // namespace papilla::procedural_detail
