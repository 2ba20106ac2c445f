// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <memory>

#include "file_options.hpp"
#include "json/texture_json.hpp"
#include "option_checks.hpp"
#include "text/texture_text.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Options {
  std::string image, pictures, lattice = "best", feature = "squared", pattern = "plane";
  std::vector<std::string> only;
  bool force_lattice = false;
  SurveyOptions survey;
};

Json run(const Options& options, VerbContext& context) {
  const auto wanted = [&](const char* part) {
    return options.only.empty() || std::find(options.only.begin(), options.only.end(), part) != options.only.end();
  };
  SurveyOptions survey = options.survey;
  survey.fractal = wanted("fractal");
  survey.symmetry = wanted("symmetry");
  survey.order = wanted("class");
  survey.by_class = options.only.empty();
  if (options.pattern == "strip") survey.pattern = SymmetryPattern::strip;
  if (options.pattern == "rosette") survey.pattern = SymmetryPattern::rosette;
  if (options.lattice == "projection") survey.lattice.method = LatticeMethod::projection;
  if (options.force_lattice) {  // The best lattice, whatever it explains.
    survey.lattice.least_significance = 1e-9;
    survey.lattice.false_alarm_rate = 1;
  }
  if (options.feature == "absolute") survey.feature = FeatureKind::absolute;
  survey.pictures = options.pictures;
  const TextureSurvey result = survey_picture(options.image, survey, context.progress);
  context.console.print(survey_text(options.image, result));
  return survey_json(options.image, result);
}

}  // namespace

void add_analyze(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb =
      add_verb(program,
               {"analyze", "Measures the roughness, symmetry and class of a texture",
                "papilla synthesize grain --kind quads6 -o quads.png && papilla analyze quads.png --pictures pictures"},
               [options](VerbContext& context) { return run(*options, context); });
  reads(verb->add_option("image", options->image, "Picture"))->required()->type_name("IMAGE");
  verb->add_option("--pitch", options->survey.pitch_mm, "Millimetres per pixel; default from the file's resolution")
      ->type_name("MM")
      ->check(positive());
  verb->add_option("--only", options->only, "Parts to analyse, whatever the class; default: what the class needs")
      ->delimiter(',')
      ->transform(one_of({"fractal", "symmetry", "class"}));
  writes_into(verb->add_option("--pictures", options->pictures,
                               "Write the strip of the symmetry, the log-log plot and the polar Hurst plot into DIR"),
              {"symmetry.png"})
      ->type_name("DIR");
  verb->add_option("--lattice", options->lattice, "How minima become a lattice")
      ->transform(one_of({"best", "projection"}))
      ->capture_default_str();
  verb->add_option("--feature", options->feature, "Distortion of the feature matrix; absolute is slow")
      ->transform(one_of({"squared", "absolute"}))
      ->capture_default_str();
  verb->add_flag("--force-lattice", options->force_lattice, "Take the best lattice even if it is not significant");
  verb->add_option("--pattern", options->pattern,
                   "strip adds the frieze group of a strip along x, rosette the group about the middle of the picture")
      ->transform(one_of({"plane", "strip", "rosette"}))
      ->capture_default_str();
}

}  // namespace papilla::app
