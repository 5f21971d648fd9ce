// What is seen follows the state: texts, controls and pictures, and what a reader does with them.
// Change the state, draw it, and put it into the address: as a new place where somebody may want to go back from it.
function change(parts, isPlace = false) {
  state = fitting({ ...state, ...parts });
  show();
  if (!playing) keep(isPlace);
}

let kept = 0;
function keep(isPlace) {
  clearTimeout(kept);
  if (isPlace) return history.pushState(null, "", address(state));
  kept = setTimeout(() => history.replaceState(null, "", address(state)), 150);
}

function rowOf(scene) {
  return scene.lead + state.t * scene.rate;
}

// Torques, numbers and texts of the state; only what has changed is computed again.
function show() {
  if (!$("#plots").clientWidth) return; // a page that is not laid out
  const scene = sceneOf(state.scene), key = [state.scene, state.joint, state.gain].join();
  if (drawn.key !== key) {
    const found = trained(scene, state.joint), k = scene.joints.findIndex(([joint]) => joint === state.joint);
    const { push, ...torques } = found;
    const moved = Object.entries(torques).map(([name, torque]) => [name, behind(torque, scene, state.gain)]);
    drawn.torques = { ...Object.fromEntries(moved), push, behind: lowPassed(push, scene, state.gain) };
    drawn.stds = Object.fromEntries(scene.stds.map((method) => [method, column(scene, `std ${method}`, k)]));
  }
  const counted = [key, state.threshold].join();
  const choices = [state.scene, state.joint, state.step, state.guess, state.lines].join();
  if (drawn.counted !== counted) {
    drawn.numbers = numbersOf(scene, drawn.torques, state.threshold);
    fillTable(scene);
  }
  if (drawn.counted !== counted || drawn.choices !== choices) tell(scene);
  if (drawn.choices !== choices) showChoices(scene);
  Object.assign(drawn, { key, counted, choices });
  showSliders(scene);
  drawPage(scene);
  draw();
}

// The part of the plots that stays while time goes on.
function drawPage(scene) {
  const canvas = $("#plots"), page = pageOf(scene, rowOf(scene), state.zoom);
  const size = fit(canvas), pen = canvas.getContext("2d");
  const key = [drawn.counted, drawn.choices, page, size, dark.matches].join();
  if (drawn.page === key) return;
  drawn.page = key;
  const name = scene.joints.find(([joint]) => joint === state.joint)[1];
  pen.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
  drawn.view = {
    scene, page, torques: drawn.torques, stds: drawn.stds, shown: state.lines, numbers: drawn.numbers,
    threshold: state.threshold,
    laneOf: (method, role) => (role === "formula" && labelOf(scene, method) === method ? role : labelOf(scene, method)),
    titles: [`external torque, ${name} [N m]`, "error: estimate minus truth [N m]", `alarms at ${state.threshold} N m`],
  };
  plot = drawPlots(pen, drawn.view, ...size, look);
}

// One frame: robot, cursor, values at the cursor. Nothing else changes while time goes on.
function draw() {
  const scene = sceneOf(state.scene), row = rowOf(scene);
  const canvas = $("#robot"), [width, height] = fit(canvas), pen = canvas.getContext("2d");
  pen.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
  const limb = robot.joints.find(([id]) => id === state.joint)?.[3];
  solids = drawRobot(pen, scene, row, width, height, drawn.turn ?? viewAngles(), limb, look);
  const over = $("#cursor"), size = fit(over), plots = over.getContext("2d");
  plots.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
  plots.clearRect(0, 0, ...size);
  drawCursor(plots, drawn.view, plot, row, look);
  showNow(scene, row);
}

function viewAngles() {
  return { azimuth: TURNS[2] + state.turn, elevation: 9 };
}

// A canvas of as many pixels as it has on the screen; its size in the page's pixels.
function fit(canvas) {
  const width = canvas.clientWidth, height = canvas.clientHeight;
  const [w, h] = [Math.round(width * devicePixelRatio), Math.round(height * devicePixelRatio)];
  if (canvas.width !== w || canvas.height !== h) [canvas.width, canvas.height] = [w, h];
  return [width, height];
}

function signed(value, digits = 1) {
  return value.toFixed(digits).replace("-", "\u2212").replace(/^\u2212(0(\.0+)?)$/, "$1");
}

