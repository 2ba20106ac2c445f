// SPDX-License-Identifier: MIT
#include "shader_writer.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "papilla/core/error.hpp"

namespace papilla::procedural_detail {
namespace {

constexpr std::size_t k_most_instances = 1024;
constexpr std::size_t k_most_text_of_shader = std::size_t{8} << 20;
constexpr std::size_t k_red = static_cast<std::size_t>(Channel::color);
constexpr std::size_t at(Channel c) { return static_cast<std::size_t>(c); }
constexpr unsigned bit(Channel c) { return 1U << static_cast<unsigned>(c); }

/// Members of Channels, in the order of ChannelRows.
constexpr std::array<std::string_view, k_channels + 2> k_members = {
    "main",     "bump",      "alpha",   "coloralpha", "reflection", "diffuse", "specular", "specularcoeff",
    "friction", "stiffness", "damping", "roughness",  "red",        "green",   "blue"};

std::string number(double value) { return ShaderValue(value).text; }

bool is_name(char c) { return (c >= 'a' && c <= 'z') || c == '_' || (c >= '0' && c <= '9'); }

/// `$name` by its value; of names that are none, `$t…` begins with the prefix.
std::string filled_in(std::string_view text, const ShaderValues& values, const std::string& prefix) {
  std::string out;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t dollar = std::min(text.find('$', from), text.size());
    out += text.substr(from, dollar - from);
    if (dollar == text.size()) break;
    std::size_t end = dollar + 1;
    while (end < text.size() && is_name(text[end])) ++end;
    const std::string_view name = text.substr(dollar + 1, end - dollar - 1);
    const auto it = std::find_if(values.begin(), values.end(), [&](const auto& v) { return v.first == name; });
    if (it != values.end())
      out +=
          it->second.text.find('$') == std::string::npos ? it->second.text : filled_in(it->second.text, values, prefix);
    else
      out += prefix + std::string(name.substr(1));
    from = end;
  }
  return out;
}

std::string prefix_of(int instance) { return "t" + std::to_string(instance) + "_"; }

std::string frame_name(int instance, FrameRow row) {
  constexpr std::string_view names[] = {"u", "v", "self", "main", "a", "b", "id", "normaldot"};
  const auto index = static_cast<std::size_t>(row);
  if (index < std::size(names)) return prefix_of(instance) + std::string(names[index]);
  return prefix_of(instance) + "info[" + std::to_string(index - static_cast<std::size_t>(FrameRow::info0)) + "]";
}

std::string block_name(BlockRow row) {
  constexpr std::string_view names[] = {"g_column", "g_row",  "g_columns", "g_rows", "g_shorter", "g_octaveadd",
                                        "g_posx",   "g_posy", "g_posz",    "g_sky",  "g_flow"};
  const auto index = static_cast<std::size_t>(row);
  if (index < std::size(names)) return std::string(names[index]);
  return "g_lower." + std::string(k_members[index - static_cast<std::size_t>(BlockRow::lower_main)]);
}

bool is_floor_of(const Program& program, std::size_t before, const Operand& operand) {
  if (operand.where == Operand::Where::constant) return true;
  if (operand.where != Operand::Where::reg) return false;
  for (std::size_t k = before; k-- > 0;)
    if (program.code[k].out == operand.index)
      return program.code[k].action == Action::kernel && kernel_name(program.code[k].kernel) == "floor";
  return false;
}

}  // namespace

ShaderValue::ShaderValue(double value) {
  const float single = static_cast<float>(std::clamp(value, -3e38, 3e38));
  char digits[48];
  const auto [end, unused] = std::to_chars(digits, digits + sizeof digits, single);
  text.assign(digits, end);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  if (const std::size_t e = text.find('e'); e != std::string::npos && text.find('.') == std::string::npos)
    text.insert(e, ".0");
  if (text.front() == '-') text = "(" + text + ")";
}
ShaderValue::ShaderValue(int value) : text(std::to_string(value)) {}
ShaderValue::ShaderValue(std::uint32_t bits) : text(std::to_string(bits) + "u") {}
ShaderValue::ShaderValue(bool flag) : text(flag ? "true" : "false") {}

