// SPDX-License-Identifier: MIT
// usage: node three.mjs IN.glb OUT.glb: what three.js's GLTFLoader reads, its GLTFExporter writes. Without a browser
// three.js reads no pictures: what is looked at is materials and meshes.
import { readFileSync, writeFileSync } from 'node:fs';

globalThis.self = globalThis;
globalThis.ProgressEvent ??= class {};
globalThis.FileReader ??= class {
  readAsArrayBuffer(blob) {
    blob.arrayBuffer().then((buffer) => {
      this.result = buffer;
      this.onloadend?.();
    });
  }
};
const { GLTFLoader } = await import('three/examples/jsm/loaders/GLTFLoader.js');
const { GLTFExporter } = await import('three/examples/jsm/exporters/GLTFExporter.js');
console.warn = console.error = () => {};
const [source, target] = process.argv.slice(2);
const bytes = readFileSync(source);
const gltf = await new GLTFLoader().parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength), '');
gltf.scene.traverse((object) => {
  if (object.material) object.material.normalMap = object.material.map = null;
});
writeFileSync(target, Buffer.from(await new GLTFExporter().parseAsync(gltf.scene, { binary: true })));