function showNow(scene, row) {
  const k = Math.min(Math.round(row), scene.count - 1);
  for (const value of drawn.values ?? []) value.node.textContent = signed(drawn.torques[value.method][k]);
  const { alarm } = scene, isRaised = alarm && row >= alarm.at && row < alarm.at + 0.7 * scene.rate;
  $("#alarm").hidden = !isRaised;
  if (isRaised) $("#alarm").textContent = `Collision felt: ${alarm.named}`;
  $("#force").textContent = pushText(scene, row) && `push ${pushText(scene, row)}`;
  $("#now").textContent = `${state.t.toFixed(3)} s`;
  if (document.activeElement !== $("#time") || playing) $("#time").value = state.t;
}

function showSliders(scene) {
  $("#time").max = (scene.count - scene.lead - 1) / scene.rate;
  [$("#gain").min, $("#gain").max] = told.settings.gains;
  [$("#threshold").min, $("#threshold").max] = told.settings.thresholds;
  $("#trained").innerHTML = `<option value="${scene.gain}"></option>`;
  for (const key of ["gain", "threshold", "zoom"]) $(`#${key}`).value = state[key];
  $("#usual").textContent = scene.gain;
  $("#gained").textContent = `${state.gain} 1/s`;
  $("#held").textContent = `${state.threshold} N m`;
  $("#back").href = `#step=${Math.max(1, state.step - 1)}`;
  $("#next").href = `#step=${Math.min(5, state.step + 1)}`;
  $("#back").setAttribute("aria-disabled", state.step < 2);
  $("#next").setAttribute("aria-disabled", state.step === 5);
  describe(scene);
}

// Texts in place of the pictures, renewed where time stands still.
function describe(scene) {
  if (playing) return;
  const k = Math.min(Math.round(rowOf(scene)), scene.count - 1), size = pushText(scene, k);
  const stands = scene.flags.swing.length ? "the leg is on the ground" : "the robot walks";
  const phase = flag(scene, "swing", k) ? "the leg is in the air" : stands;
  const push = size && `, a push of ${size} on the ${scene.point ? scene.point[2] : `joint ${scene.turned}`}`;
  $("#robot").setAttribute("aria-label", `The robot at ${state.t.toFixed(2)} seconds: ${phase}${push}.`);
  const known = state.lines.filter((name) => drawn.torques[name] && (name === "truth" || !isAsked()));
  const values = known.map((name) => `${labelOf(scene, name)} ${drawn.torques[name][k].toFixed(1)}`).join(", ");
  const now = `at ${state.t.toFixed(2)} seconds, in newton metres: ${values}.`;
  $("#plots").setAttribute("aria-label", `Torque of the joint ${state.joint} over time; ${now}`);
}

// In the second step methods have letters until somebody has picked one.
function labelOf(scene, method) {
  if (method === "truth" || method === "detector" || !isAsked()) return method;
  return `line ${LETTERS[letters(scene).indexOf(method)]}`;
}

function letters(scene) {
  return scene.methods.map(([method]) => method).sort((a, b) => a.length - b.length || (a < b ? -1 : 1));
}

function showChoices(scene) {
  radios("#pushes", told.scenes.map((one) => one.push), scene.push, () => true);
  const isThere = (plant) => told.scenes.some((one) => one.push === scene.push && one.plant === plant);
  radios("#plants", told.scenes.map((one) => one.plant), scene.plant, isThere);
  const options = scene.joints.map(([id, name]) => new Option(`${id} ${name}`, id, false, id === state.joint));
  $("#joint").replaceChildren(...options);
  for (const node of document.querySelectorAll("#telling [data-step]"))
    node.hidden = Number(node.dataset.step) !== state.step;
  for (const node of document.querySelectorAll(".story li a")) {
    if (Number(node.dataset.step) === state.step) node.setAttribute("aria-current", "step");
    else node.removeAttribute("aria-current");
  }
  $("#table").hidden = isAsked();
  showLines(scene);
  showGuess(scene);
}

// In the second step a line is to be picked: until then nothing names a method or gives a number of one.
function isAsked() {
  return state.step === 2 && !state.guess;
}

function radios(place, texts, chosen, isThere) {
  const box = $(place), names = [...new Set(texts)], focused = box.contains(document.activeElement);
  box.querySelectorAll("label").forEach((node) => node.remove());
  for (const name of names) {
    const [label, input, text] = ["label", "input", "span"].map((tag) => document.createElement(tag));
    const kind = { type: "radio", name: box.id, value: name };
    Object.assign(input, kind, { checked: name === chosen, disabled: !isThere(name) });
    text.textContent = name;
    label.append(input, text);
    box.append(label);
    if (focused && name === chosen) input.focus();
  }
}