std::string PatternShader::filled(std::string_view text, const ShaderValues& values) const {
  ShaderValues all = values;
  const auto frame = [&](FrameRow row) { return frame_name(instance_, row); };
  all.emplace_back("x", frame(FrameRow::u));
  all.emplace_back("y", frame(FrameRow::v));
  all.emplace_back("out", frame(FrameRow::self));
  all.emplace_back("id", frame(FrameRow::id));
  return filled_in(text, all, prefix_of(instance_));
}
void PatternShader::add(std::string_view statements, const ShaderValues& values) {
  statements_ += filled(statements, values);
}
void PatternShader::add_function(std::string_view text, const ShaderValues& values) {
  writer_.append(filled(text, values));
}
void PatternShader::add_array(std::string_view name, std::string_view type, const std::vector<ShaderValue>& values) {
  writer_.append_array(filled(name, {}), type, values);
}
bool PatternShader::keeps_infos() const { return writer_.node(texture_).uses_infos; }
void PatternShader::set_info(int index, const std::string& expression) {
  if (keeps_infos() && index < k_infos) add("$tinfo[" + std::to_string(index) + "] = " + expression + ";\n");
}
std::string PatternShader::noise(const std::string& x, const std::string& y, const Octave& o, double z) const {
  std::string call = (z == 0 ? "noise2(" : "noise3(") + x + " * " + number(o.frequency_x) + " + " + number(o.shift_x) +
                     ", " + y + " * " + number(o.frequency_y) + " + " + number(o.shift_y) + ", ";
  if (z != 0) call += number(z * o.frequency_x) + ", ";
  return filled(call + number(o.period_x) + ", " + number(o.period_y) + ", " + ShaderValue(o.seed).text + ")", {});
}
std::string PatternShader::formula(const Program& program, const std::vector<std::string>& distances) {
  return writer_.program(program, instance_, distances, statements_)[0];
}
std::string PatternShader::channels(int texture, const std::string& x, const std::string& y, double inner_texel) {
  return writer_.channels_function({texture, inner_texel, 1, 1}, k_all_channels) + "(" + x + ", " + y + ")";
}
void PatternShader::refuse(const std::string& reason) const { writer_.refuse(texture_, reason); }

void ShaderWriter::append(std::string_view glsl) {
  if (text_.size() + glsl.size() > k_most_text_of_shader)
    throw InvalidInput("shader: the recipe becomes more than 8 MiB of text");
  text_ += language_ == ShaderLanguage::glsl ? std::string(glsl) : to_wgsl(glsl);
}
void ShaderWriter::append_array(std::string_view name, std::string_view type, const std::vector<ShaderValue>& values) {
  text_ += shader_constant_array(language_, name, type, values);
}

void ShaderWriter::refuse(int index, const std::string& reason) const {
  throw InvalidInput("shader: '" + std::string(node(index).type->name) + "' can't be exported: " + reason);
}

int ShaderWriter::number_of(const ShaderInstance& wanted) {
  const auto [it, is_new] = numbers_.try_emplace(wanted, static_cast<int>(instances_.size()));
  if (!is_new) return it->second;
  if (instances_.size() >= k_most_instances) refuse(wanted.node, "the shader would hold more than 1024 textures");
  instances_.push_back(wanted);
  const int made = it->second;
  write_frame(made);
  write_prepare(made);
  write_pattern(made);
  write_main(made);
  return made;
}

/// A texture that the instance's formulas or layers show.
ShaderInstance ShaderWriter::inner(int index, int texture) const {
  const ShaderInstance& outer = instance(index);
  const Node& n = node(outer.node);
  return {texture, outer.texel * std::max(std::abs(n.inverse_scale_x), std::abs(n.inverse_scale_y)),
          outer.extent_x * std::abs(n.inverse_scale_x), outer.extent_y * std::abs(n.inverse_scale_y)};
}

