// SPDX-License-Identifier: MIT
// Every text of the headset.
export const XR = {
  enter: 'Enter VR', leaveVr: 'Leave VR', failed: (why) => `The headset can't be entered: ${why}`,
  part: (name) => `Part: ${name ?? 'point and pull the trigger'}`,
  noSecond: 'B: no second material', second: (name) => `B: ${name}`, before: '◂ B', off: 'B off', after: 'B ▸', groupBefore: '◂', groupAfter: '▸',
  remarks: ['Please look at this', 'Seam is visible', 'Grain too large', 'Grain too small', 'Wrong colour', 'Feels too hard', 'Feels too soft', 'Feels too slippery'],
  remark: (text) => `“${text}” ▸`, note: (n) => `Take note and picture (${n} taken)`,
  sit: 'Sit', stand: 'Stand', leave: 'Leave the headset',
};
