// SPDX-License-Identifier: MIT
// Levels of detail are chosen by the share of the picture's height that the sphere around the finest one takes.

/** From how far away on a sphere takes less than a share of the height. @param fov vertical angle of view in degrees, not zoomed */
export const levelDistance = (radius, coverage, fov) => radius / (coverage * Math.tan(fov * Math.PI / 360));
