// What is shown is the state; the address holds what of it differs from a step of the story, or from the beginning.
const $ = (selector) => document.querySelector(selector);
const LETTERS = "ABCDEFGH";
const SPEED = 0.25;
const TURNS = [-55, -10, 35, 80, 125, 170, 215, 260]; // azimuths of the view from the robot's heading [deg]
const calm = matchMedia("(prefers-reduced-motion: reduce)"), dark = matchMedia("(prefers-color-scheme: dark)");
let state = {}, drawn = {}, playing = null, look = {}, solids = [], plot = null;

function sceneOf(name) {
  return told.scenes.find((scene) => scene.name === name) ?? told.scenes[0];
}

// Time of the first page and of most steps: the largest force of the push [s] from the beginning of the scene.
function momentOf(scene) {
  const some = scene.start + Math.min(0.3 * scene.rate, (scene.end - scene.start) / 2);
  return (Math.max(scene.point ? largestPush(scene) : 0, Math.round(some)) - scene.lead) / scene.rate;
}

// What a step of the story shows; what it leaves out is as at the beginning.
function stepOf(step) {
  const story = sceneOf("story"), network = networkOf(story);
  const quiet = Math.ceil(quietOf(story, network) ?? story.threshold);
  return {
    1: { t: 0.9, zoom: 4, lines: ["truth"] },
    2: { zoom: 0.4, lines: ["truth", ...story.methods.map(([method]) => method)] },
    3: { zoom: 4, lines: ["truth", "MOB"] },
    4: { zoom: 1, lines: ["truth", "MOB", network], threshold: quiet },
    5: { scene: "hip_step", zoom: 1 },
  }[step] ?? {};
}

function networkOf(scene) {
  return (scene.methods.find(([, role]) => role === "network") ?? scene.methods.at(-1))[0];
}

function quietOf(scene, method) {
  if (!scene.methods.some(([name]) => name === method)) return null;
  scene.quiet ??= alarmsOf(scene, trained(scene, scene.joint)[method], Infinity, calmRows(scene)).quietNm;
  return scene.quiet;
}

function beginning(step, asked) {
  const of = { scene: told.scenes[0].name, ...stepOf(step), ...(asked ? { scene: asked } : {}) };
  const scene = sceneOf(of.scene);
  return {
    step, joint: scene.joint, t: momentOf(scene), gain: scene.gain, threshold: scene.threshold, turn: 0,
    zoom: scene.end - scene.start < 0.5 * scene.rate ? 1 : 4,
    lines: ["truth", ...scene.methods.map(([method]) => method)], guess: "", ...of, scene: scene.name,
  };
}

const NUMBERS = ["step", "t", "gain", "threshold", "zoom", "turn"];

function readState() {
  const wanted = new URLSearchParams(location.hash.slice(1));
  const step = Math.max(0, Math.min(5, Math.round(Number(wanted.get("step")) || 0)));
  const found = beginning(step, wanted.get("scene"));
  for (const [key, text] of wanted) {
    if (!(key in found) || key === "scene" || key === "step") continue;
    if (!NUMBERS.includes(key)) found[key] = key === "lines" ? text.split(",") : text;
    else if (Number.isFinite(Number(text))) found[key] = Number(text);
  }
  return fitting(found);
}

// A state within the page's bounds, whatever the address says.
function fitting(found) {
  const scene = sceneOf(found.scene), { gains, thresholds } = told.settings;
  const within = (value, [low, high]) => Math.max(low, Math.min(high, value));
  found.t = within(found.t, [0, (scene.count - scene.lead - 1) / scene.rate]);
  found.gain = within(found.gain, gains);
  found.threshold = within(found.threshold, thresholds);
  if (![4, 1, 0.4].includes(found.zoom)) found.zoom = 1;
  if (!scene.joints.some(([joint]) => joint === found.joint)) found.joint = scene.joint;
  return found;
}

function address(of) {
  const usual = beginning(of.step, of.scene), parts = [];
  const natural = beginning(of.step).scene;
  if (of.step) parts.push(`step=${of.step}`);
  if (of.scene !== natural) parts.push(`scene=${of.scene}`);
  for (const key of ["joint", "t", "gain", "threshold", "zoom", "turn", "lines", "guess"]) {
    const [value, same] = [of, usual].map((one) => String(key === "t" ? Number(one.t.toFixed(3)) : one[key]));
    if (value !== same) parts.push(`${key}=${value}`);
  }
  return `#${parts.join("&")}`;
}
