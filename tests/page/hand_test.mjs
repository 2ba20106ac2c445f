// SPDX-License-Identifier: MIT
// The studio's arithmetic without a page: directions as angles, places of decals, the way of the hand, what the server says of ticks.
import assert from 'node:assert/strict';
import { axesOf, firstSize, frameOf, isForOnePart, isForSome, movedBy, placedAt, turnOf, turnedTo } from '../../page/src/studio/decal_place.mjs';
import { anchorOf, angleOf, axesAt, directionOf } from '../../page/src/studio/direction.mjs';
import { ticksOf } from '../../page/src/studio/feel_batch.mjs';
import { APPROACH_MM, APPROACH_S, FeelHand, RETREAT_S } from '../../page/src/studio/feel_hand.mjs';
import { vectorText } from '../../page/src/lattice_picture.mjs';

const near = (a, b, tolerance = 1e-6) => a.forEach((x, i) => assert.ok(Math.abs(x - b[i]) <= tolerance, `${a} is not ${b}`));
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);

// Angles: 0 is upright, 90 is the quarter that follows counter-clockwise seen from outside; all of them come back.
near(directionOf(0, axesAt([0, 0, 1], [0, 1, 0])), [0, 1, 0]);
near(directionOf(90, axesAt([0, 0, 1], [0, 1, 0])), [-1, 0, 0]);
for (const normal of [[0.6, 0, 0.8], [-0.48, 0.6, 0.64], [0, 0, 1], [0, -1, 0]]) {
  const axes = axesAt(normal, [0, 0, 1]);
  for (let degrees = 0; degrees < 360; degrees += 7.5) {
    const direction = directionOf(degrees, axes);
    assert.ok(Math.abs(dot(direction, normal)) < 2e-6 && Math.abs(Math.hypot(...direction) - 1) < 2e-6);
    assert.ok(Math.abs(angleOf(direction, axes) - degrees) < 0.06, `${angleOf(direction, axes)} is not ${degrees}`);
    assert.ok(Math.abs(angleOf(direction.map((x, i) => 3 * x + 0.7 * normal[i]), axes) - degrees) < 0.06, 'what points off the surface counts along it');
  }
}
assert.equal(angleOf([0, -1, 0], axesAt([0, 0, 1], [0, 1, 0])), 180);

// The arrow stands on the triangle in the middle of an oblong surface; slivers count for nothing.
const anchor = anchorOf({ positions: [0, 0, 5, 30, 0, 5, 30, 6, 5, 0, 6, 5, 60, 0, 5, 60, 6, 5, 1, 1, 5], indices: [0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2, 6, 6, 6] });
near(anchor.normal, [0, 0, 1]);
assert.ok(anchor.point[0] === 20 || anchor.point[0] === 40);
assert.equal(anchorOf({ positions: [0, 0, 0], indices: [0, 0, 0] }), null);

// Decals: on a wall that looks along +Y, with Z up, the picture's right is to the left of the X axis; turned by 90 degrees its top is there where its left was.
const wall = { ...placedAt([10, 20, 30], [0, 2, 0], [0, 0, 1], 0), size_mm: [80, 20] };
assert.deepEqual([wall.at, wall.direction, wall.up], [[10, 20, 30], [0, -2, 0], [0, 0, 1]]);
near(axesOf(wall).right, [-1, 0, 0]);
near(axesOf(wall).out, [0, 1, 0]);
near(movedBy(wall, 5, 2), [5, 20, 32]);
near(frameOf(wall).corners[0], [50, 20, 20]);
near(frameOf(wall).corners[2], [-30, 20, 40]);
near(frameOf(wall).mark[1], [10, 20, 44]);
const quarter = turnedTo(wall, [0, 0, 1], 90);
near(quarter.up, [1, 0, 0]);
near(axesOf(quarter).right, [0, 0, 1]);
for (const degrees of [0, 30, 90, 270.5, 359]) assert.ok(Math.abs(turnOf(turnedTo(wall, [0, 0, 1], degrees), [0, 0, 1]) - degrees) < 0.06);
assert.equal(turnOf(turnedTo(wall, [0, 0, 1], -10), [0, 0, 1]), 350);
assert.deepEqual(firstSize([200, 100], 2000), { size_mm: [80, 40], depth_mm: 40 });
assert.deepEqual(firstSize([100, 200], 40), { size_mm: [10, 20], depth_mm: 10 });
assert.deepEqual(['part', 'layer'].map((key) => isForSome({ [key]: 'x' })), [true, true]);
assert.equal(isForSome({ picture: 'x.png' }), false);
assert.deepEqual([{ part: 'dash' }, { part: 'a\\*b', node: 'x/y' }, { part: 'dash*' }, { part: 'dash', layer: 'x' }, {}].map(isForOnePart), [true, true, false, false, false]);

// The hand: from outside to the depth, and out again; times increase.
const hand = new FeelHand(0.5);
hand.move([10, 20, 30], [0, 0, 1], 2);
near(hand.at(0), [10, 20, 30 + 0.5 + APPROACH_MM]);
near(hand.at(APPROACH_S), [10, 20, 28.5]);
assert.deepEqual(hand.sample(0.1).slice(0, 3), [0.1, 10, 20]);
assert.equal(hand.sample(0.1), null);
const { samples, end } = hand.lift(0.2);
assert.equal(end, 0.2 + RETREAT_S);
near(samples.at(-1), [end, 10, 20, 30 + 0.5 + APPROACH_MM]);
near(samples[0], [0.2, 10, 20, 28.5]);
assert.ok(samples.every(([t], i) => i === 0 || t > samples[i - 1][0]));
const short = new FeelHand(0.5);
short.move([0, 0, 0], [1, 0, 0], 1);
short.sample(0.01);
assert.ok(short.lift(0.02).end >= APPROACH_S, 'a click comes down before it goes up');

// Ticks.
const columns = ['t', ...['hand', 'probe', 'proxy', 'force', 'normal'].flatMap((name) => ['x', 'y', 'z'].map((axis) => `${name}_${axis}`)), 'contact'];
const [tick, other] = ticksOf({ columns, rows: [0.5, 1, 2, 3, 4, 5, 6, 7, 8, 9, 3, 0, 4, 0, 0, 1, 1, ...Array(16).fill(0), 0] });
assert.deepEqual([tick.t, tick.proxy, tick.total, tick.press, tick.side, tick.contact], [0.5, [7, 8, 9], 5, 4, 3, true]);
assert.deepEqual([other.total, other.contact], [0, false]);

// Vectors of a lattice, whose y runs down.
assert.equal(vectorText([3, -4]), '5 mm, 53.1°');
assert.equal(vectorText([6, 0]), '6 mm, 0°');
