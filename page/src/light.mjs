// SPDX-License-Identifier: MIT
// The light of the page: white, and so strong that a surface that faces the camera shows its own colour.
import * as THREE from 'three';

/** Share of the light on a surface that faces the camera that comes from the lamp beside it; the rest from around. */
const LAMP = 0.55;
/** A little more than a surface needs: tone mapping takes off what a white furnace mirrors, and the studio gives less. */
const LIGHT = 1.06;
/** Of the lamp in the frame of the camera: from the upper left, flat enough that grain throws light and shade. */
const LAMP_PLACE = new THREE.Vector3(-0.8, 0.65, 0.65);

/** Radiance from a direction: a bright ceiling with two long windows, walls, a darker floor. */
function radiance(x, y, z) {
  const walls = 0.8 + 0.2 * Math.tanh(2.5 * y);
  const isWindow = y > 0.35 && y < 0.75 && Math.abs(x) > 0.45 && Math.abs(z) < 0.6;
  return walls + (isWindow ? 1.4 : 0);
}

/** Irradiance over π of upright surfaces, averaged over the ways they face: a direction at latitude φ counts cos φ / π. */
function lightOn(values, width, height) {
  let sum = 0;
  for (let j = 0; j < height; ++j)
    for (let i = 0; i < width; ++i) {
      const [x, , z] = directionOf(i, j, width, height), flat = Math.hypot(x, z);
      sum += values[j * width + i] * flat / Math.PI * 2 * Math.PI / width * Math.PI / height * flat;
    }
  return sum / Math.PI;
}

function directionOf(i, j, width, height) {
  const latitude = Math.PI * ((j + 0.5) / height - 0.5), longitude = 2 * Math.PI * (i + 0.5) / width;
  return [Math.cos(latitude) * Math.cos(longitude), Math.sin(latitude), Math.cos(latitude) * Math.sin(longitude)];
}

/** The studio as an equirectangular picture whose irradiance is π times `level` on upright surfaces. */
export function studioTexture(level) {
  const width = 128, height = 64, values = new Float32Array(width * height);
  for (let j = 0; j < height; ++j) for (let i = 0; i < width; ++i) values[j * width + i] = radiance(...directionOf(i, j, width, height));
  const gain = level / lightOn(values, width, height);
  const half = new Uint16Array(4 * width * height), one = THREE.DataUtils.toHalfFloat(1);
  values.forEach((value, i) => half.fill(THREE.DataUtils.toHalfFloat(value * gain), 4 * i, 4 * i + 3));
  for (let i = 3; i < half.length; i += 4) half[i] = one;
  const texture = new THREE.DataTexture(half, width, height, THREE.RGBAFormat, THREE.HalfFloatType, THREE.EquirectangularReflectionMapping,
    THREE.RepeatWrapping, THREE.ClampToEdgeWrapping, THREE.LinearFilter, THREE.LinearFilter);
  texture.needsUpdate = true;
  return texture;
}

/** The studio and the lamp at the camera. */
export function addStudio(world, camera, generator) {
  world.environment = generator.fromEquirectangular(studioTexture(LIGHT * (1 - LAMP))).texture;
  const lamp = new THREE.DirectionalLight(0xffffff, Math.PI * LIGHT * LAMP / (LAMP_PLACE.z / LAMP_PLACE.length()));
  lamp.position.copy(LAMP_PLACE);
  camera.add(lamp, lamp.target);  // it shines past the eye wherever that is
}
