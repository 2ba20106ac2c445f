// SPDX-License-Identifier: MIT
#include "papilla/meshing/sheet_sides.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "check_mesh.hpp"
#include "edge_table.hpp"
#include "open_sheets.hpp"
#include "papilla/core/cold_arrays.hpp"
#include "papilla/core/error.hpp"
#include "placed_bvh.hpp"
#include "room.hpp"
#include "sample_points.hpp"

namespace papilla {
namespace {

using namespace detail;

constexpr double k_clear_share = 0.8;  ///< Of what is seen of a sheet, or of its border, that decides.
constexpr double k_least_seen = 0.02;  ///< Share of a sheet's points; less may be a view through a gap.
constexpr double k_least_border = 0.1;
constexpr double k_flattest = 0.05;   ///< |n . d| below which a coarse mesh does not tell its sides apart.
constexpr double k_near = 2e-4;       ///< Of the scene's diagonal: gaps that repair() closes.
constexpr double k_parallel = 0.8;    ///< |cosine| of borders that run along one another.
constexpr double k_eye_distance = 2;  ///< Of the scene's diagonal.
constexpr std::size_t k_room_eyes = 8, k_view_eyes = 16, k_eyes_around = 32;
constexpr int k_most_rooms = 4;  ///< So often sheets that were turned lead to another room.
constexpr std::size_t k_sight_lines = std::size_t{1} << 21;
constexpr std::size_t k_least_points = 4, k_most_points = 256, k_border_points = 64;

/// A bit a side that is shown to people.
enum Sides : std::uint8_t { k_no_side = 0, k_front = 1, k_back = 2, k_both = 3 };

/// What is known of a sheet on the way.
struct Sheet {
  std::uint32_t mesh = 0, number = 0;  ///< Of the meshes, of the mesh's sheets.
  bool is_open_question = true, faces_away = false;
  SideReason reason = SideReason::unseen;
  double seen_area = 0, front_share = 0;
};

/// A sheet in one of its places.
struct PlacedSheet {
  std::uint32_t use = 0, sheet = 0;
};

/// An edge of a border as the sheet's front side runs around it.
struct BorderEdge {
  Vec3 from, to;
  std::uint32_t sheet = 0;
};

class SideFinder {
 public:
  SideFinder(std::span<const PlacedMesh> uses, const SheetSideOptions& options) : uses_(uses), options_(options) {}

  SheetSides run() {
    collect_sheets();
    if (sheets_.empty()) return std::move(result_);
    place_scene();
    if (!settle()) {
      decide_from(rounds_of_eyes(unknown_sheets()));
      settle();
    }
    finish();
    return std::move(result_);
  }

 private:
  struct Round {
    std::vector<Vec3> eyes;
    SideReason reason;
    bool operator==(const Round&) const = default;
  };

  /// The room is where fronts are seen, and fronts are what is seen from the room: decides again while sheets that turn
  /// lead to another room. Returns false, with the sides of the start, where that does not end.
  bool settle() {
    const std::vector<Sheet> start = sheets_;
    const SheetSides result_of_start = result_;
    std::vector<Round> last;
    for (int i = 0; i < k_most_rooms; ++i) {
      std::vector<Round> rounds = rounds_of_eyes(facing());
      if (rounds == last) return true;
      decide_from(rounds);
      last = std::move(rounds);
    }
    sheets_ = start;
    result_ = result_of_start;
    return false;
  }

  void decide_from(const std::vector<Round>& rounds) {
    for (Sheet& sheet : sheets_) sheet = undecided(sheet.mesh, sheet.number);
    for (const auto& [eyes, reason] : rounds) {
      look_from(eyes, reason);
      continue_neighbours();
    }
  }

  Sheet undecided(std::uint32_t mesh, std::uint32_t number) const {
    const bool orientable = open_[mesh].sheets[number].orientable;
    return {mesh, number, orientable, false, orientable ? SideReason::unseen : SideReason::non_orientable};
  }

  /// Sets the facing of the opaque triangles of sheets that can have a side. @param facing_of of a sheet's triangle.
  template <typename FacingOf>
  std::vector<Facing> facing_of_sheets(FacingOf facing_of) const {
    std::vector<Facing> facing(bvh_.size(), Facing::as_is);
    for (const PlacedSheet& placed : placed_) {
      const Sheet& sheet = sheets_[placed.sheet];
      if (!scene_.parts[placed.use].is_opaque() || !open_of(sheet).orientable) continue;
      for (const Index t : open_of(sheet).triangles) facing[bvh_.number(placed.use, t)] = facing_of(sheet, t);
    }
    return facing;
  }

