// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>
#include <vector>

#include "haptic/tagged_glb.hpp"
#include "papilla/core/vec.hpp"
#include "papilla/haptic/sha256.hpp"
#include "player/sentinel.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::string sum(const std::string& text) { return sha256_hex(std::as_bytes(std::span(text.data(), text.size()))); }

Json tag() {
  return {{"version", 1},
          {"stiffness", 900},
          {"damping", 0.1},
          {"staticFriction", 0.3},
          {"dynamicFriction", 0.2},
          {"height",
           {{"image", "haptic.height.grain"},
            {"sha256", sum(testing::sine_png())},
            {"bits", 16},
            {"scale", 2e-4},
            {"offset", -1e-4},
            {"metresPerUV", {0.04, 0.04}}}}};
}

struct Outcome {
  int code = -1;
  std::string out, error;
  bool as_json = false;  ///< `--json -` was asked for.
  Json json() const { return Json::parse(out); }
};

class Player : public ::testing::Test {
 protected:
  Player() { fs::create_directories(folder_); }
  ~Player() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return (folder_ / name).string();
  }
  static std::string slurp(const fs::path& path) {
    std::stringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
  }
  Outcome play(const std::string& arguments) const {
    const fs::path out = folder_ / "out", error = folder_ / "error";
    const int status = std::system(
        ("'" PAPILLA_PLAYER "' " + arguments + " >'" + out.string() + "' 2>'" + error.string() + "'").c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, slurp(out), slurp(error),
            arguments.find("--json -") != std::string::npos};
  }
  Outcome play_glb(const Json& extras, const std::string& image, const std::string& more = "") const {
    return play("'" + write("a b.glb", testing::plate_glb(extras, image)) + "' --seconds 0.6 --json - " + more);
  }
  /// Starts the player, calls `act` with its process after half a second, and waits for it. The report is in r.json.
  /// @returns the exit code.
  int play_and(const std::vector<std::string>& arguments, const std::function<void(pid_t)>& act) const {
    const std::string json = (folder_ / "r.json").string(), error = (folder_ / "error").string();
    std::vector<std::string> all = {PAPILLA_PLAYER, "-q", "--json", json};
    all.insert(all.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& argument : all) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const pid_t child = ::fork();
    if (child == 0) {
      if (std::freopen(error.c_str(), "w", stderr) == nullptr) ::_exit(126);
      ::execv(PAPILLA_PLAYER, argv.data());
      ::_exit(127);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    act(child);
    int status = 0;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  Json last_report() const { return Json::parse(slurp(folder_ / "r.json")); }
  /// The same with a long run that `act` ends.
  int play_while(const std::string& glb, const std::function<void(pid_t)>& act) const {
    const int code = play_and({glb, "--seconds", "100"}, act);
    EXPECT_GT(last_report()["ticks"], 10);
    EXPECT_LT(last_report()["ticks"], 50000);
    return code;
  }
  static void expect_warning(const Json& report, const std::string& code) {
    bool found = false;
    for (const Json& warning : report["warnings"]) found = found || warning["code"] == code;
    EXPECT_TRUE(found) << code << " in " << report["warnings"];
  }
  void expect_refusal(const Outcome& outcome, int code) const {
    EXPECT_EQ(outcome.code, code) << outcome.error;
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
    if (!outcome.as_json) {
      EXPECT_EQ(outcome.out, "");
      return;
    }
    EXPECT_EQ(outcome.json()["exit_code"], code);
    EXPECT_NE(outcome.error.find(outcome.json()["error"].get<std::string>()), std::string::npos) << outcome.out;
    EXPECT_EQ(outcome.json().size(), 2U);
  }

  fs::path folder_ = fs::temp_directory_path() / ("papilla-player-test-" + std::to_string(::getpid()));
};

TEST_F(Player, FeelsThePlateAndReportsEveryKey) {
  const Outcome outcome = play_glb({{"haptic", tag()}}, testing::sine_png());
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  const Json report = outcome.json();
  EXPECT_EQ(report["rate_hz"], 1000);
  EXPECT_EQ(report["ticks"], 600);
  EXPECT_GT(report["contact_ticks"], 300);
  EXPECT_EQ(report["lost_contact_ticks"], 0);
  EXPECT_GT(report["max_force_n"], 0.1);
  EXPECT_LE(report["max_force_n"], 3.3);
  EXPECT_NEAR(report["stiffness_limit_n_per_m"].get<double>(), 400, 1e-6);
  EXPECT_EQ(report["clamped_materials"], Json({"grain"}));
  EXPECT_EQ(report["height_maps"]["loaded"], 1);
  EXPECT_EQ(report["height_maps"]["missing"], 0);
  EXPECT_EQ(report["triangles"], 200);
  EXPECT_EQ(report["warnings"], Json::array());
  for (const char* key : {"missed_deadlines", "load_seconds", "rss_mib"}) EXPECT_TRUE(report[key].is_number()) << key;
  for (const char* key : {"wakeup_us", "tick_us"})
    for (const char* quantile : {"p50", "p99", "p999", "max"}) EXPECT_TRUE(report[key][quantile].is_number());
}

TEST_F(Player, FindsTheMapAsDataUriAndAsSidecar) {
  Json data = tag();
  data["height"].erase("image");
  data["height"]["uri"] = "my%20map.png";
  write("my map.png", testing::sine_png());
  EXPECT_EQ(play_glb({{"haptic", data}}, "").json()["height_maps"]["loaded"], 1);

  const std::string png = testing::grey16_png(1, 1, {1234});
  data["height"]["uri"] = "data:image/png;base64," + testing::base64(png);
  data["height"]["sha256"] = sum(png);
  const Outcome outcome = play_glb({{"haptic", data}}, "");
  EXPECT_EQ(outcome.json()["height_maps"]["loaded"], 1) << outcome.out;
}

TEST_F(Player, LostMapsFallBackWithACode) {
  Json wrong = tag();
  wrong["height"]["sha256"] = std::string(64, '0');
  Json report = play_glb({{"haptic", wrong}}, testing::sine_png()).json();
  EXPECT_EQ(report["height_maps"]["missing"], 1);
  expect_warning(report, "height_sha256");
  expect_warning(report, "height_lost");

  wrong["roughness"] = {{"fractalDimension", 2.3}, {"rmsHeight", 2e-5}, {"wavelengthRange", {5e-4, 1e-2}}};
  report = play_glb({{"haptic", wrong}}, "").json();
  expect_warning(report, "height_image");
  expect_warning(report, "height_from_roughness");
  EXPECT_EQ(report["lost_contact_ticks"], 0);

  Json damaged = tag();
  damaged["height"]["sha256"] = sum("no picture");
  expect_warning(play_glb({{"haptic", damaged}}, "no picture").json(), "height_image");
}

TEST_F(Player, ReadsNoMapOutsideTheFolderOfItsFile) {
  const fs::path inside = folder_ / "inside";
  fs::create_directories(inside);
  write("map.png", testing::sine_png());
  Json data = tag();
  data["height"].erase("image");
  for (const std::string& address : {std::string("../map.png"), std::string("%2e%2e/map.png"),
                                     std::string("./a/../../map.png"), (folder_ / "map.png").string()}) {
    data["height"]["uri"] = address;
    const std::string glb = write("inside/p.glb", testing::plate_glb({{"haptic", data}}, ""));
    const Outcome outcome = play("'" + glb + "' --seconds 0.1 --json -");
    expect_refusal(outcome, 3);
    EXPECT_NE(outcome.error.find("p.glb: at /materials/0/extras/haptic/height/uri: '"), std::string::npos) << address;
  }
  fs::create_symlink("../map.png", inside / "link.png");
  write("inside/text.png", "root:x:0:0");
  for (const auto& [address, reason] : {std::pair("link.png", "leads out of the folder"),
                                        std::pair("text.png", "is no PNG picture"), std::pair(".", "leads out")}) {
    data["height"]["uri"] = address;
    const Outcome outcome = play("'" + write("inside/p.glb", testing::plate_glb({{"haptic", data}}, "")) + "'");
    expect_refusal(outcome, 3);
    EXPECT_NE(outcome.error.find(reason), std::string::npos) << outcome.error;
  }
  data["height"]["uri"] = "missing.png";
  const std::string glb = write("inside/p.glb", testing::plate_glb({{"haptic", data}}, ""));
  expect_warning(play("'" + glb + "' --seconds 0.1 --json -").json(), "height_file");
}

TEST_F(Player, OddTagsGiveWarningsOrAreRefused) {
  Json odd = tag();
  odd["stiffness"] = "NaN";
  odd["staticFriction"] = -1;
  const Json report = play_glb({{"haptic", odd}}, testing::sine_png()).json();
  expect_warning(report, "tag_stiffness");
  expect_warning(report, "tag_friction");
  odd["version"] = 3;
  expect_refusal(play_glb({{"haptic", odd}}, ""), 3);
  expect_refusal(play_glb(Json::object(), ""), 3);
}

TEST_F(Player, RubbishIsOneLineAndAnExitCode) {
  const std::string glb = testing::plate_glb({{"haptic", tag()}}, testing::sine_png());
  const std::string good = write("good.glb", glb);
  for (const std::string& file : {write("cut.glb", glb.substr(0, 900)), write("empty.glb", ""),
                                  write("text.glb", "hello"), folder_.string(), (folder_ / "missing.glb").string()})
    expect_refusal(play("'" + file + "'"), 3);
  expect_refusal(play("'" + good + "' --trajectory '" + write("t.csv", "0,1,2\n") + "'"), 3);
  expect_refusal(play("'" + good + "' --trajectory '" + folder_.string() + "'"), 3);
  const std::string far = write("far.csv", "t,x,y,z\n0,0,0,0.01\n0.1,0,0,1e20\n");
  expect_refusal(play("'" + good + "' --trajectory '" + far + "'"), 3);
  expect_refusal(play("'" + good + "' --device sim:nothing"), 2);
  EXPECT_EQ(play("'" + good + "' --device spoon").code, 2);
  EXPECT_EQ(play("'" + good + "' --rate 0").code, 2);
  for (const char* option : {"--rate nan", "--seconds nan", "--seconds -1", "--seconds 1e5", "--speed nan",
                             "--seed nan", "--seed -1", "--origin nan,0,0"})
    EXPECT_EQ(play("'" + good + "' " + option).code, 2) << option;
  EXPECT_EQ(play("").code, 2);
  EXPECT_EQ(play("--help").code, 0);
}

TEST_F(Player, RecordingPlayedAgainGivesTheSameFile) {
  const std::string glb = write("p.glb", testing::plate_glb({{"haptic", tag()}}, testing::sine_png()));
  const fs::path first = folder_ / "1.csv", second = folder_ / "2.csv";
  ASSERT_EQ(play("'" + glb + "' -q --watchdog 1000 --rate 2000 --seconds 0.5 --record '" + first.string() + "'").code,
            0);
  ASSERT_EQ(play("'" + glb + "' -q --watchdog 1000 --rate 2000 --trajectory '" + first.string() + "' --record '" +
                 second.string() + "'")
                .code,
            0);
  EXPECT_GT(slurp(first).size(), 100000U);
  EXPECT_EQ(slurp(first), slurp(second));
}

/// A number of a WAV file.
template <typename Number>
Number at(const std::string& file, std::size_t place) {
  Number value{};
  std::memcpy(&value, file.data() + place, sizeof value);
  return value;
}

TEST_F(Player, VibrationIsWrittenAsSound) {
  const std::string wav = (folder_ / "v.wav").string();
  const Outcome outcome = play_glb({{"haptic", tag()}}, testing::sine_png(), "--vibration '" + wav + "'");
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  const Json told = outcome.json()["vibration"];
  EXPECT_NEAR(told["samples"].get<double>(), 0.6 * 48000, 48);
  EXPECT_EQ(told["missed_ticks"], 0);
  EXPECT_GT(told["rms_m_per_s2"], 0.02);
  EXPECT_LT(told["rms_m_per_s2"], 0.08);  // 0.05 on two triangles: a smooth wave, whatever edges lie below it.
  const std::string sound = slurp(wav);
  ASSERT_GT(sound.size(), 1000U);
  EXPECT_EQ(sound.substr(0, 4) + sound.substr(8, 4), "RIFFWAVE");
  EXPECT_EQ(at<std::uint32_t>(sound, sound.find("fmt ") + 12), 48000U);
  const std::size_t data = sound.find("data");
  ASSERT_EQ(at<std::uint32_t>(sound, data + 4), 4 * told["samples"].get<std::uint32_t>());
  double squares = 0;
  for (std::size_t i = 0; i < told["samples"]; ++i) {
    const auto sample = static_cast<double>(at<float>(sound, data + 8 + 4 * i));
    ASSERT_LE(std::abs(sample), 1);
    squares += sample * sample;
  }
  // Full scale is 50 m/s2.
  EXPECT_NEAR(50 * std::sqrt(squares / told["samples"].get<double>()), told["rms_m_per_s2"].get<double>(), 0.05);

  // What is full scale is asked for; up to half of it sound is linear, and loud parts keep both their signs.
  const auto extremes = [&](double full_scale) {
    const std::string file = (folder_ / "w.wav").string();
    const Outcome other = play_glb({{"haptic", tag()}}, testing::sine_png(),
                                   "--vibration '" + file + "' --full-scale " + std::to_string(full_scale));
    EXPECT_EQ(other.code, 0) << other.error;
    const std::string bytes = slurp(file);
    std::pair<float, float> found{0, 0};
    const std::size_t first = bytes.find("data") + 8;
    for (std::size_t at_byte = first; at_byte + 4 <= bytes.size(); at_byte += 4) {
      const float sample = at<float>(bytes, at_byte);
      found = {std::min(found.first, sample), std::max(found.second, sample)};
    }
    return found;
  };
  const double peak = told["peak_m_per_s2"].get<double>();
  const auto quiet = extremes(3 * peak), loud = extremes(0.2 * peak);
  EXPECT_NEAR(std::max(-quiet.first, quiet.second), 1.0 / 3, 0.05);
  EXPECT_LT(loud.first, -0.6F);
  EXPECT_GT(loud.second, 0.6F);

  expect_refusal(play_glb({{"haptic", tag()}}, testing::sine_png(), "--vibration x.mp3"), 2);
  expect_refusal(play_glb({{"haptic", tag()}}, testing::sine_png(), "--vibration /nowhere/v.wav"), 3);
  expect_refusal(play_glb({{"haptic", tag()}}, testing::sine_png(), "--vibration alsa:none-such"), 5);
}

TEST_F(Player, WritesOverNothingThatItReads) {
  const std::string content = testing::plate_glb({{"haptic", tag()}}, testing::sine_png());
  const std::string glb = write("p.glb", content), quoted = "'" + glb + "'";
  const std::string hand = write("t.csv", "t,x,y,z\n0,0,0,0.01\n0.1,0,0,-0.001\n");
  const std::string fresh = folder_.filename().string() + ".csv";  // No such file exists.
  const std::string around = "'" + (folder_ / "." / "p.glb").string() + "'";
  for (const std::string& arguments :
       {quoted + " --record " + quoted, quoted + " --json " + quoted, quoted + " --json " + around,
        quoted + " --trajectory '" + hand + "' --record '" + hand + "'",
        quoted + " --record " + fresh + " --json ./" + fresh})
    expect_refusal(play(arguments), 2);
  EXPECT_FALSE(fs::exists(fresh));
  EXPECT_EQ(slurp(glb), content);
}

TEST_F(Player, SignalEndsItWithAReport) {
  const std::string glb = write("p.glb", testing::plate_glb({{"haptic", tag()}}, testing::sine_png()));
  EXPECT_EQ(play_while(glb, [](pid_t child) { ::kill(child, SIGTERM); }), 5);
}

struct RecordedTick {
  Vec3 probe, proxy, force;
  bool contact = false;
  friend bool operator==(const RecordedTick&, const RecordedTick&) = default;
};

std::vector<RecordedTick> recorded(const std::string& csv) {
  std::vector<RecordedTick> ticks;
  std::istringstream lines(csv);
  std::string line;
  for (std::getline(lines, line); std::getline(lines, line);) {
    std::vector<double> v;
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) v.push_back(std::stod(field));
    ticks.push_back({{v[4], v[5], v[6]}, {v[7], v[8], v[9]}, {v[10], v[11], v[12]}, v[13] != 0});
  }
  return ticks;
}

