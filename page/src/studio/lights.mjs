// SPDX-License-Identifier: MIT
// What lights the scene: a studio, the sky, a night, a picture of one's own. Each gives an environment and a sun.
import * as THREE from 'three';
import { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';
import { Sky } from 'three/addons/objects/Sky.js';

function studio() { return { scene: new RoomEnvironment(), blur: 0.04, intensity: 0.7, sun: 0xffffff, power: 1.2, from: [0.5, 1, 0.7], back: null }; }

function sky() {
  const scene = new THREE.Scene(), dome = new Sky();
  dome.scale.setScalar(1000);
  const direction = new THREE.Vector3().setFromSphericalCoords(1, THREE.MathUtils.degToRad(52), THREE.MathUtils.degToRad(140));
  Object.assign(dome.material.uniforms.turbidity, { value: 6 });
  Object.assign(dome.material.uniforms.rayleigh, { value: 1.6 });
  dome.material.uniforms.sunPosition.value.copy(direction);
  scene.add(dome);
  return { scene, blur: 0, intensity: 0.35, sun: 0xfff1dc, power: 2.2, from: direction.toArray(), back: 0x8fb4d8 };
}

function night() {
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(0x05070c);
  const lamp = (x, y, z, w, h, colour, power) => {
    const panel = new THREE.Mesh(new THREE.PlaneGeometry(w, h), new THREE.MeshBasicMaterial({ color: new THREE.Color(colour).multiplyScalar(power), side: THREE.DoubleSide }));
    panel.position.set(x, y, z);
    panel.lookAt(0, 0, 0);
    scene.add(panel);
  };
  lamp(-6, 7, -3, 2, 2, 0xffc27a, 14);
  lamp(8, 6, 5, 1.5, 1.5, 0x9fc4ff, 10);
  lamp(0, 9, 9, 1, 4, 0xffd9a8, 5);
  return { scene, blur: 0.03, intensity: 0.8, sun: 0x9fb8e8, power: 0.25, from: [-0.4, 1, -0.3], back: 0x05070c };
}

const MAKERS = { studio, sky, night };

export class Lights {
  constructor(renderer, world) {
    Object.assign(this, { world, made: new Map(), pmrem: new THREE.PMREMGenerator(renderer) });
    this.sun = new THREE.DirectionalLight(0xffffff, 1);
    world.add(this.sun, this.sun.target);
  }

  use(name) {
    if (!this.made.has(name)) {
      const light = MAKERS[name]();
      light.texture = this.pmrem.fromScene(light.scene, light.blur, 0.1, 2000).texture;
      delete light.scene;
      this.made.set(name, light);
    }
    this.apply(this.made.get(name));
  }

  /** An equirectangular picture: any that the browser shows. */
  async useOwn(file) {
    const bitmap = await createImageBitmap(file, { imageOrientation: 'flipY' });
    const texture = new THREE.Texture(bitmap);
    texture.flipY = false;
    texture.colorSpace = THREE.SRGBColorSpace;
    texture.mapping = THREE.EquirectangularReflectionMapping;
    texture.needsUpdate = true;
    this.apply({ texture: this.pmrem.fromEquirectangular(texture).texture, intensity: 1, sun: 0xffffff, power: 0.4, from: [0.5, 1, 0.7], back: null });
  }

  apply({ texture, intensity, sun, power, from, back }) {
    this.world.environment = texture;
    this.world.environmentIntensity = intensity;
    this.sun.color.set(sun);
    this.sun.intensity = power;
    this.sun.position.set(...from).multiplyScalar(1e4);
    this.back = back;
  }
}
