// #verdict=not+reproduced&kind=networks&place=Table+5&filter=knee&sort=-ours&open=noise-floor; open=all for all.
const table = document.querySelector("#statements");
const heads = [...table.tHead.rows[0].cells].filter((head) => head.dataset.key);
const statements = [...table.tBodies];
const form = document.querySelector("form");
const SELECTS = ["verdict", "kind", "place"];
const FIELDS = [...SELECTS, "filter", "sort"];
const ALL = "all"; // of what is opened

function details(statement) {
  return statement.querySelector("details");
}

function fits(statement, wanted) {
  const { verdict, kind, places } = statement.dataset;
  const own = { verdict: [verdict], kind: [kind], place: places.split("|") };
  return SELECTS.every((key) => !wanted.get(key) || own[key].includes(wanted.get(key))) &&
    holds(statement, wanted.get("filter") ?? "");
}

function show() {
  const wanted = address();
  sort(table, heads, statements, wanted.get("sort") ?? "");
  linkHeads(heads, wanted);
  const open = wanted.getAll("open");
  for (const statement of statements) {
    statement.hidden = !fits(statement, wanted);
    const more = details(statement);
    if (more) more.open = open.includes(ALL) || open.includes(statement.dataset.name);
  }
  for (const key of FIELDS) {
    const given = wanted.get(key) ?? "";
    if (form.elements[key].value !== given) form.elements[key].value = given;
  }
  form.querySelector("#all").textContent = open.includes(ALL) ? "Close all" : "Open all";
  const shown = statements.filter((statement) => !statement.hidden).length;
  form.querySelector("#shown").value = `${shown} of ${statements.length} statements`;
}

form.addEventListener("input", ({ target }) => {
  const wanted = address();
  put(wanted, target.name, target.value);
  replace(wanted);
  show();
});
form.addEventListener("submit", (event) => event.preventDefault());
form.querySelector("#all").addEventListener("click", () => {
  const wanted = address();
  put(wanted, "open", wanted.getAll("open").includes(ALL) ? "" : ALL);
  replace(wanted);
  show();
});
table.addEventListener("click", (event) => {
  if (!event.target.closest("summary")) return;
  event.preventDefault(); // the address opens it
  const name = event.target.closest("tbody[data-name]").dataset.name;
  const open = statements.filter((one) => details(one)?.open).map((one) => one.dataset.name);
  const wanted = address();
  wanted.delete("open");
  const next = open.includes(name) ? open.filter((one) => one !== name) : [...open, name];
  next.forEach((one) => wanted.append("open", one));
  replace(wanted);
  show();
});
addEventListener("hashchange", show);
show();
document.querySelector("details[open]")?.scrollIntoView({ block: "nearest" });
