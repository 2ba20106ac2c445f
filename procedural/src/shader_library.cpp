// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <iterator>

#include "papilla/core/error.hpp"
#include "shader_writer.hpp"

namespace papilla::procedural_detail {
namespace {

/// Hashes and lattices are exact; sines and arc tangents are polynomials, as those of GPUs promise 2^-11 only.
constexpr std::string_view k_library = R"(
float finite(float v) {
return pick(abs(v) <= 3.0e38, v, 0.0);
}
float hypot(float x, float y) {
return sqrt(x * x + y * y);
}
float fract_of(float v) {
return v - floor(v);
}
float wrap(float cell, float count) {
return pick(count > 0.0, cell - count * floor(cell / max(count, 1.0)), cell);
}
uint whole(float v) {
return uint(int(clamp(v, -1.0e9, 1.0e9)));
}
uint lattice(float v) {
return uint(int(floor(clamp(v, -1.0e9, 1.0e9))));
}
float edge(float d, float texel) {
return clamp(d / texel + 0.5, 0.0, 1.0);
}
float smooth01(float t) {
float s = clamp(t, 0.0, 1.0);
return s * s * (3.0 - 2.0 * s);
}
float sine_between(float r) {
float q = r * r;
return r * (1.0 + q * (-0.16666666666 + q * (0.0083333333 + q * (-0.0001984126984 + q * (0.0000027557319 - q * 0.0000000250521)))));
}
float sin_turns(float turns) {
float t = turns - floor(turns + 0.5);
float folded = pick(t > 0.25, 0.5 - t, pick(t < -0.25, -0.5 - t, t));
return sine_between(6.283185307179586 * folded);
}
float k_sine(float a) {
float n = floor(a * 0.3183098861837907 + 0.5);
float r = ((a - n * 3.140625) - n * 0.000967502593994) - n * 0.00000015099579;
float odd = n - 2.0 * floor(n * 0.5);
return finite(pick(odd > 0.5, -sine_between(r), sine_between(r)));
}
float k_cosine(float a) {
float n = floor(a * 0.3183098861837907);
float r = ((a - (n + 0.5) * 3.140625) - (n + 0.5) * 0.000967502593994) - (n + 0.5) * 0.00000015099579;
float odd = n - 2.0 * floor(n * 0.5);
return finite(pick(odd > 0.5, sine_between(r), -sine_between(r)));
}
float k_tangent(float a) {
return finite(k_sine(a) / k_cosine(a));
}
float arc_of_ratio(float t) {
float u = pick(t > 0.4142135623730950, (t - 1.0) / (t + 1.0), t);
float q = u * u;
float s = u * (1.0 + q * (-0.333333333 + q * (0.2 + q * (-0.142857143 + q * (0.111111111 + q * (-0.0909090909 + q * 0.0769230769))))));
return pick(t > 0.4142135623730950, 0.7853981633974483 + s, s);
}
float k_arc_tangent(float a) {
float t = abs(a);
float s = pick(t > 1.0, 1.5707963267948966 - arc_of_ratio(1.0 / max(t, 1.0)), arc_of_ratio(min(t, 1.0)));
return pick(a < 0.0, -s, s);
}
float atan2_of(float y, float x) {
float ax = abs(x);
float ay = abs(y);
float s = arc_of_ratio(min(ax, ay) / max(max(ax, ay), 1.0e-37));
float first = pick(ay > ax, 1.5707963267948966 - s, s);
float upper = pick(x < 0.0, 3.141592653589793 - first, first);
return pick(y < 0.0, -upper, upper);
}
float k_arc_cosine(float a) {
float c = clamp(a, -1.0, 1.0);
return atan2_of(sqrt((1.0 - c) * (1.0 + c)), c);
}
float k_power(float a, float b) {
float size = abs(a);
if (b == 0.0) {
return 1.0;
}
if (size == 0.0) {
return 0.0;
}
float value = finite(exp2(b * log2(size)));
float odd = b - 2.0 * floor(b * 0.5);
if (a < 0.0) {
value = pick(b == floor(b), pick(odd > 0.5, -value, value), 0.0);
}
return value;
}
float k_quotient(float a, float b) {
return pick(b == 0.0, 0.0, a / pick(b == 0.0, 1.0, b));
}
float k_modulo(float a, float b) {
return pick(b == 0.0, 0.0, a - b * floor(a / pick(b == 0.0, 1.0, b)));
}
float k_bias(float a, float x) {
return pick(x <= 0.0, 0.0, k_power(max(x, 0.0), log(clamp(a, 1.0e-9, 1.0)) / -0.6931471805599453));
}
float k_gain(float a, float b) {
return pick(b < 0.5, k_bias(1.0 - a, 2.0 * b) * 0.5, 1.0 - k_bias(1.0 - a, 2.0 - 2.0 * b) * 0.5);
}
float k_step(float a, float b) {
return pick(a >= b, 1.0, 0.0);
}
float k_boxstep(float a, float b, float c) {
return pick(b == a, k_step(c, a), clamp((c - a) / pick(b == a, 1.0, b - a), 0.0, 1.0));
}
float k_clamp(float a, float b, float c) {
return pick(a < b, b, pick(a > c, c, a));
}
float k_smoothstep(float a, float b, float x) {
float t = (x - a) / pick(b == a, 1.0, b - a);
return pick(x < a, 0.0, pick(x >= b, 1.0, t * t * (3.0 - 2.0 * t)));
}
float k_hue(float r, float g, float b) {
float most = max(r, max(g, b));
float reach = most - min(r, min(g, b));
float unit = max(reach, 1.0e-30);
float sixth = pick(most == r, (g - b) / unit, pick(most == g, 2.0 + (b - r) / unit, 4.0 + (r - g) / unit));
return pick(reach <= 0.0, 0.0, k_modulo(sixth / 6.0, 1.0));
}
float k_saturation(float r, float g, float b) {
float most = max(r, max(g, b));
return k_quotient(most - min(r, min(g, b)), most);
}
float hsv_part(float h, float s, float v, float shift) {
float k = k_modulo(shift + 6.0 * h, 6.0);
return v - v * clamp(s, 0.0, 1.0) * max(0.0, min(min(k, 4.0 - k), 1.0));
}
float k_heartbeat(float a, float b) {
float m = k_modulo(a, b);
return pick(m > b * 0.5, k_sine(k_quotient(m * 12.566370614359172, b)), 0.0);
}
float k_linedist(float x1, float y1, float x2, float y2, float u, float v) {
float dx = x2 - x1;
float dy = y2 - y1;
float size = dx * dx + dy * dy;
float t = pick(size > 0.0, clamp(((u - x1) * dx + (v - y1) * dy) / max(size, 1.0e-37), 0.0, 1.0), 0.0);
return hypot(u - x1 - t * dx, v - y1 - t * dy);
}
float outside_of(float low, float high, float x) {
return max(max(min(low, high) - x, x - max(low, high)), 0.0);
}
uint mix_bits(uint a, uint b, uint seed) {
uint h = a * 0x9E3779B1u + b * 0x85EBCA77u + seed * 0xC2B2AE3Du;
h = h ^ (h >> 15u);
h = h * 0x2C1B3C6Du;
h = h ^ (h >> 12u);
h = h * 0x297A2D39u;
h = h ^ (h >> 15u);
return h;
}
float unit_number(uint h) {
return float(h >> 8u) * (1.0 / 16777216.0);
}
float fade(float t) {
return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}
float slope2(uint h, float dx, float dy) {
return float(int(h & 0xFFFFu) - 32768) / 32768.0 * dx + float(int(h >> 16u) - 32768) / 32768.0 * dy;
}
float slope_part(uint h) {
return float(int(h & 1023u) - 512) / 512.0;
}
float slope3(uint h, float dx, float dy, float dz) {
return slope_part(h) * dx + slope_part(h >> 10u) * dy + slope_part(h >> 20u) * dz;
}
float next_cell(float cell, float period) {
return pick(period > 0.0 && cell + 1.0 >= period, 0.0, cell + 1.0);
}
float noise2(float x, float y, float period_x, float period_y, uint seed) {
float px = clamp(x, -1.0e9, 1.0e9);
float py = clamp(y, -1.0e9, 1.0e9);
bool closed = period_x > 0.0 && period_y > 0.0;
float dx = px - floor(px);
float dy = py - floor(py);
float cx = wrap(floor(px), pick(closed, period_x, 0.0));
float cy = wrap(floor(py), pick(closed, period_y, 0.0));
uint x0 = lattice(cx);
uint y0 = lattice(cy);
uint x1 = lattice(next_cell(cx, pick(closed, period_x, 0.0)));
uint y1 = lattice(next_cell(cy, pick(closed, period_y, 0.0)));
float a = slope2(mix_bits(x0, y0, seed), dx, dy);
float b = slope2(mix_bits(x1, y0, seed), dx - 1.0, dy);
float c = slope2(mix_bits(x0, y1, seed), dx, dy - 1.0);
float d = slope2(mix_bits(x1, y1, seed), dx - 1.0, dy - 1.0);
float u = fade(dx);
float upper = a + u * (b - a);
float lower = c + u * (d - c);
return 1.5 * (upper + fade(dy) * (lower - upper));
}
float noise_layer(uint x0, uint x1, uint y0, uint y1, float dx, float dy, float dz, uint s) {
float a = slope3(mix_bits(x0, y0, s), dx, dy, dz);
float b = slope3(mix_bits(x1, y0, s), dx - 1.0, dy, dz);
float c = slope3(mix_bits(x0, y1, s), dx, dy - 1.0, dz);
float d = slope3(mix_bits(x1, y1, s), dx - 1.0, dy - 1.0, dz);
float u = fade(dx);
float upper = a + u * (b - a);
float lower = c + u * (d - c);
return upper + fade(dy) * (lower - upper);
}
float noise3(float x, float y, float z, float period_x, float period_y, uint seed) {
float px = clamp(x, -1.0e9, 1.0e9);
float py = clamp(y, -1.0e9, 1.0e9);
float pz = clamp(z, -1.0e9, 1.0e9);
float dx = px - floor(px);
float dy = py - floor(py);
float dz = pz - floor(pz);
float cx = wrap(floor(px), period_x);
float cy = wrap(floor(py), period_y);
uint x0 = lattice(cx);
uint y0 = lattice(cy);
uint x1 = lattice(next_cell(cx, period_x));
uint y1 = lattice(next_cell(cy, period_y));
uint s = seed + 0x68E31DA4u * lattice(pz);
float near = noise_layer(x0, x1, y0, y1, dx, dy, dz, s);
float beyond = noise_layer(x0, x1, y0, y1, dx, dy, dz - 1.0, s + 0x68E31DA4u);
return 1.5 * (near + fade(dz) * (beyond - near));
}
float turbulence_row(float x, float y, float cells, float octaves, bool absolute, uint seed) {
float sum = 0.0;
float frequency = cells;
float weight = 1.0;
for (int k = 0; k < 32; ++k) {
if (float(k) >= octaves) {
break;
}
uint hash = mix_bits(uint(k), seed, 41u);
float n = noise2(x * frequency + float(hash & 1023u) / 1024.0, y * frequency + float((hash >> 10u) & 1023u) / 1024.0, 0.0, 0.0, hash);
sum = sum + min(1.0, octaves - float(k)) * weight * pick(absolute, abs(n), n);
frequency = frequency * 2.0;
weight = weight * 0.5;
}
return sum;
}
float k_turbulence(float x, float y, float z, float octaves, bool in_space, bool absolute) {
float sum = 0.0;
float frequency = 1.0;
for (int k = 0; k < 30; ++k) {
if (float(k) >= octaves) {
break;
}
float sx = 0.171875 * float(k);
float sy = 0.37 + 0.328125 * float(k);
float n = 0.0;
if (in_space) {
n = noise3(x * frequency + sx, y * frequency + sy, z * frequency, 0.0, 0.0, uint(k));
} else {
n = noise2(x * frequency + sx, y * frequency + sy, 0.0, 0.0, uint(k));
}
sum = sum + clamp(octaves - float(k), 0.0, 1.0) / frequency * pick(absolute, abs(n), n);
frequency = frequency * 2.0;
}
return sum;
}
float k_roughness_of_highlight(float specular, float exponent) {
float peak = specular * (max(exponent, 0.0) + 2.0);
return pick(peak > 2.0, sqrt(sqrt(2.0 / max(peak, 2.0))), 1.0);
}
Channels k_nothing() {
Channels c;
c.main = 0.0;
c.bump = 0.0;
c.alpha = 0.0;
c.coloralpha = 0.0;
c.reflection = 0.0;
c.diffuse = 0.0;
c.specular = 0.0;
c.specularcoeff = 0.0;
c.friction = 0.0;
c.stiffness = 0.0;
c.damping = 0.0;
c.roughness = 0.0;
c.red = 0.0;
c.green = 0.0;
c.blue = 0.0;
return c;
}
)";

/// Kernels by what they become: capitals A to F are the inputs.
struct Call {
  std::string_view kernel, text;
};
constexpr Call k_calls[] = {{"+", "(A + B)"},
                            {"-", "(A - B)"},
                            {"*", "(A * B)"},
                            {"/", "k_quotient(A, B)"},
                            {"%", "k_modulo(A, B)"},
                            {"^", "k_power(A, B)"},
                            {"pow", "k_power(A, B)"},
                            {"mod", "k_modulo(A, B)"},
                            {"negate", "(-A)"},
                            {"square", "(A * A)"},
                            {"cube", "(A * A * A)"},
                            {"abs", "abs(A)"},
                            {"absturbulence", "k_turbulence(A, 0.0, 0.0, B, false, true)"},
                            {"absturbulence2d", "k_turbulence(A, B, 0.0, C, false, true)"},
                            {"absturbulence3d", "k_turbulence(A, B, C, D, true, true)"},
                            {"acos", "k_arc_cosine(A)"},
                            {"atan", "k_arc_tangent(A)"},
                            {"bias", "k_bias(A, B)"},
                            {"boxstep", "k_boxstep(A, B, C)"},
                            {"c", "k_cosine(A)"},
                            {"churn", "unit_number(mix_bits(lattice(A), 0u, 17u))"},
                            {"clamp", "k_clamp(A, B, C)"},
                            {"clampunit", "k_clamp(A, 0.0, 1.0)"},
                            {"coldist", "((A - D) * (A - D) + (B - E) * (B - E) + (C - F) * (C - F))"},
                            {"dist", "hypot(A - C, B - D)"},
                            {"floor", "floor(A)"},
                            {"gain", "k_gain(A, B)"},
                            {"gethsvhue", "k_hue(A, B, C)"},
                            {"gethsvsaturation", "k_saturation(A, B, C)"},
                            {"gethsvvalue", "max(A, max(B, C))"},
                            {"heartbeat", "k_heartbeat(A, B)"},
                            {"hsv_red", "hsv_part(A, B, C, 5.0)"},
                            {"hsv_green", "hsv_part(A, B, C, 3.0)"},
                            {"hsv_blue", "hsv_part(A, B, C, 1.0)"},
                            {"huedist", "(0.5 - abs(k_modulo(A - B, 1.0) - 0.5))"},
                            {"interpolate", "(A + C * (B - A))"},
                            {"linedist", "k_linedist(A, B, C, D, E, F)"},
                            {"log", "pick(A > 0.0, log(max(A, 1.0e-37)), 0.0)"},
                            {"max", "max(A, B)"},
                            {"min", "min(A, B)"},
                            {"moddist", "(1.0 - 1.7 * hypot(A - k_modulo(C, 1.0), B - k_modulo(D, 1.0)))"},
                            {"noise", "noise2(A, 0.37, 0.0, 0.0, 0u)"},
                            {"noise2d", "noise2(A, B, 0.0, 0.0, 0u)"},
                            {"noise3d", "noise3(A, B, C, 0.0, 0.0, 0u)"},
                            {"ovaldist", "hypot(k_quotient(E - A, C), k_quotient(F - B, D))"},
                            {"pulse", "(k_step(C, A) - k_step(C, B))"},
                            {"random", "unit_number(mix_bits(lattice(A), lattice(B), 31u + lattice(C)))"},
                            {"rectangledist", "max(outside_of(A, C, E), outside_of(B, D, F))"},
                            {"rectangledist2", "(outside_of(A, C, E) + outside_of(B, D, F))"},
                            {"region", "unit_number(mix_bits(lattice(C * A), lattice(D * B), 29u))"},
                            {"s", "k_sine(A)"},
                            {"smoothpulse", "(k_smoothstep(A, B, D) - k_smoothstep(C, C + B - A, D))"},
                            {"smoothstep", "k_smoothstep(A, B, C)"},
                            {"sqrt", "sqrt(max(A, 0.0))"},
                            {"step", "k_step(A, B)"},
                            {"tan", "k_tangent(A)"},
                            {"turbulence", "k_turbulence(A, 0.0, 0.0, B, false, false)"},
                            {"turbulence2d", "k_turbulence(A, B, 0.0, C, false, false)"},
                            {"turbulence3d", "k_turbulence(A, B, C, D, true, false)"}};

bool is_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.';
}