  std::vector<Facing> facing() const {
    return facing_of_sheets(
        [&](const Sheet& sheet, Index t) { return is_turned(sheet, t) ? Facing::turned : Facing::as_is; });
  }

  std::vector<Facing> unknown_sheets() const {
    return facing_of_sheets([](const Sheet&, Index) { return Facing::unknown; });
  }

  bool is_turned(const Sheet& sheet, Index t) const {
    return !sheet.is_open_question && sheet.reason < SideReason::both_sides_seen &&
           (open_[sheet.mesh].against[t] != 0) != sheet.faces_away;
  }

  void collect_sheets() {
    std::map<const TriangleMesh*, std::uint32_t> number_of;
    std::vector<std::vector<std::uint32_t>> uses_of;
    for (std::uint32_t u = 0; u < uses_.size(); ++u) {
      if (uses_[u].mesh == nullptr)
        throw InvalidInput("find_sheet_sides: parts[" + std::to_string(u) + "] has no mesh");
      const auto [it, is_new] = number_of.try_emplace(uses_[u].mesh, static_cast<std::uint32_t>(uses_of.size()));
      if (is_new) {
        uses_of.emplace_back();
        result_.meshes.push_back({uses_[u].mesh, {}, {}});
      }
      uses_of[it->second].push_back(u);
    }
    for (std::size_t m = 0; m < uses_of.size(); ++m) {
      Bounds3 bounds;
      check_distance_input(*result_.meshes[m].mesh,
                           "find_sheet_sides: parts[" + std::to_string(uses_of[m].front()) + "].mesh", bounds);
    }
    const ColdArrays waiting;
    open_.resize(uses_of.size());
    oneapi::tbb::parallel_for(std::size_t{0}, open_.size(),
                              [&](std::size_t m) { open_[m] = find_open_sheets(*result_.meshes[m].mesh); });
    for (std::uint32_t m = 0; m < open_.size(); ++m)
      for (std::uint32_t s = 0; s < open_[m].sheets.size(); ++s) {
        for (const std::uint32_t u : uses_of[m]) placed_.push_back({u, static_cast<std::uint32_t>(sheets_.size())});
        sheets_.push_back(undecided(m, s));
      }
  }

  const OpenSheet& open_of(const Sheet& sheet) const { return open_[sheet.mesh].sheets[sheet.number]; }

  void place_scene() {
    scene_ = place(uses_, "find_sheet_sides");
    bvh_ = PlacedBvh(scene_);
    diagonal_ = scene_.bounds.diagonal();
  }

  std::vector<Round> rounds_of_eyes(const std::vector<Facing>& facing) {
    std::vector<Round> rounds;
    result_.enclosure = 0;
    result_.eye = {};
    if (options_.inside) {
      result_.viewpoint = Viewpoint::inside;
      result_.eye = *options_.inside;
      rounds.push_back({{*options_.inside}, SideReason::seen});
      rounds.push_back(
          {places_around(bvh_, look_for_places(bvh_, scene_.bounds, facing), *options_.inside, k_room_eyes),
           SideReason::seen});
    } else if (!options_.view.empty()) {
      result_.viewpoint = Viewpoint::view;
      rounds.push_back({{}, SideReason::seen});
      for (const Volume& volume : options_.view)
        for (std::uint64_t i = 0; i < k_view_eyes; ++i) rounds.back().eyes.push_back(point_in(volume, i));
    } else if (const std::vector<Place> places = look_for_places(bvh_, scene_.bounds, facing);
               const std::optional<Place> room = best_place(places)) {
      result_.viewpoint = Viewpoint::room;
      result_.eye = room->point;
      result_.enclosure = room->enclosure;
      rounds.push_back({places_around(bvh_, places, room->point, k_room_eyes - 1), SideReason::seen});
      rounds.back().eyes.push_back(room->point);
    } else {
      result_.viewpoint = Viewpoint::around;
    }
    Round around{{}, rounds.empty() ? SideReason::seen : SideReason::seen_around};
    for (const Vec3& direction : directions_around(k_eyes_around))
      around.eyes.push_back(scene_.bounds.middle() + k_eye_distance * diagonal_ * direction);
    rounds.push_back(std::move(around));
    return rounds;
  }

  struct Votes {
    double front = 0, back = 0;
    std::size_t points = 0, seen_points = 0;