// The lines as buttons that show and hide them, each with its value at the cursor; to be picked in the second step.
function showLines(scene) {
  const focused = document.activeElement?.dataset?.line, isGuess = isAsked();
  const order = isGuess ? letters(scene) : scene.methods.map(([method]) => method);
  drawn.values = [];
  $("#lines").replaceChildren(...["truth", ...order].map((method) => {
    const [button, swatch, value] = ["button", "span", "b"].map((tag) => document.createElement(tag));
    swatch.className = `swatch ${method === "truth" ? "truth" : roleOf(scene, method)}`;
    button.type = "button";
    button.dataset.line = method;
    if (!isGuess || method === "truth") button.setAttribute("aria-pressed", state.lines.includes(method));
    button.append(swatch, labelOf(scene, method), value);
    if (!isGuess || method === "truth") drawn.values.push({ method, node: value });
    return button;
  }));
  if (focused) document.querySelector(`[data-line="${CSS.escape(focused)}"]`)?.focus();
}

function roleOf(scene, method) {
  return scene.methods.find(([name]) => name === method)[1];
}

function showGuess(scene) {
  if (state.step !== 2 || !state.guess || !drawn.numbers) return void ($("#guessed").textContent = "");
  const off = (row) => Math.abs(row.share - 1), rows = drawn.numbers.filter((row) => row.method !== "truth");
  const best = rows.reduce((a, b) => (off(b) < off(a) ? b : a)), mine = rows.find((row) => row.method === state.guess);
  if (!mine) return;
  const words = (row) => `${row.method}, with ${(100 * row.share).toFixed(0)} % of the peak`;
  const answer = mine === best ? `Right: ${words(mine)}.` : `You picked ${words(mine)}; closest is ${words(best)}.`;
  $("#guessed").textContent = answer;
}

function fillTable(scene) {
  for (const body of document.querySelectorAll("#numbers tbody")) body.hidden = body.dataset.scene !== scene.name;
  const body = document.querySelector(`#numbers tbody[data-scene="${scene.name}"]`);
  const name = scene.joints.find(([joint]) => joint === state.joint)[1];
  const gain = state.gain === scene.gain ? "" : `, gain ${state.gain} 1/s`;
  const what = `${scene.push}, ${scene.plant}, ${name} (${state.joint})`;
  body.querySelector(".title th").textContent = `${what}, threshold ${state.threshold} N m${gain}`;
  const text = (value, digits) => {
    if (value === null) return "–";
    return typeof value === "string" ? value : value.toFixed(digits);
  };
  const late = (ms) => (ms !== null && ms <= -0.5 ? `${text(-ms, 0)} early` : text(ms, 0));
  for (const row of drawn.numbers) {
    const cells = body.querySelector(`[data-method="${row.method}"]`).cells;
    const found = [
      text(row.peak, 1), `${text(100 * row.share, 0)} %`, late(row.lateMs), text(row.error, 1),
      text(row.around, 1), text(row.alarm, 0), String(row.falseAlarms), text(row.quietNm, 1),
    ];
    found.forEach((value, k) => (cells[k + 1].textContent = value));
  }
}

const UNTIMED = {
  none: "no alarm", "on before": "its alarm is on before the push", "not watched": "a leg on the ground is not watched",
};

// One sentence on what was felt, spoken when a slider has come to rest.
let spoken = 0;
function tell(scene) {
  clearTimeout(spoken);
  spoken = setTimeout(() => {
    if (isAsked()) {
      $("#result").className = "";
      $("#result").textContent = "Pick a line above the plot; then the numbers of all methods follow.";
      return;
    }
    const methods = scene.methods.filter(([method]) => state.lines.includes(method));
    const [method, role] = methods.find(([, one]) => one === "network") ?? methods.at(-1) ?? scene.methods[0];
    const row = drawn.numbers.find((one) => one.method === method);
    $("#result").className = role;
    const alarm = UNTIMED[row.alarm] ?? `alarm after ${row.alarm.toFixed(0)} ms`;
    const wrong = `${row.falseAlarms} false alarm${row.falseAlarms === 1 ? "" : "s"}`;
    const ownMs = scene.alarm && ((scene.alarm.at - scene.start) * 1000) / scene.rate;
    const own = scene.alarm ? ` The project's detector felt it after ${ownMs.toFixed(0)} ms.` : "";
    const by = `${Math.abs(row.lateMs).toFixed(0)} ms ${row.lateMs < 0 ? "early" : "late"}`;
    const late = row.lateMs === null ? "never half of it" : by;
    const shown = `${row.method} recovers ${(100 * row.share).toFixed(0)} % of the peak, ${late}`;
    $("#result").textContent = `${shown}; ${alarm}, ${wrong} at ${state.threshold} N m.${own}`;
  }, drawn.told ? 250 : 0);
  drawn.told = true;
}