std::string_view wgsl_type(std::string_view type) {
  constexpr std::pair<std::string_view, std::string_view> k_types[] = {
      {"float", "f32"}, {"int", "i32"}, {"uint", "u32"}, {"bool", "bool"}, {"Channels", "Channels"}, {"void", ""}};
  const auto it = std::find_if(std::begin(k_types), std::end(k_types), [&](const auto& t) { return t.first == type; });
  return it == std::end(k_types) ? std::string_view("?") : it->second;
}
bool is_type(std::string_view word) { return wgsl_type(word) != "?"; }

/// Casts: float(…) is f32(…).
std::string with_casts(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at;
    while (end < text.size() && is_word(text[end])) ++end;
    const std::string_view word = text.substr(at, std::max<std::size_t>(end - at, 1));
    if (end > at && end < text.size() && text[end] == '(' && is_type(word) && word != "Channels")
      out += wgsl_type(word);
    else
      out += word;
    at += word.size();
  }
  return out;
}

/// float a, uint b  ->  a: f32, b: u32
std::string wgsl_parameters(std::string_view list) {
  std::string out;
  while (!list.empty()) {
    const std::size_t comma = std::min(list.find(','), list.size());
    std::string_view one = list.substr(0, comma);
    list.remove_prefix(std::min(list.size(), comma + 1));
    while (one.starts_with(' ')) one.remove_prefix(1);
    const std::size_t blank = one.find(' ');
    out += (out.empty() ? "" : ", ") + std::string(one.substr(blank + 1)) + ": " +
           std::string(wgsl_type(one.substr(0, blank)));
  }
  return out;
}

