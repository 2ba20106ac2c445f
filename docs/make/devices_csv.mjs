// SPDX-License-Identifier: MIT
// What the player reports of several runs as CSV: node devices_csv.mjs OUT.csv REPORT.json ...
import { readFileSync, writeFileSync } from 'node:fs';

const [out, ...files] = process.argv.slice(2);
const number = (x) => x === null ? 'none' : String(Number(x.toPrecision(3)));
const rows = files.map((file) => JSON.parse(readFileSync(file, 'utf8'))).map((r) => [
  r.device, number(r.stiffness_limit_n_per_m), r.clamped_materials.length, number(r.max_force_n), r.contact_ticks, r.lost_contact_ticks, r.passivity_interventions]);
writeFileSync(out, [['device', 'stiffness limit [N/m]', 'materials clamped', 'largest force [N]', 'contact ticks', 'lost', 'passivity interventions'], ...rows].map((r) => r.join(',')).join('\n') + '\n');
