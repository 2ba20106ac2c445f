// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace papilla::procedural_detail {

/// Points that are evaluated together: small enough for the first-level cache, long enough that dispatch costs nothing.
inline constexpr int k_row = 256;
/// Information numbers of a texture, get() and set().
inline constexpr int k_infos = 32;
inline constexpr int k_most_arguments = 6;

/// out[i] = f(in[0][i], in[1][i], …). `out` is none of the inputs.
using Kernel = void (*)(double* out, const double* const* in, int n);

/// Input rows of a formula, beside its registers.
enum class FrameRow : std::uint8_t { u, v, self, main, a, b, id, normaldot, f1, f2, f3, f4, info0 };
inline constexpr int k_frame_rows = static_cast<int>(FrameRow::info0) + k_infos;
enum class BlockRow : std::uint8_t {
  column,
  row,
  columns,
  rows,
  shorter,
  octaveadd,
  posx,
  posy,
  posz,
  sky,
  flow,
  lower_main,
  lower_bump,
  lower_alpha,
  lower_coloralpha,
  lower_reflection,
  lower_diffuse,
  lower_specular,
  lower_specularcoeff,
  lower_friction,
  lower_stiffness,
  lower_damping,
  lower_roughness,
  lower_red,
  lower_green,
  lower_blue
};
inline constexpr int k_block_rows = static_cast<int>(BlockRow::lower_blue) + 1;

/// The storage of an operand.
struct Operand {
  enum class Where : std::uint8_t { reg, constant, frame, block } where = Where::reg;
  int index = 0;
};

enum class Action : std::uint8_t {
  kernel,
  set_info,
  neighbourhood,
  rotate,
  zoom,
  sphere,
  texture,
  colmap,
  texmap_color,
  texmap_channel,
  texture_color
};

struct Instruction {
  Action action = Action::kernel;
  Kernel kernel = nullptr;
  int out = 0;    ///< First register that is written; colours take three.
  int index = 0;  ///< Texture, channel or information number.
  int arguments = 0;
  std::array<Operand, k_most_arguments> in{};
};

/// A compiled formula.
struct Program {
  std::vector<Instruction> code;
  int registers = 0;
  bool colour = false;
  std::array<Operand, 3> result{};
  bool constant = true;  ///< The result is `value`; there is no code.
  std::array<double, 3> value{};
  bool present = false;  ///< False: the recipe does not have this formula.
};

/// A function that works number by number: name, number of arguments, kernel, and which frame rows are handed over
/// behind the arguments ("uv" or "").
struct KernelInfo {
  std::string_view name;
  int arity;
  Kernel kernel;
  std::string_view extra;
};

/// nullptr when there is none of that name.
const KernelInfo* find_kernel(std::string_view name) noexcept;
/// Of the first name that has this kernel. @pre it is one of the table.
std::string_view kernel_name(Kernel kernel) noexcept;

}  // namespace papilla::procedural_detail