std::string wgsl_line(std::string_view line, bool inside) {
  if (line.starts_with("for (int ")) {
    std::string text = "for (var " + std::string(line.substr(9));
    text.insert(text.find(' ', 9), ": i32");
    for (const std::string_view step : {"++", "--"})
      if (const std::size_t at = text.rfind("; " + std::string(step)); at != std::string::npos) {
        const std::size_t close = text.rfind(')');
        const std::string name = text.substr(at + 4, close - at - 4);
        text = text.substr(0, at + 2) + name + std::string(step) + text.substr(close);
      }
    return with_casts(text);
  }
  const std::size_t blank = line.find(' ');
  const std::string_view first = line.substr(0, blank);
  if (blank == std::string_view::npos || !is_type(first)) return with_casts(line);
  const std::string_view rest = line.substr(blank + 1);
  std::size_t end = 0;
  while (end < rest.size() && is_word(rest[end])) ++end;
  const std::string name(rest.substr(0, end));
  const std::string type(wgsl_type(first));
  if (end < rest.size() && rest[end] == '(' && !inside) {
    const std::size_t close = rest.find(')');
    return "fn " + name + "(" + wgsl_parameters(rest.substr(end + 1, close - end - 1)) + ")" +
           (type.empty() ? "" : " -> " + type) + with_casts(rest.substr(close + 1));
  }
  const std::string kind = inside ? "var " : "var<private> ";
  if (end < rest.size() && rest[end] == '[')
    return kind + name + ": array<" + type + ", " + std::string(rest.substr(end + 1, rest.find(']') - end - 1)) + ">;";
  return kind + name + ": " + type + with_casts(rest.substr(end));
}

}  // namespace

