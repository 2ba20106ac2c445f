// SPDX-License-Identifier: MIT
#include "papilla/meshing/stain_transport.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "papilla/core/error.hpp"
#include "world_scene.hpp"

namespace papilla {
namespace {

/// Steps and neighbourhoods, as shares of the diagonal.
constexpr double k_step = 1.0 / 256, k_near = 3 * k_step;
constexpr int k_most_steps = 4096;
/// Sine of the slope above which water runs down.
constexpr double k_slope = 0.05;
constexpr double k_least_dirt = 1e-3;
/// Way under an overhang after which 63 % of the drops have fallen off, as a share of the diagonal.
constexpr double k_hang = 0.25;

struct Deposit {
  Vec3 at, normal;
  double dirt;
};

/// Random numbers of one drop.
class Draw {
 public:
  Draw(std::uint32_t drop, std::uint32_t seed) : state_((std::uint64_t{seed} << 32 | drop) * 0x9E3779B97F4A7C15U) {}
  /// In [0, 1); splitmix64.
  double operator()() noexcept {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15U;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9U;
    z = (z ^ z >> 27) * 0x94D049BB133111EBU;
    return static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

struct Hit {
  Vec3 at, normal;  ///< The normal looks to where the sight line came from.
};

/// The scene and its gravity.
struct World {
  detail::Occluders scene;
  Vec3 down, across, along;
  double step, start, run, cling;
  double keeps_hanging;  ///< Probability a step.

  std::optional<Hit> first_hit(const Vec3& a, const Vec3& b) const {
    const Index triangle = scene.bvh->first_cut(a, b);
    if (triangle == k_no_value) return std::nullopt;
    const detail::TriangleFrame& frame = scene.bvh->frame(triangle);
    Vec3 normal = normalized(cross(frame.ab, frame.ac));
    const Vec3 way = b - a;
    const double facing = dot(normal, way);
    if (!(std::abs(facing) > 0)) return std::nullopt;
    const double share = std::clamp(dot(frame.a - a, normal) / facing, 0.0, 1.0);
    if (facing > 0) normal = -1 * normal;
    return Hit{a + share * way, normal};
  }
};

/// One drop on its way.
class Drop {
 public:
  Drop(const World& world, std::uint32_t number, std::uint32_t seed) : world_(world), draw_(number, seed) {}

  /// @param from  above the scene. @returns whether it met it.
  bool fall(const Vec3& from) {
    const auto hit = world_.first_hit(from, from + 2.5 * world_.scene.diagonal_mm * world_.down);
    if (!hit) return false;
    land(*hit);
    return true;
  }

  void run() {
    for (int step = 0; step < k_most_steps && dirt_ > k_least_dirt && !is_gone_; ++step) move();
    if (is_gone_)
      left = dirt_;
    else
      leave(dirt_);
  }

  std::vector<Deposit> deposits;
  double left = 0;

 private:
  void land(const Hit& hit) {
    place_ = hit;
    was_steep_ = false;
    const double angle = 2 * std::numbers::pi * draw_();
    way_ = std::cos(angle) * world_.across + std::sin(angle) * world_.along;
    way_ = tangent(way_);
  }

  /// The part of a direction along the surface; any direction along it where there is none.
  Vec3 tangent(const Vec3& v) const {
    const Vec3 t = v - dot(v, place_.normal) * place_.normal;
    if (norm(t) > 1e-9) return normalized(t);
    const Vec3 other = cross(place_.normal, world_.across);
    return normalized(norm(other) > 0.1 ? other : cross(place_.normal, world_.along));
  }

  void leave(double dirt) {
    if (dirt <= 0) return;
    deposits.push_back({place_.at, place_.normal, dirt});
    dirt_ -= dirt;
  }

  void move() {
    const Vec3 downhill = world_.down - dot(world_.down, place_.normal) * place_.normal;
    const double slope = norm(downhill);
    const bool level = slope < k_slope, looks_up = dot(place_.normal, world_.down) < 0;
    if (level && looks_up && was_steep_) return leave(dirt_);  // The foot of a slope.
    if (dot(place_.normal, world_.down) > 0.5 && draw_() > world_.keeps_hanging)
      return drip(place_.at + world_.start * place_.normal);
    if (level) {
      way_ = tangent(way_);
    } else {
      // A little to either side, so that runs are no lines.
      way_ = normalized(downhill);
      way_ = normalized(way_ + 0.3 * (draw_() - 0.5) * cross(place_.normal, way_));
      was_steep_ = true;
    }
    if (!level || !looks_up) leave(dirt_ * (1 - std::exp(-world_.step * std::max(slope, k_slope) / world_.run)));
    const Vec3 n = place_.normal, lifted = place_.at + world_.start * n, next = place_.at + world_.step * way_;
    if (const auto wall = world_.first_hit(lifted, next + world_.start * n)) return meet(*wall, level);
    const double reach = 0.6 * world_.step;
    if (const auto hit = world_.first_hit(next + reach * n, next - reach * n)) {
      place_ = *hit;
      return;
    }
    go_round(next);
  }

  /// A surface stands in the way.
  void meet(const Hit& wall, bool level) {
    const Vec3 downhill = world_.down - dot(world_.down, wall.normal) * wall.normal;
    const bool wall_leads_down = norm(downhill) >= k_slope && dot(place_.normal, world_.down) > 0;
    if (level && !wall_leads_down) {  // Water on a level floor does not climb; it turns round.
      const double angle = 2 * std::numbers::pi * draw_();
      way_ = tangent(std::cos(angle) * world_.across + std::sin(angle) * world_.along);
      if (dot(way_, wall.normal) < 0) way_ = -1 * way_;
      return;
    }
    place_ = wall;
  }

  /// Round an edge onto the next surface, or off it.
  void go_round(const Vec3& beyond) {
    const Vec3 n = place_.normal, from = beyond - 0.3 * world_.step * n;
    const auto hit = world_.first_hit(from, from - 1.5 * world_.step * way_);
    const bool overhangs = hit && dot(hit->normal, world_.down) > k_slope;
    if (hit && (!overhangs || draw_() < world_.cling)) {
      place_ = *hit;
      way_ = tangent(-1 * n);
      return;
    }
    drip(beyond + world_.start * way_);
  }

  /// Falls from a point off the surface to what is below.
  void drip(const Vec3& from) {
    if (const auto below = world_.first_hit(from, from + 2.5 * world_.scene.diagonal_mm * world_.down))
      land(*below);
    else
      is_gone_ = true;
  }

  const World& world_;
  Draw draw_;
  Hit place_{};
  Vec3 way_{};
  double dirt_ = 1;
  bool was_steep_ = false, is_gone_ = false;
};

}  // namespace

/// Deposits by cells of the size of the neighbourhood.
struct StainField::Deposits {
  std::vector<Deposit> all;
  std::vector<std::uint64_t> cells;  ///< Of `all`, ascending.
  Vec3 corner;
  double near = 1, unit_area = 1;