/// Private variables of an instance, as Evaluator::Frame has rows.
void ShaderWriter::write_frame(int index) {
  const std::string t = prefix_of(index);
  std::string out = "\n// " + std::string(node(instance(index).node).type->name) + "\n";
  for (const char* row : {"u", "v", "self", "main", "a", "b", "id", "normaldot"}) out += "float " + t + row + ";\n";
  if (node(instance(index).node).uses_infos) out += "float " + t + "info[" + std::to_string(k_infos) + "];\n";
  if (node(instance(index).node).layered) out += "Channels " + t + "below;\n";
  append(out);
}

std::string ShaderWriter::operand(const Operand& o, int index, const std::vector<std::string>& distances) const {
  switch (o.where) {
    case Operand::Where::reg: return "r" + std::to_string(o.index);
    case Operand::Where::constant: return number(graph_.constants[static_cast<std::size_t>(o.index)]);
    case Operand::Where::block: return block_name(static_cast<BlockRow>(o.index));
    case Operand::Where::frame: break;
  }
  const auto row = static_cast<FrameRow>(o.index);
  if (row >= FrameRow::f1 && row <= FrameRow::f4) {
    const auto k = static_cast<std::size_t>(o.index) - static_cast<std::size_t>(FrameRow::f1);
    return k < distances.size() ? distances[k] : "0.0";
  }
  return frame_name(index, row);
}

std::string ShaderWriter::instruction(const Instruction& code, const Program& program, std::size_t place, int index,
                                      const std::vector<std::string>& distances) {
  std::vector<std::string> in;
  for (int k = 0; k < code.arguments; ++k)
    in.push_back(operand(code.in[static_cast<std::size_t>(k)], index, distances));
  const int self = instance(index).node;
  const std::string out = "r" + std::to_string(code.out), t = prefix_of(index);
  const auto reg = [&](int k) { return "r" + std::to_string(code.out + k); };
  const ShaderValues values{{"out", out},
                            {"a", in.empty() ? "0.0" : in[0]},
                            {"b", in.size() > 1 ? in[1] : "0.0"},
                            {"c", in.size() > 2 ? in[2] : "0.0"}};
  const auto colour = [&](const std::string& call) {
    const std::string held = "held" + std::to_string(programs_++);
    return "Channels " + held + " = " + call + ";\n" + reg(0) + " = " + held + ".red;\n" + reg(1) + " = " + held +
           ".green;\n" + reg(2) + " = " + held + ".blue;\n";
  };
  const std::string here = "(" + t + "u, " + t + "v)";
  switch (code.action) {
    case Action::kernel: {
      const std::string_view name = kernel_name(code.kernel);
      if (name == "churn" && !is_floor_of(program, place, code.in[0]))
        refuse(self, "churn() of a number that is no floor() depends on all bits of a double");
      return out + " = " + kernel_call(name, in) + ";\n";
    }
    case Action::set_info:
      return (node(self).uses_infos ? t + "info[" + std::to_string(code.index) + "] = finite(" + in[0] + ");\n" : "") +
             out + " = 1.0;\n";
    case Action::neighbourhood: refuse(self, "nearmean() and its kin need the whole picture");
    case Action::rotate:
      return filled_in(
          "{\nfloat co = k_cosine(finite($c));\nfloat si = k_sine(finite($c));\nfloat dx = $tu - $a;\n"
          "float dy = $tv - $b;\n$tu = finite($a + co * dx - si * dy);\n$tv = finite($b + si * dx + co * dy);\n}\n"
          "$out = 0.0;\n",
          values, t);
    case Action::zoom:
      return filled_in(
          "{\nfloat zx = finite($a + ($tu - $a) * $c);\nfloat zy = finite($b + ($tv - $b) * $c);\n$tu = zx;\n"
          "$tv = zy;\n}\n$out = 0.0;\n",
          values, t);
    case Action::sphere:
      return filled_in(
          "{\nfloat dx = $tu - $a;\nfloat dy = $tv - $b;\n"
          "float bulge = 2.0 / (1.0 + sqrt(max(0.0, 1.0 - min(1.0, 4.0 * (dx * dx + dy * dy)))));\n"
          "$tu = finite($a + dx * bulge);\n$tv = finite($b + dy * bulge);\n}\n$out = 0.0;\n",
          values, t);
    case Action::texture: return out + " = " + main_function(inner(index, code.index)) + here + ";\n";
    case Action::colmap: {
      const std::size_t count = node(self).colours.size();
      const double steps = static_cast<double>(count) - 1;
      std::string text = "{\nfloat place = clamp(finite(" + in[0] + "), 0.0, 1.0) * " + number(steps) + ";\n" +
                         "int first = int(min(floor(place), " + number(std::max(0.0, steps - 1)) + "));\n" +
                         "int second = min(first + 1, " + std::to_string(count - 1) + ");\n" +
                         "float share = place - float(first);\n";
      const std::string k = std::to_string(self);
      if (!has_colours_[static_cast<std::size_t>(self)]) {
        has_colours_[static_cast<std::size_t>(self)] = true;
        for (std::size_t part = 0; part < 3; ++part) {
          std::vector<ShaderValue> list;
          for (const Rgb& rgb : node(self).colours) list.emplace_back(rgb[part]);
          append_array("cols" + k + "_" + std::to_string(part), "float", list);
        }
      }
      for (int part = 0; part < 3; ++part) {
        const std::string name = "cols" + k + "_" + std::to_string(part);
        text += reg(part) + " = " + name + "[first] + share * (" + name + "[second] - " + name + "[first]);\n";
      }
      return text + "}\n";
    }
    case Action::texture_color:
      return colour(channels_function(inner(index, node(self).textures[static_cast<std::size_t>(code.index)]),
                                      1U << at(Channel::color)) +
                    here);
    case Action::texmap_color: return colour(texmap_function(index, 1U << at(Channel::color)) + "(" + in[0] + ")");
    case Action::texmap_channel:
      return out + " = " + texmap_function(index, 1U << static_cast<unsigned>(code.index)) + "(" + in[0] + ")." +
             std::string(k_members[static_cast<std::size_t>(code.index)]) + ";\n";
  }
  return "";
}

