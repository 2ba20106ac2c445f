// SPDX-License-Identifier: MIT
// Checks that every npm package named by a lock file runs on Debian 12's Node.js and comes from the default registry.
// usage: node check_packages.mjs ROOT     Prints one line per breach, exits 1 if any.
import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';

const OLDEST = [18, 20, 4];  // Debian 12's nodejs
const NOT_OURS = ['.git', 'build', 'demo', 'node_modules'];
const REGISTRY = 'https://registry.npmjs.org/';

/** Negative, zero or positive, as a is older than, equal to or newer than b; missing parts count as zero. */
const compare = (a, b) => [0, 1, 2].reduce((order, i) => order || (a[i] ?? 0) - (b[i] ?? 0), 0);

/** Whether a version satisfies one comparator of a range, such as ">=18", "^18.17.0" or "18.x". */
function satisfies(version, comparator) {
  const found = /^(>=|<=|>|<|\^|~|=)?v?(\d+|[x*])?(?:\.(\d+|[x*]))?(?:\.(\d+|[x*]))?$/.exec(comparator);
  if (!found) throw new Error(`unknown range of versions: ${comparator}`);
  const parts = found.slice(2).filter((part) => /^\d+$/.test(part)).map(Number);
  if (parts.length === 0) return true;
  const order = compare(version, parts);
  const same = (count) => parts.slice(0, count).every((part, i) => part === version[i]);
  switch (found[1]) {
    case '>=': return order >= 0;
    case '<': return order < 0;
    case '>': return order > 0 && !same(parts.length);
    case '<=': return order <= 0 || same(parts.length);
    case '^': return order >= 0 && same(1);
    case '~': return order >= 0 && same(Math.min(2, parts.length));
    default: return same(parts.length);
  }
}

const admits = (range, version) => range.replace(/(>=|<=|>|<|\^|~|=)\s+/g, '$1').split('||')
  .some((set) => set.trim().split(/\s+/).every((comparator) => satisfies(version, comparator)));

const root = process.argv[2];
const read = (path) => JSON.parse(readFileSync(join(root, path), 'utf8'));
let breaches = 0;
const breach = (path, text) => {
  console.log(`${path}: ${text}`);
  ++breaches;
};

/** The folders below one that hold a package.json. */
function packages(folder) {
  const entries = readdirSync(join(root, folder), { withFileTypes: true });
  const below = entries.filter((entry) => entry.isDirectory() && !NOT_OURS.includes(entry.name));
  return [...entries.filter((entry) => entry.name === 'package.json').map(() => folder),
    ...below.flatMap((entry) => packages(join(folder, entry.name)))];
}

for (const folder of packages('')) {
  const manifest = join(folder, 'package.json'), lock = join(folder, 'package-lock.json');
  if (read(manifest).engines?.node !== `>=${OLDEST[0]}`) breach(manifest, `"engines" must hold "node": ">=${OLDEST[0]}"`);
  for (const [path, { engines, resolved = REGISTRY }] of Object.entries(read(lock).packages)) {
    if (engines?.node && !admits(engines.node, OLDEST)) breach(lock, `${path} needs Node.js ${engines.node}`);
    if (!resolved.startsWith(REGISTRY)) breach(lock, `${path} comes from ${resolved}`);
  }
}
process.exitCode = breaches === 0 ? 0 : 1;
