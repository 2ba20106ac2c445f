// SPDX-License-Identifier: GPL-3.0-or-later
#include "shown_format.hpp"
#include "text/scene_text.hpp"

namespace papilla::app {
namespace {

std::string viewpoint_text(const SceneSides& sides) {
  const auto at = [&] { return shown_format("({:.0f}, {:.0f}, {:.0f}) mm", sides.eye.x, sides.eye.y, sides.eye.z); };
  switch (sides.viewpoint) {
    case Viewpoint::none: break;
    case Viewpoint::inside: return "from " + at();
    case Viewpoint::view: return "from the view volume";
    case Viewpoint::room: return shown_format("from the room at {}, {:.0f} % enclosed", at(), 100 * sides.enclosure);
    case Viewpoint::around: return "from all around";
  }
  return "";
}

const char* text_of(SideReason reason) {
  switch (reason) {
    case SideReason::seen: return "seen";
    case SideReason::neighbour: return "as its neighbours";
    case SideReason::seen_around: return "seen from outside only";
    case SideReason::both_sides_seen: return "both of its sides are seen";
    case SideReason::unseen: return "it is not seen and continues nothing that is";
    case SideReason::non_orientable: break;
  }
  return "it has one side only";
}

std::string reasons_text(const PartSides& part, bool ambiguous) {
  std::string text;
  for (const SideReason reason : part.reasons)
    if ((reason >= SideReason::both_sides_seen) == ambiguous)
      text += (text.empty() ? "" : "; ") + std::string(text_of(reason));
  return text;
}

constexpr std::size_t k_listed = 50;

std::string count_text(std::size_t count, std::size_t all) {
  return all == 1 ? "" : shown_format(" ({} of {} pieces)", count, all);
}

/// What was done to `count` sheets, `left` of which stay as they are.
std::string done_text(std::size_t count, std::size_t left, const char* done) {
  if (count == 0) return "";
  return left == 0 ? shown_format(" ({})", done) : shown_format(" ({} {}, {} left)", count - left, done, left);
}

}  // namespace

std::string sides_text(const SceneSides& sides, bool turned) {
  if (!sides.skipped.empty()) return shown_format("the sides of open parts were not looked at: {}\n", sides.skipped);
  if (sides.open_components == 0) return "";
  std::size_t left_facing_away = 0, left_ambiguous = 0;
  for (const PartSides& part : sides.parts)
    left_facing_away += part.left_facing_away, left_ambiguous += part.left_ambiguous;
  std::string text =
      shown_format("{} open pieces in {} parts, looked at {}: {} face away{}, {} without a side{}\n",
                   sides.open_components, sides.parts.size(), viewpoint_text(sides), sides.facing_away,
                   turned ? done_text(sides.facing_away, left_facing_away, "turned") : "", sides.ambiguous,
                   turned ? done_text(sides.ambiguous, left_ambiguous, "double sided") : "");
  std::size_t parts = 0;
  for (const PartSides& part : sides.parts) {
    if (++parts > k_listed) continue;
    const auto add = [&](const char* done, std::size_t count, bool ambiguous) {
      if (count > 0)
        text += shown_format("  {}: {}{}: {}\n", done, part.part, count_text(count, part.open_components),
                             reasons_text(part, ambiguous));
    };
    if (part.facing_away == 0 && part.turned_triangles > 0)
      text += shown_format("  {}: {} triangles of {} run against the rest\n", turned ? "turned" : "faces away",
                           part.turned_triangles, part.part);
    add(turned ? "turned" : "faces away", part.facing_away - part.left_facing_away, false);
    add("left facing away, it has no relief", part.left_facing_away, false);
    add(turned ? "double sided" : "no side", part.ambiguous - part.left_ambiguous, true);
    add("left without a side, it has no relief", part.left_ambiguous, true);
  }
  if (parts > k_listed) text += shown_format("  and {} parts more: --json lists all\n", parts - k_listed);
  return text;
}

}  // namespace papilla::app