/// A hand that presses a millimetre into the plate twice a second, in a run that is stopped and continued, beside the
/// same run without that. What the machine itself holds up by more than a watchdog of 300 ms is no part of the test.
TEST_F(Player, ForceFadesInAgainAfterASigstop) {
  const std::string glb = write("p.glb", testing::plate_glb({{"haptic", tag()}}, testing::sine_png()));
  std::string hand = "t,x,y,z\n";
  for (int i = 0; i < 12; ++i) {
    const std::string x = "0.05,", z = ",-0.05\n";
    hand += std::to_string(0.5 * i) + "," + x + "0.004" + z + std::to_string(0.5 * i + 0.05) + "," + x + "-0.001" + z +
            std::to_string(0.5 * i + 0.4) + "," + x + "-0.001" + z;
  }
  const std::string path = write("t.csv", hand);
  const auto play_with = [&](const std::string& record, const std::function<void(pid_t)>& act) {
    EXPECT_EQ(play_and({glb, "--trajectory", path, "--seconds", "3", "--watchdog", "300", "--record", record}, act), 0);
    return recorded(slurp(record));
  };
  const std::vector<RecordedTick> whole = play_with((folder_ / "1.csv").string(), [](pid_t) {});
  const Json calm = last_report();
  const std::vector<RecordedTick> paused = play_with((folder_ / "2.csv").string(), [](pid_t child) {
    ::kill(child, SIGSTOP);
    std::this_thread::sleep_for(std::chrono::milliseconds(900));
    ::kill(child, SIGCONT);
  });
  const Json report = last_report();
  ASSERT_EQ(calm["pauses"]["count"], 0);
  ASSERT_EQ(report["pauses"]["count"], 1);
  EXPECT_GE(report["pauses"]["longest_s"], 0.85);
  EXPECT_GE(report["missed_deadlines"].get<int>(), calm["missed_deadlines"].get<int>() + 800);
  EXPECT_EQ(report["ticks"], 3000);
  ASSERT_EQ(paused.size(), whole.size());
  const auto differs = std::mismatch(whole.begin(), whole.end(), paused.begin());
  ASSERT_NE(differs.first, whole.end());
  // Forces begin at zero with the proxy at the probe, and take 50 ms from the next contact on.
  auto i = static_cast<std::size_t>(differs.first - whole.begin());
  ASSERT_LT(i + 600, paused.size());
  if (i > 0 && whole[i - 1].contact) {  // Else it stood still in the air.
    EXPECT_EQ(paused[i].force, Vec3{});
    EXPECT_EQ(paused[i].proxy, paused[i].probe);
    while (!paused[i].contact) ++i;
  }
  const double full = 0.55;  // N, at most: 400 N/m and the hand's 1000 N/m share 1.5 mm, and the relief rises.
  for (int k = 0; k < 50; ++k) EXPECT_LE(norm(paused[i + static_cast<std::size_t>(k)].force), full * (k + 1) / 50) << k;
  // The hand may be about to leave the plate, but presses again within half a second.
  const auto feels = [](const RecordedTick& tick) { return norm(tick.force) > 0.1; };
  const auto next = paused.begin() + static_cast<std::ptrdiff_t>(i);
  EXPECT_TRUE(std::any_of(next + 50, next + 600, feels));
}

