// SPDX-License-Identifier: MIT
#include "papilla/procedural/library.hpp"

#include <algorithm>
#include <string_view>

#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/core/referenced_file.hpp"
#include "papilla/procedural/reference.hpp"
#include "syntax.hpp"

namespace papilla {
namespace {

/// The library file that comes with the program. Heights are shares of a relief's depth, friction is a coefficient,
/// stiffness a factor. An ageing recipe is a layer: it covers nothing at time 0 and takes full effect at time 1.
constexpr std::string_view k_builtin_recipes = R"(
# --- colours ---
colour fire = black, red, yellow, white, white
colour oak = <.36,.22,.11>, <.62,.43,.24>, <.74,.56,.35>
colour rust = <.20,.08,.03>, <.42,.17,.06>, <.62,.29,.10>, <.35,.13,.05>
colour mossy = <.10,.16,.04>, <.22,.32,.08>, <.36,.45,.14>

# --- materials ---
leather        voronoi|scale=.25|rooted=true|func=clampunit((f2-f1)*2.2)|smooth=.25|cols=<.05,.04,.04>,<.16,.13,.12>,<.22,.18,.17>
               |bumpfunction=bias(.65,main)+.06*turbulence2d(x*14,y*14,3)|frictionfunction=.45-.1*main|idmaterial=leather|idtype=interior
plastic_grain  fbm|scale=.2|h=.6|octaves=4|cols=<.07,.07,.08>,<.15,.15,.16>|frictionfunction=.35|idmaterial=plastic|idtype=interior
soft_touch     noise|scale=.08|cols=<.10,.10,.11>,<.14,.14,.15>|specularfunction=.05|frictionfunction=.6|stiffnessfunction=.6|dampingfunction=1.8|idmaterial=rubber|idtype=interior
oak            wood|rings=9|cols=oak|bumpfunction=main*.7+.15*turbulence2d(x*4,y*90,3)|frictionfunction=.4|idmaterial=wood|idtype=interior
walnut         wood|rings=7|seed=5|cols=<.12,.07,.04>,<.30,.19,.11>|bumpfunction=main*.5|frictionfunction=.3|idmaterial=wood|idtype=interior
brushed_metal  smear|scale=.25|density=.5|randomness=.3|turbulence=.05|cols=<.48,.49,.50>,<.72,.73,.74>|bumpfunction=main*.2
               |reflectionfunction=1|specularfunction=.8|specularcoefffunction=60|frictionfunction=.2|idmaterial=metal|idtype=interior
painted_metal  noise|scale=.04|cols=<.10,.16,.28>,<.12,.18,.31>|bumpfunction=main*.04|specularfunction=.7|specularcoefffunction=80
               |frictionfunction=.25|idmaterial=paint|idtype=interior
fabric         weave|scale=.125|roundthreads=true|xgap=2|ygap=2|cols=<.05,.05,.07>,<.22,.23,.28>|specularfunction=.03|frictionfunction=.55|stiffnessfunction=.5|dampingfunction=1.5|idmaterial=textile|idtype=interior
perforated     circle|scale=.1|seamless=true|invert=true|r=.22|cols=<.03,.03,.03>,<.17,.15,.14>|frictionfunction=.42|idmaterial=leather|idtype=interior
plaster        fbm|scale=.35|h=.35|octaves=6|cols=<.72,.70,.65>,<.88,.87,.83>|bumpfunction=main*.6|frictionfunction=.7|idmaterial=plaster|idtype=building
stone          fbm|type=ridgedmultifractal|scale=.6|h=.5|octaves=6|cols=<.30,.29,.27>,<.62,.60,.56>|frictionfunction=.65|idmaterial=stone|idtype=building
brick_wall     brick|mortarthickness=.03|switching=true|round=.25|mortarthicknessrand=.5
               |colorfunction=colmix(<.62,.60,.56>,colmix(<.48,.17,.11>,<.62,.28,.17>,id),main)
               |bumpfunction=main*.8+.15*turbulence2d(x*20,y*20,4)|frictionfunction=.7|idmaterial=brick|idtype=building
marble_tile    marble|turbulence=.6|octaves=5|cols=<.93,.92,.90>,<.80,.79,.78>,<.45,.46,.48>|bumpfunction=.02*main|specularfunction=.8|specularcoefffunction=120|frictionfunction=.2|idmaterial=stone|idtype=building

# --- ageing ---
greying        fbm|ismodifier=true|idtype=ageing|idmaterial=wood|scale=.8|octaves=5
               |colorfunction=hsv(hue,saturation*.25,clampunit(value*.9+.07))|coloralphafunction=1|alphafunction=time*(.6+.5*main)
               |bumpblend=off|bumpfunction=0|specularfunction=.05|frictionfunction=lowerfriction*1.15
dirt           fbm|ismodifier=true|idtype=ageing|idmaterial=plaster|scale=.7|octaves=6|h=.4|cols=<.13,.10,.07>,<.24,.19,.13>
               |alphafunction=smoothstep(.95-.75*time,1.3-.75*time,main+.5*(1-lowerbump))*min(time*8,1)*.9
               |bumpblend=add|bumpfunction=.12*main|specularfunction=.05|frictionfunction=.55
smears         smear|ismodifier=true|idtype=ageing|idmaterial=plaster|scale=.8|density=.35|turbulence=.1|cols=<.36,.30,.21>,<.24,.19,.12>
               |alphafunction=smoothstep(.1,.9,main)*time*.9|bumpblend=add|bumpfunction=.03*main|frictionfunction=lowerfriction*.8
               |roughnessfunction=.5+.3*lowerroughness
flow_stains    fbm|ismodifier=true|idtype=ageing|idmaterial=plaster|scale=<.08,.6>|octaves=5|h=.5|cols=<.15,.12,.09>,<.30,.25,.18>
               |alphafunction=smoothstep(.05,1,flow*time*(.4+1.2*main))*.9
               |bumpblend=add|bumpfunction=.03*main|specularfunction=.05|frictionfunction=lowerfriction*1.1
scratch_set    base|mainfunction=smoothstep(.42,.6,noise2d(x*1.5,y*70))*step(noise2d(x*2+7,y*5),.12)
scratches      base|ismodifier=true|idtype=ageing|idmaterial=paint
               |mainfunction=max(max([scratch_set|rot=.4],[scratch_set|rot=1.1|seed=3|du=.3]),max([scratch_set|rot=2.2|dv=.7],[scratch_set|rot=2.9|du=.6]))
               |colorfunction=colscale(currentcolor,1.5)|alphafunction=clampunit(main*time*1.5)
               |bumpblend=sub|bumpfunction=.35*main|frictionfunction=lowerfriction*1.3
               |reflectionfunction=lowerreflection|roughnessfunction=max(lowerroughness,.55)
chipped_paint  fbm|ismodifier=true|idtype=ageing|idmaterial=paint|scale=.5|octaves=6|h=.5|cols=<.40,.40,.41>,<.55,.55,.56>
               |alphafunction=smoothstep(.98-.55*time,1-.55*time,main)*min(time*20,1)|bumpblend=sub|bumpfunction=.4*(.8+.2*main)|frictionfunction=.5|stiffnessfunction=1.1
               |reflectionfunction=1|specularfunction=.6|specularcoefffunction=40
rust_base      fbm|scale=.45|octaves=7|h=.35|cols=rust
rust_in        rust_base|ismodifier=true|idtype=ageing|idmaterial=paint
               |alphafunction=smoothstep(1-.8*time,1.15-.8*time,main+.2*noise2d(x*30,y*30))*min(time*10,1)
               |bumpblend=sub|bumpfunction=.5*main+.2*absturbulence2d(x*12,y*12,4)|frictionfunction=.75|specularfunction=.05
rust_on        rust_base|ismodifier=true|idtype=ageing|idmaterial=paint|seed=4
               |alphafunction=smoothstep(1-.8*time,1.1-.8*time,main+.2*noise2d(x*30,y*30))*min(time*10,1)
               |bumpblend=add|bumpfunction=.35*main+.25*absturbulence2d(x*14,y*14,4)|frictionfunction=.8|specularfunction=.05
erosion        fbm|ismodifier=true|idtype=ageing|idmaterial=brick|scale=.6|octaves=7|h=.4|type=hybridmultifractal
               |alphafunction=time*(1-.8*smoothstep(.35,.7,main))|colorfunction=colscale(currentcolor,.7+.2*main)
               |bumpblend=sub|bumpfunction=.9*(1-smoothstep(.3,.7,main))+.3*absturbulence2d(x*24,y*24,4)|frictionfunction=lowerfriction*1.3|stiffnessfunction=lowerstiffness*.9
               |specularfunction=.05
moss           fbm|ismodifier=true|idtype=ageing|idmaterial=brick|scale=.3|octaves=7|h=.5|cols=mossy
               |alphafunction=smoothstep(1.35-time*.9,1.55-time*.9,main+.6*(1-lowerbump))*min(time*10,1)
               |bumpblend=add|bumpfunction=.3+.4*main|specularfunction=.05|frictionfunction=.6|stiffnessfunction=.3|dampingfunction=2
wetness        fbm|ismodifier=true|idtype=ageing|idmaterial=plaster|scale=.9|octaves=4|h=.8
               |alphafunction=smoothstep(1-time,1.25-time,main+.35*(1-lowerbump))*min(time*10,1)*.85
               |colorfunction=colscale(currentcolor,.6)|specularfunction=.9|specularcoefffunction=120|reflectionfunction=lowerreflection
               |bumpblend=interpolate|bumpfunction=max(lowerbump,.35*time)|frictionfunction=lowerfriction*.45
snow           fbm|ismodifier=true|idtype=ageing|idmaterial=brick|scale=.5|octaves=5|h=.7|cols=<.88,.91,.96>,white
               |alphafunction=smoothstep(.9-time,1.1-time,main)*clampunit(normaldot*4-.6)*sky*min(time*10,1)
               |normal=<0,1,0>|bumpblend=interpolate|bumpfunction=.7+.3*main|specularfunction=.1|frictionfunction=.1|stiffnessfunction=.2|dampingfunction=2
dust           noise|ismodifier=true|idtype=ageing|idmaterial=plastic|scale=.05|cols=<.55,.52,.47>,<.66,.63,.58>
               |alphafunction=time*(.35+.35*main)*clampunit(.4+.6*normaldot)*(1.1-.6*clampunit(lowerbump))
               |bumpblend=add|bumpfunction=.03*main|specularfunction=.03|frictionfunction=lowerfriction*.75
grime          fbm|ismodifier=true|idtype=ageing|idmaterial=leather|scale=.6|octaves=5|h=.5|cols=<.30,.26,.19>,<.44,.38,.28>
               |afunction=(nearmean(lowerbump,.08)-lowerbump)/(neardeviation(lowerbump,.2)+.05)
               |alphafunction=smoothstep(.9-time,1.5-time,a+.4*main)*min(time*8,1)*.95
               |bumpblend=interpolate|bumpfunction=lowerbump+.5*max(nearmean(lowerbump,.04)-lowerbump,0)|specularfunction=.05|frictionfunction=.6
edge_wear      fbm|ismodifier=true|idtype=ageing|idmaterial=leather|scale=.5|octaves=4|h=.5|cols=<.40,.37,.33>,<.55,.52,.47>
               |afunction=(lowerbump-nearmean(lowerbump,.08))/(neardeviation(lowerbump,.2)+.05)
               |alphafunction=smoothstep(1.2-time,1.9-time,a+.5*main)*min(time*8,1)
               |bumpblend=interpolate|bumpfunction=min(lowerbump,nearmean(lowerbump,.04))|frictionfunction=lowerfriction*.7
               |reflectionfunction=lowerreflection|roughnessfunction=.7*lowerroughness
polish         fbm|ismodifier=true|idtype=ageing|idmaterial=leather|scale=1.2|octaves=3|h=.8
               |alphafunction=time*smoothstep(.35,.75,lowerbump)*clampunit(.4+main)
               |colorfunction=colscale(currentcolor,1.12)|specularfunction=.9|specularcoefffunction=90|reflectionfunction=lowerreflection
               |bumpblend=interpolate|bumpfunction=min(lowerbump,.6-.15*time)|frictionfunction=lowerfriction*.55

# --- materials with their ageing ---
worn_leather   multi|textures=leather,polish,scratches,dirt|idmaterial=leather|idtype=aged
worn_wheel     multi|textures=perforated,polish,greying,dirt|idmaterial=leather|idtype=aged
rusty_paint    multi|textures=painted_metal,chipped_paint,rust_on,scratches|idmaterial=paint|idtype=aged
mossy_wall     multi|textures=brick_wall,erosion,dirt,moss|idmaterial=brick|idtype=aged
)";

using namespace procedural_detail;

constexpr std::uintmax_t k_most_file = std::uintmax_t{16} << 20;
constexpr std::size_t k_most_open = 32;

/// Entries of a file: continued lines joined, comments left out.
struct Entry {
  std::size_t line;
  std::string text;
};

std::vector<Entry> entries_of(std::string_view text) {
  std::vector<Entry> entries;
  std::size_t line_number = 0;
  while (!text.empty()) {
    ++line_number;
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(text.size(), end + 1));
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    const Piece content = trimmed({line, 0});
    if (content.text.empty() || content.text.front() == '#') continue;
    if (content.position > 0 && !entries.empty())
      entries.back().text += content.text;
    else
      entries.push_back({line_number, std::string(content.text)});
  }
  return entries;
}

