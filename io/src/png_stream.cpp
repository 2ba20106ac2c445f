// SPDX-License-Identifier: MIT
#include "png_stream.hpp"

#include <png.h>

#include <bit>
#include <csetjmp>

#include "papilla/core/error.hpp"

namespace papilla::io_detail {
namespace {

void append(png_structp png, png_bytep data, std::size_t length) {
  auto& bytes = *static_cast<std::vector<std::byte>*>(png_get_io_ptr(png));
  const auto* from = reinterpret_cast<const std::byte*>(data);
  bool is_kept = true;
  try {
    bytes.insert(bytes.end(), from, from + length);
  } catch (...) {  // libpng is C: no exception goes through it.
    is_kept = false;
  }
  if (!is_kept) png_error(png, "out of memory");
}

/// libpng leaves it by a jump when it fails: nothing in it has a destructor.
bool write(png_structp png, png_infop info, const PngSamples& picture, std::vector<std::byte>& bytes) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_write_fn(png, &bytes, &append, nullptr);
  const int colour = picture.channels == 1   ? PNG_COLOR_TYPE_GRAY
                     : picture.channels == 3 ? PNG_COLOR_TYPE_RGB
                                             : PNG_COLOR_TYPE_RGB_ALPHA;
  png_set_IHDR(png, info, static_cast<png_uint_32>(picture.width), static_cast<png_uint_32>(picture.height),
               picture.bits, colour, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  if (picture.bits == 16 && std::endian::native == std::endian::little) png_set_swap(png);
  const std::size_t row = static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.channels) *
                          static_cast<std::size_t>(picture.bits / 8);
  const auto* samples = static_cast<png_const_bytep>(picture.samples);
  for (int y = 0; y < picture.height; ++y) png_write_row(png, samples + static_cast<std::size_t>(y) * row);
  png_write_end(png, nullptr);
  return true;
}

void fail(png_structp png, png_const_charp) { png_longjmp(png, 1); }
void ignore(png_structp, png_const_charp) {}

}  // namespace

std::vector<std::byte> png_stream(const PngSamples& picture) {
  std::vector<std::byte> bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, &fail, &ignore);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  const bool done = info && write(png, info, picture, bytes);
  png_destroy_write_struct(&png, &info);
  if (!done) throw SolverFailure("a picture could not be written as PNG");
  return bytes;
}

}  // namespace papilla::io_detail
