// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/pipeline/texture_survey.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

double grain(int x, int y) { return 0.5 + 0.2 * std::cos(0.5 * x) * std::cos(0.4 * y) + 0.1 * std::cos(x + 0.4 * y); }

SurveyOptions in_pieces() {
  SurveyOptions options;
  options.largest_px = 256;
  return options;
}

TEST(Survey, PiecesFindWhatTheWholeFinds) {
  const test::TemporaryFolder folder;
  const GreyImage noise = test::noise_image(400, 300, 1);
  write_grey_image(
      folder / "a.png",
      test::make_image(400, 300,
                       [&](int x, int y) { return grain(x, y) + 0.1 * static_cast<double>(noise.at(x, y)) - 0.05; }),
      8);
  SurveyOptions all, cut = in_pieces();
  all.by_class = cut.by_class = false;  // The dimension of a lattice, too.
  const TextureSurvey whole = survey_picture(folder / "a.png", all, {}),
                      pieces = survey_picture(folder / "a.png", cut, {});
  EXPECT_FALSE(whole.pieces);
  ASSERT_TRUE(pieces.pieces);
  EXPECT_EQ(pieces.pieces->columns, 4);
  EXPECT_EQ(pieces.pieces->rows, 3);
  EXPECT_EQ(pieces.pieces->lattice.same, 12);
  EXPECT_EQ(pieces.middle.width, 128);
  EXPECT_TRUE(is_same_lattice(pieces.symmetry->lattice, whole.symmetry->lattice));
  ASSERT_TRUE(whole.fractal && pieces.fractal);
  EXPECT_FALSE(whole.fractal->best->power_law());  // A lattice.
  EXPECT_FALSE(pieces.fractal->best->power_law());
  EXPECT_EQ(pieces.order->kind.kind, whole.order->kind.kind);
  EXPECT_EQ(pieces.order->monochrome, whole.order->monochrome);
}

TEST(Survey, ALatticeOfTheMiddleAloneDoesNotCount) {
  const test::TemporaryFolder folder;
  const GreyImage noise = test::noise_image(640, 640, 2);
  write_grey_image(folder / "a.png",
                   test::make_image(640, 640,
                                    [&](int x, int y) {
                                      const bool middle = std::abs(x - 320) < 70 && std::abs(y - 320) < 70;
                                      return middle ? grain(x, y) : static_cast<double>(noise.at(x, y));
                                    }),
                   8);
  const TextureSurvey survey = survey_picture(folder / "a.png", in_pieces(), {});
  EXPECT_FALSE(survey.symmetry->lattice.found);
  EXPECT_NE(survey.symmetry->lattice.reason.find("pieces"), std::string::npos);
}

TEST(Survey, StripsOfOneRowHaveAResult) {
  const test::TemporaryFolder folder;
  write_grey_image(folder / "row.tif", test::noise_image(5000, 1, 3), 8);
  write_grey_image(folder / "column.tif", test::noise_image(1, 5000, 3), 8);
  for (const char* name : {"row.tif", "column.tif"}) {
    const TextureSurvey survey = survey_picture(folder / name, in_pieces(), {});
    EXPECT_FALSE(survey.fractal->best);
    EXPECT_FALSE(survey.symmetry->lattice.found);
    EXPECT_EQ(survey.pieces->columns * survey.pieces->rows, 40);
  }
}

}  // namespace
}  // namespace papilla