std::string lower_case(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return out;
}

/// The runs of letters of a name.
std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words(1);
  for (const char c : lower_case(text)) {
    if (c >= 'a' && c <= 'z')
      words.back() += c;
    else if (!words.back().empty())
      words.emplace_back();
  }
  std::erase(words, "");
  return words;
}

}  // namespace

RecipeLibrary RecipeLibrary::builtin() {
  RecipeLibrary library;
  library.read_text(k_builtin_recipes, "built-in recipes", {});
  return library;
}

void RecipeLibrary::add(const std::string& name, const std::string& recipe) {
  if (!is_name(name))
    throw InvalidInput("recipe library: " + in_quotes(name) +
                       " is no name; names hold letters, digits, _ and . and begin with a letter");
  const FunctionInfo* function = find_function(name);
  if (find_type(name) || (function && function->arity == 0))
    throw InvalidInput("recipe library: the name " + in_quotes(name) + " is taken by the language");
  recipes_.insert_or_assign(name, recipe);
}

void RecipeLibrary::add_colours(const std::string& name, const std::string& colours) {
  if (!is_name(name)) throw InvalidInput("recipe library: " + in_quotes(name) + " is no name");
  colours_.insert_or_assign(name, colours);
}

const std::string* RecipeLibrary::find(std::string_view name) const {
  const auto it = recipes_.find(name);
  return it == recipes_.end() ? nullptr : &it->second;
}

