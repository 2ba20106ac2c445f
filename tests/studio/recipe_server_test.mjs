// SPDX-License-Identifier: MIT
// What the studio's server says of recipes: completions, mistakes with their places, the outline, layers, looks and
// variations; nothing of it changes the document: node recipe_server_test.mjs PAPILLA DATA FOLDER
import assert from 'node:assert/strict';
import { mkdirSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { ask, end, start } from './studio.mjs';

const [papilla, , folder] = process.argv.slice(2);
rmSync(folder, { recursive: true, force: true });
mkdirSync(join(folder, 'work'), { recursive: true });
const work = join(folder, 'work');
writeFileSync(join(work, 'plate.obj'), 'o plate\nv 0 0 0\nv 40 0 0\nv 40 30 0\nv 0 30 0\nf 1 2 3\nf 1 3 4\n');
writeFileSync(join(folder, 'secret.png'), 'not for the studio');
const RECIPE = 'brick|scale=.5|cols=grey,<.7,.2,.1>';
writeFileSync(join(work, 'm.json'), JSON.stringify({ materials: { wall: { texture: RECIPE, size_mm: [40, 40], show: 'picture' }, hard: { stiffness: 300 } }, assign: [{ part: 'plate', material: 'wall' }] }));

// A document is there before its scene, and without one.
const alone = await start(papilla, ['-m', 'm.json', '--cache', 'none'], { cwd: work });
try {
  const answer = await ask(alone.port, `/recipe-of?token=${alone.token}&material=wall`);
  assert.deepEqual([answer.status, JSON.parse(answer.body).text], [200, RECIPE]);
} finally {
  await end(alone.child, 'SIGKILL');
}

const studio = await start(papilla, ['plate.obj', '-m', 'm.json', '--cache', 'none'], { cwd: work });
try {
  const { port, token } = studio, good = `?token=${token}`, headers = { origin: `http://127.0.0.1:${port}` };
  const post = (path, body) => ask(port, path + good, { method: 'POST', body: JSON.stringify(body), headers });
  const get = async (path, more = '') => { const answer = await ask(port, `${path}${good}${more}`); assert.equal(answer.status, 200, answer.body); return JSON.parse(answer.body); };
  const json = async (path, body) => { const answer = await post(path, body); assert.equal(answer.status, 200, answer.body); return JSON.parse(answer.body); };
  const framed = async (path, body) => {
    const { status, bytes, body: said } = await post(path, body);
    assert.equal(status, 200, said);
    const length = bytes.readUInt32LE(0);
    assert.equal(length % 4, 0);
    return { ...JSON.parse(bytes.subarray(4, 4 + length).toString()), pixels: ({ at, bytes: count }) => bytes.subarray(4 + length + at, 4 + length + at + count) };
  };
  const look = (text, more = {}) => framed('/recipe', { material: 'wall', text, time: 0, side: 64, ...more });
  const before = await get('/state');

  // The language is the library's.
  const language = await get('/recipe-language');
  assert.equal(Object.keys(language.types).length, 32);
  assert.equal(language.types.star.parameters.find(({ name }) => name === 'jags').kind, 'integer');
  assert.ok(language.common.some(({ name }) => name === 'cols') && language.recipes.leather.includes('|'));
  const { text, time } = await get('/recipe-of', '&material=wall');
  assert.deepEqual([text, time], [RECIPE, 0]);
  for (const material of ['hard', 'gone', '']) assert.equal((await ask(port, `/recipe-of${good}&material=${material}`)).status, 409, material);

  // Completions.
  const completed = async (written) => (await json('/recipe-completions', { text: written, cursor: written.length })).all.map(({ insert }) => insert);
  assert.equal((await completed('lea'))[0], 'leather');
  assert.ok((await completed('fbm|oct')).includes('octaves='));
  assert.ok((await completed('base|mainfunction=noi')).includes('noise2d('));
  assert.equal((await completed('')).length, Object.keys(language.types).length + Object.keys(language.recipes).length);

  // A mistake has its place, counted as pages count: the second line, behind letters of two bytes and of two units.
  const written = 'txt|txt=ä€😀\n|octves=3|txt=😀', { problem, look: none, textures } = await look(written);
  assert.deepEqual([problem.line, problem.column, written.slice(problem.position, problem.position + 6)], [2, 2, 'octves']);
  assert.equal(none, null);
  assert.equal(written.slice(...textures[0].parameters[2].value), '😀');
  assert.match((await look('multi|textures=[leather')).problem.reason, /never closed/);
  assert.equal((await look('multi|textures=[leather')).textures, null);
  assert.match((await look('')).problem.reason, /expected a texture/);

  // The outline, and a look in pixels.
  const seen = await look(RECIPE);
  assert.deepEqual([seen.problem, seen.uses_time, seen.needs_atlas, seen.look.width, seen.look.height, seen.surfaces], [null, false, false, 64, 64, null]);
  const [{ parameters: [scale, cols] }] = seen.textures;
  assert.deepEqual([scale.name, RECIPE.slice(...scale.numbers[0].at), scale.numbers[0].value], ['scale', '.5', 0.5]);
  assert.deepEqual(cols.colours.map(({ at }) => RECIPE.slice(...at)), ['grey', '<.7,.2,.1>']);
  assert.deepEqual(cols.colours[1].rgb, [0.7, 0.2, 0.1]);
  for (const map of ['color', 'normal']) assert.equal(seen.pixels(seen.look[map]).length, 4 * 64 * 64);
  const red = await look(RECIPE.replace('<.7,.2,.1>', '<1,0,0>'));
  assert.ok(!red.pixels(red.look.color).equals(seen.pixels(seen.look.color)) && red.pixels(red.look.normal).equals(seen.pixels(seen.look.normal)), 'the colour alone differs');
  assert.equal((await look('rusty_paint')).uses_time, true);

  // One that reads the surface has a look on each surface of its material, as soon as that is laid out, and then at once.
  const SOLID = 'base|mainfunction=.5+.5*s(200*posx)|cols=black,red', laidOut = async (recipe, more) => {
    for (;;) {
      const found = await look(recipe, { side: 128, ...more });
      if (!found.under_way) return found;
      await new Promise((again) => setTimeout(again, 20));
    }
  };
  const onto = await laidOut(SOLID), [only] = onto.surfaces;
  assert.deepEqual([onto.problem, onto.needs_atlas, onto.look, onto.surfaces.length, onto.surface_problems], [null, true, null, 1, []]);
  assert.deepEqual([only.part, only.slot, only.use], [0, 0, 0]);
  for (const map of ['color', 'normal']) assert.equal(onto.pixels(only[map]).length, 4 * only.width * only.height);
  const meshOf = async (name) => {
    const { status, bytes } = await ask(port, `/recipe-atlas${good}&id=${name}`), length = bytes.readUInt32LE(0), { arrays } = JSON.parse(bytes.subarray(4, 4 + length).toString());
    return { status, array: ({ at, count }) => Array.from({ length: count }, (_, i) => bytes.readFloatLE(4 + length + at + 4 * i)), arrays };
  };
  const mesh = await meshOf(only.mesh), places = mesh.array(mesh.arrays.positions), uv = mesh.array(mesh.arrays.uv), rgba = onto.pixels(only.color);
  for (const share of [0.25, 0.5, 0.75]) {  // Along the diagonal from (0, 0) to (40, 30), which both triangles have.
    const corner = (x, y) => { const i = [...places.keys()].find((k) => k % 3 === 0 && Math.hypot(places[k] - x, places[k + 1] - y) < 1e-3) / 3; return [uv[2 * i], uv[2 * i + 1]]; };
    const [a, b] = [corner(0, 0), corner(40, 30)], [u, v] = [0, 1].map((k) => a[k] + share * (b[k] - a[k]));
    const wrap = (n, count) => ((Math.floor(n) % count) + count) % count, texel = wrap(v * only.height, only.height) * only.width + wrap(u * only.width, only.width);
    const wanted = 255 * (0.5 + 0.5 * Math.sin(200 * 0.04 * share));
    assert.ok(Math.abs(rgba[4 * texel] - wanted) < 255 * 0.5 * 200 * 0.001 * 2 && rgba[4 * texel + 1] === 0, `${rgba[4 * texel]} is not ${wanted}`);
  }
  assert.equal((await look(SOLID.replace('200', '90'), { side: 128 })).under_way, 0, 'another recipe that looks at the same has the atlas at once');
  assert.equal((await look(SOLID, { side: 128, material: 'hard' })).surfaces.length, 0, 'of no surface');
  assert.equal((await ask(port, `/recipe-atlas${good}&id=none`)).status, 409);
  // Where the document's recipe reads the surface, another one is shown on the atlas, too.
  await json('/edit', { kind: 'set', material: 'wall', values: { '/texture': SOLID } });
  const plain = await laidOut(RECIPE, { side: 64 });
  assert.deepEqual([plain.needs_atlas, plain.look, plain.surfaces.length], [false, null, 1]);
  assert.ok(plain.pixels(plain.surfaces[0].color).equals(seen.pixels(seen.look.color)), 'its tile');
  await json('/undo', {});
  for (const more of [{ side: 4 }, { side: 5000 }]) assert.ok((await look(RECIPE, more)).problem, JSON.stringify(more));
  for (const more of [{ time: 2 }, { text: 7 }, { side: 'x' }]) assert.equal((await post('/recipe', { material: 'wall', text: RECIPE, time: 0, side: 64, ...more })).status, 409, JSON.stringify(more));
  // No picture from elsewhere.
  for (const path of ['../secret.png', join(folder, 'secret.png'), '/etc/passwd']) assert.ok((await look(`image|picpath=${path}`)).problem, path);

  // The newest look ends the one before.
  const heavy = look('fbm|octaves=19|dynamicoctaves=false', { side: 2048 });
  const quick = [await look(RECIPE), await look(RECIPE)];
  assert.ok(quick.every(({ cancelled }) => !cancelled));
  assert.equal((await heavy).cancelled || (await heavy).look !== null, true);

  // Layers.
  const moved = async (kind, more) => (await json('/recipe-layers', { text: 'multi|textures=leather,[dust|seed=1]', kind, ...more })).text;
  assert.equal(await moved('move', { layer: 2, other: 1, behind: false }), 'multi|textures=[dust|seed=1],leather');
  assert.equal(await moved('insert', { other: 1, behind: true, recipe: 'moss' }), 'multi|textures=leather,[moss],[dust|seed=1]');
  assert.equal(await moved('remove', { layer: 1 }), 'multi|textures=[dust|seed=1]');
  for (const change of [{ kind: 'remove', layer: 0 }, { kind: 'move', layer: 1 }, { kind: 'turn' }, {}]) assert.equal((await post('/recipe-layers', { text: 'multi|textures=leather,dust', ...change })).status, 409, JSON.stringify(change));

  // Pictures, and variations that a seed decides.
  const { pictures, pixels } = await framed('/recipe-pictures', { texts: [RECIPE, 'leather', 'nothing'], time: 0, side: 32 });
  assert.equal(pictures[2], null);
  assert.ok(!pixels(pictures[0]).equals(pixels(pictures[1])) && pixels(pictures[1]).length === 4 * 32 * 32);
  const vary = (seed, strength = 0.3) => framed('/recipe-mutations', { text: 'brick|mortarthickness=.1|round=.5', time: 0, side: 16, count: 3, seed, strength });
  const [first, again, other] = [await vary(1), await vary(1), await vary(4)];
  assert.deepEqual(first.mutations.map((m) => m.text), again.mutations.map((m) => m.text));
  assert.equal(new Set([...first.mutations, ...other.mutations].map((m) => m.text)).size, 6);
  assert.ok(first.mutations.every(({ text: mutant, picture }) => /^brick\|mortarthickness=[\d.]+\|round=[\d.]+$/.test(mutant) && first.pixels(picture).length === 4 * 16 * 16));
  for (const more of [{ strength: 0 }, { strength: 2 }, { count: 65 }, { side: 257 }, { text: 'fbm|' }]) assert.equal((await post('/recipe-mutations', { text: RECIPE, time: 0, side: 16, count: 3, seed: 1, strength: 0.3, ...more })).status, 409, JSON.stringify(more));
  assert.equal((await post('/recipe-pictures', { texts: Array(65).fill('fbm'), time: 0, side: 16 })).status, 409);

  // A text may be longer than the name of a file; it is kept as any other.
  const long = `multi|textures=${Array(60).fill('[dust]').join(',')}`;
  await json('/edit', { kind: 'set', material: 'wall', values: { '/texture': long } });
  assert.equal((await get('/recipe-of', '&material=wall')).text, long);
  await json('/undo', {});

  const after = await get('/state');
  assert.deepEqual([after.document, after.undo], [before.document, null], 'the document is as it was');
} finally {
  await end(studio.child, 'SIGKILL');
}
