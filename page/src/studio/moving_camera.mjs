// SPDX-License-Identifier: MIT
// The camera over a canvas: orbits, walks or sits, by the keyboard and as it is told.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

const WALK_MM_PER_S = 900, LOOK_PER_PX = 0.004;

/** Who extends it has what it looks at: box(keys) and seated(), draw(), and changing() where more will follow soon. */
export class MovingCamera {
  constructor(canvas) {
    Object.assign(this, { canvas, mode: 'orbit', keys: new Set() });
    this.camera = new THREE.PerspectiveCamera(50, 1, 1, 1e5);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.changing());
    canvas.addEventListener('keydown', (event) => this.key(event, true));
    canvas.addEventListener('keyup', (event) => this.key(event, false));
    canvas.addEventListener('blur', () => this.keys.clear());
  }

  frame(keys = null) {
    const box = this.box(keys);
    if (box.isEmpty()) return;
    this.setMode('orbit');
    const centre = box.getCenter(new THREE.Vector3()), radius = Math.max(box.getSize(new THREE.Vector3()).length() / 2, 1);
    const far = radius / Math.sin(THREE.MathUtils.degToRad(this.camera.fov / 2)) / Math.min(1, Math.max(this.camera.aspect, 0.4));
    this.near(radius);
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).add(new THREE.Vector3(-0.7, 0.5, 0.75).normalize().multiplyScalar(0.8 * far));
    this.controls.update();
    this.draw();
  }

  /** Where it is and looks, as a matrix. */
  placeOfCamera() { return new THREE.Matrix4().compose(this.camera.position, this.camera.quaternion, this.camera.scale); }

  near(radius) {
    this.camera.near = radius / 1000;
    this.camera.far = radius * 50;
    this.camera.updateProjectionMatrix();
  }

  seat() {
    const box = this.box();
    if (box.isEmpty()) return;
    const { eye, target } = this.seated();
    this.near(box.getSize(new THREE.Vector3()).length() / 4);
    this.camera.position.copy(eye);
    this.setMode('walk');
    this.camera.lookAt(target);
    this.draw();
  }

  setMode(mode) {
    if (mode === 'orbit' && this.mode === 'walk') {
      const ahead = this.camera.getWorldDirection(new THREE.Vector3());
      const box = this.box(), far = box.isEmpty() ? 500 : box.getSize(new THREE.Vector3()).length() / 4;
      this.controls.target.copy(this.camera.position).addScaledVector(ahead, far);
    }
    this.mode = mode;
    this.controls.enabled = mode === 'orbit';
    if (mode === 'orbit') this.controls.update();
    this.draw();
  }

  look(dx, dy) {
    const angles = new THREE.Euler().setFromQuaternion(this.camera.quaternion, 'YXZ');
    angles.y += dx * LOOK_PER_PX;
    angles.x = THREE.MathUtils.clamp(angles.x + dy * LOOK_PER_PX, -1.5, 1.5);
    angles.z = 0;
    this.camera.quaternion.setFromEuler(angles);
    this.changing();
  }

  walk(seconds) {
    const ahead = this.camera.getWorldDirection(new THREE.Vector3()).setY(0).normalize(), right = new THREE.Vector3(-ahead.z, 0, ahead.x);
    const has = (...names) => names.some((name) => this.keys.has(name)) ? 1 : 0, way = WALK_MM_PER_S * seconds * (this.keys.has('shift') ? 0.2 : 1);
    this.camera.position.addScaledVector(ahead, way * (has('w', 'arrowup') - has('s', 'arrowdown')));
    this.camera.position.addScaledVector(right, way * (has('d', 'arrowright') - has('a', 'arrowleft')));
    this.camera.position.y += way * (has('e') - has('q'));
    this.changing();
  }

  orbitBy(azimuth, polar, scale) {
    const from = new THREE.Spherical().setFromVector3(this.camera.position.clone().sub(this.controls.target));
    from.theta += azimuth;
    from.phi = THREE.MathUtils.clamp(from.phi + polar, 0.02, Math.PI - 0.02);
    from.radius *= scale;
    this.camera.position.setFromSpherical(from).add(this.controls.target);
    this.controls.update();
  }

  key(event, down) {
    const name = event.key.toLowerCase();
    if (this.mode === 'walk') {
      if (!/^([wasdqe]|arrow\w+|shift)$/.test(name) || event.ctrlKey || event.metaKey) return;
      event.preventDefault();
      if (down) this.keys.add(name); else this.keys.delete(name);
      if (this.keys.size && !this.walking) this.startWalk();
    } else if (down) {
      const steps = { arrowleft: [-0.12, 0, 1], arrowright: [0.12, 0, 1], arrowup: [0, -0.12, 1], arrowdown: [0, 0.12, 1], '+': [0, 0, 0.85], '=': [0, 0, 0.85], '-': [0, 0, 1.18] };
      if (!steps[name]) return;
      event.preventDefault();
      this.orbitBy(...steps[name]);
    }
  }

  startWalk() {
    this.walking = true;
    let before = performance.now();
    const step = (now) => {
      this.walk(Math.min(0.1, (now - before) / 1000));
      before = now;
      if (this.keys.size) requestAnimationFrame(step); else this.walking = false;
    };
    requestAnimationFrame(step);
  }
}
