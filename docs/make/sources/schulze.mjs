// SPDX-License-Identifier: MIT
// Figures of M. Schulze, Von computergraphischen zu haptischen Texturen, dissertation, Hannover 2005.
import { lit, recipe, shell } from './panels.mjs';

const SHEET = 'awk -f "$MAKE/sheet.awk" >sheet.obj';
const SKY = 'papilla texture "base|stretch=true|colorfunction=colmix(hsv(.58,.3+.5*y,1-.3*y),<.25,.2,.15>,step(y,.5))" -o sky --size 512x256 --channels color';
const CHROME = `echo '{"materials": {"chrome": {"metallic": 1, "roughness": 0.05, "color": "#f0f0f0"}}, "assign": [{"part": "*", "material": "chrome"}]}' >chrome.json`;
const GRAINS = ['spheres6', 'quads6', 'ovals6', 'spheres8', 'quads8', 'ovals8'];
const grain = (kind) => `papilla synthesize grain --kind ${kind} --size 400 -o ${kind}.png --relief ${kind}.exr`;
const photograph = (from, light, more = '') => `papilla synthesize photo ${from}.exr --light ${light} --albedo-noise 0.04 --blur-px 0.7 --noise 0.01${more} -o ${from}.jpg`;

/** Photograph with its primitive, feature matrix, primitive, synthesis; and the relief that is felt. */
const chain = (name, made, look) => [
  shell(`${name}: picture, feature matrix, primitive, synthesis, difference`, `${name}-lattice/symmetry.png`,
    [...made, `papilla analyze ${name}.jpg --pitch 0.1 --only symmetry --force-lattice --pictures ${name}-lattice`]),
  lit(`${name}: relief`, `${name}-found.exr`, `papilla height ${name}.jpg --pitch 0.1 ${look} -o ${name}-found.exr`),
];

const recipePhotograph = (name, text, light, depth) => [
  `papilla texture '${text}' -o ${name} --channels bump --bits 32 --size 400 --seamless`,
  `papilla height ${name}/bump.exr --method intensity --transfer linear --pitch 0.1 --depth ${depth} -o ${name}.exr`,
  photograph(name, light),
];

const plate = (size) => `{"materials": {"m": {"texture": "checker|scale=.5", "size_mm": [${size}, ${size}], "unwrap": "triplanar", "show": "picture"}}, "assign": [{"part": "*", "material": "m"}]}`;