function readLook() {
  const style = getComputedStyle(document.documentElement), read = (name) => style.getPropertyValue(`--${name}`).trim();
  const rgb = (name) => [1, 3, 5].map((k) => parseInt(read(name).slice(k, k + 2), 16));
  // Colours are those of the robot's table, lighter on a dark page; a marked limb is mixed with one of the page.
  const lift = Number(read("lift")), mark = rgb("marked");
  const tones = (part) => Object.fromEntries(Object.entries(robot.tones).map(([tone, base]) =>
    [tone, base.map((own, k) => Math.min(255, Math.round((1 - part) * own + part * mark[k] + lift)))]));
  const names = [
    "ink", "faint", "grid", "zero", "truth", "push", "pushed", "swing", "watched", "contact", "ghost", "shadow",
  ];
  const roles = Object.fromEntries(["observer", "formula", "network", "direct"].map((role) => [role, read(role)]));
  const bands = Object.fromEntries(Object.entries(roles).map(([role, colour]) => [role, `${colour}38`]));
  look = { ...Object.fromEntries(names.map((name) => [name, read(name)])), roles, bands };
  Object.assign(look, { ground: read("panel"), tones: tones(0) });
  look.font = `12px ${getComputedStyle(document.body).fontFamily}`;
  look.small = look.font.replace("12px", "10.5px");
  look.marked = { ...look, tones: tones(0.4) };
}

// Time goes on until it is stopped, the scene ends, or the moment comes at which the page opens.
function play(until = null) {
  const scene = sceneOf(state.scene), end = until ?? (scene.count - scene.lead - 1) / scene.rate;
  if (state.t >= end - 1e-6) state.t = 0;
  let last = null;
  const step = (now) => {
    if (!playing) return;
    if (last !== null) state.t = Math.min(end, state.t + (Number($("#speed").value) * (now - last)) / 1000);
    last = now;
    drawPage(scene);
    draw();
    if (state.t >= end) return stop();
    playing = requestAnimationFrame(step);
  };
  playing = requestAnimationFrame(step);
  $("#play").textContent = "Stop";
}

function stop() {
  cancelAnimationFrame(playing);
  playing = null;
  $("#play").textContent = "Play";
  change({});
}

function choosePush(push) {
  const { plant } = sceneOf(state.scene);
  const those = told.scenes.filter((one) => one.push === push);
  const found = those.find((one) => one.plant === plant) ?? those[0];
  if (found) enter(found.name);
}

function enter(name) {
  if (playing) stop();
  state = { ...beginning(0, name), turn: state.turn };
  change({}, true);
}

function listen() {
  $("#pushes").addEventListener("change", (event) => choosePush(event.target.value));
  $("#plants").addEventListener("change", (event) => {
    const { push } = sceneOf(state.scene);
    enter(told.scenes.find((one) => one.push === push && one.plant === event.target.value).name);
  });
  $("#joint").addEventListener("change", (event) => change({ joint: event.target.value }, true));
  for (const key of ["gain", "threshold"])
    $(`#${key}`).addEventListener("input", (event) => change({ [key]: Number(event.target.value) }));
  $("#zoom").addEventListener("change", (event) => change({ zoom: Number(event.target.value) }));
  $("#time").addEventListener("input", (event) => seek(Number(event.target.value)));
  $("#play").addEventListener("click", () => (playing ? stop() : play()));
  $("#turn").addEventListener("click", () => change({ turn: (state.turn + 45) % 360 }));
  $("#lines").addEventListener("click", (event) => {
    const method = event.target.closest("button")?.dataset.line;
    if (method) pickLine(method);
  });
  for (const form of document.forms) form.addEventListener("submit", (event) => event.preventDefault());
  for (const name of ["hashchange", "popstate"]) addEventListener(name, follow);
  addEventListener("resize", show);
  dark.addEventListener("change", () => { readLook(); show(); });
  addEventListener("keydown", press);
  dragPlots($("#plots"));
  dragRobot($("#robot"));
}

