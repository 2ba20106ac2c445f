// SPDX-License-Identifier: MIT
// Figures of the texture factory, a diploma thesis of 2006.
import { recipe, rows, shell, times } from './panels.mjs';

const grey = (text, label = '') => recipe(text, { label, look: 'main' });
const range = (n) => Array.from({ length: n }, (_, i) => i);
const curve = (f) => grey(`base|afunction=${f}|mainfunction=step(y,.55-.4*a)`, `\`${f}\``);
const wall = 'brick|switching=true|round=.25|cols=<.62,.60,.56>,<.55,.2,.13>';
const grass = 'fbm|scale=.06|h=.3|cols=<.05,.12,.02>,<.3,.5,.1>';

const SPOTTED = 'multi|textures=plaster,[dirt|scale=.4]';

const FBM = ['fbm', 'heteroterrain', 'multifractal', 'hybridmultifractal', 'ridgedmultifractal'];
const CELLS = ['f1', 'f2', 'f2-f1', 'f3*f3-f2*f2'];

const noises = [
  {
    number: '2.10', title: 'Koch curve', columns: 1, tile: 320,
    panels: [recipe('ifs|usestyle=false|one=.3333 0 0 .3333 0 0 .25|two=.1667 -.2887 .2887 .1667 .3333 0 .25|three=.1667 .2887 -.2887 .1667 .5 .2887 .25|four=.3333 0 0 .3333 .6667 0 .25|kilon=500|mainfunction=clampunit(this*8)', { look: 'main', size: 320 })],
  },
  {
    number: '2.7', title: 'A tile laid again and again, and Wang tiles (2.7, 2.9)', columns: 2, tile: 400,
    panels: [
      shell('one tile, 8 × 8 times', 'tiled.png', [`papilla texture '${SPOTTED}' -o worn --channels color --size 96 --time .7 --seamless`, `oiiotool ${Array(64).fill('worn/color.png').join(' ')} --mosaic 8x8 -o tiled.png`]),
      shell('eight Wang tiles, 8 × 8', 'wang/wang.plane.png', [`papilla texture '${SPOTTED}' -o wang --channels color --size 384 --time .7 --wang 96`]),
    ],
    differs: 'there photographs of a wall and squares with coloured edges',
  },
  {
    number: '2.8', title: 'A picture before and after its slow changes are taken away', columns: 2, tile: 300,
    panels: [
      shell('before', 'spots.png', ['papilla texture "multi|textures=brick_wall,[fbm|scale=.8|octaves=2|cols=black,black|alphafunction=clampunit(main*1.4-.5)]" -o before --channels color --size 300', 'cp before/color.png spots.png']),
      shell('after', 'even.png', ['papilla prepare spots.png -o even.png']),
    ],
    differs: '`prepare`, which also makes the borders match, in place of a high pass alone; it works on the grey picture',
  },
  {
    number: '4.2', title: 'Noise, turbulence, absolute turbulence, and sines that they bend', columns: 5, tile: 128,
    panels: rows(range(5).map((i) => grey(`noise|scale=${0.5 ** i}`)), range(5).map((i) => grey(`turbulence|scale=.5|dynamicoctaves=false|octaves=${i + 1}`)),
      range(5).map((i) => grey(`turbulence|scale=.5|dynamicoctaves=false|absturb=true|octaves=${i + 1}`)),
      range(5).map((i) => grey(`base|mainfunction=.5+.5*s(x*20+6*turbulence2d(x*3,y*3,${i + 1}))`)), range(5).map((i) => grey(`base|mainfunction=.5+.5*s(x*20+6*absturbulence2d(x*3,y*3,${i + 1}))`))),
  },
  {
    number: '4.3', title: 'Kinds of fBm at growing offset', columns: 4, tile: 128,
    panels: FBM.flatMap((type) => [0.5, 0.8, 1.1, 1.4].map((offset) => grey(`fbm|type=${type}|scale=.5|h=.5|offset=${offset}`, `${type}, offset ${offset}`))),
    differs: 'of `fbm` the offset is only an offset',
  },
  {
    number: '4.4', title: 'Weights and lacunarity', columns: 3, tile: 160,
    panels: rows([1.2, 2, 3].map((l) => grey(`fbm|type=ridgedmultifractal|scale=.5|weights=1 0 0 1|lacunarity=${l}`)), ['1 0 0 0 1', '1 0 0 0 0 0 .5', '0 0 1 0 0 0 .5'].map((w) => grey(`fbm|scale=.5|weights=${w}`)),
      [2.5, 3.5, 4].map((l) => grey(`fbm|type=hybridmultifractal|scale=.5|octaves=4|lacunarity=${l}`))),
    differs: 'lacunarity is at most 4 here, and 1 would be one octave over and over',
  },
  {
    number: '4.5', title: 'Distribution of the points', columns: 5, tile: 128,
    panels: rows([1, 0.75, 0.5, 0.25, 0].map((s) => grey(`voronoi|scale=.2|rooted=true|densityfunc=1|smooth=${s}`)), [0.1, 0.2, 0.3, 0.4, 0.5].map((d) => grey(`voronoi|scale=.2|rooted=true|densityfunc=1|smooth=1|displacemode=1|displace=${d}`)),
      [1, 2, 3, 4, 5].map((n) => grey(`voronoi|scale=.2|rooted=true|densityfunc=${n}`)), ['orig', 'orig-1', 'orig*5-8', 'index%3', 'index%3-1'].map((f) => grey(`voronoi|scale=.2|rooted=true|densityfunc=${f}`, `\`densityfunc=${f}\``))),
    differs: 'cells without a point are searched past, so that the fault of the last picture of the source does not happen',
  },
  {
    number: '4.6', title: 'Distances', columns: 4, tile: 144,
    panels: ['distmode=0', 'distmode=1', 'distmode=2|distmodea=.3|distmodeb=.3'].flatMap((mode) => CELLS.map((f) => grey(`voronoi|scale=.25|${mode}|func=${f}`, `${f}`))),
  },
  {
    number: '4.7', title: 'Fractal cells and the sponge', columns: 3, tile: 144,
    panels: CELLS.flatMap((f) => ['cell_initmode=0', 'cell_initmode=1|initpower=.15', 'cell_initmode=1|initpower=.35'].map((mode) => grey(`voronoi|scale=.5|octaves=4|${mode}|func=${f}`))),
  },
  {
    number: '4.8', title: 'Cells that tile', columns: 6, tile: 128,
    panels: ['points=5|func=f1', 'points=12|smoothiterations=40|func=f2-f1', 'points=30|rooted=true|func=1-f1*3', 'points=8|rooted=true|func=s(f1*40)*.5+.5', 'points=20|rooted=true|func=(f2-f1)*3+f1', 'points=20|rooted=true|func=(f2-f1)*4']
      .map((p) => recipe(`voronoiseamless|${p}|cols=<.1,.1,.12>,<.75,.7,.6>`)),
    differs: 'combinations of our own',
  },
  {
    number: '4.9', title: 'Functions in one dimension', columns: 4, tile: 160,
    panels: ['s(x*6.283)', 's(x*6.283)+turbulence(x*5,6)*.5', 'mod(x,.3)*3', 'pulse(.3,.6,x)', 'pulse(.3,.6,mod(x*3,1))', 'smoothpulse(.2,.4,.6,x)', 'smoothpulse(.2,.4,.6,mod(x*3,1))', 'heartbeat(x,.5)'].map(curve),
    differs: '`turbulence` takes its octaves, too',
  },
  {
    number: '4.10', title: 'Functions of the distance to a line', columns: 6, tile: 112,
    panels: ['a', '1-a', '(1-a)^5', '2*(1-a)^5', '.1^a', '.00001^a', 's(a*50)*.5+.5', 's(s(a*2)*50)*.5+.5', 'mod(a*5,1)', 'mod(a*5,.5)', 'smoothpulse(.1,.2,.2,mod(a,.3))', 'smoothpulse(.1,.2,.2,mod(a*3,.3))',
      'step(a,.1)', 'smoothstep(.1,.15,a)', 'step(a,.3)', 'smoothstep(.1,.4,a)', 'pulse(.1,.25,a)', 'smoothpulse(.1,.2,.2,a)'].map((f) => grey(`base|afunction=linedist(.3,.3,.7,.7)|mainfunction=${f}`, `\`${f}\``)),
  },
  {
    number: '4.11', title: 'Sines alone', columns: 4, tile: 144,
    panels: ['s(x*30)*s(y*30)*.5+.5', 's(x*12+3*s(y*12))*.5+.5', 's(40*dist(.5,.5)+4*s(x*9))*.5+.5', 's(x*25+4*s(y*7+s(x*11)*3))*s(y*25)*.5+.5'].map((f) => recipe(`base|mainfunction=${f}|cols=<.1,.15,.3>,<.8,.5,.2>,white`)),
    differs: 'combinations of our own',
  },
];