std::string_view shader_library() noexcept { return k_library; }

std::string kernel_call(std::string_view kernel, const std::vector<std::string>& in) {
  const auto it =
      std::find_if(std::begin(k_calls), std::end(k_calls), [&](const Call& call) { return call.kernel == kernel; });
  std::string out;
  for (std::size_t at = 0; at < it->text.size(); ++at) {
    const char c = it->text[at];
    const bool alone =
        (at == 0 || !is_word(it->text[at - 1])) && (at + 1 == it->text.size() || !is_word(it->text[at + 1]));
    if (c >= 'A' && c <= 'F' && alone)
      out += in.at(static_cast<std::size_t>(c - 'A'));
    else
      out += c;
  }
  return out;
}

std::string to_wgsl(std::string_view glsl) {
  std::string out;
  int depth = 0;
  while (!glsl.empty()) {
    const std::size_t end = std::min(glsl.find('\n'), glsl.size());
    const std::string_view line = glsl.substr(0, end);
    glsl.remove_prefix(std::min(glsl.size(), end + 1));
    out += (line.starts_with("//") ? std::string(line) : wgsl_line(line, depth > 0)) + "\n";
    if (!line.starts_with("//"))
      depth += static_cast<int>(std::count(line.begin(), line.end(), '{') - std::count(line.begin(), line.end(), '}'));
  }
  return out;
}

