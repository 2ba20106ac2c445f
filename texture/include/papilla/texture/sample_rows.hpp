// SPDX-License-Identifier: MIT
#pragma once

namespace papilla {

/// Samples of a picture or a relief, row by row from the top left, wherever they lie: in memory, in a file, or computed
/// from others.
class SampleRows {
 public:
  SampleRows(int width, int height) : width_(width), height_(height) {}
  virtual ~SampleRows() = default;
  SampleRows(const SampleRows&) = delete;
  SampleRows& operator=(const SampleRows&) = delete;

  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }
  double count() const noexcept { return static_cast<double>(width_) * height_; }

  /// `count` samples of row y from column x on. May be called from several threads at a time.
  /// @pre the samples lie in the row.
  virtual void read(int x, int y, int count, float* samples) const = 0;

 private:
  int width_, height_;
};

}  // namespace papilla
