// One chart of the chosen runs, and the settings in which two of them differ.
const CURVES = { validation: ["loss", "validation"], training: ["loss", "training"], rmse: ["rmse", "validation"], rate: ["rate", "rate"] };
const HASH = "fingerprint"; // of settings and data
const TINTS = 6; // then the lines are dashed
const FRAME = { left: 62, right: 630, top: 10, bottom: 262 };
const form = document.querySelector("#how");

// Return a run's curve as [epoch, number] pairs: the page has it on a grid between the ends of its axes.
function curve(name, kind) {
  const [chart, line] = CURVES[kind];
  const group = document.getElementById(`${chart}-${name}`);
  if (!group) return [];
  const [first, last, low, high] = group.dataset.spans.split(" ").map(Number);
  const places = group.querySelector(`.${line}`).getAttribute("points").split(" ").map((point) => point.split(",").map(Number));
  const values = new Map(places.map(([x, y]) => [Math.round(first + (x / 1000) * (last - first)), high - (y / 1000) * (high - low)]));
  return [...values];
}

// Return what is drawn: a name, a line of [epoch, number], and with means a band of [epoch, lowest, highest].
function drawn(picked, kind, isMean) {
  if (!isMean) return picked.map((run) => ({ name: run.dataset.name, line: curve(run.dataset.name, kind) }));
  return [...new Set(picked.map((run) => run.dataset.group))].map((own) => {
    const curves = runs.filter((run) => run.dataset.group === own).map((run) => new Map(curve(run.dataset.name, kind)));
    const epochs = [...new Set(curves.flatMap((one) => [...one.keys()]))].sort((a, b) => a - b);
    const at = epochs.map((epoch) => [epoch, curves.filter((one) => one.has(epoch)).map((one) => one.get(epoch))]);
    return {
      name: `${own}, ${curves.length} seed${curves.length === 1 ? "" : "s"}`,
      line: at.map(([epoch, values]) => [epoch, values.reduce((sum, one) => sum + one, 0) / values.length]),
      band: at.map(([epoch, values]) => [epoch, Math.min(...values), Math.max(...values)]),
    };
  });
}

function ticks(low, high) {
  const step = [1, 2, 5, 10].map((digit) => digit * 10 ** Math.floor(Math.log10((high - low) / 4))).find((one) => (high - low) / one <= 6);
  const first = Math.ceil(low / step);
  return Array.from({ length: Math.floor(high / step) - first + 1 }, (_, k) => (first + k) * step);
}

function ends(values) {
  const [low, high] = [Math.min(...values), Math.max(...values)];
  return low < high ? [low, high] : [low - 0.5, high + 0.5];
}

function draw(lines, title) {
  const { left, right, top, bottom } = FRAME;
  const across = ends(lines.flatMap(({ line }) => line.map(([epoch]) => epoch)));
  const up = ends(lines.flatMap(({ line, band }) => [...line.map(([, y]) => y), ...(band ?? []).flatMap(([, a, b]) => [a, b])]));
  const x = (epoch) => (left + ((epoch - across[0]) / (across[1] - across[0])) * (right - left)).toFixed(1);
  const y = (number) => (bottom - ((number - up[0]) / (up[1] - up[0])) * (bottom - top)).toFixed(1);
  const shown = (number) => String(Number(number.toPrecision(4)));
  const grid = ticks(...up).map((at) => `<path class="grid" d="M${left} ${y(at)}H${right}"/><text class="end" x="${left - 6}" y="${Number(y(at)) + 4}">${shown(at)}</text>`);
  const below = ticks(...across).filter(Number.isInteger).map((at) => `<text class="middle" x="${x(at)}" y="${bottom + 18}">${at}</text>`);
  const curves = lines.map(({ line, band }, k) => {
    const edge = band && [...band.map(([epoch, low]) => [epoch, low]), ...band.map(([epoch, , high]) => [epoch, high]).reverse()];
    const points = (pairs) => pairs.map(([epoch, number]) => `${x(epoch)},${y(number)}`).join(" ");
    const area = edge ? `<polygon class="band" points="${points(edge)}"/>` : "";
    return `<g class="${look(k)}">${area}<polyline class="curve ${dash(k)}" points="${points(line)}"/></g>`;
  });
  const axis = `<text class="end" x="${right}" y="${bottom + 34}">epoch</text>`;
  const chart = document.querySelector("#overlay");
  chart.innerHTML = `<title>${title} over epochs</title>${grid.join("")}${below.join("")}${axis}${curves.join("")}`;
}

function look(k) {
  return `c${k % TINTS}`;
}

function dash(k) {
  return k >= TINTS ? "dashed" : "";
}

function list(lines) {
  const entries = lines.map(({ name, line }, k) => {
    const entry = document.createElement("li");
    entry.className = look(k);
    entry.innerHTML = `<svg viewBox="0 0 32 10" aria-hidden="true"><path class="curve ${dash(k)}" d="M0 5H32"/></svg>`;
    entry.append(line.length ? name : `${name}: no epoch was finished`);
    return entry;
  });
  document.querySelector("#legend").replaceChildren(...entries);
}

function row(kind, texts) {
  const made = document.createElement("tr");
  made.append(...texts.map((one, k) => Object.assign(document.createElement(k && kind === "td" ? "td" : "th"), { textContent: one, scope: kind === "td" ? "row" : "col" })));
  return made;
}

function compareSettings(pair) {
  const shown = document.querySelector("#difference");
  shown.hidden = pair.length !== 2;
  if (shown.hidden) return;
  const [one, other] = pair.map((run) => new Map([...run.querySelectorAll("dl div")].map((entry) => [entry.children[0].textContent, entry.children[1].textContent])));
  const names = [...new Set([...one.keys(), ...other.keys()])].filter((name) => name !== HASH && one.get(name) !== other.get(name));
  shown.tHead.replaceChildren(row("th", ["Different setting", ...pair.map((run) => run.dataset.name)]));
  shown.tBodies[0].replaceChildren(...names.map((name) => row("td", [name, one.get(name) ?? "–", other.get(name) ?? "–"])));
}

function overlay(wanted) {
  const names = wanted.getAll("pick");
  const picked = names.map((name) => runs.find((run) => run.dataset.name === name)).filter(Boolean);
  const kind = wanted.get("curve") in CURVES ? wanted.get("curve") : "validation";
  for (const run of runs) box(run).checked = names.includes(run.dataset.name);
  document.querySelector("#compare").hidden = !picked.length;
  form.elements.curve.value = kind;
  form.elements.mean.checked = wanted.has("mean");
  if (!picked.length) return;
  const lines = drawn(picked, kind, wanted.has("mean"));
  if (lines.some(({ line }) => line.length)) draw(lines, form.elements.curve.selectedOptions[0].text);
  else document.querySelector("#overlay").replaceChildren();
  list(lines);
  compareSettings(picked);
}

table.addEventListener("change", () => {
  const kept = state().getAll("pick").filter((name) => runs.some((run) => run.dataset.name === name && box(run).checked));
  const added = runs.filter((run) => box(run).checked && !kept.includes(run.dataset.name)).map((run) => run.dataset.name);
  change("pick", [...kept, ...added]);
});
form.elements.curve.addEventListener("input", () => change("curve", [form.elements.curve.value]));
form.elements.mean.addEventListener("change", () => change("mean", form.elements.mean.checked ? ["1"] : []));
document.querySelector("#none").addEventListener("click", () => change("pick", []));