std::vector<std::string> ShaderWriter::program(const Program& program, int index,
                                               const std::vector<std::string>& distances, std::string& statements) {
  std::vector<std::string> results;
  const std::size_t parts = program.colour ? 3 : 1;
  if (program.constant) {
    for (std::size_t k = 0; k < parts; ++k) results.push_back(number(program.value[k]));
    return results;
  }
  const std::string id = "p" + std::to_string(programs_++) + "_";
  for (std::size_t k = 0; k < parts; ++k) {
    results.push_back(id + std::to_string(k));
    statements += "float " + results.back() + ";\n";
  }
  statements += "{\n";
  for (int r = 0; r < program.registers; ++r) statements += "float r" + std::to_string(r) + ";\n";
  for (std::size_t k = 0; k < program.code.size(); ++k)
    statements += instruction(program.code[k], program, k, index, distances);
  for (std::size_t k = 0; k < parts; ++k)
    statements += results[k] + " = finite(" + operand(program.result[k], index, distances) + ");\n";
  statements += "}\n";
  return results;
}

void ShaderWriter::assign(const Program& formula, int index, const std::vector<std::string>& targets,
                          std::string& statements) {
  const std::vector<std::string> results = program(formula, index, {}, statements);
  for (std::size_t k = 0; k < results.size(); ++k) statements += targets[k] + " = " + results[k] + ";\n";
}

