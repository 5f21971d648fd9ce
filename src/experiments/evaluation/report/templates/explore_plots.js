// The plots: torque and error of a joint over a page of time, the alarms below, and one cursor for all of them,
// which is drawn on a canvas of its own: what does not move with it is drawn once.
const MARGIN = { left: 58, right: 10, top: 20, gap: 30, bottom: 22, alarms: 13 };

// The page of time [rows] that holds a row: a few of them side by side, one with the push in its middle.
function pageOf(scene, row, seconds) {
  const from = scene.lead, whole = scene.count - from, size = Math.min(seconds * scene.rate, whole);
  if (size >= whole) return [from, scene.count];
  const middle = scene.start + Math.min(0.2 * size, (scene.end - scene.start) / 2);
  const first = middle - size / 2 + size * Math.floor((row - middle) / size + 0.5);
  const start = Math.max(from, Math.min(first, scene.count - size));
  return [Math.round(start), Math.round(start + size)];
}

// Where each plot stands on a canvas of so many pixels, with so many lines of alarms.
function framesOf(width, height, lines) {
  const { left, right, top, gap, bottom, alarms } = MARGIN;
  const below = lines * alarms + 18, rest = height - top - gap - below - bottom - 16;
  const torque = { x: left, y: top, width: width - left - right, height: Math.round(rest * 0.66) };
  const error = { ...torque, y: torque.y + torque.height + gap, height: Math.round(rest * 0.34) };
  return { torque, error, alarms: { ...torque, y: error.y + error.height + 20 + 14, height: lines * alarms } };
}

// A scale over a range of values and a little more, with ticks at steps of 1, 2 or 5 times a power of ten.
function scaleOf(low, high, frame, lines) {
  const room = high > low ? 0.06 * (high - low) : 10, [from, to] = [low - room, high + room];
  const rough = (to - from) / lines, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((part) => part * power).find((part) => part >= rough);
  const at = (value) => frame.y + frame.height * (1 - (value - from) / (to - from));
  const ticks = [];
  for (let k = Math.ceil(from / step); k * step <= to; k++) ticks.push(k * step);
  return { at, ticks };
}

function rangeOf(series, [first, last]) {
  let low = 0, high = 0;
  for (const values of series)
    for (let row = first; row < last; row++) {
      if (values[row] < low) low = values[row];
      if (values[row] > high) high = values[row];
    }
  return [low, high];
}

// A line through the samples of a page, at most four points a pixel: the first, least, largest and last of its samples.
function line(pen, values, [first, last], xOf, yOf, perPixel) {
  const every = Math.max(1, Math.floor(perPixel));
  pen.beginPath();
  for (let row = first; row < last; row += every) {
    const end = Math.min(row + every, last);
    let low = row, high = row;
    for (let k = row; k < end; k++) {
      if (values[k] < values[low]) low = k;
      if (values[k] > values[high]) high = k;
    }
    for (const k of low < high ? [low, high] : [high, low]) pen.lineTo(xOf(k), yOf(values[k]));
  }
  pen.stroke();
}

function band(pen, mean, std, [first, last], xOf, yOf, perPixel) {
  const every = Math.max(1, Math.floor(perPixel));
  pen.beginPath();
  for (let k = first; k < last; k += every) pen.lineTo(xOf(k), yOf(mean[k] + std[k]));
  for (let k = last - 1; k >= first; k -= every) pen.lineTo(xOf(k), yOf(mean[k] - std[k]));
  pen.closePath();
  pen.fill();
}

// Draw everything but the cursor. `view` has scene, page, torques, stds, shown methods, numbers, threshold and names.
function drawPlots(pen, view, width, height, look) {
  const { scene, page, torques, shown, numbers } = view, [first, last] = page;
  const methods = scene.methods.filter(([method]) => shown.includes(method));
  const frames = framesOf(width, height, scene.methods.length + (scene.alarm ? 1 : 0));
  const { torque, error, alarms } = frames;
  const xOf = (row) => torque.x + (torque.width * (row - first)) / (last - first);
  const perPixel = (last - first) / torque.width;
  const errors = methods.map(([method]) => torques[method].map((value, row) => value - torques.truth[row]));
  const drawn = [...methods.map(([method]) => torques[method]), ...(shown.includes("truth") ? [torques.truth] : [])];
  const scale = scaleOf(...rangeOf(drawn, page), torque, torque.height / 34);
  const off = scaleOf(...rangeOf(errors, page), error, error.height / 20);
  pen.clearRect(0, 0, width, height);
  pen.font = look.font;
  for (const [start, end] of without(scene.flags.swing, scene.flags.pushed))
    shadeTime(pen, start, end, look.swing, frames, page, xOf);
  for (const [start, end] of scene.flags.pushed) shadeTime(pen, start, end, look.pushed, frames, page, xOf);
  axes(pen, torque, scale, look, view.titles[0]);
  axes(pen, error, off, look, view.titles[1]);
  times(pen, scene, page, error, xOf, look);
  pen.save();
  clip(pen, torque);
  pen.setLineDash([2, 4]);
  pen.strokeStyle = look.push;
  pen.lineWidth = 1;
  for (const value of methods.length ? [view.threshold, -view.threshold] : []) {
    trace(pen, [[torque.x, scale.at(value)], [torque.x + torque.width, scale.at(value)]], false);
    pen.stroke();
  }
  pen.setLineDash([]);
  const curves = (values, yOf, [own, other]) => methods.forEach(([method, role], k) => {
    const std = view.stds[method];
    pen.fillStyle = look.bands[role];
    if (std && role === "network") band(pen, values[k], std, page, xOf, yOf, perPixel);
    pen.strokeStyle = look.roles[role];
    pen.lineWidth = role === "network" ? own : other;
    line(pen, values[k], page, xOf, yOf, perPixel);
  });
  curves(methods.map(([method]) => torques[method]), scale.at, [2.2, 1.5]);
  if (shown.includes("truth")) {
    pen.strokeStyle = look.truth;
    pen.lineWidth = 2;
    pen.setLineDash([2, 3]);
    line(pen, torques.truth, page, xOf, scale.at, perPixel);
    pen.setLineDash([]);
  }
  pen.restore();
  pen.save();
  clip(pen, error);
  curves(errors, off.at, [2, 1.3]);
  pen.restore();
  drawAlarms(pen, view, alarms, xOf, numbers, look);
  return { frames, xOf, scale, page };
}

