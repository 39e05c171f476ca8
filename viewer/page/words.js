// Tables of words and numbers.

/** A number that is copied or saved: to the digits that columns have, unless it counts something. */
function plain(value) {
  if (!Number.isFinite(value)) return "";
  return String(Number.isInteger(value) ? value : +value.toPrecision(5));
}

/** Facts that are one number along x and one along y. */
const ALONG_X_AND_Y = /^(sides|cells|grid\..*)$/;

/** Facts as rows. */
function factRows(facts) {
  const text = ({ name, value, unit }) => factText(value, unit, ALONG_X_AND_Y.test(name) ? " × " : ", ");
  return facts.map((fact) => make("tr", {}, make("th", { scope: "row" }, fact.name), make("td", {}, text(fact))));
}

function factText(value, unit, between = ", ") {
  const part = (one) => (Array.isArray(one) ? `[${factText(one, unit)}]` : factText(one, unit));
  if (Array.isArray(value)) return value.map(part).join(between);
  if (Number.isSafeInteger(value) && unit === "") return String(value);
  if (typeof value === "number") return unit === "1" ? `${digits(100 * value)} %` : unit ? quantity(value, unit) : digits(value);
  return typeof value === "string" ? value : JSON.stringify(value);
}

const facts = (title, rows, kind = "") => (rows.length ? make("section", { class: `facts ${kind}` }, make("h2", {}, title), make("table", {}, make("tbody", {}, ...rows))) : null);

/** The columns of the table of states: words, unit, and the value at an event. */
function tableColumns(path) {
  const columns = SCALARS.filter(([, name]) => path.columns[name]).map(([words, name, unit]) => ({ words, name, unit, of: (event) => path.columns[name][event] }));
  columns.unshift({ words: "event", name: "event", unit: "", of: (event) => event + 1 });
  if (path.states.length) {
    const greatest = new Map(path.states.map((state) => [state.event, state.pressure]));
    columns.splice(3, 0, { words: "greatest pressure", name: "greatest_pressure", unit: "Pa", of: (event) => greatest.get(event) ?? NaN });
  }
  return columns;
}

/** Events that the table has: the states with pressure, or some spread over the path. */
function tableEvents(path) {
  if (path.states.length) return path.states.map((state) => state.event);
  const events = Array.from({ length: 24 }, (_, i) => path.eventAt("load", path.columns.load.at(-1) * ((i + 1) / 24) ** 3));
  return [...new Set(events)];
}

/** The table of states; a row takes the slider to its state. */
function stateTable(path, onEvent) {
  const { nominal_area: nominal } = path.record;
  const columns = tableColumns(path), events = tableEvents(path);
  const units = columns.map(({ unit, of }) => (unit === "nodes" ? { name: "nodes", factor: 1 } : unitFor(unit, Math.max(...events.map(of).filter(Number.isFinite).map(Math.abs), 0), nominal)));
  const text = (column, unit, event) => {
    const value = column.of(event);
    return unit.factor === 1 && Number.isInteger(value) ? String(value) : digits(value / unit.factor);
  };
  const head = make("thead", {}, make("tr", {}, ...columns.map(({ words }, i) => make("th", { scope: "col" }, words, make("small", {}, units[i].name ? `[${units[i].name}]` : "")))));
  const rows = events.map((event) =>
    make("tr", { "data-event": event }, ...columns.map((column, i) => {
      if (i > 0) return make("td", {}, text(column, units[i], event));
      const button = make("button", { type: "button", class: "go", "aria-label": `to event ${event + 1}`, onclick: () => onEvent(event) }, String(event + 1));
      return make("td", {}, button);
    })),
  );
  const table = make("table", { class: "states" }, head, make("tbody", {}, ...rows));
  const lines = (separator) => [
    columns.map(({ words }, i) => (units[i].name ? `${words} [${units[i].name}]` : words)),
    ...events.map((event) => columns.map((column, i) => plain(column.of(event) / units[i].factor))),
  ].map((cells) => cells.join(separator)).join("\n") + "\n";
  const si = () => [
    columns.map(({ name, unit }) => (unit && unit !== "1" && unit !== "nodes" ? `${name} [${unit}]` : name)),
    ...events.map((event) => columns.map((column) => plain(column.of(event)))),
  ].map((cells) => cells.join(",")).join("\n") + "\n";
  const told = make("span", { role: "status", class: "told" });
  const copy = make("button", { type: "button", onclick: async () => (told.textContent = await copied(lines("\t"), table)) }, "Copy the table");
  const save = make("button", { type: "button", class: "save", onclick: () => saveText("states.csv", "text/csv", si()) }, "Save as CSV (SI units)");
  return make("section", { class: "table" }, make("h2", {}, `States of ${path.record.name}`), make("div", { class: "row small" }, copy, save, told), make("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Table of states" }, table));
}

