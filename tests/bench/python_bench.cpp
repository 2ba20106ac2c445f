// SPDX-License-Identifier: MIT
// Calls of the Python module beside the same calls in C++, in one process: what numpy's arrays and the interpreter
// cost.
#include <fmt/core.h>
#include <pybind11/embed.h>
#include <pybind11/numpy.h>

#include "bench/bench_json.hpp"
#include "papilla/meshing/repair.hpp"
#include "papilla/meshing/weld.hpp"
#include "papilla/param/measure.hpp"
#include "papilla/pipeline/unwrap_method.hpp"
#include "support/formula_meshes.hpp"

namespace {

using namespace papilla;
namespace py = pybind11;

template <class Number, class Row>
py::array array_of(const Values<Row>& rows) {
  constexpr std::size_t k_columns = sizeof(Row) / sizeof(Number);
  return py::array_t<Number>({rows.size(), k_columns}, reinterpret_cast<const Number*>(rows.data()));
}

/// A surface as both sides have it.
struct Input {
  TriangleMesh mesh;
  py::array V, F, uv;
};

Input make_input(bool quick) {
  Input input;
  input.mesh = quick ? test::dashboard_mesh(30, 10) : test::dashboard_mesh(374, 134);
  input.mesh.uv.indices = input.mesh.triangles;
  for (const Vec3& p : input.mesh.positions) input.mesh.uv.values.push_back({p.x, p.y});
  input.V = array_of<double>(input.mesh.positions);
  input.F = array_of<std::int32_t>(input.mesh.triangles);
  input.uv = array_of<double>(input.mesh.uv.values);
  return input;
}

/// A call on both sides.
struct Pair {
  std::string name;
  std::function<void()> native, python;
};

std::vector<Pair> pairs(const Input& input, const py::module_& papilla) {
  using namespace py::literals;
  const py::object distortion = papilla.attr("distortion"), parameterize = papilla.attr("parameterize"),
                   repaired = papilla.attr("repair"), made = papilla.attr("mesh");
  MethodOptions lscm;
  lscm.method = UnwrapMethod::lscm;
  lscm.charts = ChartSource::keep;
  return {{"distortion", [&input] { bench::keep(measure_distortion(input.mesh, input.mesh.uv).measured_triangles); },
           [&input, distortion] { distortion(input.V, input.F, input.uv); }},
          {"parameterize lscm",
           [&input, lscm] { bench::keep(flatten_part(weld_equal(input.mesh).mesh, {}, lscm).flattening.charts.count); },
           [&input, parameterize] { parameterize(input.V, input.F, "method"_a = "lscm", "charts"_a = "keep"); }},
          {"repair", [&input] { bench::keep(repair(input.mesh).passes); },
           [mesh = made(input.V, input.F, input.uv), repaired] { repaired(mesh); }}};
}

/// What is compared. Wall time says little of so small a difference where a machine has other work.
struct Quantity {
  const char *name, *words;
};
constexpr Quantity k_quantities[] = {{"seconds", "wall time"}, {"cpu_seconds", "processor time"}};

void body(bench::BenchReport& report) {
  const py::scoped_interpreter interpreter;
  py::module_::import("sys").attr("path").attr("insert")(0, PAPILLA_PYTHON);
  {
    const py::module_ papilla = py::module_::import("papilla");
    const Input input = make_input(report.options().quick);
    const std::string name = fmt::format("dash of {} triangles", input.mesh.triangles.size());
    const auto all = pairs(input, papilla);
    for (const Pair& pair : all) {
      report.add({.method = pair.name, .input = name}, [&](bench::Recorder&) { pair.native(); });
      report.add({.method = pair.name, .solver = "python", .input = name}, [&](bench::Recorder&) { pair.python(); });
      for (const Quantity& quantity : k_quantities) report.compare(pair.name + "/python", pair.name, quantity.name);
    }
    // What a mesh of arrays costs once; the other calls above copy their arrays each time.
    const py::object made = papilla.attr("mesh");
    report.add({.method = "mesh", .solver = "python", .input = name},
               [&](bench::Recorder&) { made(input.V, input.F, input.uv); });
    report.measure();
    for (const Pair& pair : all)
      for (const Quantity& quantity : k_quantities) {
        const double native = report.median_of(pair.name, name, quantity.name);
        const double python = report.median_of(pair.name + "/python", name, quantity.name);
        report.target({fmt::format("{}: at most 5 % more {} from Python than in C++", pair.name, quantity.words),
                       fmt::format("{:.1f} ms beside {:.1f} ms: {:+.1f} %", 1e3 * python, 1e3 * native,
                                   100 * (python / native - 1)),
                       python <= 1.05 * native});
      }
  }
}

}  // namespace

int main(int argc, char** argv) {
  return bench::run_benchmark("python", "Calls from Python beside C++", argc, argv, body);
}
