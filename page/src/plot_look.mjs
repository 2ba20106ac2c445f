// SPDX-License-Identifier: MIT
// What the plots of the page share: axes in the page's colours, a legend that shows dashes, too.

const ink = () => getComputedStyle(document.body).color, line = () => getComputedStyle(document.body).getPropertyValue('--line');

/** @param more what else uPlot shall know of the axis */
export const axis = (label, more = {}) => ({ label, labelSize: 20, size: label === 'seconds' ? 32 : 46, stroke: ink, grid: { stroke: line, width: 1 }, ticks: { stroke: line, width: 1 }, ...more });

/** Whole powers of ten within a logarithmic scale, with 2 and 5 where there are few. */
export function logSplits(low, high) {
  const first = Math.floor(Math.log10(low)), last = Math.ceil(Math.log10(high)), splits = [];
  for (let k = first; k <= last; ++k) for (const digit of last - first > 2 ? [1] : [1, 2, 5]) splits.push(Number((digit * 10 ** k).toPrecision(1)));
  return splits.filter((value) => value >= low * 0.999 && value <= high * 1.001);
}

/** The marks in a legend are drawn like their curves. */
export const legend = { live: false, markers: { width: 3, dash: (plot, i) => plot.series[i].dash ? 'dashed' : 'solid' } };
