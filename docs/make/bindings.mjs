// SPDX-License-Identifier: MIT
// The declarations of io/c/include/papilla/io/papilla_haptic.h in the languages of engines, between the lines
// "generated from papilla_haptic.h" and "end of what is generated" of the files in examples/.
// usage: node bindings.mjs ROOT [--check]     --check: exit 1 when a file holds something else
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

const [root, mode] = process.argv.slice(2);
const header = readFileSync(join(root, 'io/c/include/papilla/io/papilla_haptic.h'), 'utf8');

// The header is regular: one struct member or enumerator a line, functions marked with PAPILLA_HAPTIC_API.
const code = header.replace(/\/\*[\s\S]*?\*\//g, '').replace(/\s+\n/g, '\n');
const fail = (what) => {
  throw new Error(`papilla_haptic.h: ${what}`);
};

function declaration(text) {
  const found = /^(.*[\s*])(\w+)(\[\d+\])?$/.exec(text.trim());
  if (!found) fail(`no declaration: ${text}`);
  return { type: found[1].trim().replace(/\s*\*/g, '*'), name: found[2], array: found[3] ?? '' };
}

const constants = [...code.matchAll(/^#define (PAPILLA_HAPTIC_\w+) (\d+)$/gm)].map((m) => ({ name: m[1], value: m[2] }));
const enums = [...code.matchAll(/typedef enum (\w+) \{([\s\S]*?)\} \1;/g)].map((m) => ({
  name: m[1],
  values: m[2].split(',').filter((v) => v.trim()).map((v) => v.trim().split(/\s*=\s*/)),
}));
const structs = [...code.matchAll(/typedef struct (\w+) \{([\s\S]*?)\} \1;/g)].map((m) => ({
  name: m[1],
  members: m[2].split(';').filter((v) => v.trim()).map(declaration),
}));
const functions = [...code.matchAll(/PAPILLA_HAPTIC_API\s+([^(]+)\(([^)]*)\);/g)].map((m) => ({
  ...declaration(m[1]),
  parameters: m[2].trim() === 'void' ? [] : m[2].split(',').map(declaration),
}));
if (functions.length !== (code.match(/^PAPILLA_HAPTIC_API /gm) ?? []).length) fail('a function was not read');

const pascal = (name) => name.replace(/^papilla_haptic_?/i, '').toLowerCase().replace(/(^|_)(\w)/g, (_, __, c) => c.toUpperCase());
const camel = (name) => name.replace(/_(\w)/g, (_, c) => c.toUpperCase());

const csharpValues = { int32_t: 'int', int64_t: 'long', uint32_t: 'uint', uint64_t: 'ulong', double: 'double', size_t: 'UIntPtr' };
function csharpType({ type, array }, isParameter) {
  const plain = type.replace(/^const /, '');
  const constant = plain !== type;
  if (csharpValues[plain]) {
    if (!array) return csharpValues[plain];
    return `${constant ? '[In]' : '[Out]'} ${csharpValues[plain]}[]`;
  }
  if (plain === 'papilla_haptic*') return 'IntPtr';
  if (plain === 'char*') return isParameter ? (constant ? 'byte[]' : '[Out] byte[]') : 'IntPtr';
  if (plain === 'double*' && isParameter) return `${constant ? '[In]' : '[Out]'} double[]`;
  const struct = structs.find((s) => plain === `${s.name}*`);
  if (struct && isParameter) return `ref ${pascal(struct.name)}`;
  return fail(`no C# type for ${type}${array}`);
}

function csharp() {
  const lines = [];
  for (const { name, value } of constants) lines.push(`    public const int ${pascal(name)} = ${value};`);
  for (const { name, values } of enums) {
    lines.push('', `    public enum ${pascal(name)}`, '    {');
    for (const [key, value] of values) lines.push(`        ${pascal(key)} = ${value},`);
    lines.push('    }');
  }
  for (const { name, members } of structs) {
    lines.push('', '    [StructLayout(LayoutKind.Sequential)]', `    public struct ${pascal(name)}`, '    {');
    for (const m of members) lines.push(`        public ${csharpType(m, false)} ${camel(m.name)};`);
    lines.push('    }');
  }
  for (const f of functions) {
    const parameters = f.parameters.map((p) => `${csharpType(p, true)} ${camel(p.name)}`).join(', ');
    lines.push("", '    [DllImport("papilla", CallingConvention = CallingConvention.Cdecl)]');
    lines.push(`    public static extern ${csharpType(f, false)} ${f.name}(${parameters});`);
  }
  return lines.join('\n');
}

// A list of F(result, name, (parameters)) for a table of functions that are loaded at run time.
function unreal() {
  const shown = (d) => `${d.type}${d.type.endsWith('*') ? '' : ' '}${d.name}${d.array}`.replace(/\*(\w)/, '* $1');
  const lines = functions.map((f) => `\tF(${f.type}, ${f.name}, (${f.parameters.map(shown).join(', ')}))`);
  return `#define PAPILLA_HAPTIC_FUNCTIONS(F) \\\n${lines.join(' \\\n')}`;
}

let differ = false;
for (const [file, text] of [['examples/unity/PapillaHaptic.cs', csharp()], ['examples/unreal/PapillaHaptic.h', unreal()]]) {
  const path = join(root, file);
  const old = readFileSync(path, 'utf8');
  const parts = /^([\s\S]*?\/\/ Generated from papilla_haptic\.h.*\n)([\s\S]*?)(\n[ \t]*\/\/ End of what is generated\.[\s\S]*)$/.exec(old);
  if (!parts) throw new Error(`${file}: has no place for what is generated`);
  const now = parts[1] + text + parts[3];
  if (now === old) continue;
  if (mode === '--check') {
    console.error(`${file}: is not what papilla_haptic.h says; node docs/make/bindings.mjs .`);
    differ = true;
  } else {
    writeFileSync(path, now);
  }
}
process.exit(differ ? 1 : 0);
