// SPDX-License-Identifier: GPL-3.0-or-later
#include "json/texture_json.hpp"

namespace papilla::app {

Json stereo_readings_json(const StereoFiles& files) {
  const PhotometricStereoResult& stereo = files.stereo;
  Json json = {{"lights", Json::array()}};
  for (const Vec3 light : stereo.lights) json["lights"].push_back({light.x, light.y, light.z});
  json["ambient"] = stereo.ambient;
  json["confidence"] = {{"mean", files.mean_confidence}, {"low_fraction", files.low_confidence_fraction}};
  json["residual"] = stereo.residual;
  json["shifts_px"] = Json::array();
  for (const Vec2 shift : files.shifts_px) json["shifts_px"].push_back({shift.x, shift.y});
  json["depth_source"] = files.depth_source;
  json["references"] = Json::array();
  for (const ReferenceReading& reading : files.references)
    json["references"].push_back({{"name", reading.name},
                                  {"value", reading.value},
                                  {"correlation", reading.correlation ? Json(*reading.correlation) : Json(nullptr)}});
  return json;
}

Json stereo_json(const StereoFiles& files) {
  Json json = height_json(files.files);
  json["light_coherence"] = nullptr;
  json.update(stereo_readings_json(files));
  if (!files.confidence_picture.empty())
    json["pictures"].push_back({{"name", "confidence"}, {"file", files.confidence_picture}});
  return json;
}

}  // namespace papilla::app
