// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>

#include "papilla/texture/sample_rows.hpp"

namespace papilla {

/// Samples in memory, which must outlive the object.
class SamplesInMemory final : public SampleRows {
 public:
  /// @pre samples.size() == width * height.
  SamplesInMemory(std::span<const float> samples, int width, int height)
      : SampleRows(width, height), samples_(samples) {}
  void read(int x, int y, int count, float* samples) const override;

 private:
  std::span<const float> samples_;
};

/// scale · (sample − origin), plus `offset`, of other samples, which must outlive the object.
class ScaledSamples final : public SampleRows {
 public:
  ScaledSamples(const SampleRows& samples, double scale, double origin, double offset = 0)
      : SampleRows(samples.width(), samples.height()),
        samples_(samples),
        scale_(scale),
        origin_(origin),
        offset_(offset) {}
  void read(int x, int y, int count, float* samples) const override;

 private:
  const SampleRows& samples_;
  double scale_, origin_, offset_;
};

/// Samples in a temporary file that has no name and ends with the object: 4 bytes each on the disk, none in memory.
class SampleFile final : public SampleRows {
 public:
  /// @param folder where the file lies.
  /// @throws IoError naming the folder and the system's reason.
  SampleFile(int width, int height, const std::filesystem::path& folder);
  ~SampleFile() override;

  /// @throws IoError as the constructor, when the disk is full.
  void read(int x, int y, int count, float* samples) const override;
  /// Row y. @pre samples.size() == width(). @throws IoError as the constructor.
  void write(int y, std::span<const float> samples);

 private:
  std::filesystem::path folder_;
  int file_ = -1;
};

}  // namespace papilla
