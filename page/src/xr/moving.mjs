// SPDX-License-Identifier: MIT
// Where one is in the headset: at the driver's eye, or standing; by thumb stick and by a step to a pointed place.
import * as THREE from 'three';

const SPEED = 1.2, DEAD = 0.2, AIM = 0.6, TURN = Math.PI / 6;
const UP = new THREE.Vector3(0, 1, 0);

export class Moving {
  /** @param rig holds the camera; the world is in metres */
  constructor(three, rig) {
    Object.assign(this, { three, rig });
    this.floor = three.box.min.y / 1000;
    this.ring = new THREE.Mesh(new THREE.RingGeometry(0.12, 0.16, 32).rotateX(-Math.PI / 2), new THREE.MeshBasicMaterial({ color: 0x7cb8ff, toneMapped: false, depthTest: false }));
    this.ring.visible = false;
    this.ring.renderOrder = 25;
    three.world.add(this.ring);
    this.ground = new THREE.Mesh(new THREE.CircleGeometry(6, 48).rotateX(-Math.PI / 2), new THREE.MeshBasicMaterial({ color: 0x3c434b, toneMapped: false }));
    this.ground.position.y = this.floor - 0.002;
    three.world.add(this.ground);
    this.turned = false;
  }

  /** The head in the rig: its place, and the way it looks along the floor. */
  head() {
    const { position, quaternion } = this.three.camera, ahead = new THREE.Vector3(0, 0, -1).applyQuaternion(quaternion).setY(0);
    return { position, turn: Math.atan2(-ahead.x, -ahead.z) };
  }

  /** The head of who wears the headset comes to an eye point (mm) and looks along `ahead`. */
  sit(seat) {
    const { position, turn } = this.head();
    this.rig.rotation.y = Math.atan2(-seat.ahead.x, -seat.ahead.z) - turn;
    this.rig.position.copy(seat.eye).divideScalar(1000).sub(position.clone().applyAxisAngle(UP, this.rig.rotation.y));
  }

  /** On the floor below the head, as tall as one is. */
  stand() { this.rig.position.y = this.floor; }

  /** @param axes of the left and the right stick, @param ray of the right pointer */
  move(left, right, ray, seconds) {
    const { turn } = this.head(), way = new THREE.Vector3(Math.abs(left.x) > DEAD ? left.x : 0, 0, Math.abs(left.y) > DEAD ? left.y : 0);
    this.rig.position.addScaledVector(way.applyAxisAngle(UP, turn + this.rig.rotation.y), SPEED * seconds);
    if (Math.abs(right.x) > AIM && !this.turned) this.turnBy(-Math.sign(right.x) * TURN);
    this.turned = Math.abs(right.x) > AIM;
    if (right.y < -AIM) this.aim(ray);
    else if (this.ring.visible) this.step();
  }

  /** Around the head. */
  turnBy(angle) {
    const offset = this.three.camera.position.clone(), before = offset.clone().applyAxisAngle(UP, this.rig.rotation.y);
    this.rig.rotation.y += angle;
    this.rig.position.add(before).sub(offset.applyAxisAngle(UP, this.rig.rotation.y));
  }

  aim(ray) {
    const floor = new THREE.Plane(UP, -this.floor), at = ray.intersectPlane(floor, new THREE.Vector3());
    this.ring.visible = Boolean(at) && at.distanceTo(ray.origin) < 8;
    if (at) this.ring.position.copy(at).setY(this.floor + 0.005);
  }

  /** To the ring, on one's feet. */
  step() {
    const head = this.three.camera.position.clone().applyAxisAngle(UP, this.rig.rotation.y);
    this.rig.position.set(this.ring.position.x - head.x, this.floor, this.ring.position.z - head.z);
    this.ring.visible = false;
  }

  end() { this.three.world.remove(this.ring, this.ground); }
}
