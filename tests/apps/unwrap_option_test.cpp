// SPDX-License-Identifier: GPL-3.0-or-later
#include "options/unwrap_option.hpp"

#include <gtest/gtest.h>

#include "exit_code.hpp"

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
