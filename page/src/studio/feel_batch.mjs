// SPDX-License-Identifier: MIT
// What the server says of ticks: rows of numbers by columns.
const length = (v) => Math.hypot(...v);

/** @param event {columns, rows} @returns a tick each: {t, hand, probe, proxy, force, normal, contact, total, press, side} in s, mm, N */
export function ticksOf({ columns, rows }) {
  const at = Object.fromEntries(columns.map((name, i) => [name, i])), ticks = [];
  for (let first = 0; first < rows.length; first += columns.length) {
    const vector = (name) => ['x', 'y', 'z'].map((axis) => rows[first + at[`${name}_${axis}`]]);
    const tick = { t: rows[first + at.t], contact: rows[first + at.contact] === 1 };
    for (const name of ['hand', 'probe', 'proxy', 'force', 'normal']) tick[name] = vector(name);
    tick.total = length(tick.force);
    tick.press = tick.force.reduce((sum, f, i) => sum + f * tick.normal[i], 0);
    tick.side = length(tick.force.map((f, i) => f - tick.press * tick.normal[i]));
    ticks.push(tick);
  }
  return ticks;
}