export const figures = [
  {
    number: '4.2', title: 'Regular surface textures', columns: 3, tile: 240,
    panels: [recipe('weave|roundthreads=true|scale=.5', { label: 'weave' }), recipe('perforated|scale=.5', { label: 'perforated' }), recipe('checker|scale=.5', { label: 'checker' })],
    differs: 'photographs of materials there; recipes here, which also have a height',
  },
  {
    number: '4.3', title: 'Statistical surface textures', columns: 3, tile: 240,
    panels: [recipe('oak', { label: 'oak' }), recipe('leather', { label: 'leather' }), recipe('plaster', { label: 'plaster' })],
    differs: 'as 4.2',
  },
  {
    number: '4.6', title: 'Parameter lines as texture coordinates (`natural`)', columns: 1, tile: 640,
    panels: [shell('', 'natural.png', ['papilla unwrap "$DATA/cockpit.step" --chord 1 --method natural -o natural.glb --picture natural.png'])],
    differs: 'one surface there, all faces of a scene here, scaled to arc length',
  },
  {
    number: '4.7', title: 'Planar projection', columns: 2, tile: 480,
    panels: [
      shell('uv along the largest normal', 'planar.png', [SHEET, 'papilla unwrap sheet.obj --method planar -o planar.glb --picture planar.png']),
      shell('along (1, 0, 1)', 'along.png', [SHEET, 'papilla unwrap sheet.obj --method planar --direction 1,0,1 -o along.glb --picture along.png']),
    ],
    differs: 'coloured by distortion (symmetric Dirichlet)',
  },
  {
    number: '4.4', title: 'An environment as picture and in a chrome handle (4.4, 4.8)', columns: 2, tile: 420,
    panels: [
      shell('equirectangular picture', 'sky/color.png', [SKY]),
      shell('mirrored', 'report/scene.png', [SKY, CHROME, 'papilla bake "$DATA/exchange/handle.step" -m chrome.json -o chrome.glb --report report --pictures --environment sky/color.png']),
    ],
    differs: 'looked up by direction for every pixel; coordinates by the source\'s formula are `unwrap --method environment --environment-map equal-area`, those of a mirroring ball `sphere`',
  },
  {
    number: '4.11', title: 'Planar triple projection with a fine and a coarse grain', columns: 2, tile: 560,
    panels: [12, 60].map((size) => shell(`chequers of ${size / 4} mm`, `seat-${size}.png`, [
      `mkdir -p ${size}`, `echo '${plate(size)}' >${size}/materials.json`,
      `papilla bake "$DATA/cockpit.step" --chord 1 -m ${size}/materials.json -o ${size}/cockpit.glb --report ${size}/report --pictures`,
      `oiiotool ${size}/report/scene.png --cut 520x480+660+290 -o seat-${size}.png`])),
    differs: 'classes by the largest component of the normal (the source\'s 45° leave directions without a class), smoothed, without overlaps; jumps at borders are reported',
  },
  {
    number: '6.1', title: 'Koch curve', columns: 1, tile: 480,
    panels: [recipe('ifs|usestyle=false|one=.3333 0 0 .3333 0 0 .25|two=.1667 -.2887 .2887 .1667 .3333 0 .25|three=.1667 .2887 -.2887 .1667 .5 .2887 .25|four=.3333 0 0 .3333 .6667 0 .25|kilon=500|mainfunction=clampunit(this*8)', { look: 'main', size: 480 })],
    differs: 'as the fixed set of four maps',
  },
  {
    number: '6.2', title: 'Double logarithmic diagram', columns: 1, tile: 640,
    panels: [shell('', 'surface/log-log.svg', ['papilla synthesize fractal --dimension 2.5 --size 513 -o surface.png', 'papilla analyze surface.png --only fractal --pictures surface'])],
    differs: 'of second differences of a surface of D = 2.5, with the range over which the power law holds',
  },
  {
    number: '6.4', title: 'Grey pictures of D = 2.2, 2.5, 2.8', columns: 3, tile: 256,
    panels: [2.2, 2.5, 2.8].map((d) => shell(`D = ${d}`, `d${d}.png`, `papilla synthesize fractal --dimension ${d} --size 257 -o d${d}.png`)),
    differs: 'exact fractional Brownian surfaces; how the source made its pictures is not said',
  },
  {
    number: '6.5', title: 'Three resolutions of D = 2.7', columns: 3, tile: 235,
    panels: [130, 185, 235].map((size) => shell(`${size}²`, `s${size}.png`, ['papilla synthesize fractal --dimension 2.7 --size 513 -o large.png', `oiiotool large.png --cut ${size}x${size}+139+139 -o s${size}.png`])),
    differs: 'parts of one picture',
  },
  {
    number: '6.6', title: 'Graphs of Brownian motions', columns: 1, tile: 800, graph: ['0.2', '0.5', '0.8'],
    panels: ['0.2', '0.5', '0.8'].map((h) => shell(`H = ${h}`, `h${h}.png`, `papilla synthesize fractal --method brownian-graph --hurst ${h} --size 1025 -o h${h}.png`)),
    differs: 'exact increments at every scale (the source\'s variances 2^(-jH) are not those of its definition)',
  },
  {
    number: '6.7', title: 'Brownian surfaces of H = 0.1, 0.5, 0.9 (6.7 to 6.9)', columns: 3, tile: 280,
    panels: ['0.1', '0.5', '0.9'].map((h) => lit(`H = ${h}`, `b${h}.exr`, `papilla synthesize fractal --method brownian-surface --hurst ${h} --size 257 --height-mm 8 -o b${h}.png --relief b${h}.exr`)),
    differs: 'lit instead of wire frames; the source\'s midpoint displacement',
  },
  {
    number: '7.4', title: 'Grey picture, feature matrix, minima, primitive, synthesis, difference (7.4, 7.5, 7.7)', columns: 1, tile: 900,
    panels: [shell('', 'quads6-lattice/symmetry.png', [grain('quads6'), 'papilla analyze quads6.png --pitch 0.1 --only symmetry --pictures quads6-lattice'])],
    differs: 'the lattice by `best`; `--lattice projection` is the source\'s way by mean concentration (7.6)',
  },
  {
    number: '8.1', title: 'Grey picture and relief from shading', columns: 3, tile: 280,
    panels: [
      shell('picture', 'spheres6.png', grain('spheres6')),
      lit('`tsai-shah`, the source\'s', 'ts.exr', 'papilla height spheres6.png --pitch 0.1 --method tsai-shah -o ts.exr'),
      lit('`variational`', 'v.exr', 'papilla height spheres6.png --pitch 0.1 --method variational -o v.exr'),
    ],
    differs: 'lit instead of wire frames',
  },
  {
    number: '8.4', title: 'Synthetic textures of the discrimination experiment', columns: 3, tile: 240,
    panels: GRAINS.map((kind) => shell(kind, `${kind}.png`, grain(kind))),
    differs: '36, 36, 55, 64, 64 and 85 elements of one height on 40 mm, as there; rounding and light are our own',
  },
  {
    number: '8.5', title: 'Reliefs of spheres6 and ovals6', columns: 2, tile: 320,
    panels: ['spheres6', 'ovals6'].map((kind) => lit(kind, `${kind}-found.exr`, [grain(kind), `papilla height ${kind}.png --pitch 0.1 -o ${kind}-found.exr`])),
    differs: 'lit instead of wire frames',
  },
  {
    number: '8.12', title: 'Chains of analysis of plastics (8.12, 8.13)', columns: 2, tile: 700, narrow: 150,
    panels: [
      ...chain('plastic1', [grain('spheres8').replaceAll('spheres8', 'plastic1').replace('--kind plastic1', '--kind spheres8'), photograph('plastic1', '0.6,0.3,0.7')], ''),
      ...chain('plastic2', recipePhotograph('plastic2', 'voronoi|scale=.12|rooted=true|smooth=1|func=clampunit(1-f1*1.4)|mainfunction=this*(.4+.6*smoothstep(-.2,.3,noise2d(x*.4,y*.4)))', '0.6,0.3,0.7', 0.3), ''),
      ...chain('plastic3', ['papilla synthesize grain --kind leather --size 400 -o plastic3.png --relief plastic3.exr', photograph('plastic3', '0.6,0.3,0.7')], ''),
    ],
    differs: 'photographs of reliefs that are known (a regular one, one of uneven density, an irregular one), because the source\'s pictures are not available. The source takes a lattice of plastic3 all the same (here `--force-lattice`); `bake` takes none there, and the relief of the whole picture',
  },
  {
    number: '8.17', title: 'Chains of analysis of textiles (8.17, 8.18)', columns: 2, tile: 700, narrow: 150,
    panels: [
      ...chain('textile1', recipePhotograph('textile1', 'weave|roundthreads=true|xgap=2|ygap=2|scale=.5', '0.6,0.3,0.7', 0.3), ''),
      ...chain('textile2', recipePhotograph('textile2', 'weave|roundthreads=true|xgap=1|ygap=1|matrix=0011011011001001|scale=.4', '0.6,0.3,0.7', 0.3), ''),
      ...chain('textile3', recipePhotograph('textile3', 'base|mainfunction=.5+.3*s(x*62.83)*s(y*31.42)+.2*noise2d(x*60,y*60)', '0.6,0.3,0.7', 0.3), ''),
    ],
    differs: 'as 8.12',
  },
];