/// 10 ms: any machine stands still for longer when it is asked to.
TEST_F(Player, AStandstillBeyondTheWatchdogIsAPause) {
  const std::string glb = write("p.glb", testing::plate_glb({{"haptic", tag()}}, testing::sine_png()));
  EXPECT_EQ(play_and({glb, "--seconds", "2", "--watchdog", "10"},
                     [](pid_t child) {
                       ::kill(child, SIGSTOP);
                       std::this_thread::sleep_for(std::chrono::milliseconds(300));
                       ::kill(child, SIGCONT);
                     }),
            0);
  EXPECT_GE(last_report()["pauses"]["count"], 1);
}

/// Tags that ask for more than a device can do.
TEST_F(Player, HostileTagsAreHeldBackWithAWarning) {
  const auto expect_limited = [&](const Json& hostile, const std::string& code, const std::string& field,
                                  const std::string& value, const std::string& limit) {
    const fs::path record = folder_ / "r.csv";
    const Outcome outcome =
        play_glb({{"haptic", hostile}}, testing::sine_png(), "--watchdog 1000 --record '" + record.string() + "'");
    ASSERT_EQ(outcome.code, 0) << outcome.error;
    bool found = false;
    const Json report = outcome.json();
    for (const Json& warning : report["warnings"]) {
      const std::string message = warning["message"];
      found = found ||
              (warning["code"] == code && warning["material"] == "grain" &&
               message.find(field + " = " + value) != std::string::npos && message.find(limit) != std::string::npos);
    }
    EXPECT_TRUE(found) << code << " in " << report["warnings"];
    // 2 % of the device's 3.3 N a tick, but for the first two of a contact.
    const std::vector<RecordedTick> ticks = recorded(slurp(record));
    for (std::size_t i = 3; i < ticks.size(); ++i) {
      EXPECT_LE(norm(ticks[i].force), 3.3 * (1 + 1e-9));
      const bool goes_on = ticks[i].contact && ticks[i - 1].contact && ticks[i - 2].contact && ticks[i - 3].contact;
      if (goes_on && i > 300) {
        EXPECT_LE(norm(ticks[i].force - ticks[i - 1].force), 0.066 * (1 + 1e-9)) << i;
      }
    }
  };
  Json high = tag();
  high["height"]["scale"] = 1.0;
  high["height"]["offset"] = -0.5;
  expect_limited(high, "tag_height_limit", "haptic.height.scale", "1:", "the limit of 0.02,");
  Json moved = tag();
  moved["height"]["offset"] = 0.015;
  expect_limited(moved, "tag_offset_limit", "haptic.height.offset", "0.015:", "0.0002 is used");
  for (const char* model : {"orthogonal", "lateral", "lateral-isotropic", "graph-orthogonal", "graph-lateral"}) {
    Json strong = tag();
    strong["forceModel"] = {{"name", model}, {"amplitude", 100}};
    const bool both = std::string(model) == "lateral-isotropic";
    expect_limited(strong, "tag_amplitude_limit", "haptic.forceModel.amplitude",
                   "100:", both ? "0.00911505" : "0.0128906");
  }
  Json rough = tag();
  rough["height"].erase("image");
  rough["roughness"] = {{"fractalDimension", 2.9}, {"rmsHeight", 0.1}, {"wavelengthRange", {5e-4, 1e-2}}};
  expect_limited(rough, "tag_roughness_limit", "haptic.roughness.rmsHeight", "0.1:", "0.005");
  Json steep = tag();
  steep["height"]["scale"] = 0.019;  // A sine of 10 mm: slopes of up to 6.
  steep["height"]["offset"] = 0;
  const Json report = play_glb({{"haptic", steep}}, testing::sine_png()).json();
  expect_warning(report, "relief_steep");
}

