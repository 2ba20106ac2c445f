// SPDX-License-Identifier: GPL-3.0-or-later
#include "shown_format.hpp"
#include "text/scene_text.hpp"

namespace papilla::app {
namespace {

std::string felt_text(double relief_mm) { return relief_mm > 0 ? shown_format(", {:.3g} mm felt", relief_mm) : ""; }

}  // namespace

std::string object_textures_text(const ObjectTextures& made) {
  std::string out;
  for (const DecalReport& decal : made.decals)
    out += shown_format("decal {}: {:.4g} mm\u00b2 on {} surface{}, {} triangles, {:.3g} mm pushed out{}\n", decal.name,
                        decal.area_mm2, decal.surfaces, decal.surfaces == 1 ? "" : "s", decal.triangles,
                        decal.offset_mm, felt_text(decal.relief_mm));
  for (const CarrierReport& carrier : made.carriers)
    out += shown_format("replaced by {}: {} triangles drawn become {}, {} saved{}\n", carrier.name, carrier.triangles,
                        2 * carrier.carriers, carrier.saved(), felt_text(carrier.relief_mm));
  return out;
}

}  // namespace papilla::app
