// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "papilla/meshing/placed_mesh.hpp"
#include "papilla/meshing/visibility.hpp"

namespace papilla {

/// Where the people are who look at a scene.
struct SheetSideOptions {
  std::optional<Vec3> inside = {};  ///< A point between the surfaces, mm in the scene's frame.
  std::vector<Volume> view = {};    ///< Where eyes can be; counts when `inside` is not given.
};

/// Where a scene was looked at from.
enum class Viewpoint {
  none,    ///< It has no sheet.
  inside,  ///< SheetSideOptions::inside.
  view,    ///< SheetSideOptions::view.
  room,    ///< The largest enclosed place that was found.
  around   ///< From all directions: nothing encloses a place.
};

/// What a sheet's side rests on.
enum class SideReason {
  seen,             ///< From the viewpoint.
  neighbour,        ///< It continues sheets that are decided.
  seen_around,      ///< From outside of the scene, where nobody inside sees it.
  both_sides_seen,  ///< No side; nor have the following.
  unseen,           ///< Neither seen nor continuing one that is.
  non_orientable
};

/// A connected piece of a mesh with a border. Closed pieces are no sheets: their outside is known, see orient().
struct SheetSide {
  std::vector<Index> triangles;
  SideReason reason = SideReason::unseen;
  bool faces_away = false;  ///< Most of its triangles show their back to those who see it.
  double front_share = 0;   ///< Of what is seen of it where it is seen most, the share that shows its front as it is.
  bool is_ambiguous() const noexcept { return reason >= SideReason::both_sides_seen; }
};

/// The sheets of one mesh.
struct MeshSheets {
  const TriangleMesh* mesh = nullptr;
  std::vector<SheetSide> sheets;   ///< In the order of their first triangles.
  std::vector<std::uint8_t> turn;  ///< Per triangle: to be turned over, for turn_triangles(); empty: none.
};

struct SheetSides {
  Viewpoint viewpoint = Viewpoint::none;
  Vec3 eye;                        ///< Of `inside` and `room`.
  double enclosure = 0;            ///< Of `room`: share of the directions in which a surface lies.
  std::vector<MeshSheets> meshes;  ///< Those of `uses`, each once, in their order.
};

/// Finds out which side of open surfaces is their outside: the one that people see.
///
/// Eyes are at `inside`, else in the `view` volumes, else in the room. The room is looked for at 512 places p spread
/// over the scene's box: score(p) = enclosure * clearance, where the enclosure, the share of 64 directions in which a
/// surface lies, must be above 1/2, and most of these surfaces must show p their fronts as they are, or p is within a
/// solid. The eyes are the best place and up to 7 that see it with half its score or more. A scene without such a place
/// is an object: 32 eyes around it.
///
/// Points spread over a sheet's area are looked at from every eye. What is seen is summed by its foreshortened area,
///     front = sum of |n . d| over the seen lines of sight d with n . d < 0,   back = the same with n . d > 0,
/// with the normal n of the sheet as most of its triangles have it. With at least 2 points and 2 % of them seen, a
/// share of 4/5 decides; below, both sides are seen and the sheet has none. A sheet that is not seen takes the side
/// with which it continues decided neighbours: where at least a tenth of its border lies within 2e-4 of the scene's
/// diagonal of theirs, four fifths of that running opposite ways. What is still undecided is looked at from the room
/// around `inside`, then from all around, neighbours after each. Where sheets that are turned lead to another room, all
/// is decided again from there, up to 4 times; where that does not end, from the room that is found when sheets count
/// as seen from their front. So a scene that was turned is not turned again. Of a mesh that is used several times every
/// use is looked at, mirrored ones as they are drawn; uses that contradict one another leave it without a side.
///
/// Good input: files in which most surfaces face the right way. Breaks down where that is not so (a room all of whose
/// walls face outwards is taken for a box), where the people are in a room that is not the largest, or small beside the
/// scene (then give `inside`), and for sheets of fewer points than a hole in front of them needs.
/// Cost: O(n log n) for sheets and tree, the latter about 150 bytes a triangle, unless there is no sheet; then at most
/// about 2 million lines of sight of 1 us a viewpoint, or 4 points a sheet where that is more; for
/// neighbours a search an undecided border edge (64 a use at most) and wave, waves as many as the longest chain of
/// sheets that continue one another. Parallel. Deterministic:
/// same input, same result, whatever the number of threads.
/// @param uses The same mesh may come several times. @throws InvalidInput naming the use when a mesh is missing or has
/// a bad index or coordinate; when an option is not finite or a volume is out of its range.
SheetSides find_sheet_sides(std::span<const PlacedMesh> uses, const SheetSideOptions& options = {});

}  // namespace papilla