TEST_F(Player, ProbeIsTheDevicesUnlessAskedOtherwise) {
  const Outcome plain = play_glb({{"haptic", tag()}}, testing::sine_png());
  EXPECT_EQ(plain.json()["probe_radius_mm"], 0.5);
  EXPECT_EQ(play_glb({{"haptic", tag()}}, testing::sine_png(), "--probe-radius 0").json()["probe_radius_mm"], 0);
  const Json report = play_glb({{"haptic", tag()}}, testing::sine_png(), "--probe-radius 2.5").json();
  EXPECT_DOUBLE_EQ(report["probe_radius_mm"].get<double>(), 2.5);
}

TEST_F(Player, WavesShorterThanTwoTicksAreLeftOut) {
  // Texels of 0.31 mm carry a wave of 2 · 0.1 / 150 m, and so do those of twice the size.
  const auto coarser = [&](const char* rate) {
    return play_glb({{"haptic", tag()}}, testing::sine_png(), std::string("--speed 0.1 --rate ") + rate)
        .json()["left_out"]["maps_made_coarser"];
  };
  EXPECT_EQ(coarser("150"), 1);
  EXPECT_EQ(coarser("170"), 0);
}

/// The plate lies in the plane y = 0: what is loaded around a place above it or far beside it is nothing.
TEST_F(Player, OnlyWhatIsNearTheOriginIsLoaded) {
  const std::string glb = "'" + write("p.glb", testing::plate_glb({{"haptic", tag()}}, testing::sine_png())) + "'";
  expect_refusal(play(glb + " --device hid:ffff:fffe --origin 0.05,0,-0.05"), 5);
  for (const char* far : {"5,0,-0.05", "0.05,5,-0.05", "0.05,0,-5"})
    expect_refusal(play(glb + " --device hid:ffff:fffe --origin " + far), 3);
}

