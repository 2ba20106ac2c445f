// SPDX-License-Identifier: GPL-3.0-or-later
#include "weather/weather_page.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "weather/follow_files.hpp"

namespace papilla::app {
namespace {

TEST(Weather, ThePageHasAPictureATimeAndNothingFromOutside) {
  WeatheredMaterial material;
  material.name = "c", material.recipe = "dust";
  const ColorImage picture{2, 1, {0, 0, 0, 255, 255, 255}};
  const std::string page =
      weather_page("<a>", picture, {{0, picture}, {1, picture}}, {material}, "{\"$comment\": \"</pre>\"}", false);
  std::size_t steps = 0;
  for (std::size_t at = 0; (at = page.find("class=\"step\"", at)) != std::string::npos; ++at) ++steps;
  EXPECT_EQ(steps, 2U);
  EXPECT_NE(page.find("max=\"1\""), std::string::npos);
  EXPECT_EQ(page.find("http:"), std::string::npos);
  EXPECT_EQ(page.find("src=\"data:image/png") == std::string::npos, false);
  EXPECT_NE(page.find("&lt;a&gt;"), std::string::npos);
  EXPECT_EQ(page.find("\"</pre>\""), std::string::npos) << "the configuration is text, not markup";
}

TEST(FollowFiles, TellsOfAFileThatChangedAndStops) {
  const auto path = std::filesystem::temp_directory_path() / ("papilla-follow-" + std::to_string(::getpid()));
  std::ofstream(path) << "a";
  int looks = 0, changes = 0;
  follow_files([&] { return std::vector<std::filesystem::path>{path}; }, [&] { ++changes; },
               [&] {
                 if (++looks == 2) std::ofstream(path) << "longer";
                 return looks > 4;
               });
  EXPECT_EQ(changes, 1);
  // A file that joins the list is no change of its own; one that is saved later is.
  const auto other = path.string() + "-other";
  std::ofstream(other) << "a";
  looks = changes = 0;
  follow_files(
      [&] {
        return looks < 2 ? std::vector<std::filesystem::path>{path} : std::vector<std::filesystem::path>{path, other};
      },
      [&] { ++changes; },
      [&] {
        if (++looks == 4) std::ofstream(other) << "longer";
        return looks > 6;
      });
  EXPECT_EQ(changes, 1);
  std::filesystem::remove(other);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace papilla::app
