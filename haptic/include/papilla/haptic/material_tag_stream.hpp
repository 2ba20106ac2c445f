// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

#include "papilla/core/value_stream.hpp"
#include "papilla/haptic/material_tag.hpp"

/// What the streams of value_stream.hpp have to be told of a tag, and with it of a scene: structs with a base.
namespace papilla {
namespace tag_stream {

/// Value, for the fields of its base.
template <class Value>
using Picture = std::conditional_t<std::is_const_v<Value>, const PlacedPicture, PlacedPicture>;

}  // namespace tag_stream

template <class Stream, class Value>
requires std::is_same_v<std::remove_const_t<Value>, HeightTag>
void visit_value(Stream& stream, Value& tag) {
  stream(static_cast<tag_stream::Picture<Value>&>(tag));
  stream(tag.channel, tag.scale_m, tag.offset_m, tag.white_is_outward, tag.metres_per_uv, tag.rms_m);
}

template <class Stream, class Value>
requires std::is_same_v<std::remove_const_t<Value>, MapsTag>
void visit_value(Stream& stream, Value& tag) {
  stream(static_cast<tag_stream::Picture<Value>&>(tag));
  stream(tag.channels);
}

}  // namespace papilla
