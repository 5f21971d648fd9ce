"use strict";

// What pages with a table share. The address says what is shown: #sort=-rmse&filter=LSTM, `-` for descending.
const words = new Intl.Collator("en", { numeric: true });

function address() {
  return new URLSearchParams(location.hash.slice(1));
}

function replace(wanted) {
  history.replaceState(null, "", `#${wanted}`);
}

function put(wanted, key, value) {
  if (value) wanted.set(key, value);
  else wanted.delete(key);
}

function value(body, head) {
  const cell = body.rows[0].cells[head.cellIndex];
  return cell.dataset.value === undefined ? cell.textContent.trim() : parseFloat(cell.dataset.value);
}

function compare(a, b, sign) {
  if (Number.isNaN(a) || Number.isNaN(b)) return Number.isNaN(a) - Number.isNaN(b); // no number comes last
  return sign * (typeof a === "number" ? a - b : words.compare(a, b));
}

// Order the bodies of a table by the head with a key, or leave them in their own order where no head has it.
function sort(table, heads, bodies, key) {
  const sign = key.startsWith("-") ? -1 : 1;
  const by = heads.find((head) => head.dataset.key === key.replace(/^-/, ""));
  const rows = bodies.map((body) => [by && value(body, by), body]);
  if (by) rows.sort(([a], [b]) => compare(a, b, sign));
  table.append(...rows.map(([, body]) => body));
  heads.forEach((head) => head.removeAttribute("aria-sort"));
  by?.setAttribute("aria-sort", sign > 0 ? "ascending" : "descending");
}

function linkHeads(heads, wanted) {
  for (const head of heads) {
    const next = new URLSearchParams(wanted);
    const { key } = head.dataset;
    next.set("sort", wanted.get("sort") === key ? `-${key}` : key);
    head.querySelector("a").href = `#${next}`;
  }
}

function holds(element, text) {
  const held = element.textContent.toLowerCase();
  return text.toLowerCase().split(/\s+/).every((part) => held.includes(part));
}