std::string shader_constant_array(ShaderLanguage language, std::string_view name, std::string_view type,
                                  const std::vector<ShaderValue>& values) {
  const std::string size = std::to_string(values.size());
  std::string list;
  for (const ShaderValue& value : values) list += (list.empty() ? "" : ", ") + value.text;
  if (language == ShaderLanguage::glsl)
    return "const " + std::string(type) + " " + std::string(name) + "[" + size + "] = " + std::string(type) + "[" +
           size + "](" + list + ");\n";
  return "const " + std::string(name) + " = array<" + std::string(wgsl_type(type)) + ", " + size + ">(" + list + ");\n";
}

}  // namespace papilla::procedural_detail

namespace papilla {
namespace {

using namespace procedural_detail;

constexpr std::string_view k_channels_glsl = R"(
struct Channels {
  float main, bump, alpha, coloralpha, reflection, diffuse, specular, specularcoeff;
  float friction, stiffness, damping, roughness;
  float red, green, blue;
};
float pick(bool condition, float first, float second) { return condition ? first : second; }
)";
constexpr std::string_view k_channels_wgsl = R"(
struct Channels {
  main: f32, bump: f32, alpha: f32, coloralpha: f32, reflection: f32, diffuse: f32, specular: f32,
  specularcoeff: f32, friction: f32, stiffness: f32, damping: f32, roughness: f32, red: f32, green: f32, blue: f32,
}
fn pick(condition: bool, first: f32, second: f32) -> f32 { return select(second, first, condition); }
)";

