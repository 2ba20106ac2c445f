// SPDX-License-Identifier: MIT
// The exported shaders give the channels that the evaluator gives: shader_test.mjs FOLDER, written by
// papilla_shader_cases. GLSL in WebGL 2; WGSL in WebGPU where the browser has an adapter.
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { launch } from './browser.mjs';

const folder = resolve(process.argv[2]);
const { width, height, cases } = JSON.parse(readFileSync(join(folder, 'cases.json'), 'utf8'));
const CHANNELS = ['color', 'main', 'bump', 'alpha', 'coloralpha', 'reflection', 'diffuse', 'specular', 'specularcoeff', 'friction', 'stiffness', 'damping', 'roughness'];
const NEAR = 1 / 255;

/** In the page: the floats of all channels as base64, as papilla_shader_cases lays them out. `texel(c, i, k)` reads one. */
const encode = `globalThis.encode = (count, texels, texel) => {
  const floats = new Float32Array((3 + count) * texels);
  for (let i = 0; i < texels; ++i) for (let k = 0; k < 4; ++k) floats[4 * i + k] = texel(0, i, k);
  for (let c = 1; c < count; ++c) for (let i = 0; i < texels; ++i) floats[(3 + c) * texels + i] = texel(c, i, 0);
  const bytes = new Uint8Array(floats.buffer);
  let text = '';
  for (let i = 0; i < bytes.length; i += 0x8000) text += String.fromCharCode(...bytes.subarray(i, i + 0x8000));
  return btoa(text);
}`;

/** Renders all channels with WebGL 2. */
function renderGlsl([source, width, height, count]) {
  const gl = globalThis.context ??= (() => {
    const made = Object.assign(document.createElement('canvas'), { width, height }).getContext('webgl2');
    made.getExtension('EXT_color_buffer_float');
    made.bindFramebuffer(made.FRAMEBUFFER, made.createFramebuffer());
    made.bindTexture(made.TEXTURE_2D, made.createTexture());
    made.texStorage2D(made.TEXTURE_2D, 1, made.RGBA32F, width, height);
    made.framebufferTexture2D(made.FRAMEBUFFER, made.COLOR_ATTACHMENT0, made.TEXTURE_2D, made.getParameter(made.TEXTURE_BINDING_2D), 0);
    return made;
  })();
  const compile = (type, text) => {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    return shader;
  };
  const program = gl.createProgram();
  gl.attachShader(program, compile(gl.VERTEX_SHADER, '#version 300 es\nvoid main() { gl_Position = vec4(float((gl_VertexID << 1) & 2) * 2.0 - 1.0, float(gl_VertexID & 2) * 2.0 - 1.0, 0.0, 1.0); }'));
  gl.attachShader(program, compile(gl.FRAGMENT_SHADER, source));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  gl.useProgram(program);
  gl.viewport(0, 0, width, height);
  const channel = gl.getUniformLocation(program, 'u_channel');
  const all = [];
  for (let c = 0; c < count; ++c) {
    gl.uniform1i(channel, c);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    const pixels = new Float32Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, pixels);
    all.push(pixels);
  }
  gl.deleteProgram(program);
  const upwards = (i) => (height - 1 - Math.floor(i / width)) * width + i % width;
  return encode(count, width * height, (c, i, k) => all[c][4 * upwards(i) + k]);
}

