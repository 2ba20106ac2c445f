// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>

#include "bench/bench_json.hpp"
#include "bench/weather_job.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/pipeline/contact_sheet.hpp"
#include "papilla/procedural/reference.hpp"
#include "papilla/procedural/texture.hpp"
#ifdef PAPILLA_HAVE_LIBNOISE
#include <libnoise/noise.h>
#endif
#ifdef PAPILLA_HAVE_MUPARSER
#include <muParser.h>
#endif

namespace {

using namespace papilla;
using bench::Recorder;

constexpr unsigned k_main = 1U << static_cast<unsigned>(Channel::main);
/// The source's figure: 88 pictures of 256 x 256 in 40 s on an Athlon 64 of 2.2 GHz (2006).
constexpr double k_source_seconds_per_map = 40.0 / 88;
constexpr const char* k_formula = ".5+.5*s(x*20+3*y)*c(y*7-x)+(x-y)^2*.25";

RenderedTexture render(const ProceduralTexture& texture, int size, unsigned channels) {
  RenderOptions options;
  options.width = options.height = size, options.channels = channels;
  return render_texture(texture, options);
}

void add_ours(bench::BenchReport& report, const std::string& method, const std::string& recipe, int size) {
  const auto texture = std::make_shared<ProceduralTexture>(compile_texture(recipe, RecipeLibrary::builtin()));
  report.add({.method = method, .solver = "papilla", .input = std::to_string(size), .options = {{"recipe", recipe}}},
             [=](Recorder& recorder) {
               const double before = bench::process_cpu_seconds();
               bench::keep(render(*texture, size, k_main).values.channels[0].data());
               recorder.record("cpu_ns_per_texel", 1e9 * (bench::process_cpu_seconds() - before) / size / size);
             });
}

/// The same loop over texels for whoever gives a value at a point.
template <class F>
void add_peer(bench::BenchReport& report, const std::string& method, const std::string& solver, int size, F value) {
  report.add({.method = method, .solver = solver, .input = std::to_string(size)}, [=](Recorder& recorder) {
    std::vector<float> out(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
    const double before = bench::process_cpu_seconds();
    std::size_t k = 0;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) out[k++] = static_cast<float>(value((x + 0.5) / size, (y + 0.5) / size));
    bench::keep(out.data());
    recorder.record("cpu_ns_per_texel", 1e9 * (bench::process_cpu_seconds() - before) / size / size);
  });
}

/// D = 3 - slope / 2 of the structure function over lags of first to last texels, doubling.
double dimension_of(const std::vector<float>& height, int size, int first, int last) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0, count = 0;
  for (int lag = first; lag <= last; lag *= 2, ++count) {
    double sum = 0, pairs = 0;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x + lag < size; ++x, ++pairs) {
        const auto at = static_cast<std::size_t>(y * size + x);
        const double d = static_cast<double>(height[at + static_cast<std::size_t>(lag)] - height[at]);
        sum += d * d;
      }
    const double lx = std::log(lag), ly = std::log(sum / pairs);
    sx += lx, sy += ly, sxx += lx * lx, sxy += lx * ly;
  }
  return 3 - (count * sxy - sx * sy) / (count * sxx - sx * sx) / 2;
}

std::string text(const char* format, double value) { return fmt::format(fmt::runtime(format), value); }

void dimension_target(bench::BenchReport& report) {
  bench::EvidenceTable table{
      "Dimension of fbm",
      "Structure function along rows of 1024 x 1024 texels, `fbm|scale=.5|octaves=6`, lags of 4 to 32 texels: from the "
      "side of the finest cells to a quarter of the side of the coarsest; mean of five seeds.",
      {"H", "3 - H", "D", "deviation"},
      {}};
  double worst = 0;
  for (const double h : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9}) {
    double d = 0;
    for (int seed = 0; seed < 5; ++seed)
      d += dimension_of(
               render(compile_texture("fbm|scale=.5|octaves=6|seed=" + std::to_string(seed) + "|h=" + std::to_string(h),
                                      {}),
                      1024, k_main)
                   .values[Channel::main],
               1024, 4, 32) /
           5;
    worst = std::max(worst, std::abs(d - 3 + h));
    table.rows.push_back({text("{:.1f}", h), text("{:.1f}", 3 - h), text("{:.3f}", d), text("{:+.3f}", d - 3 + h)});
  }
  report.target({"fbm with given H yields D = 3 - H within 0.05",
                 "largest deviation " + text("{:.3f}", worst) + " over H = 0.1 to 0.9", worst <= 0.05});
  report.table(std::move(table));
}

