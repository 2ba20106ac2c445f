// SPDX-License-Identifier: GPL-3.0-or-later
#include "options/perception_option.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "exit_code.hpp"
#include "file_options.hpp"
#include "option_checks.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"

namespace papilla::app {
namespace {

using nlohmann::json;

constexpr double k_largest_mm = 1e9;

/// The numbers of "1,2.5,-3"; nothing when it is something else.
std::optional<std::vector<double>> numbers_of(const std::string& text) {
  std::vector<double> values;
  const char *at = text.data(), *end = at + text.size();
  while (true) {
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc()) return std::nullopt;
    values.push_back(value);
    if (next == end) return values;
    if (*next != ',') return std::nullopt;
    at = next + 1;
  }
}

/// The reason why a volume can't be used, or an empty text.
std::string fault(const Volume& volume) {
  const auto usable = [](const Vec3& p) {
    return is_finite(p) && std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= k_largest_mm;
  };
  if (const auto* sphere = std::get_if<SphereVolume>(&volume)) {
    if (!usable(sphere->centre)) return "the centre is not within 1e9 mm";
    return sphere->radius_mm >= 0 && sphere->radius_mm <= k_largest_mm ? "" : "the radius is not in [0, 1e9] mm";
  }
  const auto& box = std::get<BoxVolume>(volume);
  if (!usable(box.low) || !usable(box.high)) return "a corner is not within 1e9 mm";
  return box.low.x <= box.high.x && box.low.y <= box.high.y && box.low.z <= box.high.z
             ? ""
             : "a coordinate of the first corner exceeds that of the second";
}

Volume volume_of(std::span<const double> v) {
  if (v.size() == 4) return SphereVolume{{v[0], v[1], v[2]}, v[3]};
  return BoxVolume{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
}

/// Appends the numbers below a key.
void read_numbers(const json& object, const char* key, std::size_t count, const std::string& where,
                  std::vector<double>& values) {
  const std::string place = where + "/" + key;
  if (!object.contains(key)) throw InvalidInput(place + ": is missing");
  const json& value = object[key];
  const json list = count == 1 ? json::array({value}) : value;
  if (!list.is_array() || list.size() != count ||
      !std::all_of(list.begin(), list.end(), [](const json& x) { return x.is_number(); }))
    throw InvalidInput(place + (count == 1 ? ": must be a number" : ": must be three numbers"));
  for (const json& x : list) values.push_back(x.get<double>());
}

Volume volume_of(const json& value, const std::string& where) {
  if (!value.is_object()) throw InvalidInput(where + ": must be an object");
  const bool sphere = value.contains("centre") || value.contains("radius");
  for (const auto& [key, unused] : value.items())
    if (sphere ? key != "centre" && key != "radius" : key != "min" && key != "max")
      throw InvalidInput(where + ": unknown key '" + key + "'; known are centre and radius, or min and max");
  std::vector<double> values;
  read_numbers(value, sphere ? "centre" : "min", 3, where, values);
  read_numbers(value, sphere ? "radius" : "max", sphere ? 1 : 3, where, values);
  const Volume volume = volume_of(values);
  if (const std::string reason = fault(volume); !reason.empty()) throw InvalidInput(where + ": " + reason);
  return volume;
}

std::vector<Volume> volumes_of(const std::string& text, const std::string& file) {
  const json value = json::parse(text, nullptr, false);
  if (value.is_discarded()) throw InvalidInput(file + ": is no valid JSON");
  if (!value.is_array()) return {volume_of(value, file + ": at ")};
  if (value.empty()) throw InvalidInput(file + ": holds no volume");
  std::vector<Volume> volumes;
  for (std::size_t i = 0; i < value.size(); ++i)
    volumes.push_back(volume_of(value[i], file + ": at /" + std::to_string(i)));
  return volumes;
}

/// Volumes given on the command line, in millimetres in the scene's frame; several are taken together:
/// "X,Y,Z,R" is a sphere, "X,Y,Z,X,Y,Z" the box between two corners, anything else names a JSON file (or is JSON
/// itself) with {"centre": [X,Y,Z], "radius": R}, {"min": [X,Y,Z], "max": [X,Y,Z]}, or an array of these.
/// @throws UsageError naming the option when the numbers make no volume; IoError, InvalidInput naming file and JSON
///         pointer.
std::vector<Volume> parse_volumes(const std::string& option, const std::string& text) {
  if (const auto numbers = numbers_of(text)) {
    if (numbers->size() != 4 && numbers->size() != 6)
      throw UsageError(option + ": '" + text + "' is neither a sphere X,Y,Z,R nor a box X,Y,Z,X,Y,Z");
    const Volume volume = volume_of(*numbers);
    if (const std::string reason = fault(volume); !reason.empty())
      throw UsageError(option + ": '" + text + "': " + reason);
    return {volume};
  }
  if (!text.empty() && (text[0] == '{' || text[0] == '[')) return volumes_of(text, option);
  return volumes_of(read_file(text), text);
}

}  // namespace

void PerceptionOption::add_to(CLI::App& verb, bool can_leave_out) {
  reads(verb.add_option("--reach", reach,
                        "Where hands can be, mm in the scene's frame: X,Y,Z,R, X,Y,Z,X,Y,Z or a JSON file"))
      ->type_name("VOLUME")
      ->group("Leave out");
  reads(verb.add_option("--view", view, "Where eyes can be, given like --reach"))
      ->type_name("VOLUME")
      ->group("Leave out");
  verb.add_option("--view-samples", samples, "Points looked at on every use of a part")
      ->type_name("N")
      ->check(in_range(1, 1'000'000))
      ->capture_default_str()
      ->group("Leave out");
  if (!can_leave_out) return;
  verb.add_option("--leave-out", leave_out,
                  "unreachable, unseen, or both: then parts that can be neither touched nor seen")
      ->type_name("WHAT,...")
      ->delimiter(',')
      ->transform(one_of({"unreachable", "unseen"}))
      ->group("Leave out");
}

PerceptionOptions PerceptionOption::options() const {
  PerceptionOptions options;
  if (!reach.empty()) options.reach = parse_volumes("--reach", reach);
  if (!view.empty()) options.view = parse_volumes("--view", view);
  const auto wants = [&](const char* what) {
    return std::find(leave_out.begin(), leave_out.end(), what) != leave_out.end();
  };
  options.leave_out_unreachable = wants("unreachable");
  options.leave_out_unseen = wants("unseen");
  options.samples = samples;
  if (options.leave_out_unreachable && reach.empty()) throw UsageError("--leave-out: 'unreachable' needs --reach");
  if (options.leave_out_unseen && view.empty()) throw UsageError("--leave-out: 'unseen' needs --view");
  return options;
}

}  // namespace papilla::app