const regular = [
  { number: '4.12', title: 'Text', columns: 3, tile: 200, panels: [grey('txt|txt=Grain'), recipe('txt|txt=Grain|cols=<.1,.1,.4>,gold'), recipe('txt|txt=Grain|texture=[marble|octaves=6]')], differs: 'one face of letters; artefacts of great magnification are the source\'s as well' },
  {
    number: '4.13', title: 'Bricks', columns: 7, tile: 112,
    panels: ['tiling=true|rows=4|columns=2', 'tiling=true|rows=4|columns=2|switching=true', 'tiling=true|rows=4|columns=2|offsetrand=true', 'tiling=true|rows=4|columns=2|switching=true|mortarthicknessrand=.3', 'tiling=true|rows=4|columns=2|switching=true|round=.3',
      'tiling=true|rows=9|columns=5|switching=true', 'tiling=true|rows=9|columns=5|switching=true|colorfunction=colmix(black,colmix(firebrick,tan,turbulence2d(get(0)*.7,get(1)*.9,3)*.5+.5),main)'].map((p) => recipe(`brick|${p}|cols=grey,firebrick`)),
  },
  {
    number: '4.14', title: 'Variations of bricks', columns: 5, tile: 128,
    panels: ['brick|circle=true', 'brick|round=1|cols=black,gold', 'brick|round=1|invert=true|cols=black,gold', 'brick|tiling=true|rows=1|columns=1|mortarthickness=.3|du=.5|dv=.5|cols=red,white', 'brick|returnid=true|rot=.785|cols=navy,white'].map((r) => recipe(r)),
  },
  { number: '4.15', title: 'Stars', columns: 5, tile: 128, panels: ['', '|ninja=.5', '|jags=6', '|jags=6|rmin=1.8', '|jags=3|round=true'].map((p) => grey(`star${p}`)) },
  {
    number: '4.16', title: 'Mandelbrot and Julia sets, and a way to -0.74364388703 + 0.1318259042 i', columns: 4, tile: 144,
    panels: [...['paintmode=0', 'paintmode=1', 'julia=true|paintmode=1', 'julia=true|rr=-.8|ii=.156|paintmode=3'].map((p) => recipe(`mandelbrot|max=60|${p}|cols=black,navy,white,gold`)),
      ...[1e2, 1e5, 1e8, 1e10].map((z) => recipe(`mandelbrot|max=2000|paintmode=1|xp=-.74364388703|yp=.1318259042|zoom=${z}|mainfunction=mod(this*20,1)|cols=black,navy,white,gold,black`, { label: `× ${z}` }))],
    differs: 'the boundary is compared with |z|²; the listing of the source compares the real part. Its last magnification is 10¹⁴, for which the place that it names has too few digits',
  },
  { number: '4.17', title: 'Iterated function systems and their in-betweens', columns: 6, tile: 128, panels: [...range(8).map((i) => grey(`ifs|style=${i}|mainfunction=clampunit(this*6)`)), ...[0.25, 0.5, 0.75].map((s) => grey(`ifs|style=0|ipolfunc=${s}|ipolfuncindex=4|mainfunction=clampunit(this*6)`)), recipe('ifs|style=3|kilon=400|mainfunction=clampunit(this*4)|cols=<.3,.2,.1>,orange')], differs: 'eight systems of our own choice but for the fern, whose maps are the source\'s' },
  { number: '4.18', title: 'Weaves', columns: 4, tile: 144, panels: ['', '|roundthreads=true', '|roundthreads=true|xgap=0|ygap=0|matrix=0011011011001001', '|roundthreads=true|xwidth=8|xgap=14|cols=black,goldenrod'].map((p) => recipe(`weave|scale=.5${p}`)) },
  { number: '4.19', title: 'Sparkle', columns: 4, tile: 128, panels: ['rays=48|amount=20', 'rays=6|amount=20', 'amount=0', 'randomness=0|amount=80'].map((p) => recipe(`sparkle|${p}|cols=black,orange,white`)) },
  { number: '4.20', title: 'A flame that moves', columns: 4, tile: 128, panels: [0, 0.1, 0.2, 0.3].map((t) => recipe(`flame|timing=${t}|cols=fire`)) },
  { number: '4.21', title: 'An explosion', columns: 4, tile: 128, panels: [0.1, 0.2, 0.3, 0.4].map((r) => recipe(`xplo|radius=${r}|cols=fire`)) },
];

