// SPDX-License-Identifier: MIT
#include "codecs.hpp"
#include "papilla/core/error.hpp"

extern "C" __attribute__((visibility("default")))
const papilla::io_detail::PicturesPlugin papilla_pictures{{papilla::version()},
                                                          papilla::io_detail::open_decoder,
                                                          papilla::io_detail::make_encoder,
                                                          papilla::io_detail::encode_gif};
