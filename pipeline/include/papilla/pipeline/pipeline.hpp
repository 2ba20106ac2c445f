// SPDX-License-Identifier: MIT
#pragma once

/// The whole way from a CAD file to a scene that can be seen and felt: scenes in, scenes out. Each stage is a function
/// of (input, options) whose result is a value; options have defaults that serve a 5 mm button and a 5 m car alike.
///
///   read_scene()          CAD, mesh or glTF file -> Scene                     io/scene_file.hpp
///   part_statistics()     what is wrong with the meshes                       part_statistics.hpp
///   repair_scene()        soup -> clean, oriented, manifold parts             repair_scene.hpp
///   turn_sheets()         open surfaces face those who see them               scene_sides.hpp
///   simplify_scene()      fewer triangles within a measured tolerance, LODs   simplify_scene.hpp
///   share_identical_parts() copies -> instances of one part                   shared_parts.hpp
///   measure_perception()  what can be reached and seen; leave_out()           perception.hpp
///   unwrap_scene()        charts and uv in millimetres                        unwrap_scene.hpp, unwrap_method.hpp
///   measure_scene()       distortion of any uv                                measure_scene.hpp
///   survey_picture()      class, symmetry and fractal dimension of a picture  texture_survey.hpp
///   height_of_picture_file() picture -> height map in millimetres             height_file.hpp
///   prepare_picture_file() even light, borders that match                     prepare_file.hpp
///   read_materials()      MATERIALS.json                                      materials.hpp
///   MaterialLibrary       materials of interiors by name                      material_library.hpp
///   fit_material()        a material from a recorded stroke                    fit_material.hpp, stroke_recording.hpp
///   suggest_materials()   of the library, for surfaces without one            material_suggestion.hpp
///   plan_bake()           which stages a scene needs, and why                 bake_plan.hpp, bake_stages.hpp
///   bake_scene()          grain and touch onto a scene                        bake_scene.hpp, grain.hpp
///   synthesize_texture()  fractal surfaces and grains by formula             synthesis.hpp
///   write_texture_files() a recipe's channels as pictures                    texture_files.hpp, contact_sheet.hpp
///   evaluate()            error against run time of a method                 evaluate/evaluation.hpp, stability.hpp
///   design_study(), analyse_study() experiments with people                   study/study.hpp,
///   study/study_analysis.hpp weather_scene()       dirt, rust, snow and wear over its materials weather_scene.hpp
///   write_scene()         Scene -> GLB, OBJ, PLY, STL, OFF                    io/scene_file.hpp
///
/// Units: millimetres, SI units in haptic tags. Errors: InvalidInput, IoError, SolverFailure, one line each that names
/// file, part and place; Cancelled when a ProgressCallback returns false. Determinism: same input and options, same
/// result, whatever the number of threads. Threads: parts run in parallel (TBB); limit them with
/// oneapi::tbb::global_control. No function prints, and none keeps state between calls.

#include "papilla/io/scene_file.hpp"
#include "papilla/pipeline/bake_file.hpp"
#include "papilla/pipeline/bake_scene.hpp"
#include "papilla/pipeline/fit_material.hpp"
#include "papilla/pipeline/height_file.hpp"
#include "papilla/pipeline/material_library.hpp"
#include "papilla/pipeline/material_suggestion.hpp"
#include "papilla/pipeline/measure_scene.hpp"
#include "papilla/pipeline/part_statistics.hpp"
#include "papilla/pipeline/perception.hpp"
#include "papilla/pipeline/prepare_file.hpp"
#include "papilla/pipeline/repair_scene.hpp"
#include "papilla/pipeline/scene_sides.hpp"
#include "papilla/pipeline/simplify_scene.hpp"
#include "papilla/pipeline/study/simulated_participant.hpp"
#include "papilla/pipeline/study/study.hpp"
#include "papilla/pipeline/study/study_analysis.hpp"
#include "papilla/pipeline/study/study_answers.hpp"
#include "papilla/pipeline/study/study_stimuli.hpp"
#include "papilla/pipeline/synthesis.hpp"
#include "papilla/pipeline/texture_files.hpp"
#include "papilla/pipeline/texture_survey.hpp"
#include "papilla/pipeline/unwrap_scene.hpp"
#include "papilla/pipeline/weather_scene.hpp"
