// SPDX-License-Identifier: MIT
#include <iterator>

#include "papilla/procedural/reference.hpp"

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
/// A parameter of the source whose value changes nothing that is written here.
constexpr ParameterInfo only_default(ParameterInfo p, std::string_view reason) {
  p.refusal = reason;
  return p;
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
constexpr std::string_view k_one_light =
    "the preview has one light, that of the picture: set shade, pointlight and lightx here";
constexpr ParameterInfo k_funky[] = {
    only_default(flag_of("shadethem", "false", "light every cell by the light of its recipe"), k_one_light),
    only_default(flag_of("shadethempoint", "false", "the same with point lights"), k_one_light),
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
    flag_of("calcheight", "true", "the value is the picture's grey; false: its colours on a flat surface, value 0"),
    flag_of("fit2screen", "true",
            "render basetexture at the size of the picture that is made, in place of width and height"),
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
                                     number_in("stiffnessscale", 0, 3, "1.00", "multiplies stiffness"),
                                     number_in("dampingscale", 0, 3, "1.00", "multiplies damping"),
                                     number_in("roughnessscale", 0, 3, "1.00", "multiplies roughness")};
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
                                       only_default(flag_of("usetables", "true", "take the rays from tables"),
                                                    "rays are computed, so there is no table to do without"),
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
                                   only_default(words("txtstyle", "SansSerif", "face of the letters"),
                                                "there is one face, a built-in raster of 5 x 7 dots"),
                                   integer_in("modifier", 0, 3, "1", "0 plain, 1 bold, 2 slanted, 3 both"),
                                   number_in("spacingy", 0.1, 10, "1.00", "distance of lines"),
                                   number_in("borderx", 0, 0.49, "0.00", "free share at the left and right"),
                                   number_in("bordery", 0, 0.49, "0.00", "free share at top and bottom"),
                                   flag_of("centerx", "true", "centre the lines"),
                                   {"texture", textures, 0, 0, "", "recipe that fills the letters"}};
// What the cellular types have in common.
constexpr ParameterInfo k_first_power = number_in("distmodea", 0, 5, "1.00", "A");
constexpr ParameterInfo k_second_power = number_in("distmodeb", 0, 5, "1.00", "B");
constexpr ParameterInfo k_inverse = flag_of("inversedistance", "false", "1 / (1 + distance)");
constexpr ParameterInfo k_rooted = flag_of("rooted", "false", "square root of the distance");
constexpr ParameterInfo k_of_distances = formula("func", "f1", "of f1, f2, f3, f4");
constexpr ParameterInfo k_voronoi[] = {
    integer_in("distmode", 0, 2, "0", "0 squared, 1 Manhattan, 2 Minkowski |dx|^A + |dy|^B"),
    k_first_power,
    k_second_power,
    k_inverse,
    k_rooted,
    formula("densityfunc", "max(orig*.1,1)+index*0",
            "points of a cell; orig is Worley's number (mean 4), index its place in the table"),
    integer_in("displacemode", 0, 6, "0",
               "shift of every cell: 0 none, 1 odd rows, 2 odd columns, 3 both, 4 chequers x, 5 chequers y, 6 random"),
    any_number("displace", "0.20", "strength of that shift in cells"),
    flag_of("random", "false", "a random linear combination of f1 to f4"),
    words("weights", "", "weight of every octave"),
    integer_in("octaves", 1, 5, "1", "octaves"),
    number_in("lacunarity", 1, 10, "2.00", "ratio of their frequencies"),
    k_of_distances,
    number_in("smooth", 0, 1, "0.00", "pulls the points to the middle of their cells"),
    integer_in("cell_initmode", 0, 4, "0",
               "sponge: distances of the next octave start at 1 d^p, 2 d p, 3 d + p, 4 p; 0 infinity"),
    any_number("initpower", "0.50", "p of the sponge")};
constexpr ParameterInfo k_voronoi_seamless[] = {
    integer_in("points", 3, 200, "10", "points"),
    integer_in("smoothiterations", 0, 200, "0", "steps of mutual repulsion"),
    integer_in("distmode", 0, 2, "0", "as of voronoi"),
    k_first_power,
    k_second_power,
    k_inverse,
    k_rooted,
    k_of_distances};
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
    {"base", "no pattern of its own (this = 0); its mainfunction gives the value", Seamless::four_corner, {}},
    {"block", "rectangles that are divided again", Seamless::tile, k_block},
    {"brick", "bricks and joints; get(0), get(1) number the brick", Seamless::tile, k_brick},
    {"brickfunky", "an overview: each of the named recipes in bricks of its own, with all its channels", Seamless::tile,
     k_funky},
    {"checker", "chequers", Seamless::tile, {}},
    {"checker3d", "chequers over x and y, or in space over the position in the scene", Seamless::tile, {}},
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
    {"voronoifunky", "the same in Voronoi's cells", Seamless::tile, k_funky},
    {"voronoiseamless", "cellular texture of a few points that repel each other", Seamless::tile, k_voronoi_seamless},
    {"weave", "woven threads", Seamless::tile, k_weave},
    {"wood", "wood, along the fibres or across", Seamless::four_corner, k_wood},
    {"xplo", "an explosion", Seamless::four_corner, k_xplo}};
static_assert(std::size(k_types) == 32);