const materials = [
  { number: '4.22', title: 'Wood', columns: 5, tile: 144, panels: ['wood|cols=oak', 'wood|seed=3|rings=9|cols=oak', 'wood|makerings=true|cols=oak', 'voronoi|scale=<.08,.8>|octaves=4|func=f2-f1|cols=oak', 'base|mainfunction=mod(10*turbulence2d(x*.3,y*2,6),1)|cols=oak'].map((r) => recipe(r)) },
  { number: '4.23', title: 'Marble', columns: 3, tile: 200, panels: ['marble|octaves=6|turbulence=.8|cols=white,<.5,.5,.55>', 'marble_tile', 'base|mainfunction=.5+.5*s(12*(x+.8*turbulence2d(x*2,y*2,7)))|cols=<.1,.2,.15>,<.6,.75,.65>,white'].map((r) => recipe(r)) },
  { number: '4.24', title: 'Stone and plaster', columns: 4, tile: 144, panels: ['stone', 'plaster', 'voronoi|scale=.5|octaves=4|func=f1|cols=<.25,.24,.22>,<.7,.67,.6>', 'fbm|type=hybridmultifractal|scale=.5|cols=<.4,.35,.3>,<.8,.76,.7>'].map((r) => recipe(r)) },
  { number: '4.25', title: 'Metal', columns: 4, tile: 144, panels: ['brushed_metal', 'painted_metal', 'star|scale=.25|jags=4|rmin=1|cols=<.3,.3,.32>,<.75,.76,.8>', 'voronoi|scale=.2|smooth=1|displacemode=1|displace=.5|rooted=true|func=smoothstep(.02,.1,f2-f1)|cols=<.2,.2,.22>,<.7,.71,.73>'].map((r) => recipe(r)) },
  { number: '4.26', title: 'Skin and fur', columns: 4, tile: 144, panels: ['leather', 'voronoi|scale=.12|rooted=true|func=clampunit((f2-f1)*2)|cols=<.35,.17,.1>,<.8,.55,.42>', 'fbm|scale=<.02,.3>|h=.4|cols=<.2,.12,.05>,<.8,.6,.35>', 'multi|textures=[fbm|scale=<.02,.3>|h=.4|cols=<.5,.32,.12>,<.9,.7,.4>],[voronoi|scale=.15|rooted=true|func=smoothstep(.25,.35,f1)|cols=<.08,.05,.02>,<.08,.05,.02>|alphafunction=1-main]'].map((r) => recipe(r)), differs: 'no hair stands out of a surface' },
  { number: '4.27', title: 'Water', columns: 3, tile: 200, panels: ['voronoi|scale=.3|rooted=true|octaves=2|func=f1*f1|cols=<.02,.12,.2>,<.1,.4,.55>,white', 'noise|scale=<.5,.15>|perturbx=x+.1*noise2d(x*3,y*3)|cols=<.02,.1,.2>,<.2,.5,.6>', 'marble|turbulence=1|octaves=3|cols=<.02,.1,.25>,<.3,.6,.7>'].map((r) => recipe(r)) },
  { number: '4.28', title: 'Grass and moss', columns: 3, tile: 200, panels: [grass, 'fbm|scale=.2|h=.4|cols=mossy', 'voronoi|scale=.1|octaves=3|func=f1|cols=mossy'].map((r) => recipe(r)) },
  { number: '4.29', title: 'Regions', columns: 4, tile: 144, panels: ['base|mainfunction=noise2d(floor(x*5)*1.1,floor(y*5)*1.1)*.5+.5', 'brick|switching=true|colorfunction=colmix(black,hsv(id,.6,.8),main)', 'voronoi|scale=.25|rooted=true|func=f2-f1|colorfunction=hsv(id,.6,.4+.6*clampunit(main*4))', 'brick|tiling=true|rows=3|columns=3|mainfunction=region(3,3)|textures=oak,marble_tile,leather,stone|colorfunction=texmap(main)'].map((r) => recipe(r)) },
  { number: '4.30', title: 'Planks and roof tiles', columns: 3, tile: 200, panels: ['multi|textures=oak,[base|mainfunction=smoothpulse(.02,.06,.94,mod(x*5,1))|alphafunction=1-main|cols=<.1,.06,.03>,<.1,.06,.03>]', 'brick|brickheight=.2|switching=true|bumpfunction=mod(y*5,1)|cols=<.25,.1,.06>,<.6,.25,.15>', `multi|textures=[${grass}],[brick|brickheight=.2|switching=true|alphafunction=(1-main)*.8|cols=black,black]`].map((r) => recipe(r)) },
  { number: '4.31', title: 'Walls, paving, scree', columns: 4, tile: 144, panels: ['brick_wall', 'voronoi|scale=.2|smooth=.6|rooted=true|func=smoothstep(.02,.2,f2-f1)|cols=<.2,.19,.17>,<.6,.57,.5>', 'voronoi|scale=.15|rooted=true|func=clampunit(1-f1*1.3)|cols=<.15,.13,.1>,<.65,.6,.5>', `multi|textures=[${grass}],[${wall}|alphafunction=step([star|scale=.5],.3)]`].map((r) => recipe(r)) },
  { number: '4.32', title: 'Fences and grids', columns: 3, tile: 160, panels: ['weave|xwidth=4|ywidth=4|xgap=28|ygap=28|roundthreads=true|rot=.785|scale=.7|cols=<.85,.9,.95>,<.3,.3,.32>', 'base|mainfunction=max(smoothpulse(.4,.45,.55,mod(x*6,1)),smoothpulse(.4,.45,.55,mod(y*2,1)))|cols=skyblue,saddlebrown', 'voronoi|scale=.2|smooth=1|displacemode=1|displace=.5|rooted=true|func=1-smoothstep(.02,.08,f2-f1)|cols=<.85,.9,.95>,<.3,.3,.32>'].map((r) => recipe(r)) },
  { number: '4.33', title: 'Metal of stars, rmin from 1 to 0.7, and inverted', columns: 4, tile: 144, panels: rows([1, 0.9, 0.8, 0.7].map((r) => recipe(`star|scale=.25|rmin=${r}|jags=4|cols=<.2,.2,.22>,<.8,.81,.84>`)), [1, 0.9, 0.8, 0.7].map((r) => recipe(`star|scale=.25|rmin=${r}|jags=4|invert=true|cols=<.2,.2,.22>,<.8,.81,.84>`))) },
];

