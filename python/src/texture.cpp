// SPDX-License-Identifier: MIT
#include "fields_of_work.hpp"
#include "function.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/io/rgba_image.hpp"
#include "papilla/pipeline/height_file.hpp"
#include "papilla/pipeline/synthesis.hpp"
#include "papilla/pipeline/texture_survey.hpp"
#include "papilla/texture/best_dimension.hpp"
#include "papilla/texture/box_dimension.hpp"
#include "papilla/texture/fractal_readings.hpp"
#include "papilla/texture/fshot_dimension.hpp"
#include "papilla/texture/grain.hpp"
#include "papilla/texture/height_from_image.hpp"
#include "papilla/texture/light_direction.hpp"
#include "papilla/texture/midpoint_surface.hpp"
#include "papilla/texture/normal_map.hpp"
#include "papilla/texture/part_roughness.hpp"
#include "papilla/texture/photometric_stereo.hpp"
#include "papilla/texture/prepare.hpp"
#include "papilla/texture/probability_dimension.hpp"
#include "papilla/texture/roughness.hpp"
#include "papilla/texture/shape_from_shading.hpp"
#include "papilla/texture/spectral_surface.hpp"
#include "papilla/texture/stein_surface.hpp"
#include "papilla/texture/surface_like.hpp"
#include "papilla/texture/symmetry.hpp"
#include "papilla/texture/texture_class.hpp"
#include "pictures.hpp"