    Sides sides() const noexcept {
      const double seen = front + back;
      if (seen_points < 2 || static_cast<double>(seen_points) < k_least_seen * static_cast<double>(points))
        return k_no_side;
      if (front >= k_clear_share * seen) return k_front;
      return back >= k_clear_share * seen ? k_back : k_both;
    }
  };

  Votes look_at(const PlacedSheet& placed, const std::vector<Vec3>& eyes, std::size_t points) const {
    const Sheet& sheet = sheets_[placed.sheet];
    const PlacedTriangles& part = scene_.parts[placed.use];
    const AreaSampler sampler(part, open_of(sheet).triangles);
    Votes votes;
    if (sampler.empty()) return votes;
    const double start = k_ray_start * diagonal_;
    votes.points = points;
    for (std::size_t i = 0; i < points; ++i) {
      const auto [t, point] = sampler(i, points);
      const bool turned = (open_[sheet.mesh].against[t] != 0) != part.is_mirrored();
      const Vec3 normal = (turned ? -1.0 : 1.0) * normalized(cross(part.corner(t, 1) - part.corner(t, 0),
                                                                   part.corner(t, 2) - part.corner(t, 0)));
      const Index own = bvh_.number(placed.use, t);
      bool seen = false;
      for (const Vec3& eye : eyes) {
        const Vec3 way = eye - point;
        const double length = norm(way), height = length > 0 ? dot(normal, way) / length : 0;
        if (length <= start || std::abs(height) < k_flattest) continue;
        if (bvh_.blocks(point + (start / length) * way, eye, own)) continue;
        seen = true;
        (height > 0 ? votes.front : votes.back) += std::abs(height);
      }
      votes.seen_points += seen;
    }
    return votes;
  }

  /// Decides what is seen of the sheets that are undecided.
  void look_from(const std::vector<Vec3>& eyes, SideReason reason) {
    std::vector<PlacedSheet> wanted;
    for (const PlacedSheet& placed : placed_)
      if (sheets_[placed.sheet].is_open_question) wanted.push_back(placed);
    if (wanted.empty() || eyes.empty()) return;
    const std::size_t points = std::clamp(k_sight_lines / (wanted.size() * eyes.size()), k_least_points, k_most_points);
    std::vector<Votes> votes(wanted.size());
    oneapi::tbb::parallel_for(std::size_t{0}, wanted.size(),
                              [&](std::size_t i) { votes[i] = look_at(wanted[i], eyes, points); });
    std::vector<std::uint8_t> sides(sheets_.size(), k_no_side);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      Sheet& sheet = sheets_[wanted[i].sheet];
      sides[wanted[i].sheet] |= votes[i].sides();
      const double seen = votes[i].front + votes[i].back;
      if (votes[i].sides() == k_no_side || seen <= sheet.seen_area) continue;
      sheet.seen_area = seen;
      sheet.front_share = votes[i].front / seen;
    }
    for (std::size_t s = 0; s < sheets_.size(); ++s) {
      if (sides[s] == k_both)
        sheets_[s].reason = SideReason::both_sides_seen;
      else if (sides[s] != k_no_side)
        decide(sheets_[s], sides[s] == k_back, reason);
      if (sides[s] != k_no_side) sheets_[s].is_open_question = false;
    }
  }

  static void decide(Sheet& sheet, bool faces_away, SideReason reason) {
    sheet.is_open_question = false;
    sheet.faces_away = faces_away;
    sheet.reason = reason;
  }

  void add_border(const PlacedSheet& placed, std::size_t most, std::vector<BorderEdge>& edges) const {
    const Sheet& sheet = sheets_[placed.sheet];
    const std::vector<Index>& border = open_of(sheet).border;
    const PlacedTriangles& part = scene_.parts[placed.use];
    const std::size_t count = std::min(most, border.size());
    for (std::size_t i = 0; i < count; ++i) {
      const Index h = border[i * border.size() / count], t = triangle_of(h);
      Vec3 from = part.position(from_vertex(part.triangles(), h)), to = part.position(to_vertex(part.triangles(), h));
      const bool turned = (open_[sheet.mesh].against[t] != 0) != part.is_mirrored();
      if (turned != sheet.faces_away) std::swap(from, to);
      edges.push_back({from, to, placed.sheet});
    }
  }

  /// Of a sheet's border: what neighbours are asked for, and what runs opposite to or along decided ones.
  struct Lengths {
    double asked = 0, opposite = 0, along = 0;
  };

