// SPDX-License-Identifier: GPL-3.0-or-later
#include "weather/weather_page.hpp"

#include <gtest/gtest.h>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "json/json.hpp"
#include "papilla/core/temporary_folder.hpp"
#include "weather/file_watch.hpp"
#include "weather/live_looks.hpp"

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

TEST(FileWatch, TellsOfAFileThatChanged) {
  const TemporaryFolder folder("papilla-watch");
  const std::filesystem::path path = folder / "a", other = folder / "b";
  std::ofstream(path) << "a";
  std::vector<std::filesystem::path> files{path};
  FileWatch watch([&] { return files; });
  EXPECT_FALSE(watch.changed());
  std::ofstream(path) << "longer";
  EXPECT_TRUE(watch.changed());
  EXPECT_FALSE(watch.changed());
  // A file that joins the list is no change of its own; one that is saved later is.
  std::ofstream(other) << "a";
  files.push_back(other);
  EXPECT_FALSE(watch.changed());
  std::ofstream(other) << "longer";
  EXPECT_TRUE(watch.changed());
  // One that is being replaced counts when it is there again.
  std::filesystem::remove(other);
  EXPECT_FALSE(watch.changed());
  std::ofstream(other) << "longest of all";
  EXPECT_TRUE(watch.changed());
}

WeatherLooks looks_of(std::shared_ptr<const WeatheredLook> first, std::shared_ptr<const WeatheredLook> second) {
  WeatherLooks looks;
  looks.materials = {std::move(first), nullptr, std::move(second)};
  return looks;
}

std::shared_ptr<const WeatheredLook> look(unsigned char grey) {
  WeatheredLook look;
  look.width = look.height = 1, look.color = {grey, grey, grey, 255}, look.roughness = 0.25;
  if (grey > 100) look.shine = {1, 2, 3, 4};
  return std::make_shared<const WeatheredLook>(std::move(look));
}

/// The text and the pixels of an answer of /looks.
std::pair<Json, std::string> looks_since(const PageRoutes& routes, int version) {
  const std::string all = *routes.post.at("/looks")("{\"since\": " + std::to_string(version) + "}").body;
  std::size_t length = 0;
  for (std::size_t k = 0; k < 4; ++k) length |= std::size_t{static_cast<unsigned char>(all[k])} << 8 * k;
  return {Json::parse(all.substr(4, length)), all.substr(4 + length)};
}

TEST(LiveLooks, GivesWhatChangedAndTellsOfMistakes) {
  LiveLooks live;
  const PageRoutes routes = live.routes();
  const auto a = look(10), b = look(200);
  live.show(
      [](std::uint64_t page, std::uint64_t version) { return std::to_string(page) + " " + std::to_string(version); },
      looks_of(a, b));
  EXPECT_EQ(*routes.get.at("/")().body, "1 1");
  std::uint64_t seen = 0;
  const auto news = [&] { return routes.streams.at("/live")(seen); };
  EXPECT_EQ(news(), "event: looks\ndata: {\"page\":1,\"version\":1,\"problem\":\"\"}\n\n");
  EXPECT_EQ(news(), "");
  EXPECT_TRUE(looks_since(routes, 1).first["materials"].empty());
  EXPECT_TRUE(live.is_taken()) << "it came with the page";
  live.update(looks_of(a, look(50)));
  EXPECT_FALSE(live.is_taken());
  const auto [json, pixels] = looks_since(routes, 1);
  EXPECT_TRUE(live.is_taken());
  EXPECT_EQ(json["version"], 2);
  ASSERT_EQ(json["materials"].size(), 1U) << "the first is the same object";
  EXPECT_EQ(json["materials"][0]["material"], 2);
  EXPECT_EQ(json["materials"][0]["roughness"], 0.25);
  EXPECT_TRUE(json["materials"][0]["shine"].is_null());
  EXPECT_FALSE(json["materials"][0].contains("normal")) << "the same as before";
  EXPECT_EQ(pixels, "\x32\x32\x32\xff");
  EXPECT_EQ(looks_since(routes, 0).first["materials"].size(), 2U);
  live.update(looks_of(b, look(50)));
  const auto third = looks_since(routes, 2);
  EXPECT_EQ(third.first["materials"].size(), 2U);
  EXPECT_EQ(third.first["materials"][0]["shine"]["at"], 4);
  EXPECT_EQ(third.second.substr(4, 4), "\x01\x02\x03\x04");
  news();
  live.tell("line 1:\n\"oops\"");
  EXPECT_NE(news().find("\"problem\":\"line 1:\\n\\\"oops\\\"\""), std::string::npos);
  live.tell("line 1:\n\"oops\"");
  EXPECT_EQ(news(), "") << "the same mistake";
  live.update(looks_of(b, look(50)));
  EXPECT_NE(news().find("\"problem\":\"\""), std::string::npos) << "mended";
  live.show([](std::uint64_t page, std::uint64_t) { return std::to_string(page); }, looks_of(a, b));
  EXPECT_NE(news().find("\"page\":2"), std::string::npos);
  EXPECT_THROW(routes.post.at("/looks")("{}"), std::exception);
}

}  // namespace
}  // namespace papilla::app
