// The numbers of a push, as explore_numbers.py computes them.
function numbersOf(scene, torques, threshold) {
  const { afterS, longestS, judgedS } = told.settings, rowsOf = (seconds) => Math.round(seconds * scene.rate);
  const first = scene.start - 1, quiet = calmRows(scene);
  const stop = Math.min(scene.end + rowsOf(afterS), scene.start + rowsOf(longestS), scene.count);
  const judged = Math.max(scene.lead, scene.start - rowsOf(judgedS));
  const push = torques.push.subarray(first, stop), pushed = torques.behind.subarray(first, stop);
  return ["truth", ...scene.methods.map(([method]) => method)].map((method) => {
    const whole = Float64Array.from(torques.truth, (truth, k) => torques[method][k] - truth);
    const error = whole.subarray(first, stop), around = rms(whole.subarray(judged));
    const felt = feltOf(push, pushed, error.map((value, k) => pushed[k] + value));
    const lateMs = felt.late === null ? null : (felt.late * 1000) / scene.rate;
    return { method, ...felt, lateMs, error: rms(error), around, ...alarmsOf(scene, torques[method], threshold, quiet) };
  });
}

function rms(values) {
  return Math.sqrt(values.reduce((sum, value) => sum + value * value, 0) / values.length);
}

// Peak and share of a push that is seen, and how late its half is [rows], if ever; the first sample is the zero.
function feltOf(push, behind, seen) {
  const extreme = (values) => values.reduce((most, value) => (Math.abs(value) > Math.abs(most) ? value : most), 0);
  const top = extreme(behind), raw = extreme(push), zero = seen[0];
  const peak = seen.reduce((most, value) => Math.max(most, Math.sign(top) * (value - zero)), -Infinity);
  if (!top) return { peak, share: 0, late: null };
  const scaled = (values) => Array.from(values, (value) => (value - values[0]) / raw);
  const late = firstAbove(scaled(seen)) - firstAbove(scaled(push));
  return { peak, share: peak / Math.abs(top), late: peak >= 0.5 * Math.abs(raw) ? late : null };
}

// When a signal first reaches one half, between two rows; its last row if it never does.
function firstAbove(signal) {
  const row = signal.findIndex((value) => value >= 0.5);
  if (row < 0) return signal.length - 1;
  return row === 0 ? 0 : row - 1 + (0.5 - signal[row - 1]) / (signal[row] - signal[row - 1]);
}

// The torque behind the detectors' low-pass, the least of the last samples, and nothing while the leg is not watched.
function heldSize(scene, torque) {
  const pole = Math.exp((-2 * Math.PI * told.settings.lowPassHz) / scene.rate);
  const hold = Math.max(1, Math.round(told.settings.holdS * scene.rate));
  const size = new Float64Array(scene.count), held = new Float64Array(scene.count);
  const watched = flagRows(scene, "watched");
  let low = 0;
  for (let row = 0; row < scene.count; row++) {
    low = pole * low + (1 - pole) * torque[row];
    size[row] = watched[row] ? Math.abs(low) : 0;
    let least = size[row];
    for (let i = 1; i < hold; i++) least = Math.min(least, row < i ? 0 : size[row - i]);
    held[row] = least;
  }
  return held;
}

function alarmsOf(scene, torque, threshold, quiet) {
  const held = heldSize(scene, torque), watched = scene.flags.watched, stretches = [];
  let falseAlarms = 0, quietNm = 0, begun = null;
  for (let row = 0; row <= scene.count; row++) {
    const over = row < scene.count && held[row] > threshold, calm = row < scene.count && quiet[row];
    if (calm) quietNm = Math.max(quietNm, held[row]);
    if (over && calm && !(row > 0 && held[row - 1] > threshold && quiet[row - 1])) falseAlarms += 1;
    if (over && begun === null) begun = row;
    if (!over && begun !== null) stretches.push([begun, row]), (begun = null);
  }
  const seen = watched.some(([, end]) => end > scene.lead);
  const alarm = delayOf(scene, stretches);
  return { alarm, falseAlarms, quietNm: seen ? quietNm : null, stretches };
}

// The delay of the push's alarm [ms], or why there is none.
function delayOf(scene, stretches) {
  const stop = scene.end + Math.round(told.settings.lateS * scene.rate);
  if (!scene.flags.watched.some(([start, end]) => start < stop && end > scene.start)) return "not watched";
  if (stretches.some(([start, end]) => start < scene.start && end >= scene.start)) return "on before";
  const found = stretches.find(([start]) => start >= scene.start && start < stop);
  return found ? ((found[0] - scene.start) * 1000) / scene.rate : "none";
}

function flagRows(scene, name) {
  scene.rows ??= {};
  if (!scene.rows[name]) {
    scene.rows[name] = new Uint8Array(scene.count);
    for (const [start, end] of scene.flags[name]) scene.rows[name].fill(1, start, end);
  }
  return scene.rows[name];
}

// Rows in which an alarm is a false one: watched, and nothing has pushed since that began.
function calmRows(scene) {
  const calm = flagRows(scene, "watched").slice().fill(0, 0, scene.lead);
  for (const [start, end] of scene.flags.watched) {
    const hit = scene.flags.pushed.find(([from, to]) => from < end && to > start);
    if (hit) calm.fill(0, Math.max(hit[0], start), end);
  }
  return calm;
}
