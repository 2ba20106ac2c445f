// SPDX-License-Identifier: MIT
// Icons as outlines in a square of 24, in the colour of the text.
const PATHS = {
  seat: 'M8 3v8l1.5 4H17l1 6M9.5 15 8 21M8 5.5h3',
  outside: 'M3 15.5 5 10l4-3.5h6l3.5 3.5 2.5 1v4.5zM7 15.5v2M17 15.5v2M9.5 10h8',
  frame: 'M4 8V4h4M16 4h4v4M20 16v4h-4M8 20H4v-4M9 9h6v6H9z',
  plus: 'M12 5v14M5 12h14',
  minus: 'M5 12h14',
  hand: 'M8 12V6a1.5 1.5 0 0 1 3 0v5V4.5a1.5 1.5 0 0 1 3 0V11 6a1.5 1.5 0 0 1 3 0v8c0 4-2.3 6.5-5.5 6.5-3 0-4.3-1.6-5.6-4L4.2 13.200a1.4 1.4 0 0 1 2.4-1.4L8 14z',
  expand: 'M14 4h6v6M20 4l-7 7M10 20H4v-6M4 20l7-7',
  contrast: 'M12 4a8 8 0 1 0 0 16 8 8 0 0 0 0-16zM12 4v16M12 8h6.500M12 12h8M12 16h6.5',
  headset: 'M4 8h16v9h-5l-2-3h-2l-2 3H4zM7.5 12h2M14.5 12h2M6 8l1.5-2.500h9L18 8',
  list: 'M8 6h12M8 12h12M8 18h12M4 6h.01M4 12h.01M4 18h.01',
  grid: 'M4 4h16v16H4zM4 12h16M12 4v16',
  note: 'M5 4h14v11l-4 5H5zM15 20v-5h4M8 8h8M8 12h5',
  pulse: 'M3 12h4l3-7 4 14 3-7h4',
  sound: 'M4 9v6h4l5 4V5L8 9zM16.5 9a4 4 0 0 1 0 6M19 6.500a8 8 0 0 1 0 11',
  download: 'M12 4v11M7.5 11l4.5 4.500L16.5 11M5 20h14',
  open: 'M4 19V5h6l2 2.500h8V19z',
  remove: 'M5 7h14M10 7V4h4v3M7 7l1 13h8l1-13',
  place: 'M12 21s-6.5-6.5-6.5-11a6.5 6.5 0 0 1 13 0c0 4.5-6.5 11-6.5 11zM12 12.500a2.5 2.5 0 1 0 0-5 2.5 2.5 0 0 0 0 5z',
};

export function icon(name) {
  const space = 'http://www.w3.org/2000/svg', svg = document.createElementNS(space, 'svg'), path = document.createElementNS(space, 'path');
  svg.setAttribute('class', 'i');
  svg.setAttribute('viewBox', '0 0 24 24');
  svg.setAttribute('aria-hidden', 'true');
  path.setAttribute('d', PATHS[name]);
  svg.append(path);
  return svg;
}

/** Puts icons where the page names them. */
export function fillIcons() {
  for (const node of document.querySelectorAll('[data-icon]')) node.replaceWith(icon(node.dataset.icon));
}
