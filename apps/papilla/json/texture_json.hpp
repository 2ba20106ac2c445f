// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "json/json.hpp"
#include "papilla/pipeline/contact_sheet.hpp"
#include "papilla/pipeline/height_file.hpp"
#include "papilla/pipeline/photograph_file.hpp"
#include "papilla/pipeline/stereo_file.hpp"
#include "papilla/pipeline/synthesis.hpp"
#include "papilla/pipeline/texture_files.hpp"
#include "papilla/pipeline/texture_survey.hpp"
#include "papilla/texture/part_roughness.hpp"
#include "papilla/texture/prepare.hpp"

namespace papilla::app {

// Results on textures under the key names of docs/files.md.

/// {step, run, reason} a line.
Json steps_json(const AnalysisPlan& steps);
/// {hurst, rms_mm, wavelength_range_mm[], anisotropy{ratio, direction_deg}}; null without one.
Json roughness_model_json(const std::optional<RoughnessModel>& roughness);

/// Of `analyze`, `height`, `prepare`, `synthesize`, `texture` and `texture --sheet`.
Json survey_json(const std::string& image, const TextureSurvey& survey);
Json height_json(const HeightFiles& files);
/// Of `height` with several photographs: all of height_json(), and more.
Json stereo_json(const StereoFiles& files);
/// What photometric stereo found beside the relief.
Json stereo_readings_json(const StereoFiles& files);
Json prepared_json(const std::string& image, const PreparedPicture& prepared);
Json synthesis_json(const std::string& what, const Synthesis& synthesis, const SynthesisOptions& options);
Json texture_json(const TextureFiles& files);
Json wang_json(const WangFiles& files);
Json sheet_json(const ContactSheet& sheet);
Json photograph_json(const std::string& relief, const PhotographFile& made, const PhotographFileOptions& options);

}  // namespace papilla::app
