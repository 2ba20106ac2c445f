// SPDX-License-Identifier: MIT
// A whole bake of a CAD file beside what OpenCASCADE alone takes to read and to mesh it, as processes.
#include <fmt/core.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "bench/bench_json.hpp"
#include "bench/whole_process.hpp"

namespace {

using namespace papilla;
using bench::Recorder;
namespace fs = std::filesystem;

constexpr double k_most_of_reading = 1.3, k_most_wall = 0.6;
constexpr const char* k_input = "sample cockpit";

void body(bench::BenchReport& report) {
  const fs::path folder = fs::temp_directory_path() / fmt::format("papilla-bench-cad-{}", ::getpid());
  fs::create_directories(folder);
  std::ofstream(folder / "materials.json")
      << R"({"materials": {"skin": {"texture": "grain:leather", "size_mm": [40, 40],
    "height": {"method": "auto", "depth_mm": 0.3}}}, "assign": [{"part": "*", "material": "skin"}]})";
  const std::string chord = report.options().quick ? "2" : "0.1";
  const auto add = [&](const char* method, const char* solver, std::vector<std::string> command) {
    report.add({.method = method, .solver = solver, .input = k_input},
               [command = std::move(command)](Recorder& recorder) {
                 const bench::ProcessCost cost = bench::run_process(command);
                 recorder.record("process_seconds", cost.seconds);
                 recorder.record("process_cpu_seconds", cost.cpu_seconds);
                 recorder.record("wall_over_cpu", cost.seconds / cost.cpu_seconds);
               });
  };
  add("bake", "papilla",
      {PAPILLA_PROGRAM, "bake", PAPILLA_DATA "/cockpit.step", "-m", (folder / "materials.json").string(), "-o",
       (folder / "out.glb").string(), "--chord", chord, "--cache", "none"});
  add("read-and-mesh", "opencascade", {PAPILLA_OCCT_MESH, PAPILLA_DATA "/cockpit.step", chord, "20"});
  report.compare("bake/papilla", "read-and-mesh/opencascade", "process_seconds");
  report.measure();
  if (!report.options().quick) {
    const auto median = [&](const char* subject, const char* quantity) {
      return report.median_of(subject, k_input, quantity);
    };
    const double ratio =
        median("bake/papilla", "process_seconds") / median("read-and-mesh/opencascade", "process_seconds");
    report.target(
        {fmt::format("whole bake of the cockpit at most {} times OpenCASCADE's reading and meshing, wall time",
                     k_most_of_reading),
         fmt::format("{:.2f} times", ratio), ratio <= k_most_of_reading});
    const double wall = median("bake/papilla", "wall_over_cpu");
    report.target({fmt::format("wall at most {} of the processor time", k_most_wall), fmt::format("{:.2f}", wall),
                   wall <= k_most_wall});
  }
  fs::remove_all(folder);
}

}  // namespace

int main(int argc, char** argv) { return bench::run_benchmark("cad", "Bake of a CAD file", argc, argv, body); }
