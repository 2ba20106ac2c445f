// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "json/texture_json.hpp"
#include "options/texture_option.hpp"
#include "text/texture_text.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Options {
  std::string image;
  SurveyOption survey;
};

Json run(const Options& options, VerbContext& context) {
  const TextureSurvey survey = survey_picture(options.image, options.survey.options(), context.progress);
  context.console.print(survey_text(options.image, survey));
  return survey_json(options.image, survey);
}

}  // namespace

void add_analyze(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb =
      add_verb(program,
               {"analyze", "Measures the roughness, symmetry and class of a texture",
                "papilla synthesize grain --kind quads6 -o quads.png && papilla analyze quads.png --pictures pictures"},
               [options](VerbContext& context) { return run(*options, context); });
  verb->add_option("image", options->image, "Picture")->required()->type_name("IMAGE");
  options->survey.add_to(*verb);
}

}  // namespace papilla::app