// Stretches less those of others.
function without(stretches, others) {
  const parts = ([start, end], [from, to]) => [[start, Math.min(end, from)], [Math.max(start, to), end]];
  const cut = (left, other) => left.flatMap((one) => parts(one, other));
  return others.reduce(cut, stretches).filter(([start, end]) => end > start);
}

function clip(pen, { x, y, width, height }) {
  pen.beginPath();
  pen.rect(x, y - 2, width, height + 4);
  pen.clip();
}

function shadeTime(pen, start, end, colour, { torque, error, alarms }, [first, last], xOf) {
  const [a, b] = [xOf(Math.max(start, first)), xOf(Math.min(end, last))];
  if (b <= a) return;
  pen.fillStyle = colour;
  for (const frame of [torque, error, alarms]) pen.fillRect(a, frame.y, Math.max(b - a, 1), frame.height);
}

function axes(pen, frame, scale, look, title) {
  pen.textBaseline = "middle";
  for (const tick of scale.ticks) {
    const y = Math.round(scale.at(tick)) + 0.5;
    pen.strokeStyle = tick === 0 ? look.zero : look.grid;
    pen.lineWidth = 1;
    trace(pen, [[frame.x, y], [frame.x + frame.width, y]], false);
    pen.stroke();
    pen.fillStyle = look.faint;
    pen.textAlign = "right";
    pen.fillText(String(Number(tick.toFixed(6))).replace("-", "\u2212"), frame.x - 7, y);
  }
  pen.textAlign = "left";
  pen.textBaseline = "alphabetic";
  pen.fillStyle = look.ink;
  pen.fillText(title, frame.x, frame.y - 8);
}

function times(pen, scene, [first, last], frame, xOf, look) {
  const seconds = (last - first) / scene.rate, step = [0.05, 0.1, 0.2, 0.5, 1].find((part) => seconds / part <= 8) ?? 1;
  pen.fillStyle = look.faint;
  pen.textBaseline = "top";
  pen.textAlign = "center";
  const from = (first - scene.lead) / scene.rate, to = (last - scene.lead) / scene.rate;
  for (let k = Math.ceil(from / step - 1e-6); k * step <= to + 1e-6; k++) {
    const x = xOf(scene.lead + k * step * scene.rate), text = `${Number((k * step).toFixed(2))} s`;
    pen.fillText(text, Math.max(frame.x + 8, Math.min(x, frame.x + frame.width - 12)), frame.y + frame.height + 5);
  }
  pen.textBaseline = "alphabetic";
}

// A line for each method: where its torque raises an alarm; pale where nothing is watched. The first line is the
// recorded alarm of the project's own detector.
function drawAlarms(pen, view, frame, xOf, numbers, look) {
  const { scene, page } = view, [first, last] = page;
  pen.fillStyle = look.ink;
  pen.textAlign = "left";
  pen.fillText(view.titles[2], frame.x, frame.y - 5);
  const rows = [...(scene.alarm ? [["detector", null]] : []), ...scene.methods];
  rows.forEach(([method, role], k) => {
    const y = frame.y + k * MARGIN.alarms + 2, height = MARGIN.alarms - 4;
    pen.fillStyle = look.faint;
    pen.textAlign = "right";
    pen.font = look.small;
    pen.fillText(view.laneOf(method, role), frame.x - 7, y + height);
    const bar = (start, end, colour) => {
      const [a, b] = [xOf(Math.max(start, first)), xOf(Math.min(end, last))];
      pen.fillStyle = colour;
      if (b > a) pen.fillRect(a, y, Math.max(b - a, 2), height);
    };
    for (const [start, end] of scene.flags.watched) bar(start, end, look.watched);
    if (role === null && scene.alarm) bar(scene.alarm.at, scene.alarm.at + 0.02 * scene.rate, look.ink);
    if (role !== null && view.shown.includes(method))
      for (const [start, end] of numbers.find((row) => row.method === method).stretches)
        bar(start, end, look.roles[role]);
  });
}

// The cursor, and a dot where it meets each line.
function drawCursor(pen, view, plot, row, look) {
  const { torque, alarms } = plot.frames, x = plot.xOf(row);
  pen.strokeStyle = look.ink;
  pen.lineWidth = 1;
  trace(pen, [[x, torque.y], [x, alarms.y + alarms.height]], false);
  pen.stroke();
  const k = Math.min(Math.round(row), view.scene.count - 1);
  for (const [method, role] of view.scene.methods) {
    if (!view.shown.includes(method)) continue;
    pen.fillStyle = look.roles[role];
    pen.beginPath();
    pen.arc(x, plot.scale.at(view.torques[method][k]), 3.5, 0, 2 * Math.PI);
    pen.fill();
  }
}