const ageing = [
  { number: '4.34', title: 'Masks: smears and a formula', columns: 4, tile: 144, panels: rows([0.2, 0.4, 0.6, 0.9].map((d) => grey(`smear|density=${d}`)), [0, 0.33, 0.67, 1].map((t) => recipe('base|mainfunction=(y*y*y+turbulence2d(x*5,1,10)*.3-.1)*(time+.1)', { look: 'main', options: `--time ${t}` }))), differs: '`y*y*y+turbulence(x*5,10)*.3-.1` is set in brackets as the text means it' },
  { number: '4.35', title: 'The masks on a wall', columns: 2, tile: 240, panels: [recipe(`multi|textures=[${wall}],[smear|density=.5|cols=black,black|alphafunction=main*.7]`), recipe(`multi|textures=[${wall}],[base|mainfunction=(y*y*y+turbulence2d(x*5,1,10)*.3-.1)*1.1|cols=black,black|alphafunction=clampunit(main)]`)] },
  { number: '4.36', title: 'Paint that chips off stone', columns: 4, tile: 144, panels: times('multi|textures=stone,[painted_metal|alphafunction=1-smoothstep(.98-.75*time,1-.75*time,[fbm|scale=.5|octaves=6|h=.5])]', [0.1, 0.4, 0.7, 1]) },
  { number: '4.37', title: 'A scratch in one dimension', columns: 1, tile: 240, panels: [curve('1-smoothpulse(.1,.8,.9,x)*(.6+.4*turbulence(x*100,4))')], differs: 'the constants of the source\'s formula do not fit the order of its own smoothpulse' },
  { number: '4.38', title: 'Scratches', columns: 4, tile: 144, panels: times('multi|textures=painted_metal,scratches', [0.25, 0.5, 0.75, 1]) },
  { number: '4.39', title: 'Rust', columns: 4, tile: 144, panels: rows(times('multi|textures=painted_metal,rust_on', [0.2, 0.4, 0.6, 0.9]), times('multi|textures=painted_metal,rust_in', [0.2, 0.4, 0.6, 0.9])) },
  { number: '4.40', title: 'Erosion', columns: 4, tile: 144, panels: times('multi|textures=stone,erosion', [0, 0.33, 0.67, 1]) },
  { number: '4.41', title: 'A wall that decays and is overgrown', columns: 4, tile: 144, panels: times('multi|textures=brick_wall,erosion,[moss|alphafunction=smoothstep(1.5-time*1.2,1.8-time*1.2,main+.5*(1-lowerbump)+.8*y-.2)*min(time*8,1)]', [0.1, 0.4, 0.7, 1]) },
  { number: '4.42', title: 'Wood that greys', columns: 4, tile: 144, panels: times('multi|textures=oak,greying', [0, 0.33, 0.67, 1]) },
];