/** Units of columns of other tables, by their names. */
const COLUMN_UNITS = [
  [/area_fraction$|^loss_factor$|^contact_area_fraction$/, ""],
  [/pressure/, "Pa"],
  [/load$|^amplitude$/, "N"],
  [/stiffness/, "N/m"],
  [/leak_rate/, "m³/s"],
  [/permeability/, "m³/(Pa s)"],
  [/_area$|^contact_area$/, "m²"],
  [/^time$|period/, "s"],
  [/frequency/, "Hz"],
  [/dissip|energy|^dissipated$/, "J"],
  [/gap|approach|displacement|distance/, "m"],
];
const unitOfColumn = (name) => COLUMN_UNITS.find(([pattern]) => pattern.test(name))?.[1] ?? "";

/** Whether a logarithmic axis suits values: zeros, which it leaves out, do not count. */
function isSteep(values) {
  const positive = values.filter((value) => value > 0);
  return !values.some((value) => value < 0) && Math.max(...positive) > 200 * Math.min(...positive);
}

/** What another command has computed of a record: its charts. `number` is that of the record, null if there is one. */
function panel(found, number) {
  const letter = number === null || found.both ? "" : "AB"[number];
  const colour = found.both ? ink("--soft") : lineColour(number ?? 0);
  const where = found.folder ? `in ${found.folder}` : `beside ${found.both ? "both records" : "the record"}`;
  const columns = found.columns.map(({ name, values }) => ({ name, values: values.map((value) => value ?? NaN) }));
  const along = columns.find(({ name }) => name === found.along);
  const title = make("h2", {}, letter ? `${letter}: ${found.title}` : found.title);
  const note = make("p", { class: "note" }, `${found.lines} lines of ${found.file}, ${where}`);
  const section = make("section", { class: "panel" }, title, note);
  const charts = found.charts
    .map((name) => columns.find((column) => column.name === name))
    .filter((column) => column && column.values.some(Number.isFinite))
    .map((column) => {
      const words = (name) => name.replaceAll("_", " ");
      const known = along.values.map((_, i) => i).filter((i) => Number.isFinite(along.values[i]));
      const x = known.map((i) => along.values[i]), y = known.map((i) => column.values[i]);
      const rows = x.map((_, i) => i), places = rows.slice().sort((a, b) => x[a] - x[b]);
      const at = (value) => x.reduce((best, one, i) => (Math.abs(one - value) < Math.abs(x[best] - value) ? i : best), 0);
      const line = { label: "", colour, dash: 0, x, y, at, places };
      // A loop has several values at one place.
      const isLoop = x.some((value, i) => value > x[i - 1]) && x.some((value, i) => value < x[i - 1]);
      if (isLoop) Object.assign(line, { rows, at: null });
      const axis = ({ name }, log) => ({ words: words(name), unit: unitOfColumn(name), log });
      const title = `${letter} ${found.short}: ${words(column.name)}`.trim();
      return new Chart(title, axis(along, found.log && isSteep(x)), axis(column, isSteep(y)), [line]);
    });
  section.append(make("div", { class: "charts" }, ...charts.map(({ figure }) => figure)));
  return { section, charts, along: along.name };
}

/** What is said of a record. */
function wordsOf(record) {
  const settings = Object.entries(record.settings ?? {}).filter(([, value]) => value !== null).map(([name, value]) => ({ name, value, unit: "" }));
  const warnings = [...record.warnings.map((words) => `Warning: ${words}`), ...record.notes.map((words) => `Note: ${words}`)];
  return make(
    "section",
    { class: "record" },
    make("h2", { class: "name" }, record.name),
    warnings.length ? make("ul", { class: "warnings" }, ...warnings.map((words) => make("li", {}, words))) : null,
    make(
      "div",
      { class: "columns" },
      facts("Surface, half-space, bodies", factRows(record.facts)),
      facts("How exact: residuals of the last state, 0 is exact", factRows(record.certificate)),
      facts("Settings", factRows(settings), "settings"),
    ),
  );
}
