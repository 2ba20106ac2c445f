// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace papilla {

/// What is felt: a plate with a relief, as a tagged GLB file of a name that gives nothing away.
struct StudyStimulus {
  std::string file;                      ///< Relative to STUDY.json.
  std::string grain;                     ///< A GrainKind's name, or "fractal".
  double height = 1;                     ///< Factor of the relief, and of the force of models that add one.
  std::string model;                     ///< A force model's name.
  std::optional<double> dimension = {};  ///< Of a fractal: of the surface, or 1 more than that of its graph.
  double size_mm = 40;                   ///< Side of the plate.
  double depth_mm = 0;                   ///< Of the relief as it was baked, peak to valley.
  double limited_share = 0;              ///< Of the relief that was steeper than the probe may meet.

  /// "spheres6 x2 heightfield", "2.3 lateral".
  std::string label() const;
};

/// How an answer is given.
enum class StudyAnswerKind {
  identification,  ///< One of the question's labels.
  rating,          ///< A whole number from low to high; labels name the steps, or only the ends.
  choice,          ///< "first" or "second" of two stimuli.
};

/// "identification", "rating", "choice".
std::string_view to_string(StudyAnswerKind kind) noexcept;

/// Trials with one question.
struct StudyExperiment {
  std::string id;  ///< grains, recognisability, roughness, dimension or height; unique.
  StudyAnswerKind kind = StudyAnswerKind::rating;
  std::string instructions;  ///< Before each block.
  std::string question;
  std::vector<std::string> labels;
  int low = 1, high = 5;  ///< Of a rating.
  std::string factor;     ///< Of a choice: what the stimuli differ in, "dimension" or "height".
  double seconds = 8;     ///< That a trial takes, for the length of a session.
};

/// What is asked once.
struct StudyTrial {
  std::size_t experiment = 0;
  std::vector<std::size_t> stimuli;   ///< One, or of a choice two in the order in which they are felt.
  std::vector<std::string> pictures;  ///< Shown with it, relative to STUDY.json.
};

/// Trials in one go, after their instructions.
struct StudyBlock {
  std::vector<std::size_t> shown;  ///< Stimuli to get used to before.
  std::vector<std::size_t> trials;
};

/// An experiment with people: stimuli, questions, and for every participant the order of the trials.
struct Study {
  std::string id;  ///< Of stimuli, trials and orders: answers carry it.
  std::uint64_t seed = 1;
  std::string language = "en";  ///< Of the texts.
  std::vector<StudyExperiment> experiments;
  std::vector<StudyStimulus> stimuli;
  std::vector<StudyTrial> trials;
  std::vector<std::vector<StudyBlock>> participants;

  /// The trials of a participant in order. @pre participant from 1 to participants.size().
  std::vector<std::size_t> order_of(std::size_t participant) const;
  /// Of a trial: of a choice the greater level less the smaller one, in the unit of difference_unit(); nothing of other
  /// kinds.
  std::optional<double> difference_of(const StudyTrial& trial) const;
  /// The right answer: the grain, or "first" or "second" for the greater level; empty for ratings.
  std::string right_answer(const StudyTrial& trial) const;
};

/// "of fractal dimension", "octaves of height".
std::string_view difference_unit(std::string_view factor) noexcept;

/// Experiments of [Schulze 2005] and the choices beside them, by id:
///   grains           8.3: which of six grains is it, five of them without repetition on 80 mm, then on 40 mm
///   recognisability  8.4, 8.5: five steps from "not" to "perfectly recognisable": grains × heights × grain_models
///   roughness        6.4.2: rough from 1 to 20: dimensions × models
///   dimension        two-alternative: which is rougher, the lowest dimension or another: dimensions × models
///   height           two-alternative: which relief is higher, ×1 or another: grains × height_steps
struct StudyDesignOptions {
  std::vector<std::string> experiments = {"grains", "recognisability", "roughness", "dimension", "height"};
  std::vector<std::string> grains = {"spheres6", "ovals6", "quads6"};
  std::vector<double> heights = {1, 2, 4};
  std::vector<double> height_steps = {1.1, 1.2, 1.4, 2, 2.8, 4};
  std::vector<double> dimensions = {2.1, 2.2, 2.3, 2.4, 2.5, 2.6, 2.7, 2.8, 2.9};
  std::vector<std::string> grain_models = {"heightfield", "textured-normal", "orthogonal", "lateral"};
  std::vector<std::string> models = {"orthogonal", "lateral", "graph-orthogonal", "graph-lateral"};
  int repetitions = 2;  ///< Of the blocks of choices; each has every pair in both orders.
  int participants = 20;
  std::string language = "en";  ///< "en", "de".
  std::uint64_t seed = 1;
};

/// All experiments' ids, in the order in which a participant gets them.
std::vector<std::string_view> study_experiments();

/// Stimuli, trials and orders. Blocks of an experiment (one a force model, grain or size) stand in the order of
/// balanced_order() for each participant, those of `grains` in that of the source; within a block the order is random;
/// which grain of the six is left out goes round. Stimuli have no files yet, but names.
/// Deterministic for given options.
/// @throws InvalidInput naming the option and value that cannot be.
/// Sources: M. Schulze, Von computergraphischen zu haptischen Texturen, dissertation, Hannover 2005, 6.4 and 8.2
/// to 8.5; G. T. Fechner, Elemente der Psychophysik, 1860 (constant stimuli, both orders).
Study design_study(const StudyDesignOptions& options = {});

/// Seconds that a participant's session takes, by StudyExperiment::seconds.
double session_seconds(const Study& study, std::size_t participant);

/// Reads STUDY.json. @throws IoError, InvalidInput naming the file and the JSON pointer of the offending value.
Study read_study(const std::filesystem::path& path);

/// STUDY.json; read_study() gives the same value back.
std::string study_json(const Study& study);

}  // namespace papilla