void seam_target(bench::BenchReport& report) {
  std::vector<double> x0, y0, x1, y1;
  for (int i = 0; i < 256; ++i) {
    const double t = (i + 0.5) / 256;
    x0.insert(x0.end(), {0, t}), y0.insert(y0.end(), {t, 0}), x1.insert(x1.end(), {1, t}), y1.insert(y1.end(), {t, 1});
  }
  int equal = 0, all = 0;
  std::string unlike;
  for (const TypeInfo& type : texture_types()) {
    std::string recipe = std::string(type.name) + "|seamless=true";
    if (type.name == "multi") recipe += "|textures=brick,fbm";
    if (type.name == "base" || type.name == "texture") recipe += "|mainfunction=noise2d(x*5.3,y*5.3)";
    if (type.name == "image") recipe += "|basetexture=star";
    const auto texture = compile_texture(recipe, RecipeLibrary::builtin());
    ++all;
    if (evaluate_texture(texture, {x0, y0, {}, {}, {}, {}}, k_main, 0).channels[0] ==
        evaluate_texture(texture, {x1, y1, {}, {}, {}, {}}, k_main, 0).channels[0])
      ++equal;
    else
      unlike += " " + std::string(type.name);
  }
  report.target({"every type with seamless=true is bit-equal across borders",
                 std::to_string(equal) + " of " + std::to_string(all) + " types" + unlike, equal == all});
}

/// The contact sheet beside the page, and what each type gives.
void types_table(bench::BenchReport& report) {
  namespace fs = std::filesystem;
  const ContactSheet sheet = make_contact_sheet(examples_of_types(), RecipeLibrary::builtin(), CompileOptions{}, 128);
  bench::EvidenceTable table{"Types", "", {"type", "least height", "largest", "mean"}, {}};
  table.note = fmt::format("The plainest recipe of every type, {} a row, in the order of the table.", sheet.columns);
  if (const fs::path page = report.options().evidence; !page.empty()) {
    const fs::path picture = fs::path(page).replace_filename(page.stem().string() + "-types.jpg");
    write_color_image(picture, sheet.picture);
    table.note += "\n\n![every type](" + picture.filename().string() + ")";
  }
  for (const SheetEntry& e : sheet.entries)
    table.rows.push_back({e.name, text("{:.3f}", e.low), text("{:.3f}", e.high), text("{:.3f}", e.mean)});
  report.table(std::move(table));
}

double ratio(const bench::BenchReport& report, const std::string& peer, const std::string& ours,
             const std::string& input) {
  return report.median_of(peer, input, "cpu_ns_per_texel") / report.median_of(ours, input, "cpu_ns_per_texel");
}

void speed_targets(bench::BenchReport& report, int size, const std::vector<int>& sizes) {
  const std::string input = std::to_string(size);
#ifdef PAPILLA_HAVE_LIBNOISE
  const double fbm = ratio(report, "fbm/libnoise", "fbm/papilla", input),
               f1 = ratio(report, "worley F1/libnoise", "worley F1/papilla", input);
  const double f2 = ratio(report, "worley F1/libnoise", "worley F2/papilla", input);
  report.target({"fBm of 6 octaves, " + input + "^2: at least 3.5 times faster than libnoise's Perlin",
                 text("{:.1f} times", fbm), fbm >= 3.5});
  report.target({"Worley F1 at least 50 times faster than libnoise's Voronoi", text("{:.1f} times", f1), f1 >= 50});
  report.target(
      {"Worley F1 and F2 at least 50 times faster than libnoise's Voronoi", text("{:.1f} times", f2), f2 >= 50});
#endif
  const double cpp = 1 / ratio(report, "formula/C++", "formula/papilla", input);
  report.target(
      {"a formula takes at most twice the time of the same in C++", text("{:.2f} times its time", cpp), cpp <= 2});
#ifdef PAPILLA_HAVE_MUPARSER
  const double mu = ratio(report, "formula/muParser", "formula/papilla", input);
  report.target({"a formula at least twice as fast as muParser", text("{:.1f} times", mu), mu >= 2});
#endif
  double least = 1e30, most = 0;
  for (const int s : sizes) {
    const double ns = report.median_of("sizes/papilla", std::to_string(s), "cpu_ns_per_texel");
    least = std::min(least, ns), most = std::max(most, ns);
  }
  report.target(
      {"time a texel constant from " + std::to_string(sizes.front()) + "^2 to " + std::to_string(sizes.back()) + "^2",
       text("{:.1f} to ", least) + text("{:.1f} ns", most), most <= 1.5 * least});
  const auto job = [&](const char* quantity) { return report.median_of("weather/papilla", "scene", quantity); };
  const double seconds = job("cpu_s") / job("maps");
  report.target(
      {fmt::format("the source's scene job, {:.0f} maps for {:.0f} triangles with {:.0f} normals, at least 100 times "
                   "faster a map than its 40 s / 88, with an atlas instead of duplicates",
                   job("maps"), job("faces"), job("normals")),
       fmt::format("{:.2f} ms a map, {:.0f} times (machines of 2006 and now); {:.0f} of {:.0f} tiles kept",
                   seconds * 1e3, k_source_seconds_per_map / seconds, job("tiles"), job("charts")),
       k_source_seconds_per_map / seconds >= 100});
}