const colours = [
  { number: '5.1', title: 'Colour maps', columns: 2, tile: 200, panels: [recipe('base|mainfunction=x|cols=blue,yellow'), recipe('base|mainfunction=x|cols=blue,blue,yellow,yellow')] },
  { number: '5.2', title: 'texmap with a wider beach', columns: 2, tile: 240, panels: [1, 4].map((r) => recipe(`fbm|scale=.7|limitlo=0|textures=[col|cols=navy,navy],[fbm|scale=.1|cols=khaki,tan|range=${r}],[${grass}]|colorfunction=texmap(main)`, { label: `range ${r}` })) },
  { number: '5.3', title: 'texmap with wider changes', columns: 4, tile: 144, panels: [0, 0.5, 1, 4].map((f) => recipe(`fbm|scale=.7|textures=[col|cols=navy,navy|fade=${f}],[fbm|scale=.1|cols=khaki,tan|fade=${f}],[${grass}|fade=${f}]|colorfunction=texmap(main)`, { label: `fade ${f}` })) },
  { number: '5.4', title: 'stretch', columns: 2, tile: 300, panels: [recipe('circle|r=.4', { size: '300x150' }), recipe('circle|r=.4|stretch=true', { size: '300x150' })] },
  {
    number: '5.5', title: 'Perturbation', columns: 4, tile: 144,
    panels: ['', '|perturbx=x*y', '|perturbx=x+y', '|perturbx=x+.05*s(x*20)', '|perturbx=y|perturby=x', '|perturbx=x%.2', '|perturbx=x+.2*noise2d(x*2,y*2)', '|perturbx=x+.1*noise2d(x*10,y*10)|perturby=y+.1*noise2d(x*10,y*10)'].map((p) => recipe(`brick|brickheight=.125|switching=true|cols=black,firebrick,orange${p}`, { label: p.slice(1) || 'original' })),
  },
  { number: '5.6', title: 'zoom about the middle', columns: 4, tile: 144, panels: times('checker|scale=.25|afunction=zoom(.5,.5,1+dist(.5,.5)^4*10*(time*2-.5))', [0, 0.33, 0.67, 1]) },
  { number: '5.7', title: 'rotate about the middle', columns: 4, tile: 144, panels: times('checker|scale=.25|afunction=rotate(.5,.5,10*dist(.5,.5)*time)', [0, 0.33, 0.67, 1]) },
  { number: '5.8', title: 'Smears in rows', columns: 3, tile: 180, panels: ['', '|perturby=(y*10)%2', '|perturby=(y*10)%2|perturbx=x+10*noise(floor(y*10)*1.1)'].map((p) => grey(`smear${p}`)) },
  {
    number: '5.10', title: 'Light: diffuse, specular, exponent, height; a lamp and a direction', columns: 4, tile: 144,
    panels: rows(['.2', '.6', '1'].map((v) => recipe(`multi|textures=[${wall}],[star|jags=7|cols=red,gold|alphafunction=step(main,.05)]|diffusescale=${v}`, { label: `diffusescale ${v}` })), ['3'].map((v) => recipe(`multi|textures=[${wall}],[star|jags=7|cols=red,gold|alphafunction=step(main,.05)]|specularscale=${v}`, { label: `specularscale ${v}` })),
      ['.3', '3'].map((v) => recipe(`multi|textures=[${wall}],[star|jags=7|cols=red,gold|alphafunction=step(main,.05)]|specularscale=2|specularcoeffscale=${v}`, { label: `specularcoeffscale ${v}` })), ['0', '3'].map((v) => recipe(`multi|textures=[${wall}],[star|jags=7|cols=red,gold|alphafunction=step(main,.05)]|bumpscale=${v}`, { label: `bumpscale ${v}` })),
      ['-.8', '0', '.8'].map((v) => recipe(`multi|textures=[${wall}]|pointlight=true|lightdist=true|lightz=.3|lighty=0|lightx=${v}`, { label: `lamp at x ${v}` })), [recipe(`multi|textures=[${wall}]|lightx=-1|lighty=0|lightz=.3`, { label: 'direction from the left' })]),
  },
  { number: '5.14', title: 'A channel as it is and normalized', columns: 2, tile: 200, panels: [recipe('voronoi|scale=.3|func=f1*3-.6', { look: 'main' }), recipe('voronoi|scale=.3|func=f1*3-.6', { look: 'main', options: '--normalize' })] },
];

