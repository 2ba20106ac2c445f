// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "papilla/pipeline/study/simulated_participant.hpp"
#include "papilla/pipeline/study/study_analysis.hpp"

namespace papilla::app {

/// "0.25 (0.21 to 0.3)"; an open end is "…".
std::string estimate_text(const Estimate& estimate);

/// estimate_text(), and whether both ends are known. Where neither is, no number: every one fits as well.
std::string threshold_text(const Estimate& threshold);

/// Stimuli, trials and how long a session takes; reliefs that were too steep.
std::string study_design_text(const std::string& file, const Study& study);
/// Thresholds, effects, recognitions.
std::string study_analysis_text(const StudyAnalysis& analysis, double confidence);
std::string study_power_text(const std::vector<StudyPower>& powers, double confidence);

}  // namespace papilla::app