// The address was changed, by a link or by going back.
function follow() {
  if (playing) stop();
  state = readState();
  show();
}

function seek(t) {
  if (playing) stop();
  change({ t });
}

function pickLine(method) {
  if (isAsked() && method !== "truth") return change({ guess: method }, true);
  const lines = state.lines.includes(method) ? state.lines.filter((name) => name !== method) : [...state.lines, method];
  change({ lines });
}

function press(event) {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  const tag = event.target.tagName, isField = tag === "INPUT" || tag === "SELECT";
  const pushes = [...new Set(told.scenes.map((scene) => scene.push))], by = event.shiftKey ? 0.1 : 0.01;
  if (event.key === " " && !["BUTTON", "A", "SUMMARY", "SELECT"].includes(tag)) playing ? stop() : play();
  else if (event.key === "ArrowLeft" && !isField) seek(state.t - by);
  else if (event.key === "ArrowRight" && !isField) seek(state.t + by);
  else if (tag !== "SELECT" && pushes[Number(event.key) - 1]) choosePush(pushes[Number(event.key) - 1]);
  else return;
  event.preventDefault();
}

// A click or a drag on the plots moves the time; in the second step, a click near a line picks it.
function dragPlots(canvas) {
  const move = (event) => {
    const box = canvas.getBoundingClientRect(), { torque } = plot.frames, [first, last] = plot.page;
    const share = Math.max(0, Math.min(1, (event.clientX - box.x - torque.x) / torque.width));
    const scene = sceneOf(state.scene);
    seek((first + share * (last - 1 - first) - scene.lead) / scene.rate);
  };
  canvas.addEventListener("pointerdown", (event) => {
    const picked = isAsked() ? lineUnder(event) : null;
    if (picked) return pickLine(picked);
    canvas.setPointerCapture(event.pointerId);
    move(event);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (event.buttons && canvas.hasPointerCapture(event.pointerId)) move(event);
  });
}

function lineUnder(event) {
  const box = $("#plots").getBoundingClientRect(), [x, y] = [event.clientX - box.x, event.clientY - box.y];
  const { torque } = plot.frames, [first, last] = plot.page, scene = sceneOf(state.scene);
  const row = Math.round(first + ((x - torque.x) / torque.width) * (last - first));
  const away = (method) => Math.abs(plot.scale.at(drawn.torques[method][row] ?? NaN) - y);
  const near = scene.methods.map(([method]) => [away(method), method]);
  const [distance, method] = near.sort(([a], [b]) => a - b)[0];
  return distance < 14 ? method : null;
}

// A drag turns the view, a click chooses the joint of what is clicked.
function dragRobot(canvas) {
  let from = null;
  canvas.addEventListener("pointerdown", (event) => {
    from = { x: event.clientX, y: event.clientY, turn: state.turn, moved: false };
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!from) return (canvas.style.cursor = underPointer(event) ? "pointer" : "grab");
    const dx = event.clientX - from.x;
    from.moved ||= Math.hypot(dx, event.clientY - from.y) > 4;
    if (from.moved) change({ turn: Math.round((((from.turn - 0.6 * dx) % 360) + 360) % 360) });
  });
  canvas.addEventListener("pointerup", (event) => {
    const joint = from && !from.moved ? underPointer(event) : null;
    from = null;
    if (joint) change({ joint }, true);
  });
  canvas.addEventListener("pointercancel", () => (from = null));
}

function underPointer(event) {
  const box = $("#robot").getBoundingClientRect(), scene = sceneOf(state.scene);
  return jointUnder(solids, event.clientX - box.x, event.clientY - box.y, scene.joints.map(([joint]) => joint));
}

async function begin() {
  readScenes(await unpack($("#data").textContent));
  readLook();
  $(".live").hidden = false;
  $("#still").hidden = true;
  $("#speed").value = SPEED;
  listen();
  const isFresh = location.hash.length < 2;
  state = readState();
  show();
  if (!isFresh || calm.matches) return;
  const end = state.t;
  state.t = Math.max(0, end - 0.6);
  play(end);
}

if ("DecompressionStream" in window) begin();