/// On a simulated device a real part is moved over as a file says.
constexpr const char* k_still = "t,x,y,z\n0,0,0,0.01\n0.2,0,0,0.01\n";

/// Numbers as an option takes them.
std::string listed(const std::vector<Vec3>& points) {
  std::ostringstream text;
  text.precision(17);
  for (const Vec3& p : points) text << (text.tellp() > 0 ? "," : "") << p.x << ',' << p.y << ',' << p.z;
  return text.str();
}

/// Touched points that lie 1 % farther from their middle than those of the part, elsewhere.
TEST_F(Player, TellsHowWellARealPartIsFound) {
  const std::vector<Vec3> part{{0.01, 0, -0.01}, {0.09, 0, -0.02}, {0.03, 0, -0.08}};
  const Vec3 middle = (1.0 / 3) * (part[0] + part[1] + part[2]);
  std::vector<Vec3> touched;
  double squares = 0;
  for (const Vec3& p : part) {
    const Vec3 arm = p - middle;
    const Vec3 longer = 1.01 * arm;
    touched.push_back({0.3 + longer.z, 0.2 - longer.x, -0.4 - longer.y});  // Turned about all axes.
    squares += dot(arm, arm) / 3;
  }
  const Outcome outcome = play_glb({{"haptic", tag()}}, testing::sine_png(),
                                   "--surface real --trajectory '" + write("t.csv", k_still) + "' --touched " +
                                       listed(touched) + " --part-points " + listed(part));
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  EXPECT_NEAR(outcome.json()["registration_residual_mm"].get<double>(), 10 * std::sqrt(squares), 1e-3);
}