const std::string* RecipeLibrary::find_colours(std::string_view name) const {
  const auto it = colours_.find(name);
  return it == colours_.end() ? nullptr : &it->second;
}

void RecipeLibrary::read_file(const std::filesystem::path& path) { read_file(path, Quotes::yes); }

void RecipeLibrary::read_file(const std::filesystem::path& path, Quotes quotes) {
  std::error_code error;
  files_.push_back(path);
  require_file(path);
  if (const auto size = std::filesystem::file_size(path, error); error || size > k_most_file)
    throw InvalidInput(path.string() + ": a library of recipes has at most 16 MiB");
  const auto whole = std::filesystem::weakly_canonical(path, error);
  if (std::find(open_files_.begin(), open_files_.end(), whole) != open_files_.end())
    throw InvalidInput(path.string() + ": is included by itself");
  if (open_files_.size() >= k_most_open) throw InvalidInput(path.string() + ": more than 32 files include each other");
  const std::string text = papilla::read_file(path);
  open_files_.push_back(whole);
  try {
    read_text(text, path.string(), path.parent_path(), quotes);
  } catch (...) {
    open_files_.pop_back();
    throw;
  }
  open_files_.pop_back();
}

void RecipeLibrary::include(const std::string& name, const std::string& place, const std::filesystem::path& folder) {
  const auto file = resolve_reference({folder, place, name});
  if (!file) {
    files_.push_back(folder / name);
    throw IoError(place + ": '" + shown(name) + "' does not exist");
  }
  read_file(*file, Quotes::no);
}

