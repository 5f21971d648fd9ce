// #sort=-rmse&filter=LSTM&open=LSTM-LL-s0&pick=GRU-LL-s0&curve=rmse&mean=1
const table = document.querySelector("#runs");
const heads = [...table.tHead.rows[0].cells].filter((head) => head.dataset.key);
const runs = [...table.tBodies]; // a run's row, and the one that opens below it
const filter = document.querySelector("#filter");

function state() {
  const wanted = address();
  if (!wanted.has("sort")) wanted.set("sort", heads[0].dataset.key);
  return wanted;
}

function named(key) {
  return heads.find((head) => head.dataset.key === key);
}

function opener(run) {
  return run.querySelector("th a");
}

function box(run) {
  return run.querySelector("th input");
}

function sift(text) {
  for (const run of runs) run.hidden = !holds(run.rows[0], text);
  if (filter.value !== text) filter.value = text;
  const shown = runs.filter((run) => !run.hidden);
  const hours = shown.reduce((sum, run) => sum + (value(run, named("seconds")) || 0), 0) / 3600;
  document.querySelector("#shown").value = `${shown.length} of ${runs.length} runs, ${hours.toFixed(2)} h of training`;
}

function unfold(names) {
  for (const run of runs) {
    const open = names.includes(run.dataset.name);
    run.classList.toggle("open", open);
    opener(run).setAttribute("aria-expanded", open);
    opener(run).setAttribute("aria-controls", run.rows[1].id);
  }
}

function link(wanted) {
  linkHeads(heads, wanted);
  for (const run of runs) {
    const next = new URLSearchParams(wanted);
    const open = next.getAll("open").filter((name) => name !== run.dataset.name);
    if (!run.classList.contains("open")) open.push(run.dataset.name);
    next.delete("open");
    open.forEach((name) => next.append("open", name));
    opener(run).href = `#${next}`;
  }
}

function show() {
  const wanted = state();
  sort(table, heads, runs, named(wanted.get("sort").replace(/^-/, "")) ? wanted.get("sort") : heads[0].dataset.key);
  sift(wanted.get("filter") ?? "");
  unfold(wanted.getAll("open"));
  link(wanted);
  overlay(wanted);
}

function change(key, values) {
  const wanted = state();
  wanted.delete(key);
  values.forEach((one) => wanted.append(key, one));
  replace(wanted);
  show();
}

filter.addEventListener("input", () => change("filter", filter.value ? [filter.value] : []));
document.querySelectorAll("form").forEach((form) => form.addEventListener("submit", (event) => event.preventDefault()));
addEventListener("hashchange", show);
