// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/core.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "bench/bench_json.hpp"
#include "bench/whole_process.hpp"
#include "live_socket.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/io/glb_writer.hpp"
#include "papilla/io/gltf_reader.hpp"
#include "support/formula_meshes.hpp"

namespace {

using namespace papilla;
using bench::Json;
using bench::Recorder;
namespace fs = std::filesystem;

constexpr const char* k_cockpit = "sample cockpit";
constexpr const char* k_grid = "grid of two million triangles";
constexpr double k_megabyte = 1e6;

/// Goes away with the benchmark.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("papilla-bench-page-" + std::to_string(::getpid()))) {
    fs::create_directories(path_ / "grain");
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

Json read_json(const std::string& file) { return Json::parse(read_file(file)); }

void make_materials(const Folder& folder) {
  const std::string text = read_file(PAPILLA_DATA "/cockpit.materials.json");
  std::ofstream(folder / "materials.json") << text;
  constexpr std::string_view k_head = "\"grain/", k_tail = ".png\"";
  for (std::size_t at = text.find(k_head); at != std::string::npos; at = text.find(k_head, at + 1)) {
    const std::size_t begin = at + k_head.size();
    const std::string kind = text.substr(begin, text.find(k_tail, begin) - begin);
    bench::run_process(
        {PAPILLA_PROGRAM, "synthesize", "grain", "--kind", kind, "-o", folder / ("grain/" + kind + ".png")});
  }
}

void make_grid(const Folder& folder, bool quick) {
  const int n = quick ? 100 : 1000;
  Part part;
  part.name = "grid";
  part.mesh = test::dashboard_mesh(n, n);
  part.mesh.uv = test::uv_per_vertex(part.mesh, [](Vec3 p) { return Vec2{p.x / 1000, p.z / 1000}; });
  write_glb(single_part_scene(std::move(part), "bench"), folder / "grid.glb", {});
}

void add_bakes(bench::BenchReport& report, const Folder& folder) {
  const std::vector<std::string> plain = {
      PAPILLA_PROGRAM,        "bake",    PAPILLA_DATA "/cockpit.step",        "-m", folder / "materials.json", "-o",
      folder / "cockpit.glb", "--chord", report.options().quick ? "2" : "0.1"};
  std::vector<std::string> reported = plain;
  reported.insert(reported.end(), {"--report", folder / "report"});
  for (const auto& [solver, command] : {std::pair("plain", plain), std::pair("report", reported)})
    report.add({.method = "bake", .solver = solver, .input = k_cockpit}, [command = command](Recorder& recorder) {
      recorder.record("process_cpu_seconds", bench::run_process(command).cpu_seconds);
    });
  report.compare("bake/report", "bake/plain", "process_cpu_seconds");
}

void add_view(bench::BenchReport& report, const Folder& folder) {
  report.add({.method = "view", .input = k_grid}, [&folder](Recorder& recorder) {
    const bench::ProcessCost cost =
        bench::run_process({PAPILLA_PROGRAM, "view", folder / "grid.glb", "-o", folder / "grid.html", "--no-open"});
    recorder.record("process_cpu_seconds", cost.cpu_seconds);
    recorder.record("page_mb", static_cast<double>(fs::file_size(folder / "grid.html")) / k_megabyte);
  });
}

/// Reads what a player tells until it ends; counts the bytes.
void listen_to(const std::string& socket, std::size_t& bytes) {
  int connection = -1;
  for (int i = 0; i < 500 && connection < 0; ++i) {
    connection = app::connect_live(socket);
    if (connection < 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  std::array<char, 4096> buffer;
  for (ssize_t got = 1; connection >= 0 && got > 0;) {
    got = ::recv(connection, buffer.data(), buffer.size(), 0);
    if (got > 0) bytes += static_cast<std::size_t>(got);
  }
  if (connection >= 0) ::close(connection);
}

void add_players(bench::BenchReport& report, const Folder& folder) {
  const std::string seconds = report.options().quick ? "0.3" : "5";
  const auto play = [&folder, seconds](Recorder& recorder, std::vector<std::string> more) {
    std::vector<std::string> command = {PAPILLA_PLAYER, folder / "cockpit.glb", "--seconds", seconds,
                                        "--json",       folder / "player.json"};
    command.insert(command.end(), more.begin(), more.end());
    bench::run_process(command);
    const Json json = read_json(folder / "player.json");
    for (const char* name : {"p50", "p99", "p999"})
      recorder.record(std::string("tick_us_") + name, json["tick_us"][name].get<double>());
  };
  report.add({.method = "player", .solver = "alone", .input = k_cockpit},
             [play](Recorder& recorder) { play(recorder, {}); });
  report.add({.method = "player", .solver = "followed", .input = k_cockpit, .notes = "two listeners"},
             [play, &folder](Recorder& recorder) {
               const std::string socket = folder / "p.sock";
               std::array<std::size_t, 2> bytes{};
               {
                 std::array<std::jthread, 2> listeners;
                 for (std::size_t i = 0; i < 2; ++i)
                   listeners[i] = std::jthread([&socket, &bytes, i] { listen_to(socket, bytes[i]); });
                 play(recorder, {"--live", socket});
               }
               recorder.record("bytes_heard", static_cast<double>(std::min(bytes[0], bytes[1])));
             });
  for (const char* quantity : {"tick_us_p50", "tick_us_p99", "tick_us_p999"})
    report.compare("player/followed", "player/alone", quantity);
}

double ratio_of(const bench::BenchReport& report, const std::string& method, const std::string& quantity) {
  for (const Json& ratio : report.json()["ratios"])
    if (ratio["method"] == method && ratio["quantity"] == quantity) return ratio["ratio"].get<double>();
  return 0;
}

/// In a browser with software GL: what is shown, and how long a turn takes.
void browser_targets(bench::BenchReport& report, const Folder& folder) {
  const std::string command = fmt::format("{} '{}' '{}'", PAPILLA_RATES, folder / "grid.html", folder / "rates.json");
  const bool ran = std::system(command.c_str()) == 0 && fs::exists(folder / "rates.json");
  const std::string promise = "two million triangles turn at 10 pictures a second on software GL";
  if (!ran) return report.target({promise, "no Chromium, or no playwright-core (npm ci in tests/page)", {}});
  const Json rates = read_json(folder / "rates.json");
  const double turn_ms = bench::median(rates["turn_ms"].get<std::vector<double>>());
  report.target(
      {promise,
       fmt::format("{:.0f} ms a picture; {} triangles shown while it moves, {} at rest", turn_ms,
                   rates["triangles_moving"].get<std::size_t>(), rates["triangles_at_rest"].get<std::size_t>()),
       turn_ms <= 100});
  report.target({"the page of a grid opens without a complaint of the browser",
                 fmt::format("{} complaints", rates["complaints"].size()), rates["complaints"].empty()});
}

/// A part of a GLB file as a file of its own.
void take_part(const std::string& from, const std::string& name, const std::string& to) {
  Scene scene = read_gltf(from);
  const auto found =
      std::find_if(scene.parts.begin(), scene.parts.end(), [&](const Part& part) { return part.name == name; });
  if (found == scene.parts.end()) throw InvalidInput(from + ": has no part '" + name + "'");
  Scene alone = single_part_scene(std::move(*found), "bench");
  alone.materials = std::move(scene.materials);
  write_glb(alone, to, {});
}

/// From the drop of a material on the dash until the studio's page has drawn it, and what `papilla unwrap` takes for
/// that dash alone.
void studio_targets(bench::BenchReport& report, const Folder& folder) {
  const std::string promise = "the studio: grain is on the cockpit's dash within 1 s of the drop";
  const std::string command = fmt::format("{} '{}' '{}' dash_skin '{}'", PAPILLA_DROPS, PAPILLA_PROGRAM,
                                          PAPILLA_DATA "/cockpit.step", folder / "drops.json");
  const bool ran = std::system(command.c_str()) == 0 && fs::exists(folder / "drops.json");
  if (!ran) return report.target({promise, "no Chromium, or no playwright-core (npm ci in tests/page)", {}});
  bench::run_process({PAPILLA_PROGRAM, "tessellate", PAPILLA_DATA "/cockpit.step", "-o", folder / "parts.glb"});
  take_part(folder / "parts.glb", "dash_skin", folder / "dash.glb");
  const bench::ProcessCost unwrap =
      bench::run_process({PAPILLA_PROGRAM, "unwrap", folder / "dash.glb", "-o", folder / "dash_uv.glb", "--layout",
                          "tile", "--tile", "40", "40", "--cache", "none"});
  std::vector<double> drawn, served;
  for (const Json& drop : read_json(folder / "drops.json")) {
    drawn.push_back(drop["drawn_ms"].get<double>());
    served.push_back(drop["server_ms"].get<double>());
  }
  report.target(
      {promise,
       fmt::format("{:.0f} ms in the middle of {} leathers with software GL, of which {:.0f} ms of the server; "
                   "{:.1f} times as long as `papilla unwrap` of the dash alone",
                   bench::median(drawn), drawn.size(), bench::median(served),
                   bench::median(drawn) / (1000 * unwrap.seconds)),
       bench::median(drawn) <= 1000});
}

void body(bench::BenchReport& report) {
  const Folder folder;
  make_materials(folder);
  make_grid(folder, report.options().quick);
  add_bakes(report, folder);
  add_view(report, folder);
  add_players(report, folder);
  report.measure();
  const double share = ratio_of(report, "bake/report", "process_cpu_seconds") - 1;
  report.target({"the cockpit's report takes at most 25 % of its bake's processor time",
                 fmt::format("{:.0f} %", 100 * share), share <= 0.25});
  const double page_mb = static_cast<double>(fs::file_size(folder / "report/index.html")) / k_megabyte;
  report.target({"the cockpit's page has at most 10 MB", fmt::format("{:.1f} MB", page_mb), page_mb <= 10});
  const double slower = ratio_of(report, "player/followed", "tick_us_p99");
  report.target({"two pages that follow the player make its tick (p99) at most 10 % longer",
                 fmt::format("{:.2f} times", slower), slower <= 1.1});
  browser_targets(report, folder);
  studio_targets(report, folder);
}

}  // namespace

int main(int argc, char** argv) { return bench::run_benchmark("page", "Report page and live view", argc, argv, body); }