/// Evaluator::prepare().
void ShaderWriter::write_prepare(int index) {
  const Node& n = node(instance(index).node);
  const ShaderInstance within = inner(index, 0);
  const std::string t = prefix_of(index);
  std::string body = "void " + t + "prepare(float x, float y) {\n";
  std::string x = "x", y = "y";
  if (n.sin_rot != 0) {
    const ShaderValues turn{{"c", n.cos_rot}, {"s", n.sin_rot}};
    body += filled_in(
        "float px = 0.5 + $c * (x - 0.5) - $s * (y - 0.5);\nfloat py = 0.5 + $s * (x - 0.5) + $c * (y - 0.5);\n", turn,
        t);
    x = "px", y = "py";
  }
  body += t + "u = finite(" + x + " * " + number(n.inverse_scale_x) + " + " + number(n.du) + ");\n";
  body += t + "v = finite(" + y + " * " + number(n.inverse_scale_y) + " + " + number(n.dv) + ");\n";
  if (n.seamless)
    body += filled_in("$tu = finite($tu - $w * floor($tu / $w));\n$tv = finite($tv - $h * floor($tv / $h));\n",
                      {{"w", within.extent_x}, {"h", within.extent_y}}, t);
  if (n.uses_infos)
    body += filled_in("for (int k = 0; k < $count; ++k) {\n$tinfo[k] = 0.0;\n}\n", {{"count", k_infos}}, t);
  body += t + "id = 0.0;\n";
  if (n.uses_normal) {
    double dot = 0;
    for (std::size_t k = 0; k < 3; ++k) dot -= n.dirt[k] * n.normal[k];
    body += t + "normaldot = " + number(dot) + ";\n";
  }
  const auto formula = [&](const Program& p, const char* name) {
    if (p.present)
      assign(p, index, {t + name}, body);
    else
      body += t + name + " = 0.0;\n";
  };
  formula(n.a, "a");
  formula(n.b, "b");
  std::vector<std::string> moved_x, moved_y;
  if (n.perturb_x.present) moved_x = program(n.perturb_x, index, {}, body);
  if (n.perturb_y.present) moved_y = program(n.perturb_y, index, {}, body);
  if (!moved_x.empty()) body += t + "u = " + moved_x[0] + ";\n";
  if (!moved_y.empty()) body += t + "v = " + moved_y[0] + ";\n";
  append(body + "}\n");
}

/// Evaluator::layers(): statements that fill the instance's `below`.
std::string ShaderWriter::layers(int index) {
  const Node& n = node(instance(index).node);
  const std::string t = prefix_of(index), here = "(at_u, at_v)";
  std::string body = "float at_u = " + t + "u;\nfloat at_v = " + t + "v;\nChannels outside = g_lower;\n";
  for (std::size_t k = 0; k < n.textures.size(); ++k) {
    const Node& top = node(n.textures[k]);
    const std::string call = channels_function(inner(index, n.textures[k]), k_all_channels) + here;
    if (k == 0) {
      body += t + "below = " + call + ";\n";
    } else if (top.cuts) {
      body += filled_in("Channels $layer = $call;\n$tbelow.alpha = $tbelow.alpha * (1.0 - $layer.alpha);\n",
                        {{"layer", "layer" + std::to_string(k)}, {"call", call}}, t);
    } else {
      const std::string layer = "layer" + std::to_string(k);
      const ShaderValues names{{"layer", layer}};
      body += filled_in("Channels $layer = $call;\nfloat cover_$layer = $layer.alpha * $layer.coloralpha;\n",
                        {{"layer", layer}, {"call", call}}, t);
      for (std::size_t c = 0; c < k_channels + 2; ++c) {
        const std::size_t channel = std::min(c, k_red);
        if (channel == at(Channel::alpha) || channel == at(Channel::coloralpha)) continue;
        const ShaderValues part{{"layer", layer},
                                {"part", std::string(k_members[c])},
                                {"cover", channel == k_red ? "cover_" + layer : layer + ".alpha"}};
        switch (top.blend[channel]) {
          case Blend::off: break;
          case Blend::interpolate:
            body += filled_in("$tbelow.$part = $tbelow.$part + $cover * ($layer.$part - $tbelow.$part);\n", part, t);
            break;
          case Blend::add:
            body += filled_in("$tbelow.$part = $tbelow.$part + $cover * $layer.$part;\n", part, t);
            break;
          case Blend::subtract:
            body += filled_in("$tbelow.$part = $tbelow.$part - $cover * $layer.$part;\n", part, t);
            break;
        }
      }
      body += filled_in(
          "float before_$layer = $tbelow.alpha * $tbelow.coloralpha;\n"
          "$tbelow.alpha = $tbelow.alpha + $layer.alpha * (1.0 - $tbelow.alpha);\n"
          "$tbelow.coloralpha = pick($tbelow.alpha > 0.0, (before_$layer + cover_$layer * (1.0 - before_$layer)) "
          "/ max($tbelow.alpha, 1.0e-30), 0.0);\n",
          names, t);
    }
    body += "g_lower = " + t + "below;\n";
  }
  return body + "g_lower = outside;\n";
}

