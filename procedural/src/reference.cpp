// SPDX-License-Identifier: MIT
#include "papilla/procedural/reference.hpp"

#include <algorithm>
#include <array>

namespace papilla {
namespace {

using enum ParameterKind;
constexpr double k_open = 1e300;

constexpr ParameterInfo number_in(std::string_view name, double low, double high, std::string_view preset,
                                  std::string_view note) {
  return {name, number, low, high, preset, note};
}
constexpr ParameterInfo any_number(std::string_view name, std::string_view preset, std::string_view note) {
  return {name, number, -k_open, k_open, preset, note};
}
constexpr ParameterInfo integer_in(std::string_view name, double low, double high, std::string_view preset,
                                   std::string_view note) {
  return {name, integer, low, high, preset, note};
}
constexpr ParameterInfo flag_of(std::string_view name, std::string_view preset, std::string_view note) {
  return {name, flag, 0, 1, preset, note};
}
constexpr ParameterInfo formula(std::string_view name, std::string_view preset, std::string_view note) {
  return {name, expression, 0, 0, preset, note};
}
constexpr ParameterInfo words(std::string_view name, std::string_view preset, std::string_view note) {
  return {name, text, 0, 0, preset, note};
}
constexpr ParameterInfo one_of(std::string_view name, std::string_view preset, std::string_view choices) {
  return {name, choice, 0, 0, preset, choices};
}

constexpr ParameterInfo k_block[] = {integer_in("subx", 1, 256, "3", "blocks in a row"),
                                     integer_in("suby", 1, 256, "4", "rows"),
                                     integer_in("subx2", 1, 256, "2", "parts of every other block, across"),
                                     integer_in("suby2", 1, 256, "1", "parts of every other block, down")};
constexpr ParameterInfo k_brick[] = {
    number_in("mortarthickness", 0, 1, "0.05", "width of the joint, as a share of the picture / 2"),
    number_in("brickwidth", 0.01, 0.5, "0.25", "width of a brick and its joint"),
    number_in("brickheight", 0.005, 1, "0.10", "height of a brick and its joint"),
    flag_of("returnid", "false", "give every brick a random value in place of its profile"),
    flag_of("tiling", "false", "take rows and columns in place of brickwidth and brickheight"),
    integer_in("rows", 1, 20, "1", "rows when tiling"),
    integer_in("columns", 1, 20, "1", "columns when tiling"),
    flag_of("offsetrand", "false", "shift every row by a random share"),
    flag_of("switching", "false", "shift every other row by half a brick"),
    number_in("round", 0, 4, "0.00", "rounding of the bricks; 1 is a smooth cushion"),
    number_in("mortarthicknessrand", 0, 4, "0.00", "variation of the joint by turbulence"),
    number_in("mortarthicknessrandscale", 1e-3, 1e3, "1.00", "scale of that variation"),
    flag_of("circle", "false", "a round dent in every brick")};
constexpr ParameterInfo k_funky[] = {
    flag_of("shadethem", "false", "kept for old recipes; without effect"),
    flag_of("shadethempoint", "false", "kept for old recipes; without effect"),
    words("types", "multi", "types of the named recipes that are shown, separated by commas; empty: all"),
    words("idfilter", "", "a part of the recipe's name"),
    words("filter", "", "a part of the recipe's text"),
    flag_of("onlytimedependant", "false", "only recipes that use time"),
    flag_of("onlynormaldependant", "false", "only recipes that use normaldot")};
constexpr ParameterInfo k_circle[] = {number_in("r", 0, 1e3, "0.20", "radius")};
constexpr ParameterInfo k_fbm[] = {
    number_in("h", 0, 4, "0.20", "Hurst exponent H; the dimension of type=fbm is 3 - H for H in [0.05, 0.95]"),
    number_in("lacunarity", 0.2, 4, "2.00", "ratio of the frequencies of neighbouring octaves"),
    number_in("octaves", 1, 19, "7.00", "most octaves; a fraction weighs the last one"),
    number_in("gain", -k_open, k_open, "0.67", "feedback of the ridged kind; contrast of the others"),
    any_number("zvalue", "0.00", "third coordinate of the noise; moving it lets hills become valleys"),
    one_of("type", "fbm", "fbm heteroterrain multifractal hybridmultifractal ridgedmultifractal"),
    any_number("offset", "1.10", "added to the noise by the multifractal kinds"),
    words("weights", "", "weight of every octave, separated by spaces; replaces the power law"),
    flag_of("closed", "true",
            "let the first and last octave stand for those that are cut off, so that H holds over all lags")};
constexpr ParameterInfo k_flame[] = {
    number_in("flameh", 1e-3, 1e3, "0.80", "height"), number_in("flamew", 1e-3, 1e3, "0.40", "width"),
    any_number("timing", "0.00", "moves the flame upwards"), any_number("turb", "1.00", "strength of the turbulence")};
constexpr ParameterInfo k_ifs[] = {
    integer_in("kilon", 1, 500, "200", "thousands of points for 256 x 256 cells"),
    integer_in("style", 0, 9, "4",
               "system: 0 fern, 1 Sierpinski, 2 dragon, 3 maple, 4 tree, 5 spiral, 6 carpet, 7 crystal; 8 and 9 repeat "
               "0 and 1"),
    flag_of("usestyle", "true", "take the system `style`; else one, two, three, four"),
    number_in("scalefak", 1e-3, 1e3, "1.00", "size of the picture"),
    formula("ipolfunc", "", "share of the second system, 0 to 1; may use time"),
    integer_in("ipolfuncindex", 0, 9, "1", "the second system"),
    words("one", "", "first map: a b c d e f p"),
    words("two", "", "second map"),
    words("three", "", "third map"),
    words("four", "", "fourth map"),
    words("posandscale", "", "x0 y0 width height of the part that is shown; empty: all")};
constexpr ParameterInfo k_image[] = {
    integer_in("ipol", 0, 2, "1", "interpolation: 0 nearest, 1 linear, 2 cubic"),
    words("picpath", "", "file of the picture"),
    integer_in("width", 16, 512, "32", "columns of the rendered basetexture"),
    integer_in("height", 16, 512, "32", "rows of the rendered basetexture"),
    {"basetexture", textures, 0, 0, "", "recipe that is rendered once in place of a file"},
    flag_of("calcheight", "true", "the value is the picture's grey"),
    flag_of("fit2screen", "true", "render basetexture at the size of the target"),
    number_in("fit2screenratio", 0.01, 2, "1.00", "share of that size"),
    integer_in("blur", 0, 10, "0", "passes of a 3 x 3 box"),
    flag_of("repeat", "true", "tile the picture; else hold its border")};
constexpr ParameterInfo k_led[] = {number_in("digwidth", 1e-3, 1e3, "0.14", "width of a digit"),
                                   number_in("digheight", 1e-3, 1e3, "0.35", "height of a digit"),
                                   number_in("digspacing", 0, 1e3, "0.20", "distance of digits"),
                                   integer_in("numdecimals", 0, 9, "2.00", "digits behind the point"),
                                   integer_in("exponent", -9, 9, "0.00", "power of ten that multiplies the number"),
                                   integer_in("numdigits", 1, 16, "5", "digits"),
                                   formula("displaynumber", "globaltime", "the number, for instance time*100")};
constexpr ParameterInfo k_mandelbrot[] = {
    integer_in("max", 1, 10000, "20", "most iterations"),
    number_in("zoom", 1e-14, 1e14, "1.00", "magnification"),
    number_in("xp", -2, 2, "0.00", "real part of the centre"),
    number_in("yp", -2, 2, "0.00", "imaginary part of the centre"),
    number_in("boundary", 0, 1e6, "4.00", "squared modulus beyond which a point has escaped"),
    flag_of("julia", "false", "the Julia set of rr + ii i"),
    number_in("power", 0, 64, "2.00", "exponent of the iteration"),
    flag_of("forceintegerpow", "false", "round the exponent"),
    any_number("rr", "0.35", "real part of c"),
    any_number("ii", "0.29", "imaginary part of c"),
    integer_in("paintmode", 0, 3, "0", "0 steps, 1 smooth steps, 2 last modulus, 3 angle of the last point")};
constexpr ParameterInfo k_marble[] = {number_in("turbulence", 0, 2, "0.50", "strength of the veins' bending"),
                                      integer_in("octaves", 1, 15, "1", "octaves of it"),
                                      flag_of("absturb", "true", "bend with absolute turbulence")};
constexpr ParameterInfo k_multi[] = {number_in("bumpscale", -3, 3, "1.00", "multiplies the height"),
                                     number_in("alphascale", 0, 3, "1.00", "multiplies alpha"),
                                     number_in("diffusescale", 0, 3, "1.00", "multiplies diffuse"),
                                     number_in("specularscale", 0, 3, "1.00", "multiplies specular"),
                                     number_in("specularcoeffscale", 0, 3, "1.00", "multiplies the specular exponent"),
                                     number_in("frictionscale", 0, 3, "1.00", "multiplies friction"),
                                     number_in("stiffnessscale", 0, 3, "1.00", "multiplies stiffness")};
constexpr ParameterInfo k_sd[] = {one_of("sdkey", "hmbump", "hmbump hmcolor main")};
constexpr ParameterInfo k_smear[] = {number_in("density", 0, 1, "0.50", "share that is covered"),
                                     any_number("turbulence", "0.00", "bending of the smears"),
                                     any_number("randomness", "0.50", "unevenness along a smear")};
constexpr ParameterInfo k_sparkle[] = {any_number("centrex", "0.50", "centre"),
                                       any_number("centrey", "0.50", "centre"),
                                       number_in("radius", 1e-6, 1e3, "0.25", "radius of the glow"),
                                       any_number("amount", "0.00", "weight of the rays, percent"),
                                       number_in("randomness", 0, 10, "0.25", "unevenness of the rays"),
                                       integer_in("rays", 1, 1000, "32", "rays"),
                                       integer_in("seed", 0, 1e9, "50", "another choice of the rays"),
                                       flag_of("usetables", "true", "kept for old recipes; without effect"),
                                       flag_of("timer", "true", "turn with time")};
constexpr ParameterInfo k_star[] = {any_number("noise", "0.00", "distortion by noise"),
                                    any_number("turb", "0.00", "distortion by turbulence"),
                                    number_in("ninja", -10, 10, "0.00", "bends the edges to a throwing star"),
                                    number_in("roundjag", 0, 10, "0.00", "exponent that rounds the points; 0: none"),
                                    flag_of("repeat", "true", "tile the star"),
                                    integer_in("jags", 1, 1000, "10", "points"),
                                    flag_of("round", "false", "the same as roundjag=2"),
                                    number_in("rmin", 0, 1e3, "0.66", "inner radius"),
                                    number_in("rmax", 0, 1e3, "0.48", "outer radius"),
                                    number_in("starscale", 1e-6, 1e3, "1.00", "size")};
constexpr ParameterInfo k_tmp[] = {number_in("radius", 1e-6, 1e3, "0.20", "radius of the ball"),
                                   any_number("radiusintensity", "1.00", "brightness of the ball"),
                                   any_number("timing", "0.00", "grows the ball"),
                                   any_number("turbintensity", "1.00", "strength of the turbulence"),
                                   any_number("turbscale", "2.00", "frequency of the turbulence"),
                                   number_in("turbfreq", 1, 19, "7.00", "octaves"),
                                   any_number("turbz", "0.00", "third coordinate of the turbulence")};
constexpr ParameterInfo k_turbulence[] = {number_in("octaves", 1, 19, "5.00", "octaves"),
                                          any_number("zvalue", "0.00", "third coordinate of the noise"),
                                          flag_of("absturb", "false", "sum absolute values")};
constexpr ParameterInfo k_txt[] = {words("txt", "moin", "what is written; \\n starts a line"),
                                   words("txtstyle", "SansSerif", "kept for old recipes: one built-in raster face"),
                                   integer_in("modifier", 0, 3, "1", "0 plain, 1 bold, 2 slanted, 3 both"),
                                   number_in("spacingy", 0.1, 10, "1.00", "distance of lines"),
                                   number_in("borderx", 0, 0.49, "0.00", "free share at the left and right"),
                                   number_in("bordery", 0, 0.49, "0.00", "free share at top and bottom"),
                                   flag_of("centerx", "true", "centre the lines"),
                                   {"texture", textures, 0, 0, "", "recipe that fills the letters"}};
constexpr ParameterInfo k_voronoi[] = {
    integer_in("distmode", 0, 2, "0", "0 squared, 1 Manhattan, 2 Minkowski |dx|^A + |dy|^B"),
    number_in("distmodea", 0, 5, "1.00", "A"),
    number_in("distmodeb", 0, 5, "1.00", "B"),
    flag_of("inversedistance", "false", "1 / (1 + distance)"),
    flag_of("rooted", "false", "square root of the distance"),
    formula("densityfunc", "max(orig*.1,1)+index*0",
            "points of a cell; orig is Worley's number (mean 4), index its place in the table"),
    integer_in("displacemode", 0, 6, "0",
               "shift of every cell: 0 none, 1 odd rows, 2 odd columns, 3 both, 4 chequers x, 5 chequers y, 6 random"),
    any_number("displace", "0.20", "strength of that shift in cells"),
    flag_of("random", "false", "a random linear combination of f1 to f4"),
    words("weights", "", "weight of every octave"),
    integer_in("octaves", 1, 5, "1", "octaves"),
    number_in("lacunarity", 1, 10, "2.00", "ratio of their frequencies"),
    formula("func", "f1", "of f1, f2, f3, f4"),
    number_in("smooth", 0, 1, "0.00", "pulls the points to the middle of their cells"),
    integer_in("cell_initmode", 0, 4, "0",
               "sponge: distances of the next octave start at 1 d^p, 2 d p, 3 d + p, 4 p; 0 infinity"),
    any_number("initpower", "0.50", "p of the sponge")};
constexpr ParameterInfo k_voronoi_seamless[] = {
    integer_in("points", 3, 200, "10", "points"),
    integer_in("smoothiterations", 0, 200, "0", "steps of mutual repulsion"),
    integer_in("distmode", 0, 2, "0", "as of voronoi"),
    number_in("distmodea", 0, 5, "1.00", "A"),
    number_in("distmodeb", 0, 5, "1.00", "B"),
    flag_of("inversedistance", "false", "1 / (1 + distance)"),
    flag_of("rooted", "false", "square root of the distance"),
    formula("func", "f1", "of f1, f2, f3, f4")};
constexpr ParameterInfo k_weave[] = {number_in("xwidth", 0.01, 1e3, "16.00", "width of the threads that run down"),
                                     number_in("ywidth", 0.01, 1e3, "16.00", "width of the threads that run across"),
                                     number_in("xgap", 0, 1e3, "6.00", "gap between them"),
                                     number_in("ygap", 0, 1e3, "6.00", "gap between them"),
                                     integer_in("rows", 1, 4, "4", "rows of the matrix"),
                                     integer_in("columns", 1, 4, "4", "columns of the matrix"),
                                     flag_of("roundthreads", "false", "round profile"),
                                     flag_of("shadecrossings", "true", "threads dive at crossings"),
                                     words("matrix", "0101101001011010", "1: the thread that runs across lies on top")};
constexpr ParameterInfo k_wood[] = {number_in("intensity2", 0, 2, "0.30", "strength of the fibres"),
                                    flag_of("makerings", "false", "rings of a cross-cut"),
                                    integer_in("rings", 1, 100, "15", "rings")};
constexpr ParameterInfo k_xplo[] = {number_in("radius", 1e-6, 1e3, "0.20", "radius"),
                                    any_number("attract", "1.00", "pull to the centre"),
                                    any_number("turbintensity", "1.00", "strength of the turbulence"),
                                    any_number("turbscale", "2.00", "its frequency"),
                                    any_number("turbz", "0.00", "its third coordinate"),
                                    any_number("turbadd", "0.00", "added to it"),
                                    flag_of("absturb", "false", "absolute values")};

constexpr TypeInfo k_types[] = {
    {"base", "nothing of its own; its mainfunction says it all (this = 0)", Seamless::four_corner, {}},
    {"block", "rectangles that are divided again", Seamless::tile, k_block},
    {"brick", "bricks and joints; get(0), get(1) number the brick", Seamless::tile, k_brick},
    {"brickfunky", "bricks that show the named recipes", Seamless::tile, k_funky},
    {"checker", "chequers", Seamless::tile, {}},
    {"checker3d", "chequers in space over x, y and zvalue, or over the position in the scene", Seamless::tile, {}},
    {"circle", "a disc", Seamless::tile, k_circle},
    {"col", "plain: 1 everywhere; colorfunction gives the colour", Seamless::tile, {}},
    {"earthstar", "a star that grows out of a fractal terrain", Seamless::four_corner, {}},
    {"fbm", "fractional Brownian motion and its multifractal kin", Seamless::lattice, k_fbm},
    {"flame", "a flame", Seamless::four_corner, k_flame},
    {"ifs", "iterated function systems", Seamless::four_corner, k_ifs},
    {"image", "a picture, or a recipe that is rendered once", Seamless::tile, k_image},
    {"led", "a number in seven segments", Seamless::four_corner, k_led},
    {"mandelbrot", "Mandelbrot and Julia sets", Seamless::four_corner, k_mandelbrot},
    {"marble", "marble", Seamless::four_corner, k_marble},
    {"multi", "layers, each blended over what lies below", Seamless::tile, k_multi},
    {"noise", "gradient noise", Seamless::lattice, {}},
    {"sd", "what the layers below have: height, grey or value", Seamless::tile, k_sd},
    {"smear", "smears that run across", Seamless::four_corner, k_smear},
    {"sparkle", "a glow with rays", Seamless::four_corner, k_sparkle},
    {"star", "a star", Seamless::tile, k_star},
    {"texture", "the same as base", Seamless::four_corner, {}},
    {"tmp", "a burning ball", Seamless::four_corner, k_tmp},
    {"turbulence", "noise summed over octaves of half the size and half the weight", Seamless::lattice, k_turbulence},
    {"txt", "text", Seamless::tile, k_txt},
    {"voronoi", "cellular texture; get(6 i + 0..5) of the i-th next point: x, y, dx, dy, distance, id",
     Seamless::lattice, k_voronoi},
    {"voronoifunky", "cells that show the named recipes", Seamless::tile, k_funky},
    {"voronoiseamless", "cellular texture of a few points that repel each other", Seamless::tile, k_voronoi_seamless},
    {"weave", "woven threads", Seamless::tile, k_weave},
    {"wood", "wood, along the fibres or across", Seamless::four_corner, k_wood},
    {"xplo", "an explosion", Seamless::four_corner, k_xplo}};
static_assert(std::size(k_types) == 32);

constexpr ParameterInfo k_common[] = {
    flag_of("abs", "false", "absolute value of main"),
    any_number("add", "0", "added to main, last"),
    formula("afunction", "0", "evaluated first, known as a"),
    formula("alphafunction", "1", "cover of a layer, cut to [0, 1]"),
    number_in("ambient", 0, 1, "0.00", "ambient light of the preview"),
    formula("bfunction", "0", "evaluated second, known as b"),
    one_of("bumpblend", "add", "off interpolate interpol add sub"),
    formula("bumpfunction", "main", "height"),
    formula("coloralphafunction", "1", "cover of the colour alone"),
    one_of("colorblend", "interpolate", "off interpolate interpol add sub"),
    {"colorfunction", colour, 0, 0, "colmap(main)", "colour"},
    {"cols", colours, 0, 0, "black,white", "colours of colmap"},
    one_of("diffuseblend", "interpolate", "off interpolate interpol add sub"),
    formula("diffusefunction", "1", "diffuse reflection"),
    {"dirtdirection", vector, -k_open, k_open, "<0,-1,0>", "direction in which dirt, rain or snow moves"},
    number_in("du", -1, 1, "0.00", "shift to the left, in pictures, after scaling"),
    number_in("dv", -1, 1, "0.00", "shift up"),
    flag_of("dynamicoctaves", "true", "leave out octaves finer than two texels"),
    number_in("fade", 0, 1e6, "1", "width of the change to the next texture of texmap"),
    flag_of("fixtime", "false", "take the recipe's own time"),
    one_of("frictionblend", "interpolate", "off interpolate interpol add sub"),
    formula("frictionfunction", ".35", "coefficient of friction"),
    words("idmaterial", "", "material, for suggestions"),
    words("idtype", "", "category, for lists"),
    any_number("intensity", "1", "multiplies main"),
    flag_of("invert", "false", "1 - main"),
    flag_of("ismodifier", "false", "marks a recipe that is meant to lie on others"),
    flag_of("lightdist", "false", "light of the preview falls with distance"),
    any_number("lightscale", "1.00", "brightness of the preview"),
    number_in("lightx", -1, 1, "0.50", "light of the preview"),
    number_in("lighty", -1, 1, "0.50", "light of the preview"),
    number_in("lightz", 0, 3, "1.00", "light of the preview"),
    any_number("limithi", "1e30", "main is at most this"),
    any_number("limitlo", "-1e30", "main is at least this"),
    formula("mainfunction", "this", "the value, from `this`, what the type gives"),
    words("matid", "", "the same as idmaterial"),
    integer_in("maximumoctaves", 0, 30, "30", "most octaves"),
    integer_in("minimumoctaves", 0, 10, "1", "fewest octaves"),
    {"normal", vector, -k_open, k_open, "<0,1,0>", "normal of the surface where none is known"},
    flag_of("periodicmod", "false", "time modifiers end where they begin"),
    flag_of("pertube", "false", "kept for old recipes: a perturb formula alone is enough"),
    formula("pertubex", "", "new x; the same as perturbx"),
    formula("pertubey", "", "new y; the same as perturby"),
    formula("perturbx", "", "new x, an expression of x and y"),
    formula("perturby", "", "new y"),
    flag_of("pointlight", "false", "light of the preview stands at a point"),
    any_number("privatescalex", "1.00", "second scale"),
    any_number("privatescaley", "1.00", "second scale"),
    flag_of("quickshade", "true", "kept for old recipes; without effect"),
    number_in("range", 0, 1e6, "1", "width of this texture in texmap"),
    one_of("reflectionblend", "interpolate", "off interpolate interpol add sub"),
    formula("reflectionfunction", "0", "reflection"),
    number_in("rot", -1e6, 1e6, "0.00", "rotation in radians"),
    {"scale", vector, -k_open, k_open, "1", "size: half of it shows twice as much; <x,y> or one number"},
    flag_of("seamless", "false", "the picture tiles"),
    integer_in("seed", 0, 1e9, "0", "another texture of the same kind; handed to the textures within"),
    flag_of("shade", "true", "shade the preview"),
    {"shift", vector, -k_open, k_open, "0", "du and dv in one, <du,dv>"},
    one_of("specularblend", "interpolate", "off interpolate interpol add sub"),
    one_of("specularcoeffblend", "interpolate", "off interpolate interpol add sub"),
    formula("specularcoefffunction", "10", "specular exponent"),
    formula("specularfunction", ".3", "specular reflection"),
    one_of("stiffnessblend", "interpolate", "off interpolate interpol add sub"),
    formula("stiffnessfunction", "1", "stiffness as a multiple of the material's"),
    flag_of("strech", "false", "the same as stretch"),
    flag_of("stretch", "false", "fit a picture that is not square"),
    any_number("sx", "1.00", "size across"),
    any_number("sy", "1.00", "size down"),
    {"texes", textures, 0, 0, "", "the same as textures"},
    {"textures", textures, 0, 0, "", "layers of multi, textures of texmap"},
    any_number("time", "0.00", "own time, see fixtime"),
    words("timemodifiers", "", "parameter:formula of time, separated by ;"),
    any_number("u", "0.00", "kept for old recipes; without effect"),
    any_number("uORIG", "0.00", "kept for old recipes; without effect"),
    flag_of("usetimemodifiers", "true", "obey timemodifiers"),
    any_number("v", "0.00", "kept for old recipes; without effect"),
    any_number("vORIG", "0.00", "kept for old recipes; without effect")};

constexpr FunctionInfo k_functions[] = {
    {"a", 0, "", false, "what afunction gave"},
    {"abs", 1, "n", false, "absolute value"},
    {"absturbulence", 2, "nn", false, "sum of |noise(x 2^i)| / 2^i; x, octaves"},
    {"absturbulence2d", 3, "nnn", false, "the same over x, y"},
    {"absturbulence3d", 4, "nnnn", false, "the same over x, y, z"},
    {"acos", 1, "n", false, "arc cosine; beyond [-1, 1] that of the border"},
    {"atan", 1, "n", false, "arc tangent"},
    {"b", 0, "", false, "what bfunction gave"},
    {"bias", 2, "nn", false, "bias(a, x) = x^(log a / log 0.5)"},
    {"boxstep", 3, "nnn", false, "clamp((x - a) / (b - a), 0, 1) of a, b, x"},
    {"c", 1, "n", false, "cosine"},
    {"churn", 1, "n", false, "random number in [0, 1) that depends on the argument alone"},
    {"clamp", 3, "nnn", false, "clamp(x, low, high)"},
    {"clampunit", 1, "n", false, "clamp(x, 0, 1)"},
    {"coldist", 1, "c", false, "squared distance of the current colour to this one"},
    {"colgamma", 2, "cn", true, "every channel to the power 1 / g"},
    {"colmap", 1, "n", true, "the colour at this place of cols"},
    {"colmix", 3, "ccn", true, "(1 - t) first + t second"},
    {"colscale", 2, "cn", true, "every channel times s"},
    {"currentcolor", 0, "", true, "colour of the layers below"},
    {"dist", 2, "nn", false, "distance to the point (a, b)"},
    {"du", 0, "", false, "parameter du"},
    {"dv", 0, "", false, "parameter dv"},
    {"f1", 0, "", false, "within func: distance to the next point"},
    {"f2", 0, "", false, "within func: to the second"},
    {"f3", 0, "", false, "within func: to the third"},
    {"f4", 0, "", false, "within func: to the fourth"},
    {"floor", 1, "n", false, "largest integer that is not larger"},
    {"gain", 2, "nn", false, "gain(a, x): bias on both halves"},
    {"get", 1, "n", false, "information number i of the texture, 0 to 31"},
    {"get0", 0, "", false, "get(0)"},
    {"get1", 0, "", false, "get(1)"},
    {"getblue", 1, "c", false, "blue in [0, 1]"},
    {"getgreen", 1, "c", false, "green in [0, 1]"},
    {"gethsvhue", 1, "c", false, "hue in [0, 1)"},
    {"gethsvsaturation", 1, "c", false, "saturation in [0, 1]"},
    {"gethsvvalue", 1, "c", false, "value in [0, 1]"},
    {"getred", 1, "c", false, "red in [0, 1]"},
    {"globaltime", 0, "", false, "time of the whole picture, whatever fixtime says"},
    {"heartbeat", 2, "nn", false, "a = mod(a, b); sin(4 pi a / b) in the second half, else 0"},
    {"hsv", 3, "nnn", true, "colour of hue, saturation, value"},
    {"hue", 0, "", false, "hue of the current colour"},
    {"huedist", 1, "n", false, "distance of hues round the circle, 0 to 0.5"},
    {"id", 0, "", false, "random number in [0, 1) of the cell or brick"},
    {"index", 0, "", false, "within densityfunc: place in Worley's table"},
    {"infoheight", 0, "", false, "rows of the picture"},
    {"infominwh", 0, "", false, "the smaller of rows and columns"},
    {"infowidth", 0, "", false, "columns of the picture"},
    {"infox", 0, "", false, "column"},
    {"infoy", 0, "", false, "row"},
    {"interpolate", 3, "nnn", false, "(1 - t) a + t b of a, b, t"},
    {"linedist", 4, "nnnn", false, "distance to the line from (x1, y1) to (x2, y2)"},
    {"log", 1, "n", false, "natural logarithm; 0 where the argument is not positive"},
    {"lowerbump", 0, "", false, "height of the layers below"},
    {"lowerdiffuse", 0, "", false, "diffuse reflection of the layers below"},
    {"lowerfriction", 0, "", false, "friction of the layers below"},
    {"lowermain", 0, "", false, "value of the layer below"},
    {"lowerreflection", 0, "", false, "reflection of the layers below"},
    {"lowerspecular", 0, "", false, "specular reflection of the layers below"},
    {"lowerspecularcoeff", 0, "", false, "specular exponent of the layers below"},
    {"lowerstiffness", 0, "", false, "stiffness of the layers below"},
    {"main", 0, "", false, "what mainfunction gave"},
    {"max", 2, "nn", false, "the larger"},
    {"min", 2, "nn", false, "the smaller"},
    {"mod", 2, "nn", false, "a - b floor(a / b); 0 for b = 0"},
    {"moddist", 2, "nn", false, "1 - 1.7 distance to (a, b) within the unit cell"},
    {"noise", 1, "n", false, "gradient noise about 0, within [-1, 1]"},
    {"noise2d", 2, "nn", false, "the same over x, y"},
    {"noise3d", 3, "nnn", false, "the same over x, y, z"},
    {"normaldot", 0, "", false, "1 where dirt lands squarely, -1 at the back: - normal . dirtdirection"},
    {"octaveadd", 0, "", false, "log2(texels of a unit square's side / 256)"},
    {"orig", 0, "", false, "within densityfunc: Worley's number of points"},
    {"ovaldist", 4, "nnnn", false, "distance to (x, y) with axes rx, ry"},
    {"pi", 0, "", false, "3.14159..."},
    {"posx", 0, "", false, "position in the scene, metres"},
    {"posy", 0, "", false, "position in the scene, up"},
    {"posz", 0, "", false, "position in the scene"},
    {"pow", 2, "nn", false, "a^b; 0 where it is not defined"},
    {"preparemapping", 1, "n", false, "0; kept for old recipes"},
    {"privatescalex", 0, "", false, "parameter privatescalex"},
    {"privatescaley", 0, "", false, "parameter privatescaley"},
    {"pulse", 3, "nnn", false, "1 for a <= x < b of a, b, x"},
    {"random", 0, "", false, "random number in [0, 1) of the texel; the same on every run"},
    {"realtime", 0, "", false, "seconds, as the caller says; 0 unless told otherwise"},
    {"rectangledist", 4, "nnnn", false,
     "larger of the distances across and down to the rectangle (x1, y1) to (x2, y2)"},
    {"rectangledist2", 4, "nnnn", false, "their sum"},
    {"region", 2, "nn", false, "random number in [0, 1) of the cell of a grid of a x b"},
    {"rgb", 3, "nnn", true, "colour of red, green, blue"},
    {"rotate", 3, "nnn", false, "turns the texture about (a, b) by c radians; 0"},
    {"s", 1, "n", false, "sine"},
    {"saturation", 0, "", false, "saturation of the current colour"},
    {"seed", 0, "", false, "parameter seed"},
    {"set", 2, "nn", false, "keeps x as information number i; 1"},
    {"sky", 0, "", false, "share of the sky that the point sees, 0 to 1"},
    {"smoothpulse", 4, "nnnn", false, "smoothstep(a, b, x) - smoothstep(c, d, x) of a, b, c, x with d = c + b - a"},
    {"smoothstep", 3, "nnn", false, "3 t^2 - 2 t^3 between a and b of a, b, x"},
    {"sphere", 2, "nn", false, "bulges the texture to a ball about (a, b); 0"},
    {"sqrt", 1, "n", false, "square root; 0 of negative numbers"},
    {"step", 2, "nn", false, "1 where a >= b"},
    {"tan", 1, "n", false, "tangent"},
    {"texmap", 1, "n", true, "colour at this place of textures"},
    {"texmap2", 4, "nnnn", true,
     "mix, index, mode, place: colour of texture[index], mixed with colmap (0), texmap (1) or the current colour (2) "
     "at place"},
    {"texmappedalpha", 0, "", false, "alpha at place main of textures"},
    {"texmappedbump", 0, "", false, "height at place main of textures"},
    {"texmappedcolor", 0, "", true, "colour at place main of textures"},
    {"texmappedcoloralpha", 0, "", false, "colour's alpha at place main of textures"},
    {"texmappeddiffuse", 0, "", false, "diffuse reflection at place main of textures"},
    {"texmappedfriction", 0, "", false, "friction at place main of textures"},
    {"texmappedmain", 0, "", false, "value at place main of textures"},
    {"texmappedreflection", 0, "", false, "reflection at place main of textures"},
    {"texmappedspecular", 0, "", false, "specular reflection at place main of textures"},
    {"texmappedspecularcoeff", 0, "", false, "specular exponent at place main of textures"},
    {"texmappedstiffness", 0, "", false, "stiffness at place main of textures"},
    {"this", 0, "", false, "what the type gives"},
    {"time", 0, "", false, "0 new to 1 worn"},
    {"turbulence", 2, "nn", false, "sum of noise(x 2^i) / 2^i; x, octaves"},
    {"turbulence2d", 3, "nnn", false, "the same over x, y"},
    {"turbulence3d", 4, "nnnn", false, "the same over x, y, z"},
    {"value", 0, "", false, "value of the current colour"},
    {"x", 0, "", false, "place across, after scaling"},
    {"y", 0, "", false, "place down, after scaling"},
    {"zoom", 3, "nnn", false, "magnifies the texture about (a, b) by c; 0"}};

template <class Table>
auto find_in(const Table& table, std::string_view name) noexcept -> decltype(&table[0]) {
  for (const auto& entry : table)
    if (entry.name == name) return &entry;
  return nullptr;
}

std::string range_text(const ParameterInfo& p) {
  if (p.kind != number && p.kind != integer) return "";
  const auto side = [](double v) {
    if (v <= -k_open || v >= k_open) return std::string("open");
    std::string s = std::to_string(v);
    while (s.back() == '0') s.pop_back();
    if (s.back() == '.') s.pop_back();
    return s;
  };
  return side(p.low) + " to " + side(p.high);
}

void table_of(std::string& out, std::span<const ParameterInfo> parameters) {
  out += "| parameter | takes | range | default | meaning |\n|---|---|---|---|---|\n";
  for (const ParameterInfo& p : parameters) {
    out += "| `" + std::string(p.name) + "` | " + std::string(to_string(p.kind)) + " | " + range_text(p) + " | ";
    out += (p.preset.empty() ? std::string() : "`" + std::string(p.preset) + "`") + " | ";
    for (const char ch : p.note) out += ch == '|' ? std::string("\\|") : std::string(1, ch);
    out += " |\n";
  }
  out += '\n';
}

}  // namespace

std::span<const TypeInfo> texture_types() noexcept { return k_types; }
std::span<const ParameterInfo> common_parameters() noexcept { return k_common; }
std::span<const FunctionInfo> expression_functions() noexcept { return k_functions; }

const TypeInfo* find_type(std::string_view name) noexcept { return find_in(k_types, name); }
const FunctionInfo* find_function(std::string_view name) noexcept { return find_in(k_functions, name); }

const ParameterInfo* find_parameter(const TypeInfo& type, std::string_view name) noexcept {
  if (const ParameterInfo* own = find_in(type.parameters, name)) return own;
  return find_in(k_common, name);
}

std::string_view to_string(ParameterKind kind) noexcept {
  constexpr std::array<std::string_view, 10> names = {"number", "integer", "flag",    "expression", "colour expression",
                                                      "text",   "choice",  "colours", "recipes",    "vector"};
  return names[static_cast<std::size_t>(kind)];
}

std::string reference_markdown() {
  std::string out = "## Types\n\n";
  for (const TypeInfo& type : k_types) {
    out += "### " + std::string(type.name) + "\n\n" + std::string(type.note) + ". Seamless ";
    out += type.seamless == Seamless::four_corner ? "by blending four corners" : "by construction";
    out += ".\n\n";
    if (!type.parameters.empty()) table_of(out, type.parameters);
  }
  out += "## Parameters of every type\n\n";
  table_of(out, k_common);
  out += "## Functions\n\n| function | gives | meaning |\n|---|---|---|\n";
  for (const FunctionInfo& f : k_functions) {
    out += "| `" + std::string(f.name);
    if (f.arity > 0) {
      out += '(';
      for (int i = 0; i < f.arity; ++i)
        out += (i ? ", " : "") + std::string(f.arguments[static_cast<std::size_t>(i)] == 'c' ? "colour" : "number");
      out += ')';
    }
    out += "` | " + std::string(f.colour ? "colour" : "number") + " | ";
    for (const char ch : f.note) out += ch == '|' ? std::string("\\|") : std::string(1, ch);
    out += " |\n";
  }
  return out;
}

}  // namespace papilla