  /// Decides the sheets that continue decided ones, and those that continue these.
  void continue_neighbours() {
    const ColdArrays waiting;
    std::vector<BorderEdge> known, asked;
    for (const PlacedSheet& placed : placed_) {
      const Sheet& sheet = sheets_[placed.sheet];
      if (sheet.is_open_question)
        add_border(placed, k_border_points, asked);
      else if (sheet.reason < SideReason::both_sides_seen)
        add_border(placed, open_of(sheet).border.size(), known);
    }
    std::map<std::uint32_t, Lengths> lengths;
    for (const BorderEdge& edge : asked) lengths[edge.sheet].asked += norm(edge.to - edge.from);
    while (!known.empty() && !asked.empty()) {
      const std::vector<std::uint32_t> decided = continue_along(known, asked, lengths);
      if (decided.empty()) return;
      known.clear();
      for (const PlacedSheet& placed : placed_)
        if (std::binary_search(decided.begin(), decided.end(), placed.sheet))
          add_border(placed, open_of(sheets_[placed.sheet]).border.size(), known);
      std::erase_if(asked, [&](const BorderEdge& e) { return !sheets_[e.sheet].is_open_question; });
    }
  }

  /// @param asked loses the edges that meet known ones. @param lengths of the undecided sheets, on which those are
  /// added.
  /// @return the sheets that were decided, ascending.
  std::vector<std::uint32_t> continue_along(const std::vector<BorderEdge>& known, std::vector<BorderEdge>& asked,
                                            std::map<std::uint32_t, Lengths>& lengths) {
    std::vector<Vec3> positions;
    std::vector<Triangle> segments;
    for (const BorderEdge& edge : known) {
      const auto p = static_cast<Index>(positions.size());
      positions.push_back(edge.from);
      positions.push_back(edge.to);
      segments.push_back({p, p + 1, p + 1});
    }
    const TriangleBvh tree(positions, segments);
    const double near = k_near * diagonal_;
    std::erase_if(asked, [&](const BorderEdge& edge) {
      const ClosestPoint found = tree.closest(0.5 * (edge.from + edge.to), {near * near, k_no_value});
      if (found.triangle == k_no_value) return false;
      const BorderEdge& other = known[found.triangle];
      const double cosine = dot(normalized(edge.to - edge.from), normalized(other.to - other.from));
      if (std::abs(cosine) < k_parallel) return false;
      Lengths& sum = lengths[edge.sheet];
      (cosine < 0 ? sum.opposite : sum.along) += norm(edge.to - edge.from);
      return true;
    });
    std::vector<std::uint32_t> decided;
    for (const auto& [number, sum] : lengths) {
      if (!sheets_[number].is_open_question) continue;
      const double met = sum.opposite + sum.along;
      if (!(met > 0) || met < k_least_border * sum.asked) continue;
      if (std::max(sum.opposite, sum.along) < k_clear_share * met) continue;
      decide(sheets_[number], sum.along > sum.opposite, SideReason::neighbour);
      decided.push_back(number);
    }
    return decided;
  }

  void finish() {
    for (std::size_t m = 0; m < open_.size(); ++m) result_.meshes[m].sheets.resize(open_[m].sheets.size());
    for (const Sheet& sheet : sheets_) {
      MeshSheets& mesh = result_.meshes[sheet.mesh];
      SheetSide& side = mesh.sheets[sheet.number];
      side.triangles = std::move(open_[sheet.mesh].sheets[sheet.number].triangles);
      side.reason = sheet.reason;
      side.faces_away = sheet.faces_away;
      side.front_share = sheet.front_share;
      for (const Index t : side.triangles) {
        if (!is_turned(sheet, t)) continue;
        mesh.turn.resize(mesh.mesh->triangles.size(), 0);
        mesh.turn[t] = 1;
      }
    }
  }

  std::span<const PlacedMesh> uses_;
  const SheetSideOptions& options_;
  SheetSides result_;
  std::vector<OpenSheets> open_;  ///< In the order of the result's meshes.
  std::vector<Sheet> sheets_;
  std::vector<PlacedSheet> placed_;
  WorldScene scene_;
  PlacedBvh bvh_;
  double diagonal_ = 0;
};

}  // namespace

SheetSides find_sheet_sides(std::span<const PlacedMesh> uses, const SheetSideOptions& options) {
  if (options.inside && !is_finite(*options.inside))
    throw InvalidInput("find_sheet_sides: the point inside is not finite");
  for (const Volume& volume : options.view) check_volume(volume, "find_sheet_sides");
  return SideFinder(uses, options).run();
}

}  // namespace papilla
