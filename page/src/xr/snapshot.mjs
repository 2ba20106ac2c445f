// SPDX-License-Identifier: MIT
// A picture of what the head sees.
import * as THREE from 'three';

const WIDTH = 640, HEIGHT = 480, DEGREES = 70;

/** As a JPEG in a data URL. @param three of the headset: renderer, world, camera, scene */
export function snapshot({ renderer, world, camera, scene }) {
  const target = new THREE.WebGLRenderTarget(WIDTH, HEIGHT, { colorSpace: THREE.SRGBColorSpace }), shown = renderer.getRenderTarget();
  const eye = new THREE.PerspectiveCamera(DEGREES, WIDTH / HEIGHT, 0.02, 50);
  camera.matrixWorld.decompose(eye.position, eye.quaternion, eye.scale);
  scene.updateMatrixWorld();
  renderer.xr.enabled = false;
  renderer.setRenderTarget(target);
  renderer.render(world, eye);
  const bytes = new Uint8Array(4 * WIDTH * HEIGHT), picture = new ImageData(WIDTH, HEIGHT);
  renderer.readRenderTargetPixels(target, 0, 0, WIDTH, HEIGHT, bytes);
  renderer.setRenderTarget(shown);
  renderer.xr.enabled = true;
  target.dispose();
  for (let y = 0; y < HEIGHT; ++y) picture.data.set(bytes.subarray(4 * WIDTH * (HEIGHT - 1 - y), 4 * WIDTH * (HEIGHT - y)), 4 * WIDTH * y);
  for (let i = 3; i < picture.data.length; i += 4) picture.data[i] = 255;
  const canvas = Object.assign(document.createElement('canvas'), { width: WIDTH, height: HEIGHT });
  canvas.getContext('2d').putImageData(picture, 0, 0);
  return canvas.toDataURL('image/jpeg', 0.8);
}
