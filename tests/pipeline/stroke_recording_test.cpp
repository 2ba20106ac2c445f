// SPDX-License-Identifier: MIT
#include "papilla/pipeline/stroke_recording.hpp"

#include <gtest/gtest.h>

#include "papilla/core/error.hpp"
#include "papilla/haptic/haptic_loop.hpp"

namespace papilla {
namespace {

TEST(StrokeRecording, ReadsWhatThePlayerWrites) {
  const std::vector<RecordRow> rows = {{0, {1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {0.1, 0.2, 0.3}, true},
                                       {1e-3, {0, 0, 0}, {-1, 1e-9, 0}, {0, 0, 1}, {0, 0, -2}, false}};
  const auto stroke = parse_stroke_recording(record_csv(rows), "r.csv");
  ASSERT_EQ(stroke.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(stroke[i].t_s, rows[i].t);
    EXPECT_EQ(stroke[i].probe_m, rows[i].probe);
    EXPECT_EQ(stroke[i].proxy_m, rows[i].proxy);
    EXPECT_EQ(stroke[i].force_n, rows[i].force);
    EXPECT_FALSE(stroke[i].velocity_m_per_s);
  }
}

TEST(StrokeRecording, ReadsColumnsInAnyOrder) {
  const auto stroke = parse_stroke_recording(
      "# a force sensor\n\nforce_x, force_y,force_z ,note,t,x,y,z,velocity_x,velocity_y,velocity_z\r\n"
      "1,2,3,soft,0,4,5,6,7,8,9\n1,2,3,,0.5,4,5,6,7,8,9",
      "r.csv");
  ASSERT_EQ(stroke.size(), 2U);
  EXPECT_EQ(stroke[1].t_s, 0.5);
  EXPECT_EQ(stroke[1].probe_m, (Vec3{4, 5, 6}));
  EXPECT_EQ(stroke[1].force_n, (Vec3{1, 2, 3}));
  EXPECT_EQ(*stroke[1].velocity_m_per_s, (Vec3{7, 8, 9}));
  EXPECT_FALSE(stroke[1].proxy_m);
}

TEST(StrokeRecording, TakesTheByteOrderMarkOfSpreadsheets) {
  const auto stroke = parse_stroke_recording(
      "\xef\xbb\xbft,x,y,z,force_x,force_y,force_z\r\n0,1,2,3,4,5,6\r\n1,1,2,3,4,5,6\r\n", "r.csv");
  ASSERT_EQ(stroke.size(), 2U);
  EXPECT_EQ(stroke[1].t_s, 1);
}

TEST(StrokeRecording, NamesThePlaceOfWhatIsWrong) {
  const std::string heading = "t,probe_x,probe_y,probe_z,force_x,force_y,force_z\n";
  const auto says = [](const std::string& csv, const std::string& text) {
    try {
      parse_stroke_recording(csv, "r.csv");
      ADD_FAILURE() << "not refused: " << csv;
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
    }
  };
  says("", "r.csv: holds no recording");
  says(heading, "r.csv: holds no recording");
  says(heading + "0,0,0,0,0,0,0\n", "r.csv: holds no recording");
  says("t,x,y,z\n0,0,0,0\n", "r.csv:1: the heading has no column force_x");
  says("0,0,0,0,0,0,0\n", "r.csv:1: the heading has no column t");
  says("t,probe_x,prob_y,probz,force_x,force_y,force_z\n", "r.csv:1: the heading has no column probe_y; did you mean");
  says(heading + "0,0,0,0,0,0,0\n1,0,0,x,0,0,0\n", "r.csv:3: column 4 (probe_z) is no number");
  says(heading + "0,0,0\n", "r.csv:2: column 4 (probe_z) is missing");
  says(heading + "0,0,0,0,nan,0,0\n", "r.csv:2: column 5 (force_x) is not finite");
  says(heading + "0,0,0,0,0,0,0\n0,0,0,0,0,0,0\n", "r.csv:3: the time does not increase");
  says(heading + "0,1e9,0,0,0,0,0\n", "r.csv:2: a position is farther than 1000 km");
  says(heading + "0,0,0,0,0,0,0,0\n", "r.csv:2: has 8 values, and the heading 7 columns");
  says("t,t,x,y,z,force_x,force_y,force_z\n", "r.csv:1: the heading has the column t twice");
  says("t;x;y;z;force_x;force_y;force_z\n", "r.csv:1: the heading has no column t; commas must separate columns");
  // A probe that is misspelt must not give way to the hand, nor half a proxy to none.
  says("t,x,y,z,probex,probe_y,probe_z,force_x,force_y,force_z\n", "has no column probe_x; did you mean 'probex'?");
  says("t,x,y,z,proxyx,proxy_y,proxy_z,force_x,force_y,force_z\n", "has no column proxy_x; did you mean 'proxyx'?");
}

}  // namespace
}  // namespace papilla