void RecipeLibrary::read_text(std::string_view text, const std::string& source, const std::filesystem::path& folder) {
  read_text(text, source, folder, Quotes::yes);
}

void RecipeLibrary::read_text(std::string_view text, const std::string& source, const std::filesystem::path& folder,
                              Quotes quotes) {
  for (const Entry& entry : entries_of(text)) {
    const std::string place = source + ": line " + std::to_string(entry.line);
    const std::size_t blank = entry.text.find_first_of(" \t");
    if (blank == std::string::npos)
      throw InvalidInput(place + ": expected a name, a blank and a recipe" +
                         (quotes == Quotes::yes ? ", found " + in_quotes(entry.text) : ""));
    const std::string name = entry.text.substr(0, blank),
                      rest(trimmed({std::string_view(entry.text).substr(blank), 0}).text);
    if (name == "include") {
      include(rest, place, folder);
    } else if (name == "colour" || name == "color") {
      const std::size_t equals = rest.find('=');
      const std::string colour(trimmed({std::string_view(rest).substr(0, equals), 0}).text);
      if (equals == std::string::npos || !is_name(colour))
        throw InvalidInput(place + ": expected colour NAME = COLOURS");
      add_colours(colour, std::string(trimmed({std::string_view(rest).substr(equals + 1), 0}).text));
    } else {
      try {
        add(name, rest);
      } catch (const InvalidInput& refusal) {
        throw InvalidInput(place + ": " + (quotes == Quotes::yes ? refusal.what() : "expected a name and a recipe"));
      }
    }
  }
}

std::vector<std::string> suggest_recipes(std::string_view material, const RecipeLibrary& library) {
  const std::vector<std::string> wanted = words_of(material);
  std::vector<std::pair<int, std::string>> ranked;
  for (const auto& [name, recipe] : library.recipes()) {
    std::string known = name;
    for (const std::string_view key : {"idmaterial=", "matid=", "idtype="})
      if (const std::size_t at = recipe.find(key); at != std::string::npos)
        known += ' ' + recipe.substr(at + key.size(), recipe.find('|', at) - at - key.size());
    int score = 0;
    for (const std::string& word : words_of(known))
      score += static_cast<int>(std::count(wanted.begin(), wanted.end(), word));
    if (score > 0) ranked.emplace_back(-score, name);
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<std::string> names;
  for (auto& [score, name] : ranked) names.push_back(std::move(name));
  return names;
}

}  // namespace papilla
