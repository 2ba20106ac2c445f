// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "papilla/pipeline/height_file.hpp"
#include "papilla/pipeline/photograph_file.hpp"
#include "papilla/pipeline/stereo_file.hpp"
#include "papilla/pipeline/synthesis.hpp"
#include "papilla/pipeline/texture_files.hpp"
#include "papilla/pipeline/texture_survey.hpp"
#include "papilla/texture/prepare.hpp"

namespace papilla::app {

// Results on textures for people, as lines of a terminal.

/// Of `analyze`, `height`, `prepare`, `synthesize` and `texture`.
std::string survey_text(const std::string& image, const TextureSurvey& survey);
std::string height_text(const std::string& image, const std::string& output, const HeightFiles& files);
std::string stereo_text(const std::string& output, const StereoFiles& files);
std::string prepared_text(const std::string& output, const PreparedPicture& prepared);
std::string synthesis_text(const std::string& what, const std::string& output, const std::string& relief,
                           const Synthesis& synthesis, const SynthesisOptions& options);
std::string texture_text(const TextureFiles& files);
std::string wang_text(const WangFiles& files);
std::string photograph_text(const std::string& relief, const std::string& output, const PhotographFile& made);

}  // namespace papilla::app