  std::array<std::int64_t, 3> cell_of(const Vec3& p) const noexcept {
    const Vec3 q = (1 / near) * (p - corner);
    const auto whole = [](double v) {
      return static_cast<std::int64_t>(std::floor(std::clamp(v, -1e6, 1e6))) + (1 << 20);
    };
    return {whole(q.x), whole(q.y), whole(q.z)};
  }
  static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) noexcept {
    return static_cast<std::uint64_t>(x) << 42 | static_cast<std::uint64_t>(y) << 21 | static_cast<std::uint64_t>(z);
  }
  void sort() {
    const auto cell = [this](const Deposit& d) {
      const auto c = cell_of(d.at);
      return key(c[0], c[1], c[2]);
    };
    std::stable_sort(all.begin(), all.end(), [&](const Deposit& a, const Deposit& b) { return cell(a) < cell(b); });
    for (const Deposit& d : all) cells.push_back(cell(d));
  }
};

StainField::StainField(std::span<const PlacedMesh> parts, const StainOptions& options) {
  const double length = norm(options.gravity);
  if (options.drops == 0 || !(length > 0) || !std::isfinite(length))
    throw InvalidInput("StainField: drops must be positive and gravity a direction");
  if (!(options.run_mm >= 0 && std::isfinite(options.run_mm)) || !(options.cling >= 0 && options.cling <= 1))
    throw InvalidInput("StainField: run_mm must not be negative, cling lie in [0, 1]");
  World world{detail::occluders(parts, "StainField"),
              (1 / length) * options.gravity,
              {},
              {},
              0,
              0,
              0,
              options.cling,
              std::exp(-k_step / k_hang)};
  const double diagonal = world.scene.diagonal_mm;
  auto deposits = std::make_shared<Deposits>();
  deposits->near = std::max(k_near * diagonal, 1e-12);
  deposits_ = deposits;
  if (!(diagonal > 0)) return;
  world.across = normalized(cross(world.down, std::abs(world.down.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 0, 1}));
  world.along = cross(world.down, world.across);
  world.step = k_step * diagonal, world.start = world.scene.start_mm;
  world.run = options.run_mm > 0 ? options.run_mm : diagonal / 6;
  // The scene as gravity sees it.
  std::array<double, 3> low, high;
  low.fill(std::numeric_limits<double>::infinity()), high.fill(-std::numeric_limits<double>::infinity());
  const detail::WorldScene placed = detail::place(parts, "StainField");
  for (const detail::PlacedTriangles& part : placed.parts)
    for (Index v = 0; v < part.vertices(); ++v) {
      const Vec3 p = part.position(v);
      const std::array<double, 3> seen{dot(p, world.across), dot(p, world.along), dot(p, world.down)};
      for (std::size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], seen[k]), high[k] = std::max(high[k], seen[k]);
      deposits->corner = p;
    }
  std::vector<Drop> drops;
  for (std::uint32_t k = 0; k < options.drops; ++k) drops.emplace_back(world, k, options.seed);
  std::vector<unsigned char> landed(options.drops, 0);
  tbb::parallel_for(std::uint32_t{0}, options.drops, [&](std::uint32_t k) {
    // Evenly spread: multiples of the roots of x^3 = x + 1 [Roberts 2018].
    const double u = std::fmod(0.5 + 0.7548776662466927 * (k + 1), 1.0),
                 v = std::fmod(0.5 + 0.5698402909980532 * (k + 1), 1.0);
    const Vec3 from = (low[0] + u * (high[0] - low[0])) * world.across +
                      (low[1] + v * (high[1] - low[1])) * world.along + (low[2] - 0.01 * diagonal) * world.down;
    landed[k] = drops[k].fall(from);
    if (landed[k]) drops[k].run();
  });
  for (std::uint32_t k = 0; k < options.drops; ++k) {
    if (!landed[k]) continue;
    balance_.carried += 1;
    balance_.left += drops[k].left;
    for (const Deposit& d : drops[k].deposits) balance_.deposited += d.dirt;
    deposits->all.insert(deposits->all.end(), drops[k].deposits.begin(), drops[k].deposits.end());
  }
  deposits->unit_area = (high[0] - low[0]) * (high[1] - low[1]) / options.drops;
  deposits->sort();
}

double StainField::operator()(const Vec3& point, const Vec3& normal) const noexcept {
  const Deposits& d = *deposits_;
  const auto centre = d.cell_of(point);
  double sum = 0;
  for (std::int64_t x = -1; x <= 1; ++x)
    for (std::int64_t y = -1; y <= 1; ++y) {
      // Cells along z follow each other.
      const auto first =
          std::lower_bound(d.cells.begin(), d.cells.end(), Deposits::key(centre[0] + x, centre[1] + y, centre[2] - 1));
      const std::uint64_t last = Deposits::key(centre[0] + x, centre[1] + y, centre[2] + 1);
      for (auto it = first; it != d.cells.end() && *it <= last; ++it) {
        const Deposit& one = d.all[static_cast<std::size_t>(it - d.cells.begin())];
        const Vec3 away = one.at - point;
        const double share = 1 - dot(away, away) / (d.near * d.near);
        if (share <= 0 || dot(one.normal, normal) < 0.5) continue;
        sum += one.dirt * share * share;
      }
    }
  // The kernel 3 (1 - r^2)^2 / pi integrates to 1 over the disc.
  return sum * 3 / (std::numbers::pi * d.near * d.near) * d.unit_area;
}

}  // namespace papilla
