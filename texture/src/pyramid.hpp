// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/texture/image.hpp"
#include "papilla/texture/sample_rows.hpp"

namespace papilla::texture_detail {

/// The picture at half its sides (rounded), every pixel the mean of the area it covers.
GreyImage halved(const GreyImage& image);

/// A picture halved until no side is longer than `most_side`, and how often that was.
struct Shrunk {
  GreyImage image;
  int halvings = 0;
};
Shrunk shrunk(const GreyImage& image, int most_side);
/// The same of samples that are read once, from the top down; the pitch is not known.
Shrunk shrunk(const SampleRows& picture, int most_side);

/// Heights in pixels over a grid made by halved(), once or several times, and the picture it was made from.
struct CoarseHeights {
  const std::vector<double>& heights;
  int width, height;
  int fine_width, fine_height;
  bool periodic;
};

/// Samples along one axis of the fine picture: sample i covers pixels begin + i·step … begin + (i + 1)·step, which may
/// lie beyond the borders.
struct FineAxis {
  double begin = 0, step = 1;
  int count = 0;
};

/// Factor on heights in pixels: fine samples per coarse sample.
double enlargement(const CoarseHeights& coarse, const FineAxis& across, const FineAxis& down);

/// The heights, in fine pixels, at the samples of a part of the finer grid: bilinear, across the borders when periodic.
std::vector<double> enlarged(const CoarseHeights& coarse, const FineAxis& across, const FineAxis& down);
/// The same for the whole picture.
std::vector<double> enlarged(const CoarseHeights& coarse);

}  // namespace papilla::texture_detail
