// SPDX-License-Identifier: MIT
#include "papilla/pipeline/stereo_file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <sstream>
#include <utility>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/io/image_bands.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/even_light.hpp"
#include "papilla/texture/height_reference.hpp"
#include "papilla/texture/registration.hpp"
#include "papilla/texture/roughness.hpp"
#include "papilla/texture/stored_samples.hpp"
#include "relief_files.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;
using Kind = HeightReference::Kind;

}  // namespace

int width_of_picture_files(const std::vector<fs::path>& files) {
  if (files.size() < 3)
    throw InvalidInput(fmt::format("{}: {} photographs of one place are {}, at least 3 are needed",
                                   files.empty() ? "height" : files.back().string(), files.size(),
                                   files.size() == 2 ? "too few" : "none"));
  int width = 0, height = 0;
  for (const fs::path& file : files) {
    const ImageBands bands(file);
    bands.require_memory(k_stereo_bytes_per_pixel + files.size() * k_photograph_bytes_per_pixel);
    if (width == 0) width = bands.width(), height = bands.height();
    if (bands.width() != width || bands.height() != height)
      throw InvalidInput(fmt::format("{}: is {} x {} pixels, {} is {} x {}; photographs of one place must be alike",
                                     file.string(), bands.width(), bands.height(), files.front().string(), width,
                                     height));
  }
  return width;
}

namespace {

/// @param decoded what made brightness of the first one.
std::vector<GreyImage> read_linear(const std::vector<fs::path>& files, Transfer transfer, CurveSource& decoded) {
  std::vector<GreyImage> photographs;
  for (const fs::path& file : files) {
    photographs.push_back(
        read_grey_image(file, k_stereo_bytes_per_pixel + files.size() * k_photograph_bytes_per_pixel));
    GreyImage& image = photographs.back();
    if (std::none_of(image.pixels.begin(), image.pixels.end(), [](float v) { return v > 0; }))
      throw InvalidInput(file.string() + ": the photograph is black");
    const Values<float> stored = image.pixels;
    const SamplesInMemory samples(stored, image.width, image.height);
    const TransferCurve curve = transfer_curve(transfer, image.bits, image.curve);
    if (photographs.size() == 1) decoded = curve.source;
    const EvenedSamples linear(samples, curve, {});
    for (int y = 0; y < image.height; ++y) linear.read(0, y, image.width, &image.at(0, y));
  }
  return photographs;
}

std::vector<Vec3> lights_of(const StereoFileOptions& options, const std::vector<fs::path>& files,
                            const std::vector<GreyImage>& photographs) {
  StereoLights lights = options.lights;
  for (std::size_t k = 0; lights.sphere && k < photographs.size(); ++k) try {
      lights.directions.push_back(light_of_sphere(photographs[k], *lights.sphere));
    } catch (const InvalidInput& error) {
      throw InvalidInput(files[k].string() + ": " + error.what());
    }
  return std::move(lights.directions);
}

/// Lines of two numbers; the first line may be a heading.
ProfileLine read_profile(const fs::path& path) {
  ProfileLine profile;
  std::istringstream lines(read_file(path));
  std::string line;
  for (int row = 1; std::getline(lines, line); ++row) {
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
    if (line.empty()) continue;
    double along = 0, height = 0;
    const char* const end = line.data() + line.size();
    const auto first = std::from_chars(line.data(), end, along);
    const char* next = first.ptr;
    while (next < end && (*next == ',' || *next == ';' || *next == ' ' || *next == '\t')) ++next;
    const auto second = std::from_chars(next, end, height);
    if (first.ec == std::errc() && second.ec == std::errc() && second.ptr == end) {
      profile.along_mm.push_back(along), profile.height_mm.push_back(height);
    } else if (row > 1) {
      throw InvalidInput(fmt::format("{}: line {} is not mm_along,mm_height", path.string(), row));
    }
  }
  return profile;
}

double height_in_px(const PixelRelief& relief, Vec2 low, Vec2 high) { return 1 / scale_of_step(relief, 1, low, high); }

/// Sets the pitch by rulers and grids.
void measure_pitch(const std::vector<HeightReference>& references, const GreyImage& first, double& pitch,
                   StereoFiles& result) {
  double sum = 0;
  for (const HeightReference& reference : references) {
    if (reference.kind != Kind::ruler && reference.kind != Kind::grid) continue;
    const bool ruler = reference.kind == Kind::ruler;
    const double found =
        ruler ? pitch_of_ruler(reference.mm, reference.from_px, reference.to_px) : pitch_of_grid(first, reference.mm);
    result.references.push_back({ruler ? "ruler" : "grid", found, {}});
    sum += found;
  }
  if (!result.references.empty()) pitch = sum / static_cast<double>(result.references.size());
}

/// Millimetres of height per pixel of height by the other references; 0: there are none.
double measure_scale(const std::vector<HeightReference>& references, const PixelRelief& relief, double pitch,
                     StereoFiles& result) {
  double sum = 0;
  int count = 0;
  for (const HeightReference& reference : references) {
    ReferenceReading reading;
    if (reference.kind == Kind::step) {
      reading = {"step", scale_of_step(relief, reference.mm, reference.from_px, reference.to_px), {}};
    } else if (reference.kind == Kind::profile) {
      const ProfileFit fit =
          fit_profile(relief, read_profile(reference.profile_csv), reference.from_px, reference.to_px);
      reading = {"profile", fit.scale, fit.correlation};
    } else if (reference.kind == Kind::shadow) {
      const double mm = height_of_shadow(reference.from_px, reference.to_px, result.stereo.lights.front(), pitch);
      reading = {"shadow", mm / height_in_px(relief, reference.to_px, reference.from_px), {}};
    } else {
      continue;
    }
    sum += reading.value, ++count;
    result.depth_source = reading.name;
    result.references.push_back(reading);
  }
  return count > 0 ? sum / count : 0;
}

GreyImage confidence_picture(const PhotometricStereoResult& stereo) {
  return {stereo.width, stereo.height, Values<float>(stereo.confidence.begin(), stereo.confidence.end()), 0, 8};
}

void list_measured_and_assumed(const StereoFiles& stereo, HeightResult& result) {
  const bool unknown = stereo.stereo.lights_estimated;
  result.measured.emplace_back("slopes in both directions, whatever the albedo");
  if (unknown) result.measured.emplace_back("azimuths of the lights, by integrability");
  if (unknown) result.assumed.emplace_back("mean surface: faces the camera");
  if (unknown && stereo.depth_source == "measured")
    result.assumed.emplace_back("depth: by the usual elevation of lamps");
  if (stereo.stereo.two_sided) result.assumed.emplace_back("side: convex and concave explain the photographs alike");
  result.assumed.emplace_back("bends over the whole picture: as probable by the spectrum of the relief");
  if (!(result.map.pitch_mm_x > 0)) result.assumed.emplace_back("pitch: unknown");
}

}  // namespace

