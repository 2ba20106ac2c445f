// SPDX-License-Identifier: MIT
// Notes that the studio keeps: node review_test.mjs PAPILLA DATA FOLDER
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { parseReview } from '../../page/src/review_file.mjs';
import { connect } from './socket.mjs';
import { ask, end, start } from './studio.mjs';

const [papilla, , folder] = process.argv.slice(2);
rmSync(folder, { recursive: true, force: true });
mkdirSync(join(folder, 'materials'), { recursive: true });
writeFileSync(join(folder, 'plate.obj'), 'o plate\nv 0 0 0\nv 40 0 0\nv 40 30 0\nv 0 30 0\nf 1 2 3\nf 1 3 4\n');
writeFileSync(join(folder, 'materials/m.json'), '{"materials": {"hard": {"stiffness": 300}}, "assign": [{"part": "plate", "material": "hard"}]}');
const file = join(folder, 'materials/review.json'), text = () => JSON.parse(readFileSync(file, 'utf8'));
const note = (id, more = {}) => ({ id, text: 'Seam is visible', part: 'plate', material: 'hard', place_m: [0.01, 0.02, 0.003], view: 'textured', camera: { position_m: [0, 0.1, 0.3], look: [0, 0, -1] }, taken_in: 'headset', time: '2026-01-01T00:00:00Z', ...more });

const run = () => start(papilla, ['plate.obj', '-m', 'materials/m.json', '--cache', 'none'], { cwd: folder });
let studio = await run();
const asker = ({ port, token }) => async (method, body) => {
  const answer = await ask(port, `/review?token=${token}`, { method, ...(body === undefined ? {} : { body: JSON.stringify(body), headers: { origin: `http://127.0.0.1:${port}` } }) });
  return { status: answer.status, json: JSON.parse(answer.body) };
};
let review = asker(studio);
const page = await connect(studio);

// None, then two; each change is in the file at once, told to all pages, and nothing lies beside it.
assert.deepEqual((await review('GET')).json, { papilla_review: 1, scene: 'plate.obj', notes: [] });
const before = page.events.length;
assert.equal((await review('POST', { put: note('a') })).status, 200);
await page.next(({ event }) => event === 'review', before);
assert.deepEqual(text(), { papilla_review: 1, scene: 'plate.obj', notes: [note('a')] });
await review('POST', { put: note('b', { text: 'Grain too large', picture: `data:image/jpeg;base64,${'A'.repeat(90000)}` }) });
await review('POST', { put: note('a', { text: 'Seam is gone' }) });
assert.deepEqual(text().notes.map(({ id, text: said }) => [id, said]), [['a', 'Seam is gone'], ['b', 'Grain too large']]);
assert.deepEqual(readdirSync(join(folder, 'materials')).sort(), ['m.json', 'review.json']);
assert.equal(parseReview(JSON.stringify(text())).length, 2, 'pages read it');

// What is none changes nothing.
for (const body of [
  {}, { put: note('c'), remove: 'a' }, { put: 1 }, { put: { ...note('c'), id: 7 } }, { put: note('c', { text: 'x'.repeat(10001) }) }, { put: note('c', { place_m: [0, 0] }) },
  { put: note('c', { place_m: ['0', 0, 0] }) }, { put: note('c', { camera: { look: [0, 0, 1] } }) }, { put: note('c', { picture: 'http://evil.example/x.png' }) }, { remove: 3 },
]) assert.equal((await review('POST', body)).status, 409, JSON.stringify(body));
assert.equal(text().notes.length, 2);
assert.equal((await review('POST', { remove: 'none' })).json.notes.length, 2);

// Read again on start; notes of another program get a name, and what is unknown stays.
page.close();
await end(studio.child);
writeFileSync(file, JSON.stringify({ papilla_review: 1, scene: 'plate.glb', by: 'someone', notes: [...text().notes, { ...note(), id: undefined, extra: 1 }] }));
studio = await run();
review = asker(studio);
assert.deepEqual((await review('GET')).json.notes.map(({ id }) => id), ['a', 'b', 'note-3']);
const left = await review('POST', { remove: 'a' });
assert.deepEqual(left.json.notes.map(({ id }) => id), ['b', 'note-3']);
assert.equal(text().by, 'someone');
assert.equal(text().notes[1].extra, 1);

// A file that is no review is left alone.
writeFileSync(file, '{"papilla_review": 9, "notes": []}');
assert.match((await review('GET')).json.error, /review\.json: is no review of version 1/);
assert.equal((await review('POST', { put: note('z') })).status, 409);
assert.deepEqual(text(), { papilla_review: 9, notes: [] });
await end(studio.child, 'SIGKILL');
