// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "papilla/pipeline/study/study_analysis.hpp"

namespace papilla::app {

/// A picture of an analysis, as SVG.
struct StudyPicture {
  std::string name;  ///< Of a file, without extension.
  std::string svg;
};

/// Per experiment of choices the psychometric functions with their data; per experiment the effects with intervals; per
/// experiment of ratings the means. Empty without gnuplot.
std::vector<StudyPicture> study_pictures(const Study& study, const StudyAnalysis& analysis);

/// A self-contained page: the pictures, and all numbers as tables.
std::string study_page(const Study& study, const StudyAnalysis& analysis, const std::vector<StudyPicture>& pictures,
                       double confidence);

}  // namespace papilla::app
