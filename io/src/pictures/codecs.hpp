// SPDX-License-Identifier: MIT
#pragma once

#include "picture_codec.hpp"

/// The functions of PicturesPlugin, by OpenImageIO.
namespace papilla::io_detail {

std::unique_ptr<PictureDecoder> open_decoder(std::string_view format, const std::string& name,
                                             std::optional<std::span<const std::byte>> bytes, int most_megabytes,
                                             std::string& reason);

std::unique_ptr<PictureEncoder> make_encoder(const std::string& name, const PictureToStore& picture);

std::vector<unsigned char> encode_gif(const std::string& name, std::span<const ColorImage> frames, double per_second,
                                      std::size_t held);

}  // namespace papilla::io_detail
