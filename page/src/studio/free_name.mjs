// SPDX-License-Identifier: MIT
/** The wanted name, with a number behind it where a material of the document has it. */
export function freeName(wanted, materials = {}) {
  let name = wanted;
  for (let i = 2; name in materials; ++i) name = `${wanted} ${i}`;
  return name;
}
