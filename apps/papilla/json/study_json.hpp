// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "json/json.hpp"
#include "papilla/pipeline/study/simulated_participant.hpp"
#include "papilla/pipeline/study/study_analysis.hpp"

namespace papilla::app {

/// id, participants, minutes, stimuli[], trials[] with the labels of their stimuli, factors[] {name, levels[]}.
Json study_design_json(const Study& study);

/// thresholds[] {experiment, factor, condition, unit, value, low, high, ...}, factors[] {experiment, factor, level,
/// reference, unit, value, low, high, determined}, ratings[], recognitions[]. An end that the data leave open is null.
Json study_analysis_json(const StudyAnalysis& analysis, double confidence);

/// A row a condition: truth, runs, covered, cover, determined, median, median_ratio.
Json study_power_json(const std::vector<StudyPower>& powers);

}  // namespace papilla::app
