// SPDX-License-Identifier: GPL-3.0-or-later
#include "options/unwrap_option.hpp"

#include <gtest/gtest.h>

#include "exit_code.hpp"
#include "option_checks.hpp"

namespace papilla::app {
namespace {

TEST(UnwrapOption, ReadsPlacesLinesAndParts) {
  const PlacedPin pin = parse_pin("1,-2,3.5=4,5@door:left");
  EXPECT_EQ(pin.position, (Vec3{1, -2, 3.5}));
  EXPECT_EQ(pin.uv, (Vec2{4, 5}));
  EXPECT_EQ(pin.part, "door:left");
  const PlacedIsoLine line = parse_iso_line("v:0,0,0;1,0,0;1,1,0");
  EXPECT_FALSE(line.is_u);
  EXPECT_FALSE(line.value);
  EXPECT_EQ(line.points.size(), 3u);
  EXPECT_TRUE(line.part.empty());
  EXPECT_EQ(parse_iso_line("u=-2.5:0,0,0;1,0,0").value, -2.5);
  for (const char* bad : {"", "1,2,3", "1,2,3=4", "1,2=3,4", "1,2,3=4,nan", "1,2,3=4,5,6"})
    EXPECT_THROW(parse_pin(bad), UsageError) << bad;
  for (const char* bad : {"", "u", "w:0,0,0;1,0,0", "u:0,0,0", "u=x:0,0,0;1,0,0", "u:0,0;1,0,0", "u:0,0,0;"})
    EXPECT_THROW(parse_iso_line(bad), UsageError) << bad;
}

TEST(UnwrapOption, ReadsGrains) {
  EXPECT_EQ(parse_grain("up").source, GrainSource::up);
  EXPECT_EQ(parse_grain("longest@door").source, GrainSource::longest);
  EXPECT_EQ(parse_grain("longest@door").part, "door");
  EXPECT_EQ(parse_grain("0,2,0").source, GrainSource::direction);
  EXPECT_EQ(parse_grain("0,2,0").vector, (Vec3{0, 2, 0}));
  const PlacedGrain edge = parse_grain("edge:0,0,0@rim*");
  EXPECT_EQ(edge.source, GrainSource::edge_loop);
  EXPECT_EQ(edge.vector, (Vec3{}));
  EXPECT_EQ(edge.part, "rim*");
  for (const char* bad : {"", "0,0,0", "along", "edge:", "edge:1,2", "1,2@x"})
    EXPECT_THROW(parse_grain(bad), UsageError) << bad;
}

/// The message with which these options of unwrap are refused; empty: they are not.
std::string complaint(const std::string& line) {
  CLI::App app;
  UnwrapOption options;
  options.add_to(app);
  app.parse(line);
  try {
    options.options();
  } catch (const UsageError& error) {
    return error.what();
  }
  return {};
}

TEST(UnwrapOption, BothSidesOfATileAndTheLeastDensityCount) {
  CLI::App app;
  UnwrapOption options;
  options.add_to(app);
  app.parse("--tile 30 45 --texture-px 1024 --density door=0.001 --density seat*=1000");
  const UnwrapOptions read = options.options();
  EXPECT_EQ(read.tile_mm, (Vec2{30, 45}));
  ASSERT_EQ(read.density.size(), 2u);
  EXPECT_EQ(read.density[0], (std::pair<std::string, double>{"door", 0.001}));
  EXPECT_EQ(read.density[1], (std::pair<std::string, double>{"seat*", 1000}));
  EXPECT_NE(complaint("--texture-px 1024 --density door=0.0009"), "");
}

TEST(OptionChecks, EndsOfARangeAndAnyCaseAreTaken) {
  const CLI::Validator range = in_range(-1, 2.5);
  for (const char* good : {"-1", "0", "2.5"}) {
    std::string text = good;
    EXPECT_EQ(range(text), "") << good;
  }
  for (const char* bad : {"-1.01", "2.51", "nan", "x"}) {
    std::string text = bad;
    EXPECT_NE(range(text), "") << bad;
  }
  const CLI::Validator choice = one_of({"Atlas", "tile"});
  std::string text = "aTLAS";
  EXPECT_EQ(choice(text), "");
  EXPECT_EQ(text, "Atlas");
}

TEST(UnwrapOption, OptionsOfOtherMethodsAreRefused) {
  EXPECT_EQ(complaint("--method maillot --phi 0.3 --start planar --distortion-limit 0"), "");
  EXPECT_EQ(complaint("--method best --phi 0.3"), "--phi: it is of maillot, not of best");
  EXPECT_EQ(complaint("--shape cone"), "--shape: it is of intermediate, not of auto");
  EXPECT_EQ(complaint("--method lscm --iso-line u:0,0,0;1,0,0"), "--iso-line: it is of levy, not of lscm");
  EXPECT_EQ(complaint("--method planar --eye 1,2,3"),
            "--eye: it is of auto, best, environment, intermediate, not of planar");
  EXPECT_EQ(complaint("--method auto --iterations 5"), "");
  EXPECT_NE(complaint("--method maillot --distortion-limit 0.5").find("at least 1"), std::string::npos);
  EXPECT_NE(complaint("--method lscm --solver direct").find("no such solver"), std::string::npos);
}

TEST(UnwrapOption, ABoundOnDistortionFindsSeamCostAndCharts) {
  EXPECT_EQ(complaint("--max-distortion 4.1"), "");
  EXPECT_EQ(complaint("--method best --max-distortion p95=4.2 --eye 1,2,3"), "");
  EXPECT_EQ(complaint("--method levy --max-distortion 4.1"), "--max-distortion: it is of auto, best, not of levy");
  EXPECT_EQ(complaint("--max-distortion 4.1 --seam-cost 0.03"),
            "--seam-cost: --max-distortion finds it, give one of the two");
  EXPECT_EQ(complaint("--max-distortion 4.1 --charts uv"), "--charts uv: --max-distortion makes charts of its own");
  for (const char* bad : {"3.9", "p95", "4.1mm", "p0=4.1"})
    EXPECT_NE(complaint(std::string("--max-distortion ") + bad).find("expected D or pNN=D"), std::string::npos) << bad;
}

TEST(UnwrapOption, ACouplingThatCantBeKeptIsRefused) {
  const std::string levy = "--method levy --coupling conformal ";
  EXPECT_EQ(complaint(levy), "");
  for (const char* other :
       {"--border convex", "--border released", "--solver gauss-seidel", "--iso-line u:0,0,0;1,0,0"})
    EXPECT_NE(complaint(levy + other).find("--coupling conformal: "), std::string::npos) << other;
  EXPECT_EQ(complaint("--method levy --coupling auto --border convex"), "");
}

TEST(UnwrapOption, PartsWithoutANameAreHeldByTheirPath) {
  Scene scene;
  scene.parts.resize(2);
  scene.parts[0].id = "path/#1";
  scene.parts[1].name = "door";
  MethodOptions method;
  method.pins = {parse_pin("0,0,0=0,0@path/#1"), parse_pin("0,0,0=0,0@door")};
  EXPECT_NO_THROW(check_held_parts(method, "a.glb", scene));
  method.pins = {parse_pin("0,0,0=0,0@path/#2")};
  try {
    check_held_parts(method, "a.glb", scene);
    ADD_FAILURE() << "not refused";
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean 'path/#1'"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace papilla::app
