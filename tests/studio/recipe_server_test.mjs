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
  const { text, time, needs_atlas: isSolid } = await get('/recipe-of', '&material=wall');
  assert.deepEqual([text, time, isSolid], [RECIPE, 0, false]);
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
  assert.deepEqual([seen.problem, seen.uses_time, seen.needs_atlas, seen.look.side], [null, false, false, 64]);
  const [{ parameters: [scale, cols] }] = seen.textures;
  assert.deepEqual([scale.name, RECIPE.slice(...scale.numbers[0].at), scale.numbers[0].value], ['scale', '.5', 0.5]);
  assert.deepEqual(cols.colours.map(({ at }) => RECIPE.slice(...at)), ['grey', '<.7,.2,.1>']);
  assert.deepEqual(cols.colours[1].rgb, [0.7, 0.2, 0.1]);
  for (const map of ['color', 'normal']) assert.equal(seen.pixels(seen.look[map]).length, 4 * 64 * 64);
  const red = await look(RECIPE.replace('<.7,.2,.1>', '<1,0,0>'));
  assert.ok(!red.pixels(red.look.color).equals(seen.pixels(seen.look.color)) && red.pixels(red.look.normal).equals(seen.pixels(seen.look.normal)), 'the colour alone differs');
  assert.equal((await look('rusty_paint')).uses_time, true);
  assert.equal((await look('base|mainfunction=posx')).needs_atlas, true);
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