const layers = [
  {
    number: '5.21', title: 'Blend rules: bumpblend interpolate, add, off across; all, specularblend=off, colorblend=off down', columns: 3, tile: 160,
    panels: ['', '|specularblend=off', '|colorblend=off'].flatMap((more) => ['interpolate', 'add', 'off'].map((rule) => recipe(`multi|textures=plaster,[${wall}|alphafunction=main],[star|jags=7|specularfunction=1|specularcoefffunction=60|cols=red,yellow|alphafunction=smoothstep(.05,.3,main)|bumpblend=${rule}${more}]`, { label: rule }))),
  },
  { number: '5.22', title: 'Moss that knows the wall', columns: 4, tile: 160, panels: rows(times(`multi|textures=[${wall}],[fbm|scale=.3|cols=mossy|alphafunction=smoothstep(1-time,1.2-time,main)]`, [0.2, 0.4, 0.6, 0.8]), times(`multi|textures=[${wall}],[fbm|scale=.3|cols=mossy|alphafunction=smoothstep(1-time,1.2-time,main)*(1-lowerbump)]`, [0.2, 0.4, 0.6, 0.8])), differs: '`lowerbump` in place of the wall a second time' },
  { number: '5.23', title: 'Colours changed: shifted, darker, greyer', columns: 4, tile: 144, panels: ['currentcolor', 'hsv((1-hue)%1,saturation,value)', 'hsv(hue,saturation,value*.5)', 'hsv(hue,saturation*.4,value)'].map((f) => recipe(`multi|textures=[${wall}],[base|bumpblend=off|colorfunction=${f}]`, { label: `\`${f}\`` })) },
  { number: '5.24', title: 'Grass by the colour below (5.24 to 5.27)', columns: 4, tile: 144, panels: ['coldist(red)', '1-coldist(red)*2', 'huedist(.3)*4', 'saturation*value'].map((f) => recipe(`multi|textures=[base|colorfunction=hsv(x,1,y)],[${grass}|alphafunction=clampunit(${f})]`, { label: `\`${f}\`` })) },
  { number: '5.28', title: 'A plain picture, textured anew by its colours', columns: 2, tile: 240, panels: ['', ',[plaster|alphafunction=clampunit(coldist(<.45,.25,.12>)*5)],[oak|alphafunction=clampunit(1-coldist(<.45,.25,.12>)*50)]'].map((more) => recipe(`multi|textures=[base|mainfunction=max(max(pulse(.0,.08,mod(x*3,1)),pulse(0,.08,mod(y*3,1))),step(abs(mod(x*3,1)-mod(y*3,1)),-1)*pulse(0,.08,abs(mod(x*3,1)-mod(y*3,1))))|cols=<.93,.9,.82>,<.45,.25,.12>]${more}`)) },
  { number: '5.30', title: 'fixtime: the wall grows coarser, or the dirt grows', columns: 4, tile: 144, panels: rows(times('multi|textures=[fbm|scale=.5|h=.4|cols=<.4,.35,.3>,<.8,.75,.65>|timemodifiers=octaves:1+6*time],[dirt|fixtime=true|time=1]', [0, 0.33, 0.67, 1]), times('multi|textures=[fbm|scale=.5|h=.4|cols=<.4,.35,.3>,<.8,.75,.65>],dirt', [0, 0.33, 0.67, 1])) },
  { number: '5.33', title: 'An explosion over time', columns: 5, tile: 120, panels: times('tmp|timemodifiers=radius:.05+.3*time;turbz:time*2|cols=fire', [0, 0.25, 0.5, 0.75, 1]) },
  { number: '5.35', title: 'Time modifiers that end where they begin', columns: 5, tile: 120, panels: times('noise|scale=.4|periodicmod=true|timemodifiers=du:time;rot:noise(time*3)|cols=navy,white', [0, 0.25, 0.5, 0.75, 1]) },
];