constexpr std::string_view k_shown = R"(
vec4 papilla_shown(int channel, Channels c) {
  if (channel == 0) { return vec4(c.red, c.green, c.blue, c.alpha); }
  float v = c.main;
  if (channel == 2) { v = c.bump; }
  if (channel == 3) { v = c.alpha; }
  if (channel == 4) { v = c.coloralpha; }
  if (channel == 5) { v = c.reflection; }
  if (channel == 6) { v = c.diffuse; }
  if (channel == 7) { v = c.specular; }
  if (channel == 8) { v = c.specularcoeff; }
  if (channel == 9) { v = c.friction; }
  if (channel == 10) { v = c.stiffness; }
  if (channel == 11) { v = c.damping; }
  if (channel == 12) { v = c.roughness; }
  return vec4(v, v, v, 1.0);
}
)";

/// The texture at a place, in the part that both languages share.
std::string texture_function(const std::string& root, double step_x, double step_y, int width, int height,
                             double texel) {
  const auto text = [](double v) { return ShaderValue(v).text; };
  return "Channels papilla_texture_at(float x, float y) {\ng_column = floor(x / " + text(step_x) +
         ");\ng_row = floor(y / " + text(step_y) + ");\ng_columns = " + text(width) + ";\ng_rows = " + text(height) +
         ";\ng_shorter = " + text(std::min(width, height)) + ";\ng_octaveadd = " + text(-std::log2(texel * 256)) +
         ";\ng_posx = x;\ng_posy = y;\ng_posz = 0.0;\ng_sky = 1.0;\ng_flow = 1.0;\ng_lower = k_nothing();\nChannels c "
         "= " +
         root +
         "(x, y);\nc.friction = clamp(c.friction, 0.0, 10.0);\nc.stiffness = clamp(c.stiffness, 0.0, 10.0);\n"
         "c.damping = clamp(c.damping, 0.0, 10.0);\nreturn c;\n}\n";
}

}  // namespace

