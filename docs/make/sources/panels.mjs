// SPDX-License-Identifier: MIT
// The parts of a figure. A panel is {label, commands, picture, crop}: shell commands that run in the folder of the figure, and what they leave there.

/** What a command of one's own leaves. @param crop WIDTHxHEIGHT+X+Y of the picture that is shown; all without */
export const shell = (label, picture, commands, crop) => ({ label, picture, commands: [commands].flat(), crop });

/**
 * A recipe as `papilla texture` draws it.
 * @param look preview, the lit picture, or the channel that is shown
 */
export const recipe = (text, { label = '', look = 'preview', size = 144, options = '' } = {}) => ({
  label, picture: `{}/${look}.png`,
  commands: [`papilla texture '${text}' -o {} ${look === 'preview' ? '--preview' : `--channels ${look}`} --size ${size}${options && ` ${options}`}`],
});

/** A relief lit from the upper left. @param relief a picture, or millimetres */
export const lit = (label, relief, commands, options = '--pitch 0.1') => shell(label, '{}/relief.png',
  [...[commands].flat(), `papilla height ${relief} --method intensity --transfer linear ${options} -o {}.exr --pictures {}`]);

export const rows = (...lines) => lines.flat();
export const times = (text, list, options = {}) => list.map((time) => recipe(text, { ...options, label: `time ${time}`, options: `--time ${time}` }));
