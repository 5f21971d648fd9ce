"use strict";

// The address says what is shown: #sort=-rmse&filter=LSTM&open=LSTM-LL-s0, `-` for descending. Links change it.
const table = document.querySelector("table");
const heads = [...table.tHead.rows[0].cells].filter((head) => head.dataset.key);
const runs = [...table.tBodies]; // a run's row, and the one that opens below it
const filter = document.querySelector("#filter");
const words = new Intl.Collator("en", { numeric: true });

function state() {
  const wanted = new URLSearchParams(location.hash.slice(1));
  if (!wanted.has("sort")) wanted.set("sort", heads[0].dataset.key);
  return wanted;
}

function named(key) {
  return heads.find((head) => head.dataset.key === key);
}

function opener(run) {
  return run.querySelector("th a");
}

function value(run, head) {
  const cell = run.rows[0].cells[head.cellIndex];
  return cell.dataset.value === undefined ? cell.textContent.trim() : parseFloat(cell.dataset.value);
}

function compare(a, b, sign) {
  if (Number.isNaN(a) || Number.isNaN(b)) return Number.isNaN(a) - Number.isNaN(b); // no number comes last
  return sign * (typeof a === "number" ? a - b : words.compare(a, b));
}

function sort(wanted) {
  const sign = wanted.startsWith("-") ? -1 : 1;
  const by = named(wanted.replace(/^-/, "")) ?? heads[0];
  const rows = runs.map((run) => [value(run, by), run]).sort(([a], [b]) => compare(a, b, sign));
  table.append(...rows.map(([, run]) => run));
  heads.forEach((head) => head.removeAttribute("aria-sort"));
  by.setAttribute("aria-sort", sign > 0 ? "ascending" : "descending");
}

function sift(text) {
  const parts = text.toLowerCase().split(/\s+/);
  for (const run of runs) {
    const held = run.rows[0].textContent.toLowerCase();
    run.hidden = !parts.every((part) => held.includes(part));
  }
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
  const sorted = wanted.get("sort");
  for (const head of heads) {
    const next = new URLSearchParams(wanted);
    next.set("sort", sorted === head.dataset.key ? `-${head.dataset.key}` : head.dataset.key);
    head.querySelector("a").href = `#${next}`;
  }
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
  sort(wanted.get("sort"));
  sift(wanted.get("filter") ?? "");
  unfold(wanted.getAll("open"));
  link(wanted);
}

filter.addEventListener("input", () => {
  const wanted = state();
  if (filter.value) wanted.set("filter", filter.value);
  else wanted.delete("filter");
  history.replaceState(null, "", `#${wanted}`);
  show();
});
filter.form.addEventListener("submit", (event) => event.preventDefault());
addEventListener("hashchange", show);
show();
document.querySelector(".open")?.scrollIntoView({ block: "nearest" });
