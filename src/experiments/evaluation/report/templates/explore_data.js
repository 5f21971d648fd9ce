"use strict";

// What Python stored: `told` has numbers and names, the text of #data every array, packed as explore.py says.
const told = JSON.parse(document.querySelector("#told").textContent);

async function unpack(text) {
  const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Each part becomes an array of columns; one that is not asked for stays packed.
function readScenes(bytes) {
  let at = 0;
  for (const scene of told.scenes) {
    scene.parts = Object.fromEntries(scene.parts.map((part) => {
      const size = part.count * part.width;
      const found = { ...part, low: bytes.subarray(at, at + size), high: bytes.subarray(at + size, at + 2 * size) };
      at += 2 * size;
      return [part.name, found];
    }));
  }
}

// Column k of a part in its own unit: whole numbers are sums of differences, which wrap around at 16 bits.
function column(scene, name, k) {
  const part = scene.parts[name];
  part.columns ??= [];
  if (!part.columns[k]) {
    const values = new Float64Array(part.count);
    let sum = 0;
    for (let row = 0, i = k * part.count; row < part.count; row++, i++) {
      sum = ((sum + part.low[i] + 256 * part.high[i]) << 16) >> 16;
      values[row] = sum * part.step;
    }
    part.columns[k] = values;
  }
  return part.columns[k];
}

// The push on a joint, and its torques behind the observer's low-pass of the trained gain. What a method subtracts from
// the residual is stored in its place, but for the observer itself and a network that predicts the torque without it.
function trained(scene, joint) {
  const k = scene.joints.findIndex(([name]) => name === joint);
  const torques = { truth: column(scene, "truth", k), push: column(scene, "push", k) };
  const observer = scene.methods.find(([, role]) => role === "observer");
  for (const [method, role] of scene.methods) {
    const stored = column(scene, method, k);
    const whole = !observer || role === "observer" || role === "direct";
    torques[method] = whole ? stored : column(scene, observer[0], k).map((torque, i) => torque - stored[i]);
  }
  return torques;
}

// The push behind the low-pass of a gain, from rest.
function lowPassed(push, scene, gain) {
  const pole = Math.exp(-gain / scene.rate), found = new Float64Array(push.length);
  let value = 0;
  for (let k = 1; k < push.length; k++) found[k] = value = pole * value + (1 - pole) * push[k];
  return found;
}

// The same torque behind the low-pass of another gain: the first one undone, (x_k - g x_(k-1)) / (1 - g), and the other
// one applied. For truth, residual and friction this is exact; a network's mean was learned behind the first.
function behind(torque, scene, gain) {
  if (gain === scene.gain) return torque;
  const old = Math.exp(-scene.gain / scene.rate), pole = Math.exp(-gain / scene.rate);
  const scale = (1 - pole) / (1 - old), found = new Float64Array(torque.length);
  let value = torque[0];
  for (let k = 1; k < torque.length; k++) {
    value = pole * value + scale * (torque[k] - old * torque[k - 1]);
    found[k] = value;
  }
  found[0] = torque[0];
  return found;
}

function flag(scene, name, row) {
  return scene.flags[name].some(([start, end]) => row >= start && row < end);
}