const results = [
  { number: '6.1', title: 'Rust that eats in and rust that lies on', columns: 2, tile: 240, panels: ['sub', 'add'].map((rule) => recipe(`multi|textures=brushed_metal,[rust_on|bumpblend=${rule}],[weave|xwidth=4|ywidth=4|xgap=28|ygap=28|roundthreads=true|cols=black,<.3,.3,.32>|alphafunction=step(main,.05)]`, { label: `bumpblend=${rule}`, options: '--time .7' })) },
  { number: '6.3', title: 'Seeds 1 to 3', columns: 3, tile: 180, panels: rows([1, 2, 3].map((s) => recipe(`worn_leather|seed=${s}`, { options: '--time .8' })), [1, 2, 3].map((s) => recipe(`voronoi|scale=.2|smooth=.6|rooted=true|func=smoothstep(.02,.2,f2-f1)|cols=<.2,.19,.17>,<.6,.57,.5>|seed=${s}`))) },
  { number: '6.4', title: 'As they are, and with seamless=true', columns: 4, tile: 144, panels: ['wood|cols=oak', 'marble|octaves=5|cols=white,<.45,.46,.5>', 'flame|cols=fire', 'mandelbrot|cols=black,navy,white'].flatMap((r) => [recipe(r), recipe(`${r}|seamless=true`)]) },
  { number: '6.5', title: 'Landscapes that move', columns: 4, tile: 160, panels: rows(times('fbm|scale=.6|timemodifiers=zvalue:time*2|cols=navy,<.2,.4,.6>,khaki,<.15,.4,.1>,<.4,.35,.3>,white', [0, 0.33, 0.67, 1]), times('fbm|scale=.6|timemodifiers=h:.1+.9*time|cols=navy,<.2,.4,.6>,khaki,<.15,.4,.1>,<.4,.35,.3>,white', [0, 0.33, 0.67, 1])) },
  { number: '6.7', title: 'Materials that age', columns: 5, tile: 144, panels: ['worn_leather', 'worn_wheel', 'rusty_paint', 'mossy_wall'].flatMap((r) => times(r, [0, 0.25, 0.5, 0.75, 1])) },
  { number: '6.16', title: 'Sponge and fBm, coloured by hue', columns: 1, tile: 320, panels: [recipe('voronoi|scale=.5|octaves=4|cell_initmode=1|initpower=.3|rooted=true|colorfunction=hsv(main*.8,[fbm|scale=.5],.4+.6*main)', { size: 320 })] },
  { number: '6.17', title: 'An overview in bricks (6.17), and one in cells (6.18)', columns: 2, tile: 400, panels: [recipe('brickfunky|types=|scale=.7', { size: 400 }), recipe('voronoifunky|types=|idfilter=|scale=.3', { size: 400 })], differs: 'of the recipes of our library' },
];