/// A part that looks along x has a direction in its plane, too.
TEST_F(Player, ARealPlaneMayLookAnyWay) {
  const std::string plate = testing::plate_glb({{"haptic", tag()}}, testing::sine_png());
  std::uint32_t length = 0;
  std::memcpy(&length, plate.data() + 12, 4);
  Json gltf = Json::parse(plate.substr(20, length));
  const std::string touched = listed({{0, 0, 0}, {0.05, 0, 0.01}, {0.02, 0.04, 0.03}});
  for (const std::vector<double>& turn :
       {std::vector{0.0, 0.0, 0.0, 1.0}, std::vector{0.0, 0.0, -std::sqrt(0.5), std::sqrt(0.5)},
        std::vector{std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)}}) {
    gltf["nodes"][0]["rotation"] = turn;
    std::string json = gltf.dump();
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::string bin = plate.substr(20 + length);
    const std::string glb =
        plate.substr(0, 8) + testing::little_endian(static_cast<std::uint32_t>(20 + json.size() + bin.size()), 4) +
        testing::little_endian(static_cast<std::uint32_t>(json.size()), 4) + plate.substr(16, 4) + json + bin;
    const Outcome outcome = play("'" + write("t.glb", glb) + "' --seconds 0.2 --json - --surface real --trajectory '" +
                                 write("t.csv", k_still) + "' --touched " + touched);
    EXPECT_EQ(outcome.code, 0) << outcome.error;
  }
}