StereoFiles relief_of_picture_files(const std::vector<fs::path>& files, const StereoFileOptions& options) {
  width_of_picture_files(files);  // Nothing is decoded in vain.
  const HeightOptions& height = options.files.height;
  StereoFiles result;
  std::vector<GreyImage> photographs = read_linear(files, height.transfer, result.files.result.decoded);
  PhotometricStereoOptions stereo{lights_of(options, files, photographs), height.progress};
  double pitch = height.pitch_mm > 0 ? height.pitch_mm : std::max(0.0, photographs.front().pitch_mm);
  measure_pitch(options.references, photographs.front(), pitch, result);
  Registration registration = register_photographs(photographs);
  photographs = std::move(registration.photographs);
  result.shifts_px = std::move(registration.shifts_px);
  try {
    result.stereo = photometric_stereo(photographs, stereo);
  } catch (const InvalidInput& error) {
    throw InvalidInput((stereo.lights.empty() ? files.front().string() : options.lights.source) + ": " + error.what());
  }

  HeightResult& relief = result.files.result;
  relief.method = HeightMethod::photometric_stereo;
  relief.light = result.stereo.lights.front();
  relief.light_estimated = result.stereo.lights_estimated;
  relief.light_uncertainty_deg = result.stereo.light_uncertainty_deg;
  relief.ambiguous = result.stereo.two_sided;
  relief.shadows_fraction = result.stereo.shadows_fraction;
  relief.highlights_fraction = result.stereo.highlights_fraction;
  relief.reason = fmt::format("{} photographs under different light", files.size());
  relief.trace = result.stereo.trace;
  relief.stop = result.stereo.stop;
  HeightMap& map = relief.map;
  map = {result.stereo.width, result.stereo.height, {}, pitch, pitch, false};
  const std::vector<double>& px = result.stereo.height_px;
  result.depth_source = "measured";
  double scale = measure_scale(options.references, {map.width, map.height, px}, pitch, result);
  if (!(scale != 0)) scale = pitch;
  const auto [low, high] = std::minmax_element(px.begin(), px.end());
  const double range = *high - *low;
  if (options.is_depth_given || !(scale != 0)) {
    scale = range > 0 ? height.depth_mm / range : 0;
    result.depth_source = "given";
  }
  const double lowest = scale < 0 ? *high : *low;
  for (const double value : px) map.mm.push_back(static_cast<float>(scale * (value - lowest)));
  relief.depth_mm = std::abs(scale) * range;
  relief.rms_mm = rms_height_mm(map);
  if (pitch > 0) relief.shortest_wavelength_mm = 2 * pitch;
  list_measured_and_assumed(result, relief);
  const std::vector<float>& confidence = result.stereo.confidence;
  const auto count = static_cast<double>(confidence.size());
  result.mean_confidence = std::accumulate(confidence.begin(), confidence.end(), 0.0) / count;
  result.low_confidence_fraction =
      static_cast<double>(std::count_if(confidence.begin(), confidence.end(), [](float c) { return c < 0.5F; })) /
      count;
  result.stereo.height_px = {};
  return result;
}

StereoFiles height_of_picture_files(const std::vector<fs::path>& files, const fs::path& output,
                                    const StereoFileOptions& options) {
  StereoFiles result = relief_of_picture_files(files, options);
  write_relief_files(result.files, output, options.files);
  if (!options.files.pictures.empty()) {
    result.confidence_picture = (options.files.pictures / "confidence.png").string();
    write_grey_image(result.confidence_picture, confidence_picture(result.stereo), 8);
  }
  return result;
}

}  // namespace papilla