/** A handle of brushed steel that is baked and then weathered. */
const steel = ['echo \'{"materials": {"steel": {"texture": "brushed_metal", "size_mm": [30, 30]}}, "assign": [{"part": "*", "material": "steel"}]}\' >steel.json',
  'papilla bake "$DATA/exchange/handle.step" -m steel.json -o handle.glb'];
const weathering = (name, config) => [...steel, `echo '${config}' >${name}.json`, `papilla weather handle.glb -c ${name}.json -o ${name}.glb --report ${name} --pictures`];
const sides = '{"size": 256, "time": [0, 0.5, 1], "layers": [{"recipe": "rust_on|scale=.6|dirtdirection=<-1,0,0>|alphafunction=smoothstep(.9-.8*time,1.1-.8*time,main+.4*normaldot)*min(time*10,1)"}, {"recipe": "moss|scale=.6|dirtdirection=<1,0,0>|alphafunction=smoothstep(1.2-.9*time,1.4-.9*time,main+.5*normaldot)*min(time*10,1)"}, {"recipe": "snow|scale=.6"}]}';
const weathered = [
  {
    number: '5.36', title: 'Dirt by its direction: max(normaldot, 0) to the power ½, 2 and 20; normaldot²; and another direction', columns: 2, tile: 400,
    panels: [['max(normaldot,0)^.5', '<0,-1,0>'], ['max(normaldot,0)^2', '<0,-1,0>'], ['max(normaldot,0)^20', '<0,-1,0>'], ['normaldot^2', '<-1,-1,0>']].map(([f, direction], i) => shell(`\`${f}\` along ${direction}`, `dirt-${i}/time.0000.png`,
      weathering(`dirt-${i}`, `{"size": 128, "layers": [{"recipe": "base|cols=red,red|dirtdirection=${direction}|alphafunction=${f}"}]}`))),
    differs: 'the normal of every texel; one a triangle there',
  },
  {
    number: '6.13', title: 'Rust from the right, snow from above, moss from the left (5.43, 5.44, 6.8, 6.11 to 6.14)', columns: 2, tile: 400,
    panels: [['before', 'before'], ['time 0', 'time.0000'], ['time 0.5', 'time.0001'], ['time 1', 'time.0002']].map(([label, file]) => shell(label, `sides/${file}.png`, weathering('sides', sides))),
    differs: 'an atlas with a normal a texel, in place of a picture for each cluster of normals',
  },
];

export const figures = [...noises, ...regular, ...materials, ...ageing, ...colours, ...layers, ...weathered, ...results];