void body(bench::BenchReport& report) {
  const bool quick = report.options().quick;
  const int size = quick ? 64 : 1024;
  const std::vector<int> sizes = quick ? std::vector<int>{64, 128} : std::vector<int>{256, 1024, 4096, 8192};
  add_ours(report, "fbm", "fbm|octaves=6|dynamicoctaves=false|closed=false", size);
  add_ours(report, "worley F1", "voronoi|scale=.25|rooted=true", size);
  add_ours(report, "worley F2", "voronoi|scale=.25|rooted=true|func=f2-f1", size);
  add_ours(report, "formula", std::string("base|mainfunction=") + k_formula, size);
  for (const int s : sizes) add_ours(report, "sizes", "noise", s);
  for (const bool sky : {false, true})
    report.add({.method = "weather", .solver = "papilla", .input = sky ? "scene and sky" : "scene"},
               [quick, sky](Recorder& recorder) {
                 const bench::WeatherJob job = bench::run_weather_job(quick ? 32 : 256, sky);
                 recorder.record("cpu_s", job.cpu_seconds);
                 recorder.record("maps", job.maps);
                 recorder.record("faces", job.faces);
                 recorder.record("normals", job.normals);
                 recorder.record("charts", job.charts);
                 recorder.record("tiles", job.tiles);
               });
  add_peer(report, "formula", "C++", size, [](double x, double y) {
    return .5 + .5 * std::sin(x * 20 + 3 * y) * std::cos(y * 7 - x) + (x - y) * (x - y) * .25;
  });
#ifdef PAPILLA_HAVE_LIBNOISE
  const auto perlin = std::make_shared<noise::module::Perlin>();
  perlin->SetOctaveCount(6);
  add_peer(report, "fbm", "libnoise", size,
           [perlin](double x, double y) { return perlin->GetValue(4 * x, 4 * y, 0.5); });
  const auto voronoi = std::make_shared<noise::module::Voronoi>();
  voronoi->EnableDistance(true);
  add_peer(report, "worley F1", "libnoise", quick ? 64 : size,
           [voronoi](double x, double y) { return voronoi->GetValue(16 * x, 16 * y, 0.5); });
#endif
#ifdef PAPILLA_HAVE_MUPARSER
  struct Formula {
    double x = 0, y = 0;
    mu::Parser parser;
  };
  const auto formula = std::make_shared<Formula>();
  formula->parser.DefineVar("x", &formula->x);
  formula->parser.DefineVar("y", &formula->y);
  formula->parser.SetExpr(".5+.5*sin(x*20+3*y)*cos(y*7-x)+(x-y)^2*.25");
  add_peer(report, "formula", "muParser", size, [formula](double x, double y) {
    formula->x = x, formula->y = y;
    return formula->parser.Eval();
  });
#endif
  report.measure();
  speed_targets(report, size, sizes);
  if (!quick) dimension_target(report);
  seam_target(report);
  types_table(report);
}

}  // namespace

int main(int argc, char** argv) { return bench::run_benchmark("procedural", "Procedural textures", argc, argv, body); }
