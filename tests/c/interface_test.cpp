// SPDX-License-Identifier: MIT
// The files for interface_checks.c, which is C99.
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "haptic/tagged_glb.hpp"
#include "interface_checks.h"
#include "papilla/core/temporary_folder.hpp"
#include "papilla/haptic/sha256.hpp"
#include "papilla/io/papilla_haptic.h"

namespace papilla {
namespace {

class CInterface : public ::testing::Test {
 protected:
  CInterface() {
    write(plate, plate_bytes());
    write(smooth, testing::plate_glb({{"haptic", {{"version", 1}, {"stiffness", 300}}}}, ""));
  }

  static std::string plate_bytes() {
    const std::string png = testing::sine_png();
    const nlohmann::json height = {{"image", "haptic.height.grain"},
                                   {"sha256", sha256_hex(std::as_bytes(std::span(png.data(), png.size())))},
                                   {"scale", 2e-4},
                                   {"offset", -1e-4},
                                   {"metresPerUV", {0.04, 0.04}}};
    return testing::plate_glb({{"haptic", {{"version", 1}, {"stiffness", 300}, {"height", height}}}}, png);
  }

  static void write(const std::string& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
  }

  TemporaryFolder folder{"c-interface"};
  std::string plate = (folder / "plate.glb").string(), smooth = (folder / "smooth.glb").string();
};

TEST_F(CInterface, KeepsItsLayout) { EXPECT_STREQ(check_layout(), nullptr); }
TEST_F(CInterface, FeelsAPlate) { EXPECT_STREQ(check_forces(plate.c_str()), nullptr); }
TEST_F(CInterface, ProbeIsABallUnlessAskedForAPoint) { EXPECT_STREQ(check_probe_radius(smooth.c_str()), nullptr); }
TEST_F(CInterface, ListsMaterials) { EXPECT_STREQ(check_materials(plate.c_str(), smooth.c_str()), nullptr); }
TEST_F(CInterface, HeightsAreThoseOfTheFile) { EXPECT_STREQ(check_heights(plate.c_str()), nullptr); }
TEST_F(CInterface, RefusesFilesWithOneLine) { EXPECT_STREQ(check_refused_files(folder.path().c_str()), nullptr); }
TEST_F(CInterface, RefusesOptions) { EXPECT_STREQ(check_refused_options(plate.c_str()), nullptr); }
TEST_F(CInterface, RefusesWhatIsNoHandle) { EXPECT_STREQ(check_handles(plate.c_str()), nullptr); }
TEST_F(CInterface, RefusesNullPointers) { EXPECT_STREQ(check_arguments(plate.c_str()), nullptr); }
TEST_F(CInterface, ServesOlderAndNewerCallers) { EXPECT_STREQ(check_struct_sizes(plate.c_str()), nullptr); }
TEST_F(CInterface, ForcesAreFiniteWhateverThePosition) { EXPECT_STREQ(check_bad_positions(plate.c_str()), nullptr); }
TEST_F(CInterface, SaysWhenTooManyAreOpen) { EXPECT_STREQ(check_most_open(plate.c_str()), nullptr); }

TEST_F(CInterface, SurvivesDamagedFiles) {
  const std::string whole = plate_bytes(), path = (folder / "damaged.glb").string();
  std::array<char, 300> message{};
  int refused = 0;
  const auto open = [&](const std::string& bytes) {
    write(path, bytes);
    papilla_haptic* const haptic = papilla_haptic_open(path.c_str(), nullptr, message.data(), message.size());
    if (haptic != nullptr) {
      EXPECT_EQ(papilla_haptic_close(haptic), 0);
    } else {
      ++refused;
      EXPECT_NE(std::string(message.data()).find("damaged.glb"), std::string::npos) << message.data();
    }
  };
  for (std::size_t size = 0; size < whole.size(); size += 97) open(whole.substr(0, size));
  EXPECT_EQ(refused, static_cast<int>((whole.size() + 96) / 97));
  for (std::size_t at = 0; at < whole.size(); at += 61) {
    std::string turned = whole;
    turned[at] = static_cast<char>(~turned[at]);
    open(turned);
  }
}

/// Open, tick and close in eight threads at once: each finds what one alone finds.
TEST_F(CInterface, HandlesOfThreadsDoNotMeet) {
  const auto stroke = [this] {
    std::vector<double> forces;
    for (int round = 0; round < 5; ++round) {
      papilla_haptic* const haptic = papilla_haptic_open(plate.c_str(), nullptr, nullptr, 0);
      double position[3] = {0.05, 0.002, -0.05}, force[3];
      papilla_haptic_reset(haptic, position);
      for (int i = 0; i < 200; ++i) {
        position[1] -= 2e-5;
        if (papilla_haptic_tick(haptic, position, 0, force) < 0) return std::vector<double>{};
        forces.push_back(force[1]);
      }
      if (papilla_haptic_close(haptic) != 0) return std::vector<double>{};
    }
    return forces;
  };
  const std::vector<double> alone = stroke();
  ASSERT_EQ(alone.size(), 1000U);
  EXPECT_GT(alone.back(), 0.1);
  std::array<std::vector<double>, 8> found;
  std::vector<std::thread> threads;
  for (auto& forces : found) threads.emplace_back([&] { forces = stroke(); });
  for (std::thread& thread : threads) thread.join();
  for (const auto& forces : found) EXPECT_EQ(forces, alone);
}

}  // namespace
}  // namespace papilla