/// Evaluator::pattern_and_main().
void ShaderWriter::write_pattern(int index) {
  const Node& n = node(instance(index).node);
  const ShaderInstance within = inner(index, 0);
  const std::string t = prefix_of(index);
  std::string body;
  if (n.multi) {
    body += layers(index);
  } else if (n.pattern) {
    PatternShader shader(*this, instance(index).node, index);
    shader.texel = within.texel;
    if (n.seamless && n.type->seamless != Seamless::four_corner)
      shader.period_x = within.extent_x, shader.period_y = within.extent_y;
    n.pattern->write_shader(shader);
    body += shader.statements();
  } else {
    body += t + "self = 0.0;\n";
  }
  body += n.layered ? t + "self = " + t + "below.main;\n" : t + "self = finite(" + t + "self);\n";
  body += t + "main = " + t + "self;\n";
  assign(n.main, index, {t + "main"}, body);
  append("void " + t + "pattern() {\n" + body + "}\n");
}

/// Evaluator::main_value(), with the blend of four corners where it is needed.
void ShaderWriter::write_main(int index) {
  const Node& n = node(instance(index).node);
  const ShaderInstance within = inner(index, 0);
  const std::string t = prefix_of(index);
  std::string body = "float " + t + "value(float x, float y) {\n" + t + "prepare(x, y);\n";
  if (n.seamless && n.type->seamless == Seamless::four_corner) {
    body += filled_in(
        "float at_u = $tu;\nfloat at_v = $tv;\nfloat s = at_u / $w;\nfloat r = at_v / $h;\nfloat sum = 0.0;\n",
        {{"w", within.extent_x}, {"h", within.extent_y}}, t);
    for (int corner = 3; corner >= 0; --corner)
      body += filled_in("$tu = at_u - $across;\n$tv = at_v - $down;\n$tpattern();\nsum = sum + $tmain * ($s) * ($r);\n",
                        {{"across", (corner & 1) * within.extent_x},
                         {"down", (corner >> 1) * within.extent_y},
                         {"s", corner & 1 ? "s" : "1.0 - s"},
                         {"r", corner >> 1 ? "r" : "1.0 - r"}},
                        t);
    body += filled_in("$tmain = sum;\n$tu = at_u;\n$tv = at_v;\n", {}, t);
  } else {
    body += t + "pattern();\n";
  }
  const ShaderValues limits{{"low", n.limit_low}, {"high", n.limit_high}, {"intensity", n.intensity}, {"add", n.add}};
  if (n.absolute) body += filled_in("$tmain = abs($tmain);\n", {}, t);
  if (n.invert) body += filled_in("$tmain = 1.0 - $tmain;\n", {}, t);
  body +=
      filled_in("$tmain = finite(min(max($tmain, $low), $high) * $intensity + $add);\nreturn $tmain;\n}\n", limits, t);
  append(body);
}

std::string ShaderWriter::main_function(const ShaderInstance& wanted) { return prefix_of(number_of(wanted)) + "value"; }