constexpr std::string_view k_no_place = "the place runs over the picture; du and dv shift it";
constexpr ParameterInfo k_common[] = {
    flag_of("abs", "false", "absolute value of main"),
    any_number("add", "0", "added to main, last"),
    formula("afunction", "0", "evaluated first, known as a"),
    one_of("alphablend", "cover", "cover cut"),
    formula("alphafunction", "1", "cover of a layer, cut to [0, 1]"),
    number_in("ambient", 0, 1, "0.00", "light of the preview from everywhere"),
    formula("bfunction", "0", "evaluated second, known as b"),
    one_of("bumpblend", "add", "off interpolate interpol add sub"),
    formula("bumpfunction", "main", "height"),
    formula("coloralphafunction", "1", "cover of the colour alone"),
    one_of("colorblend", "interpolate", "off interpolate interpol add sub"),
    {"colorfunction", colour, 0, 0, "colmap(main)", "colour"},
    {"cols", colours, 0, 0, "black,white", "colours of colmap"},
    one_of("dampingblend", "interpolate", "off interpolate interpol add sub"),
    formula("dampingfunction", "1", "damping as a multiple of the material's"),
    one_of("diffuseblend", "interpolate", "off interpolate interpol add sub"),
    formula("diffusefunction", "1", "diffuse reflection"),
    {"dirtdirection", vector, -k_open, k_open, "<0,-1,0>", "direction in which dirt, rain or snow moves"},
    number_in("du", -1, 1, "0.00", "shift to the left, in pictures, after scaling"),
    number_in("dv", -1, 1, "0.00", "shift up"),
    flag_of("dynamicoctaves", "true", "leave out octaves finer than two texels, of fbm and turbulence"),
    number_in("fade", 0, 1e6, "1", "width of the change to the next texture of texmap"),
    flag_of("fixtime", "false", "take the recipe's own time"),
    one_of("frictionblend", "interpolate", "off interpolate interpol add sub"),
    formula("frictionfunction", ".35", "coefficient of friction"),
    words("idmaterial", "", "material, for suggestions"),
    words("idtype", "", "category, for lists"),
    any_number("intensity", "1", "multiplies main"),
    flag_of("invert", "false", "1 - main"),
    flag_of("ismodifier", "false", "marks a recipe that is meant to lie on others"),
    flag_of("lightdist", "false",
            "the light falls with the square of the distance to a point light, 1 at one side of the picture"),
    any_number("lightscale", "1.00", "brightness of the light"),
    number_in("lightx", -1, 1, "0.50",
              "light of the preview: to the right; -1 to 1 spans the picture for a point light"),
    number_in("lighty", -1, 1, "0.50", "upwards"),
    number_in("lightz", 0, 3, "1.00", "towards the viewer, in sides of the picture for a point light"),
    any_number("limithi", "1e30", "main is at most this"),
    any_number("limitlo", "-1e30", "main is at least this"),
    formula("mainfunction", "this", "the value, from `this`, what the type gives"),
    words("matid", "", "the same as idmaterial"),
    integer_in("maximumoctaves", 0, 30, "30", "most octaves, of fbm and turbulence"),
    integer_in("minimumoctaves", 0, 10, "1", "fewest octaves, of fbm and turbulence"),
    {"normal", vector, -k_open, k_open, "<0,1,0>", "normal of the surface where none is known"},
    flag_of("periodicmod", "false", "time modifiers end where they begin"),
    flag_of("pertube", "true", "obey the perturb formulas"),
    formula("pertubex", "", "new x; the same as perturbx"),
    formula("pertubey", "", "new y; the same as perturby"),
    formula("perturbx", "", "new x, an expression of x and y"),
    formula("perturby", "", "new y"),
    flag_of("pointlight", "false", "lightx, lighty, lightz is the place of the light; false: the direction to it"),
    any_number("privatescalex", "1.00", "second scale"),
    any_number("privatescaley", "1.00", "second scale"),
    flag_of("quickshade", "true",
            "slopes of the preview from neighbouring texels, across the border too; false: from heights half a texel "
            "to either side"),
    number_in("range", 0, 1e6, "1", "width of this texture in texmap"),
    one_of("reflectionblend", "interpolate", "off interpolate interpol add sub"),
    formula("reflectionfunction", "0", "reflection"),
    number_in("rot", -1e6, 1e6, "0.00", "rotation in radians"),
    one_of("roughnessblend", "interpolate", "off interpolate interpol add sub"),
    formula("roughnessfunction", "", "roughness, 0 mirror to 1 matte; empty: (2/(specular (specularcoeff+2)))^1/4"),
    {"scale", vector, -k_open, k_open, "1", "size: half of it shows twice as much; <x,y> or one number"},
    flag_of("seamless", "false", "the picture tiles"),
    integer_in("seed", 0, 1e9, "0", "another texture of the same kind; handed to the textures within"),
    flag_of("shade", "true", "light the preview; false: the colours"),
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
    only_default(any_number("u", "0.00", "place of the point that is evaluated"), k_no_place),
    only_default(any_number("uORIG", "0.00", "place of the point that is evaluated"), k_no_place),
    flag_of("usetimemodifiers", "true", "obey timemodifiers"),
    only_default(any_number("v", "0.00", "place of the point that is evaluated"), k_no_place),
    only_default(any_number("vORIG", "0.00", "place of the point that is evaluated"), k_no_place)};

}  // namespace

std::span<const TypeInfo> texture_types() noexcept { return k_types; }
std::span<const ParameterInfo> common_parameters() noexcept { return k_common; }

}  // namespace papilla
