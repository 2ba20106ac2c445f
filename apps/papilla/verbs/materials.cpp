// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "exit_code.hpp"
#include "file_options.hpp"
#include "json/materials_json.hpp"
#include "option_checks.hpp"
#include "page/materials_page.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/base64.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/file_guard.hpp"
#include "papilla/core/progress.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/pipeline/material_library.hpp"
#include "papilla/pipeline/pictures/material_picture.hpp"
#include "shown_format.hpp"
#include "text/materials_text.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string what, library, picture, output;
  std::vector<std::string> words;
  int side_px = MaterialPictureOptions{}.side_px;

  fs::path folder() const { return library.empty() ? find_material_library() : fs::path(library); }
};

Json materials_json(const std::vector<LibraryMaterial>& materials, const fs::path& folder) {
  Json json{{"library", folder.string()}, {"materials", Json::array()}};
  for (const LibraryMaterial& material : materials) json["materials"].push_back(library_material_json(material));
  return json;
}

Json run_list(const Options& options, const VerbContext& context) {
  const MaterialLibrary library(options.folder());
  const std::vector<LibraryMaterial> materials = library.materials();
  context.console.print(library_table(materials));
  return materials_json(materials, library.folder());
}

Json run_show(const Options& options, const VerbContext& context) {
  if (options.words.size() != 1) throw UsageError("materials show needs the id of one material");
  const MaterialLibrary library(options.folder());
  const LibraryMaterial material = library.material(options.words.front());
  context.console.print(library_material_text(material));
  Json json = materials_json({material}, library.folder());
  if (!options.picture.empty()) {
    write_color_image(options.picture, material_picture(rule_of(material, material.id), {.side_px = options.side_px}));
    context.console.print(shown_format("{}: lit ball and relief\n", options.picture));
    json["picture"] = options.picture;
  }
  return json;
}

Json run_search(const Options& options, const VerbContext& context) {
  if (options.words.empty()) throw UsageError("materials search needs words");
  const MaterialLibrary library(options.folder());
  const std::vector<LibraryMaterial> all = library.materials();
  std::string words;
  for (const std::string& word : options.words) words += (words.empty() ? "" : " ") + word;
  const std::vector<MaterialHit> hits = search_materials(all, words);
  std::vector<LibraryMaterial> found;
  for (const MaterialHit& hit : hits) found.push_back(all[hit.material]);
  const bool is_near = !hits.empty() && hits.front().is_near;
  if (hits.empty()) context.console.print(shown_format("nothing is called '{}'\n", words));
  if (is_near) context.console.print(shown_format("nothing is called '{}'; near are\n", words));
  if (!hits.empty()) context.console.print(library_table(found));
  Json json = materials_json(found, library.folder());
  json["search"] = words;
  json["near"] = is_near;
  return json;
}

Json run_check(const Options& options, VerbContext& context) {
  LibraryCheck check;
  std::vector<fs::path> paths(options.words.begin(), options.words.end());
  if (paths.empty()) paths.push_back(options.folder());
  for (const fs::path& path : paths) {
    LibraryCheck one = check_materials(path);
    check.materials += one.materials;
    check.cited += one.cited;
    check.estimated += one.estimated;
    std::move(one.problems.begin(), one.problems.end(), std::back_inserter(check.problems));
  }
  context.console.print(library_check_text(check));
  Json json = library_check_json(check);
  if (!check.problems.empty()) {
    context.exit_code = k_exit_input;
    json["error"] = "a material of the library is wrong";
  }
  return json;
}

/// One file that holds the pictures, or a folder with the page and a picture a material.
Json run_page(const Options& options, const VerbContext& context) {
  if (options.output.empty()) throw UsageError("materials page needs -o: an .html file or a folder");
  const bool is_file = fs::path(options.output).extension() == ".html";
  const fs::path folder = is_file ? fs::path() : fs::path(options.output);
  const fs::path page = is_file ? fs::path(options.output) : folder / "index.html";
  if (!is_file) make_folder(folder);
  if (!is_file) declare_output(page, "--output");
  require_writable(page);
  const MaterialLibrary library(options.folder());
  const std::vector<LibraryMaterial> materials = library.materials();
  std::vector<MaterialsPageEntry> entries;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    report_progress(context.progress, "pictures", static_cast<double>(i) / static_cast<double>(materials.size()));
    const LibraryMaterial& material = materials[i];
    const ColorImage picture = material_picture(rule_of(material, material.id), {.side_px = options.side_px});
    std::string name = material.id + ".png";
    std::replace(name.begin(), name.end(), '/', '_');
    if (is_file) {
      const std::vector<std::byte> png = encode_png(picture);
      name = "data:image/png;base64," + encode_base64(png);
    } else {
      write_color_image(folder / name, picture);
    }
    entries.push_back({&material, std::move(name)});
  }
  write_atomically(page, materials_page(entries));
  context.console.print(shown_format("{}: {} materials\n", page.string(), materials.size()));
  return {{"page", page.string()}, {"materials", materials.size()}};
}

Json run(const Options& options, VerbContext& context) {
  if ((options.what == "list" || options.what == "page") && !options.words.empty())
    throw UsageError("materials " + options.what + " takes no '" + options.words.front() + "'");
  if (!options.picture.empty() && options.what != "show") throw UsageError("--picture is of materials show");
  if (!options.output.empty() && options.what != "page") throw UsageError("--output is of materials page");
  if (options.what == "list") return run_list(options, context);
  if (options.what == "show") return run_show(options, context);
  if (options.what == "search") return run_search(options, context);
  if (options.what == "check") return run_check(options, context);
  return run_page(options, context);
}

}  // namespace

void add_materials(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb =
      add_verb(program,
               {"materials", "Lists, shows, searches and checks the material library, and makes a page to browse it",
                "papilla materials search Leder fein; papilla materials show leather/nappa-fine --picture nappa.png"},
               [options](VerbContext& context) { return run(*options, context); });
  verb->add_option("what", options->what, "list, show, search, check or page")
      ->required()
      ->transform(one_of({"list", "show", "search", "check", "page"}));
  reads(
      verb->add_option("words", options->words,
                       "Show: an id. Search: words in English or German. Check: files or folders; default the library"))
      ->type_name("WORD");
  reads(verb->add_option("--library", options->library,
                         "Folder of the library; default $PAPILLA_MATERIAL_LIBRARY, or that of the program"))
      ->type_name("DIR");
  writes(verb->add_option("--picture", options->picture, "Show: picture of a lit ball and the relief"))
      ->type_name("FILE");
  writes_if_file(verb->add_option("-o,--output", options->output, "Page: an .html file with all in it, or a folder"))
      ->type_name("OUT");
  verb->add_option("--picture-px", options->side_px, "Side of each of the two pictures, 64 to 2048")
      ->type_name("N")
      ->check(in_range(64, 2048))
      ->capture_default_str();
}

}  // namespace papilla::app
