// SPDX-License-Identifier: MIT
#include "pictures.hpp"

#include "fields_of_work.hpp"

namespace papilla::python {
namespace {

/// The samples of a picture as (height, width) or (height, width, channels), whatever the class calls them.
template <class Image>
auto& samples_of(Image& image) {
  if constexpr (std::is_same_v<std::remove_const_t<Image>, HeightMap>)
    return image.mm;
  else if constexpr (std::is_same_v<std::remove_const_t<Image>, HeightGrid>)
    return image.heights;
  else
    return image.pixels;
}

template <class Image>
std::vector<py::ssize_t> sides_of(const Image& image, py::ssize_t channels) {
  std::vector<py::ssize_t> sides;
  if constexpr (std::is_same_v<Image, HeightGrid>)
    sides = {image.size, image.size};
  else
    sides = {image.height, image.width};
  if (channels > 1) sides.push_back(channels);
  return sides;
}

template <class Image>
using Sample = typename std::decay_t<decltype(samples_of(std::declval<Image&>()))>::value_type;

/// A picture of an array of the shape that its class has.
template <class Image>
void fill(Image& image, py::handle given, py::ssize_t channels, const char* name) {
  std::vector<py::ssize_t> shape{-1, -1};
  if (channels > 1) shape.push_back(channels);
  const py::array array = array_of(given, dtype_of<Sample<Image>>(), shape, std::string(name) + ": array");
  const auto height = static_cast<int>(array.shape(0)), width = static_cast<int>(array.shape(1));
  if constexpr (std::is_same_v<Image, HeightGrid>) {
    if (width != height) throw UsageError(std::string(name) + ": needs as many rows as columns");
    image.size = width;
  } else {
    image.width = width, image.height = height;
  }
  samples_of(image) = values_in<Sample<Image>>(array, static_cast<std::size_t>(array.size()));
}

/// Samples never move: the picture's size is fixed, so that buffers stay good as long as the picture lives.
template <class Image>
py::class_<Image> add_picture(py::module_& module, const char* name, const char* doc, py::ssize_t channels) {
  py::class_<Image> type(module, name, py::buffer_protocol(), doc);
  type.def_buffer([channels](Image& image) {
    const auto sides = sides_of(image, channels);
    std::vector<py::ssize_t> strides(sides.size());
    py::ssize_t stride = sizeof(Sample<Image>);
    for (std::size_t i = sides.size(); i-- > 0; stride *= sides[i]) strides[i] = stride;
    return py::buffer_info(samples_of(image).data(), sizeof(Sample<Image>),
                           py::format_descriptor<Sample<Image>>::format(), static_cast<py::ssize_t>(sides.size()),
                           sides, strides);
  });
  type.def_property_readonly(
      "array",
      [channels](py::object self) {
        auto& image = self.cast<Image&>();
        return py::array(dtype_of<Sample<Image>>(), sides_of(image, channels), {}, samples_of(image).data(), self);
      },
      "The samples, looked at in place: (height, width), with colours (height, width, channels).");
  type.def("__repr__", [name, channels](const Image& image) {
    return "<" + std::string(name) + " " + py::str(py::tuple(py::cast(sides_of(image, channels)))).cast<std::string>() +
           ">";
  });
  return type;
}

void add_grey(py::module_& module) {
  auto type = add_picture<GreyImage>(module, "GreyImage",
                                     "A single-channel picture, row by row from the top left: float32 of (height, "
                                     "width), grey pictures in [0, 1]. Has the buffer protocol.",
                                     1);
  type.def(py::init([](const py::object& array, double pitch_mm, int bits) {
             auto image = std::make_unique<GreyImage>();
             fill(*image, array, 1, "GreyImage");
             image->pitch_mm = pitch_mm;
             image->bits = bits;
             return image;
           }),
           py::arg("array"), py::kw_only(), py::arg("pitch_mm") = 0.0, py::arg("bits") = 32);
  type.def_readonly("width", &GreyImage::width).def_readonly("height", &GreyImage::height);
  type.def_readwrite("pitch_mm", &GreyImage::pitch_mm, "Millimetres per pixel; 0 when unknown.");
  type.def_readwrite("bits", &GreyImage::bits, "Bits per sample of the file (8, 16, 32); the rounding of the values.");
}

template <class Image>
void add_colours(py::module_& module, const char* name, const char* doc, py::ssize_t channels) {
  auto type = add_picture<Image>(module, name, doc, channels);
  type.def(py::init([name, channels](const py::object& array) {
             auto image = std::make_unique<Image>();
             fill(*image, array, channels, name);
             return image;
           }),
           py::arg("array"));
  type.def_readonly("width", &Image::width).def_readonly("height", &Image::height);
}

void add_height_map(py::module_& module) {
  auto type = add_picture<HeightMap>(module, "HeightMap",
                                     "Relief over a rectangle in millimetres, outward positive, row by row from the "
                                     "top left: float32 of (height, width). Sample (x, y) covers the square of side "
                                     "pitch_mm around ((x + 1/2), (y + 1/2)) pitch_mm. Has the buffer protocol.",
                                     1);
  type.def(py::init([](const py::object& array, double pitch_mm_x, double pitch_mm_y, bool periodic) {
             auto map = std::make_unique<HeightMap>();
             fill(*map, array, 1, "HeightMap");
             map->pitch_mm_x = pitch_mm_x;
             map->pitch_mm_y = pitch_mm_y;
             map->periodic = periodic;
             return map;
           }),
           py::arg("array"), py::kw_only(), py::arg("pitch_mm_x") = 0.0, py::arg("pitch_mm_y") = 0.0,
           py::arg("periodic") = false);
  type.def_readonly("width", &HeightMap::width).def_readonly("height", &HeightMap::height);
  type.def_readwrite("pitch_mm_x", &HeightMap::pitch_mm_x).def_readwrite("pitch_mm_y", &HeightMap::pitch_mm_y);
  type.def_readwrite("periodic", &HeightMap::periodic,
                     "True when the right neighbour of the last column is the first one, and likewise for rows.");
}

void add_height_grid(py::module_& module) {
  auto type = add_picture<HeightGrid>(module, "HeightGrid",
                                      "Heights over a square grid in units of its pitch: float64 of (size, size). Has "
                                      "the buffer protocol.",
                                      1);
  type.def(py::init([](const py::object& array, bool periodic) {
             auto grid = std::make_unique<HeightGrid>();
             fill(*grid, array, 1, "HeightGrid");
             grid->periodic = periodic;
             return grid;
           }),
           py::arg("array"), py::kw_only(), py::arg("periodic") = false);
  type.def_readonly("size", &HeightGrid::size).def_readwrite("periodic", &HeightGrid::periodic);
}

}  // namespace

void add_pictures(py::module_& module) {
  add_grey(module);
  add_colours<ColorImage>(module, "ColorImage",
                          "An 8-bit RGB picture, row by row from the top left: uint8 of (height, width, 3). Has the "
                          "buffer protocol.",
                          3);
  add_colours<RgbaImage>(module, "RgbaImage",
                         "An 8-bit picture with alpha, row by row from the top left: uint8 of (height, width, 4). "
                         "Colours are not multiplied by alpha. Has the buffer protocol.",
                         4);
  add_colours<LinearImage>(module, "LinearImage",
                           "A picture of linear light, row by row from the top left: float32 of (height, width, 3), "
                           "finite and at least 0. Has the buffer protocol.",
                           3);
  add_height_map(module);
  add_height_grid(module);
}

}  // namespace papilla::python