/** The same with WebGPU. */
async function renderWgsl([source, width, height, count]) {
  const device = globalThis.device ??= await (await navigator.gpu.requestAdapter()).requestDevice();
  device.pushErrorScope('validation');
  const module = device.createShaderModule({ code: source });
  const wrong = (await module.getCompilationInfo()).messages.filter((m) => m.type === 'error');
  if (wrong.length) throw new Error(wrong.map((m) => `${m.lineNum}: ${m.message}`).join('\n'));
  const pipeline = await device.createRenderPipelineAsync({ layout: 'auto', vertex: { module, entryPoint: 'papilla_corner' }, fragment: { module, entryPoint: 'papilla_fragment', targets: [{ format: 'rgba32float' }] }, primitive: { topology: 'triangle-list' } });
  const texture = device.createTexture({ size: [width, height], format: 'rgba32float', usage: GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC });
  const uniform = device.createBuffer({ size: 4, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST });
  const bytesPerRow = Math.ceil(16 * width / 256) * 256;
  const buffer = device.createBuffer({ size: bytesPerRow * height, usage: GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ });
  const bindGroup = device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries: [{ binding: 0, resource: { buffer: uniform } }] });
  const all = [];
  for (let c = 0; c < count; ++c) {
    device.queue.writeBuffer(uniform, 0, new Int32Array([c]));
    const encoder = device.createCommandEncoder();
    const pass = encoder.beginRenderPass({ colorAttachments: [{ view: texture.createView(), loadOp: 'clear', storeOp: 'store' }] });
    pass.setPipeline(pipeline);
    pass.setBindGroup(0, bindGroup);
    pass.draw(3);
    pass.end();
    encoder.copyTextureToBuffer({ texture }, { buffer, bytesPerRow }, [width, height]);
    device.queue.submit([encoder.finish()]);
    await buffer.mapAsync(GPUMapMode.READ);
    all.push(new Float32Array(buffer.getMappedRange()).slice());
    buffer.unmap();
  }
  const error = await device.popErrorScope();
  if (error) throw new Error(error.message);
  return encode(count, width * height, (c, i, k) => all[c][bytesPerRow / 4 * Math.floor(i / width) + 4 * (i % width) + k]);
}

const floats = (bytes) => new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));

/** Texels of any channel that differ by more than 1/255 of what it spans, and the largest difference. */
function compare(name, rendered) {
  const expected = floats(readFileSync(join(folder, `${name}.f32`))), texels = width * height, far = new Set();
  if (rendered.length !== expected.length) throw new Error(`${rendered.length} numbers in place of ${expected.length}`);
  let most = 0, where = '';
  CHANNELS.forEach((channel, c) => {
    const first = c === 0 ? 0 : (3 + c) * texels, parts = c === 0 ? 4 : 1;
    let span = 1;  // of channels that are not in [0, 1], such as the specular exponent
    for (let n = 0; n < parts * texels; ++n) span = Math.max(span, Math.abs(expected[first + n]));
    for (let n = 0; n < parts * texels; ++n) {
      const difference = Math.abs(rendered[first + n] - expected[first + n]) / span, i = Math.floor(n / parts);
      if (!(difference <= NEAR)) far.add(i);
      if (!(difference <= most)) most = difference, where = `${channel} at ${i % width},${Math.floor(i / width)}`;
    }
  });
  return { name, far: far.size, most, where };
}

/** Formulas that jump: a texel within float's rounding of a jump may fall to its other side. */
const MOST_FAR = 0.001;

async function check(page, extension, render) {
  let failures = 0;
  const report = [];
  for (const one of cases) {
    if (one.refused) continue;
    try {
      const rendered = await page.evaluate(render, [readFileSync(join(folder, one.name + extension), 'utf8'), width, height, CHANNELS.length]);
      const found = compare(one.name, floats(Buffer.from(rendered, 'base64')));
      report.push({ ...found, recipe: one.recipe });
      if (found.far > MOST_FAR * width * height) {
        ++failures;
        console.log(`${one.name}${extension}: ${found.far} texels differ, by ${found.most.toFixed(4)} at most, ${found.where}: ${one.recipe}`);
      }
    } catch (error) {
      ++failures;
      console.log(`${one.name}${extension}: ${error.message.slice(0, 600)}`);
    }
  }
  const exact = report.filter((r) => r.far === 0).length;
  console.log(`${extension}: ${report.length} recipes, ${exact} of them within 1/255 at every texel of every channel; the others: ${report.filter((r) => r.far > 0).map((r) => `${r.name} ${r.far}`).join(', ') || 'none'}`);
  writeFileSync(join(folder, `report${extension}.json`), JSON.stringify(report, null, 1));
  return failures;
}

const browser = await launch(['--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader', '--enable-features=Vulkan']);
const page = await browser.newPage();
writeFileSync(join(folder, 'blank.html'), '<!doctype html><title>shaders</title>');
await page.goto(pathToFileURL(join(folder, 'blank.html')).href);
await page.evaluate(encode);
let failures = await check(page, '.frag', renderGlsl);
const hasAdapter = await page.evaluate(async () => Boolean(navigator.gpu && await navigator.gpu.requestAdapter())).catch(() => false);
if (hasAdapter && existsSync(join(folder, 'type_noise.wgsl'))) failures += await check(page, '.wgsl', renderWgsl);
else console.log('.wgsl: not checked, the browser has no WebGPU adapter');
await browser.close();
if (failures) {
  console.log(`${failures} failures`);
  process.exit(1);
}