std::string ShaderWriter::channels_function(const ShaderInstance& wanted, unsigned mask) {
  const int index = number_of(wanted);
  const auto known = channels_.find({index, mask});
  if (known != channels_.end()) return known->second;
  const Node& n = node(wanted.node);
  const std::string t = prefix_of(index), name = t + "channels" + std::to_string(mask);
  std::string body =
      "Channels " + name + "(float x, float y) {\nChannels c = k_nothing();\nc.main = " + t + "value(x, y);\n";
  const bool highlight = n.own_highlight && (mask & bit(Channel::roughness));
  const unsigned needed = highlight ? mask | bit(Channel::specular) | bit(Channel::specularcoeff) : mask;
  for (std::size_t c = 1; c < k_channels; ++c) {
    if (!(needed >> c & 1U)) continue;
    if (highlight && c == at(Channel::roughness)) {
      body += "c.roughness = k_roughness_of_highlight(c.specular, c.specularcoeff);\n";
      continue;
    }
    const std::size_t parts = c == k_red ? 3 : 1;
    std::vector<std::string> members;
    for (std::size_t k = 0; k < parts; ++k) members.push_back("c." + std::string(k_members[c + k]));
    const bool from_below = n.layered >> c & 1U;
    const auto below = [&](std::size_t k) {
      return t + "below." + std::string(k_members[c + k]) + " * " + number(n.channel_scale[c]);
    };
    if (!from_below || n.channels[c].present || c == at(Channel::alpha))
      assign(n.channels[c], index, members, body);
    else
      for (std::size_t k = 0; k < parts; ++k) body += members[k] + " = " + below(k) + ";\n";
    if (from_below && c == at(Channel::alpha)) body += members[0] + " = " + members[0] + " * " + below(0) + ";\n";
    if (c == at(Channel::alpha) || c == at(Channel::coloralpha) || c == at(Channel::roughness) || c == k_red)
      for (const std::string& member : members) body += member + " = clamp(" + member + ", 0.0, 1.0);\n";
  }
  append(body + "return c;\n}\n");
  return channels_[{index, mask}] = name;
}

/// Evaluator::texmap().
std::string ShaderWriter::texmap_function(int index, unsigned mask) {
  const auto known = texmaps_.find({index, mask});
  if (known != texmaps_.end()) return known->second;
  const Node& n = node(instance(index).node);
  const std::string t = prefix_of(index), name = t + "texmap" + std::to_string(mask);
  std::string body = "Channels " + name +
                     "(float wanted) {\nfloat p = clamp(finite(wanted), 0.0, 1.0);\n"
                     "Channels c = k_nothing();\nfloat w = 0.0;\nChannels part = k_nothing();\n";
  double total = 0, start = 0;
  for (std::size_t k = 0; k < n.textures.size(); ++k)
    total += n.ranges[k] + (k + 1 < n.textures.size() ? n.fades[k] : 0);
  if (!(total > 0)) total = 1;
  for (std::size_t k = 0; k < n.textures.size(); ++k) {
    const double end = start + n.ranges[k] / total, before = k > 0 ? n.fades[k - 1] / total : 0,
                 after = k + 1 < n.textures.size() ? n.fades[k] / total : 0;
    body += "part = " + channels_function(inner(index, n.textures[k]), mask) + "(" + t + "u, " + t + "v);\nw = 1.0;\n";
    const ShaderValues values{{"start", start}, {"end", end}, {"before", before}, {"after", after}};
    if (k > 0)
      body += filled_in(before > 0 ? "if (p < $start) {\nw = max(0.0, 1.0 - ($start - p) / $before);\n}\n"
                                   : "if (p < $start) {\nw = 0.0;\n}\n",
                        values, t);
    if (k + 1 < n.textures.size())
      body += filled_in(after > 0 ? "if (p > $end) {\nw = max(0.0, 1.0 - (p - $end) / $after);\n}\n"
                                  : "if (p > $end) {\nw = 0.0;\n}\n",
                        values, t);
    for (std::size_t c = 0; c < k_channels + 2; ++c)
      if (mask >> std::min(c, k_red) & 1U)
        body += filled_in("c.$part = c.$part + w * part.$part;\n", {{"part", std::string(k_members[c])}}, t);
    start = end + after;
  }
  append(body + "return c;\n}\n");
  return texmaps_[{index, mask}] = name;
}

}  // namespace papilla::procedural_detail
