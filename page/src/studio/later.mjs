// SPDX-License-Identifier: MIT
const WAIT_MS = 250;

/** Does work a moment after something was typed into a control, or at once when it is left, once. */
export function later(node, work) {
  let timer = 0;
  node.addEventListener('input', () => { clearTimeout(timer); timer = setTimeout(() => { timer = 0; work(); }, WAIT_MS); });
  node.addEventListener('change', () => { if (timer) { clearTimeout(timer); timer = 0; work(); } });
  return node;
}