TEST_F(Player, FileThatChangesUnderItEndsItWithAReport) {
  const std::string whole = testing::plate_glb({{"haptic", tag()}}, testing::sine_png());
  const std::string glb = (folder_ / "p.glb").string();
  const auto truncate = [&](pid_t) { fs::resize_file(glb, whole.size() / 2); };
  const auto replace = [&](pid_t) { fs::rename(write("q.glb", whole), glb); };
  const auto remove = [&](pid_t) { fs::remove(glb); };
  for (const std::function<void(pid_t)>& change :
       std::initializer_list<std::function<void(pid_t)>>{truncate, replace, remove}) {
    write("p.glb", whole);
    EXPECT_EQ(play_while(glb, change), 5);
    EXPECT_NE(slurp(folder_ / "error").find("p.glb: changed while it was played, forces are off"), std::string::npos);
  }
}

TEST_F(Player, ListsDevices) {
  const Outcome text = play("--list-devices");
  EXPECT_EQ(text.code, 0);
  EXPECT_NE(text.out.find("sim:lambda7"), std::string::npos);
  const Outcome json = play("--list-devices --json -");
  EXPECT_EQ(json.json()["simulated"].size(), 7U);
  EXPECT_TRUE(json.json()["connected"].is_array());
}

TEST_F(Player, NoSuchDeviceIsExitCode5) {
  const std::string glb = write("p.glb", testing::plate_glb({{"haptic", tag()}}, testing::sine_png()));
  expect_refusal(play("'" + glb + "' --device hid:ffff:fffe"), 5);
  expect_refusal(play("'" + glb + "' --device hid:nonsense"), 2);
}

/// A process with a sentinel that writes a file when it switches the device off.
void with_sentinel(const fs::path& trace, int ready, bool wait) {
  const player::Sentinel sentinel([&] { std::ofstream(trace) << "off"; });
  const char byte = sentinel.watched() ? 1 : 0;
  if (::write(ready, &byte, 1) == 1 && wait) ::pause();
}

TEST_F(Player, KilledPlayerIsSwitchedOffByItsSentinel) {
  for (const bool killed : {true, false}) {
    const fs::path trace = folder_ / "trace";
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    const pid_t child = ::fork();
    if (child == 0) {
      with_sentinel(trace, ends[1], killed);
      ::_exit(0);
    }
    ::close(ends[1]);
    char byte = 0;
    ASSERT_EQ(::read(ends[0], &byte, 1), 1);
    EXPECT_EQ(byte, 1);
    if (killed) ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    // The sentinel keeps its end of the pipe open until it exits.
    EXPECT_EQ(::read(ends[0], &byte, 1), 0);
    ::close(ends[0]);
    EXPECT_EQ(fs::exists(trace), killed);
    fs::remove(trace);
  }
}

}  // namespace
}  // namespace papilla