std::string shader_source(const ProceduralTexture& texture, const ShaderOptions& options) {
  if (options.width < 1 || options.height < 1 || options.width > 65536 || options.height > 65536)
    throw InvalidInput("shader_source: each side of the picture must be 1 to 65536 texels");
  const Graph& graph = texture.graph();
  const bool stretch = graph.nodes[static_cast<std::size_t>(graph.root)]->stretch;
  const double shorter = std::min(options.width, options.height);
  const double step_x = 1 / (stretch ? options.width : shorter), step_y = 1 / (stretch ? options.height : shorter);
  const double texel = std::max(step_x, step_y);
  ShaderWriter writer(graph, options.language);
  std::string globals;
  for (const char* name : {"g_column", "g_row", "g_columns", "g_rows", "g_shorter", "g_octaveadd", "g_posx", "g_posy",
                           "g_posz", "g_sky", "g_flow"})
    globals += "float " + std::string(name) + ";\n";
  writer.append(shader_library());
  writer.append(globals + "Channels g_lower;\n");
  const std::string root =
      writer.channels_function({graph.root, texel, options.width * step_x, options.height * step_y}, k_all_channels);
  writer.append(texture_function(root, step_x, step_y, options.width, options.height, texel));
  const auto text = [](double v) { return ShaderValue(v).text; };
  if (options.language == ShaderLanguage::glsl)
    return "#version 300 es\nprecision highp float;\nprecision highp int;\n" + std::string(k_channels_glsl) +
           writer.text() + "Channels papilla_texture(vec2 place) { return papilla_texture_at(place.x, place.y); }\n" +
           std::string(k_shown) +
           "\nuniform int u_channel;\nlayout(location = 0) out vec4 papilla_color;\nvoid main() {\n" +
           "  papilla_color = papilla_shown(u_channel, papilla_texture_at(gl_FragCoord.x * " + text(step_x) + ", (" +
           text(options.height) + " - gl_FragCoord.y) * " + text(step_y) + "));\n}\n";
  std::string shown(k_shown);
  const auto put = [&shown](std::string_view from, std::string_view to) {
    for (std::size_t at = shown.find(from); at != std::string::npos; at = shown.find(from, at + to.size()))
      shown.replace(at, from.size(), to);
  };
  put("vec4 papilla_shown(int channel, Channels c) {", "fn papilla_shown(channel: i32, c: Channels) -> vec4f {");
  put("float v = c.main", "var v = c.main");
  put("return vec4(", "return vec4f(");
  return std::string(k_channels_wgsl) + writer.text() +
         "fn papilla_texture(place: vec2f) -> Channels { return papilla_texture_at(place.x, place.y); }\n" + shown +
         "\n@group(0) @binding(0) var<uniform> u_channel: i32;\n@vertex fn papilla_corner(@builtin(vertex_index) k: "
         "u32) -> "
         "@builtin(position) vec4f {\n  return vec4f(f32((k << 1u) & 2u) * 2.0 - 1.0, f32(k & 2u) * 2.0 - 1.0, 0.0, "
         "1.0);\n}\n"
         "@fragment fn papilla_fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {\n"
         "  return papilla_shown(u_channel, papilla_texture_at(at.x * " +
         text(step_x) + ", at.y * " + text(step_y) + "));\n}\n";
}

std::vector<ShaderSupport> shader_support() {
  std::vector<ShaderSupport> support;
  for (const TypeInfo& type : texture_types()) {
    std::string recipe(type.name);
    if (type.name == "multi") recipe += "|textures=[col]";
    ShaderSupport entry{type.name, ""};
    try {
      shader_source(compile_texture(recipe, RecipeLibrary::builtin()));
    } catch (const InvalidInput& refusal) {
      entry.reason = refusal.what();
    }
    support.push_back(std::move(entry));
  }
  return support;
}

}  // namespace papilla