namespace papilla::python {
namespace {

using Path = std::filesystem::path;

void add_files(py::module_& module) {
  define(module, "read_grey_image(path: str | os.PathLike[str]) -> GreyImage", docs::read_grey_image,
         [](const Path& path) { return read_grey_image(path); });
  define(module, "read_color_image(path: str | os.PathLike[str]) -> ColorImage", docs::read_color_image,
         [](const Path& path) { return read_color_image(path); });
  define(module, "read_rgba_image(path: str | os.PathLike[str]) -> RgbaImage", docs::read_rgba_image,
         [](const Path& path) { return read_rgba_image(path); });
  define(module, "read_linear_image(path: str | os.PathLike[str]) -> LinearImage", docs::read_linear_image,
         [](const Path& path) { return read_linear_image(path); });
  define(module, "write_grey_image(path: str | os.PathLike[str], image: GreyImage, bits: int, jpeg_quality: int = 98)",
         docs::write_grey_image, [](const Path& path, const GreyImage& image, int bits, int jpeg_quality) {
           write_grey_image(path, image, bits, jpeg_quality);
         });
  define(module, "write_color_image(path: str | os.PathLike[str], image: ColorImage)",
         "Writes a colour picture in the format of the extension. Raises as write_grey_image().",
         [](const Path& path, const ColorImage& image) { write_color_image(path, image); });
  define(module, "write_height_file(path: str | os.PathLike[str], map: HeightMap)", docs::write_height_file,
         [](const Path& path, const HeightMap& map) { write_height_file(path, map); });
}

void add_dimensions(py::module_& module) {
  define(module, "box_dimension(image: GreyImage) -> FractalEstimate", docs::box_dimension,
         [](const GreyImage& image) { return box_dimension(image); });
  define(module, "information_dimension(image: GreyImage) -> FractalEstimate",
         "The information dimension, by the boxes of box_dimension().",
         [](const GreyImage& image) { return information_dimension(image); });
  define(module, "correlation_dimension(image: GreyImage) -> FractalEstimate",
         "The correlation dimension, by the boxes of box_dimension().",
         [](const GreyImage& image) { return correlation_dimension(image); });
  define<ProbabilityOptions>(
      module, "probability_dimension(image: GreyImage) -> FractalEstimate", docs::probability_dimension,
      [](const GreyImage& image, const ProbabilityOptions& options) { return probability_dimension(image, options); });
  define(module, "fshot_dimension(image: GreyImage) -> FshotSignature", docs::fshot_dimension,
         [](const GreyImage& image) { return fshot_dimension(image); });
  define(module, "best_dimension(image: GreyImage, longest_wave_px: float = 1e300) -> BestDimension",
         docs::best_dimension,
         [](const GreyImage& image, double longest_wave_px) { return best_dimension(image, longest_wave_px); });
  define(module, "read_fractal_dimensions(image: GreyImage) -> FractalReadings", docs::read_fractal_dimensions,
         [](const GreyImage& image, const ProgressCallback& progress) {
           return read_fractal_dimensions(image, progress);
         });
}

void add_analyses(py::module_& module) {
  define<LatticeOptions>(
      module, "analyze_symmetry(image: GreyImage, feature: FeatureKind = 'squared') -> SymmetryAnalysis",
      docs::analyze_symmetry,
      [](const GreyImage& image, FeatureKind feature, const LatticeOptions& options, const ProgressCallback& progress) {
        return analyze_symmetry(image, options, feature, progress);
      });
  define<WallpaperOptions>(module, "find_wallpaper_group(analysis: SymmetryAnalysis) -> WallpaperSymmetry",
                           docs::find_wallpaper_group,
                           [](const SymmetryAnalysis& analysis, const WallpaperOptions& options) {
                             return find_wallpaper_group(analysis, options);
                           });
  define(module, "classify(image: GreyImage, explained_variance: float, stripes: float = 0.0) -> TextureClass",
         docs::classify, [](const GreyImage& image, double explained_variance, double stripes) {
           return classify(image, explained_variance, stripes);
         });
  define(module, "orientation_field(image: GreyImage) -> OrientationField", docs::orientation_field,
         [](const GreyImage& image) { return orientation_field(image); });
  define(module, "measure_suitability(image: GreyImage, lattice: Lattice) -> Suitability", docs::measure_suitability,
         [](const GreyImage& image, const Lattice& lattice) { return measure_suitability(image, lattice); });
  define<SurveyOptions>(module, "survey_picture(path: str | os.PathLike[str]) -> TextureSurvey", docs::survey_picture,
                        [](const Path& path, const SurveyOptions& options, const ProgressCallback& progress) {
                          return survey_picture(path, options, progress);
                        });
  define<PrepareOptions>(module, "prepare_picture(image: GreyImage) -> PreparedPicture", docs::prepare_picture,
                         [](const GreyImage& image, PrepareOptions& options, const ProgressCallback& progress) {
                           options.progress = progress;
                           return prepare_picture(image, options);
                         });
  define<RoughnessOptions>(
      module, "measure_roughness(relief: HeightMap) -> Roughness", docs::measure_roughness,
      [](const HeightMap& relief, const RoughnessOptions& options) { return measure_roughness(relief, options); });
  define(module, "part_roughness(relief: HeightMap, longest_mm: float = 1.0) -> PartedRelief", docs::part_roughness,
         [](const HeightMap& relief, double longest_mm) { return part_roughness(relief, longest_mm); });
  define(module, "estimate_light(image: GreyImage) -> LightEstimate", docs::estimate_light,
         [](const GreyImage& image) { return estimate_light(image); });
}

template <class F>
void add_shading(py::module_& module, const std::string& name, const std::string& result, const char* doc, F shape) {
  define<ShadingOptions>(module, (name + "(image: GreyImage) -> " + result).c_str(), doc,
                         [shape](const GreyImage& image, ShadingOptions& options, const ProgressCallback& progress) {
                           options.progress = progress;
                           return shape(image, options);
                         });
}

void add_heights(py::module_& module) {
  define<HeightOptions>(module, "height_from_image(image: GreyImage) -> HeightResult", docs::height_from_image,
                        [](const GreyImage& image, HeightOptions& options, const ProgressCallback& progress) {
                          options.progress = progress;
                          return height_from_image(image, options);
                        });
  define<HeightFileOptions>(
      module, "height_of_picture_file(picture: str | os.PathLike[str], output: str | os.PathLike[str]) -> HeightFiles",
      docs::height_of_picture_file,
      [](const Path& picture, const Path& output, HeightFileOptions& options, const ProgressCallback& progress) {
        options.height.progress = progress;
        return height_of_picture_file(picture, output, options);
      });
  add_shading(module, "shape_from_shading_variational", "ShadingResult", docs::shape_from_shading_variational,
              shape_from_shading_variational);
  add_shading(module, "shape_from_shading_pentland", "ShadingResult", docs::shape_from_shading_pentland,
              shape_from_shading_pentland);
  add_shading(module, "shape_from_shading_wiener", "WienerShadingResult", docs::shape_from_shading_wiener,
              shape_from_shading_wiener);
  add_shading(module, "shape_from_shading_tsai_shah", "ShadingResult", docs::shape_from_shading_tsai_shah,
              shape_from_shading_tsai_shah);
  define<PhotometricStereoOptions>(
      module, "photometric_stereo(photographs: list[GreyImage]) -> PhotometricStereoResult", docs::photometric_stereo,
      [](const std::vector<GreyImage>& photographs, PhotometricStereoOptions& options,
         const ProgressCallback& progress) {
        options.progress = progress;
        return photometric_stereo(photographs, options);
      });
  define(module, "opposite_relief(relief: HeightMap) -> HeightMap", docs::opposite_relief,
         [](const HeightMap& relief) { return opposite_relief(relief); });
  define(module, "normal_map(relief: HeightMap) -> ColorImage", docs::normal_map,
         [](const HeightMap& relief) { return normal_map(relief); });
}

void add_synthesis(py::module_& module) {
  define<SpectralSurfaceOptions>(module, "spectral_surface() -> HeightGrid", docs::spectral_surface,
                                 [](SpectralSurfaceOptions& options, const ProgressCallback& progress) {
                                   options.progress = progress;
                                   return spectral_surface(options);
                                 });
  define<MidpointOptions>(module, "midpoint_surface() -> HeightGrid", docs::midpoint_surface,
                          [](MidpointOptions& options, const ProgressCallback& progress) {
                            options.progress = progress;
                            return midpoint_surface(options);
                          });
  define<BrownianSurfaceOptions>(module, "brownian_surface_exact() -> HeightGrid", docs::brownian_surface_exact,
                                 [](BrownianSurfaceOptions& options, const ProgressCallback& progress) {
                                   options.progress = progress;
                                   return brownian_surface_exact(options);
                                 });
  define<BrownianGraphOptions>(module, "brownian_graph() -> NDArray[np.float64]", docs::brownian_graph,
                               [](const BrownianGraphOptions& options) { return brownian_graph(options); });
  define<SurfaceLikeOptions>(module, "surface_like(image: GreyImage) -> SurfaceLike", docs::surface_like,
                             [](const GreyImage& image, SurfaceLikeOptions& options, const ProgressCallback& progress) {
                               options.progress = progress;
                               return surface_like(image, options);
                             });
  define<GrainOptions>(module, "synthesize_grain(kind: GrainKind) -> GrainResult", docs::synthesize_grain,
                       [](GrainKind kind, const GrainOptions& options) { return synthesize_grain(kind, options); });
  define<SynthesisOptions>(module, "synthesize_texture() -> Synthesis", docs::synthesize_texture,
                           [](SynthesisOptions& options, const ProgressCallback& progress) {
                             options.progress = progress;
                             return synthesize_texture(options);
                           });
  define(module, "to_grey_image(surface: HeightGrid, bits: int = 32) -> GreyImage", docs::to_grey_image,
         [](const HeightGrid& surface, int bits) { return to_grey_image(surface, bits); });
}

}  // namespace

void add_texture(py::module_& module) {
  add_files(module);
  add_dimensions(module);
  add_analyses(module);
  add_heights(module);
  add_synthesis(module);
}

}  // namespace papilla::python
