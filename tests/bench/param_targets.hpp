// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/bench_json.hpp"
#include "bench/param_meshes.hpp"
#include "bench/param_peer.hpp"
#include "papilla/param/flattening.hpp"
#include "papilla/param/levy.hpp"
#include "papilla/param/lscm.hpp"
#include "papilla/param/maillot.hpp"
#include "papilla/param/measure.hpp"

namespace papilla::bench {

using MapMethod = std::function<Flattening(const TriangleMesh&)>;

/// The whole mesh as one chart, with the method's own options.
Flattening lscm_with(const TriangleMesh& mesh, LscmSolver solver);
Flattening lscm_hermitian(const TriangleMesh& mesh);
Flattening arap(const TriangleMesh& mesh);            ///< CGAL's.
Flattening levy_conformal(const TriangleMesh& mesh);  ///< Without lengths: least squares conformality, linear as lscm.
Flattening levy(const TriangleMesh& mesh);
Flattening levy_written(const TriangleMesh& mesh, LevyBorder border, LevySolver solver);
Flattening maillot(const TriangleMesh& mesh);
Flattening maillot_written(const TriangleMesh& mesh, MaillotStart start);
Flattening best(const TriangleMesh& mesh);

/// A mesh that methods are compared on.
struct Disk {
  std::string name;
  TriangleMesh mesh;
  enum Size { small, large, huge } size = small;
};

const TriangleMesh& mesh_of(const std::vector<Disk>& all, const std::string& name);

/// A map of a peer program with what the referee says of it.
struct Peer {
  PeerMap map;
  DistortionReport report;
  bool valid() const { return report.flipped + report.degenerate_uv == 0 && report.overlapping_within_charts == 0; }
};

/// Maps of the program that param_peer.hpp describes.
class Peers {
 public:
  /// Runs the method at most once per mesh; small meshes a few times, for the least time.
  const Peer* find(const std::string& method, const std::string& name, const TriangleMesh& mesh);

 private:
  std::map<std::pair<std::string, std::string>, std::optional<Peer>> peers_;
};

/// Reads the medians of a benchmark.
struct Medians {
  const BenchReport& report;
  double operator()(const std::string& subject, const std::string& input, const std::string& quantity) const {
    return report.median_of(subject, input, quantity);
  }
  double cpu(const std::string& subject, const std::string& input) const {
    return (*this)(subject, input, "cpu_seconds");
  }
  double energy(const std::string& subject, const std::string& input) const {
    return (*this)(subject, input, "symmetric_dirichlet_mean");
  }
  bool valid(const std::string& subject, const std::string& input) const {
    return (*this)(subject, input, "flipped") == 0 && (*this)(subject, input, "degenerate_uv") == 0 &&
           (*this)(subject, input, "overlap_within_charts") == 0;
  }
};

/// Least CPU of ours over a share of the peer's.
void cpu_target(const std::string& promise, const TriangleMesh& mesh, const MapMethod& map, const Peer* peer,
                double limit, double peer_share, BenchReport& report);

/// The largest part of each file on the command line, welded; what is no mesh is left out.
std::vector<NamedMesh> files_of(const BenchReport& report);

/// Whether the method takes the whole mesh as one chart.
bool is_disk(const TriangleMesh& mesh);

/// Adds "name" to a list that begins with `start`.
void add_name(std::string& list, const std::string& name, const char* start = "not: ");

/// Newton steps of best on the dashboards, by own and other factorizations.
void add_factorizations(const std::vector<Disk>& all, BenchReport& report);

/// What the targets by their letters have to say.
void report_linear(const std::vector<Disk>& all, Peers& peers, const Medians& of, BenchReport& report);   // A
void report_maillot(const std::vector<Disk>& all, Peers& peers, const Medians& of, BenchReport& report);  // B
void report_best(const std::vector<Disk>& all, Peers& peers, const Medians& of, BenchReport& report);     // C
void report_curved(Peers& peers, BenchReport& report);                                                    // D
void report_extremes(const TriangleMesh& dash, BenchReport& report);                                      // E
void report_parts(const std::vector<Disk>& all, BenchReport& report);                                     // F
void report_triplanar(const std::vector<Disk>& all, const Medians& of, BenchReport& report);              // G
void report_same(const std::vector<Disk>& all, BenchReport& report);                                      // H
void report_bad_input(BenchReport& report);                                                               // H

}  // namespace papilla::bench
