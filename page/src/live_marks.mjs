// SPDX-License-Identifier: MIT
// Probe, proxy and force of a player in the scene, always in front and of the same size on the screen.
import * as THREE from 'three';

/** Of the distance to the camera. */
const MARK = 0.015, ARROW = 0.22;
/** The neighbourhood that is framed first, as a share of the scene and at least in mm. */
const AROUND = 0.04, AROUND_MM = 40;

const UP = new THREE.Vector3(0, 1, 0);
const basic = (color, wireframe = false) => new THREE.MeshBasicMaterial({ color, depthTest: false, transparent: true, wireframe });

export class LiveMarks {
  constructor(three) {
    this.three = three;
    this.probe = new THREE.Mesh(new THREE.SphereGeometry(1, 20, 14), basic(0xff3030));
    this.proxy = new THREE.Mesh(new THREE.OctahedronGeometry(1.3), basic(0xffd000, true));
    this.spring = new THREE.Line(new THREE.BufferGeometry().setAttribute('position', new THREE.BufferAttribute(new Float32Array(6), 3)),
      new THREE.LineBasicMaterial({ color: 0xffd000, depthTest: false, transparent: true }));
    this.arrow = new THREE.Group();
    this.shaft = new THREE.Mesh(new THREE.CylinderGeometry(1, 1, 1, 12).translate(0, 0.5, 0), basic(0x35c0ff));
    this.head = new THREE.Mesh(new THREE.ConeGeometry(1, 1, 16).translate(0, 0.5, 0), basic(0x35c0ff));
    this.arrow.add(this.shaft, this.head);
    this.group = new THREE.Group();
    this.group.add(this.spring, this.arrow, this.proxy, this.probe);
    this.group.traverse((o) => {
      o.renderOrder = 20;
      o.frustumCulled = false;
    });
    this.group.visible = false;
    three.scene.add(this.group);
    three.marks.push(this);
  }

  /** Positions in metres and newtons, as glTF has them; the scene is in mm. @param follow the camera goes along */
  show({ probe, proxy, force, contact }, strongest, follow) {
    this.now = { probe: new THREE.Vector3(...probe).multiplyScalar(1000), proxy: new THREE.Vector3(...proxy).multiplyScalar(1000), force: new THREE.Vector3(...force), strongest };
    this.group.visible = true;
    this.opacity(1);
    this.probe.position.copy(this.now.probe);
    this.proxy.position.copy(this.now.proxy);
    this.spring.geometry.attributes.position.array.set([...this.now.probe, ...this.now.proxy]);
    this.spring.geometry.attributes.position.needsUpdate = true;
    if (follow) this.follow(contact);
    this.three.moved();
  }

  /** What is shown is no longer so. */
  fade() { this.opacity(0.4); this.three.invalidate(); }

  hide() { this.group.visible = false; this.three.invalidate(); }

  opacity(value) { this.group.traverse((o) => { if (o.material) o.material.opacity = value; }); }

  /** First contact: look at it from 30 degrees above the surface. Later: keep it in the middle half of the picture. */
  follow(contact) {
    const { camera, controls } = this.three;
    if (!this.framed && contact && this.now.force.lengthSq() > 0) {
      this.framed = true;
      const up = this.now.force.clone().normalize(), aside = camera.position.clone().sub(controls.target).projectOnPlane(up);
      if (aside.lengthSq() === 0) aside.set(1, 1, 1).projectOnPlane(up);
      camera.position.copy(controls.target).addScaledVector(up, 0.5).addScaledVector(aside.normalize(), 0.87);
      const half = Math.max(AROUND * this.three.size, AROUND_MM) / 2;
      return this.three.frame(new THREE.Box3().setFromCenterAndSize(this.now.proxy, new THREE.Vector3(half, half, half)), 1.2);
    }
    const seen = this.now.proxy.clone().project(camera);
    if (!this.framed || Math.max(Math.abs(seen.x), Math.abs(seen.y)) < 0.5 && seen.z < 1) return;
    const step = this.now.proxy.clone().sub(controls.target);
    camera.position.add(step);
    controls.target.add(step);
    controls.update();
  }

  fit() {
    if (!this.group.visible) return;
    const distance = this.three.camera.position.distanceTo(this.now.proxy) / this.three.camera.zoom, { force, strongest } = this.now;
    this.probe.scale.setScalar(MARK * distance);
    this.proxy.scale.setScalar(MARK * distance);
    this.arrow.visible = strongest > 0 && force.length() > 1e-3 * strongest;
    if (!this.arrow.visible) return;
    const long = ARROW * distance * force.length() / strongest, head = Math.min(0.5 * long, 0.03 * distance);
    this.arrow.position.copy(this.now.proxy);
    this.arrow.quaternion.setFromUnitVectors(UP, force.clone().normalize());
    this.shaft.scale.set(0.2 * head, long - head, 0.2 * head);
    this.head.position.y = long - head;
    this.head.scale.set(0.5 * head, head, 0.5 * head);
  }
}
