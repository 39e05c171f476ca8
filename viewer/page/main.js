// The page: its slider, and what follows it.

const byId = (id) => document.getElementById(id);
const STEPS = 100000;
/** Seconds in which play goes over the whole path. */
const PLAY = 14;

class Viewer {
  constructor(paths, data) {
    Object.assign(this, { charts: [], panels: [], marked: [] });
    this.controls();
    this.begin(paths, data);
    new ResizeObserver(() => this.resized()).observe(byId("stage"));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.remake());
    addEventListener("beforeprint", () => this.forPrint());
  }

  /** Shows these paths, at their end. */
  begin(paths, data) {
    this.stop();
    Object.assign(this, { paths, data, lead: 0, event: paths[0].count - 1, along: "load", logX: false, logY: false });
    this.maps = paths.map((path, index) => new MapView(path, index, paths[0], (lead, event) => this.goTo(event, lead)));
    byId("maps").replaceChildren(...this.maps.map(({ figure }) => figure));
    const several = paths.length > 1;
    for (const id of ["stage", "tables", "words"]) byId(id).classList.toggle("two", several);
    byId("reads").replaceChildren(...this.maps.map(({ readout, path }, i) => make("div", {}, several ? make("p", { class: "which" }, `${"AB"[i]}: ${path.record.name} `, this.maps[i].ended) : "", readout)));
    byId("lead-label").hidden = !several;
    byId("lead").replaceChildren(...paths.map((path, i) => option([i, `${"AB"[i]}: ${path.record.name}`])));
    // On the way to full contact most happens at small loads.
    const { columns } = paths[0], half = paths[0].eventAt("load", 0.5 * columns.load.at(-1));
    this.logX = this.logY = columns.area[half] > 0.75 * columns.area.at(-1);
    const ends = paths.map((path) => path.columns.load.at(-1));
    if (Math.max(...ends) > 3 * Math.min(...ends)) this.logX = true;
    byId("along").value = this.along;
    byId("log-x").checked = this.logX;
    byId("log-y").checked = this.logY;
    this.remake();
    this.goTo(this.event);
    this.maps.forEach((map) => map.point(null));
  }

  /** Whether these are the paths that are shown, which have gone on. */
  canTake(paths) {
    return paths.length === this.paths.length && paths.every((path, i) => path.continues(this.paths[i]));
  }

  /** Paths that have gone on: the slider stays where the reader has left it, or goes on with the end. */
  take(paths, data) {
    const isAtEnd = this.event === this.path.count - 1 && !this.playing;
    Object.assign(this, { paths, data });
    this.maps.forEach((map, i) => map.take(paths[i], paths[0]));
    if (isAtEnd) this.event = this.path.count - 1;
    this.remake();
  }

  get path() {
    return this.paths[this.lead];
  }

  /** What slider and charts run over, of the path that leads. */
  get values() {
    return this.path.grown(this.along);
  }

  ends() {
    const { values } = this, last = values.at(-1);
    const first = this.logX ? values.find((value) => value > 0) ?? last : values[0];
    return [first, last].map((value) => (this.logX ? Math.log(value) : value));
  }

  /** The place on the slider of an event, 0 to 1. */
  placeOf(event) {
    const [from, to] = this.ends(), value = this.values[event];
    const at = this.logX ? (value > 0 ? Math.log(value) : from) : value;
    return to > from ? Math.min(1, Math.max(0, (at - from) / (to - from))) : 1;
  }

  eventAt(place) {
    if (place >= 1) return this.path.count - 1;
    const [from, to] = this.ends(), at = from + place * (to - from);
    // The slider stands before an event by rounding.
    return this.path.eventAt(this.along, (this.logX ? Math.exp(at) : at) * (1 + 1e-12));
  }

  /** To the state after an event of a path, which leads from now on. */
  goTo(event, lead = this.lead) {
    if (lead !== this.lead) {
      this.lead = lead;
      byId("lead").value = String(lead);
    }
    this.event = Math.min(this.path.count - 1, Math.max(0, event));
    const slider = byId("slider");
    if (!this.sliding) slider.value = String(Math.round(this.placeOf(this.event) * STEPS));
    const value = this.values[this.event];
    this.maps.forEach((map, i) => {
      map.show(i === this.lead ? this.event : map.path.eventAt(this.along, value));
      map.ended.hidden = !(value > map.path.grown(this.along).at(-1));
    });
    const events = this.maps.map(({ event, ended }) => (ended.hidden ? event : null));
    this.charts.forEach((chart) => chart.setPlace(value, events));
    // Other tables are of one path, and some of them run over its load.
    this.panels.filter(({ along }) => along === "load").forEach(({ charts, path }) => charts.forEach((chart) => chart.setPlace(path.columns.load[path.present])));
    this.marked.forEach((row) => row.classList.remove("now"));
    this.marked = this.rows.flatMap((rows, i) => rows.get(this.maps[i].event) ?? []);
    this.marked.forEach((row) => row.classList.add("now"));
    const { columns, contactNodes } = this.path;
    const words = `${quantity(columns.load[this.event], "N")}, ${contactNodes[this.event]} nodes in contact, ${digits(100 * columns.area[this.event])} %, event ${this.event + 1} of ${this.path.count}`;
    slider.setAttribute("aria-valuetext", words);
    clearTimeout(this.telling);
    this.telling = setTimeout(() => {
      byId("said").textContent = words;
      this.maps.forEach((map) => map.describe());
      this.charts.forEach((chart) => chart.describe());
    }, 400);
  }

  /** Everything that units, colours and axes change. */
  remake() {
    const { paths, along, logX, logY } = this;
    this.everyChart().forEach((chart) => chart.plot.destroy());
    const chosenAlong = ALONG.find(([name]) => name === along);
    this.maps.forEach((map) => map.recolour());
    const several = paths.length > 1, nominal = paths[0].record.nominal_area;
    // The slider compares parts of the area.
    const common = paths.every((path) => path.record.nominal_area === nominal) ? nominal : undefined;
    this.charts = CHARTS.flatMap(([title, unit, series]) => {
      const lines = paths.flatMap((path, record) => {
        const end = path.grown(along).at(-1) * (1 + 1e-12);
        const at = (value) => (value > end ? null : path.eventAt(along, value * (1 + 1e-12)));
        return series
          .map(([name, label], dash) => ({ name, label: several ? `${"AB"[record]} ${label}`.trim() : label, dash }))
          .filter(({ name }) => path.columns[name] && (name !== "yielded" || path.hasYielded))
          .map(({ name, label, dash }) => {
            const { columns, record: { nominal_area: nominal } } = path;
            const line = { label, dash, colour: lineColour(record), x: columns[along], y: columns[name], record, nominal, at };
            // Fields are known at few states.
            if (name !== "greatest_pressure") return line;
            return { ...line, places: path.states.map(({ event }) => event), of: (event) => path.nearest(event).event };
          });
      });
      if (!lines.length) return [];
      const x = { words: chosenAlong[1], unit: chosenAlong[2], log: logX, nominal: common };
      return [new Chart(title, x, { words: title.toLowerCase().replace(", of the contact", ""), unit, log: logY, nominal }, lines, (value) => this.toValue(value))];
    });
    byId("charts").replaceChildren(...this.charts.map(({ figure }) => figure));
    this.charts.forEach((chart) => chart.draw());
    this.panels = paths.flatMap((path, i) => {
      return path.record.panels.map((found) => ({ ...panel(found, several ? i : null), path }));
    });
    const tables = paths.map((path, lead) => stateTable(path, (event) => this.goTo(event, lead)));
    byId("panels").replaceChildren(...this.panels.map(({ section }) => section));
    byId("tables").replaceChildren(...tables);
    byId("words").replaceChildren(...paths.map((path) => wordsOf(path.record)));
    this.everyChart().slice(this.charts.length).forEach((chart) => chart.draw());
    const rowsOf = (table) => [...table.querySelectorAll("tr[data-event]")].map((row) => [Number(row.dataset.event), row]);
    this.rows = tables.map((table) => new Map(rowsOf(table)));
    this.width = byId("stage").clientWidth;
    this.goTo(this.event);
  }

  /** To the state of the leading path at a value along the charts. */
  toValue(value) {
    this.goTo(this.path.eventAt(this.along, value * (1 + 1e-12)));
  }

  resized() {
    if (byId("stage").clientWidth === this.width) return;
    this.width = byId("stage").clientWidth;
    for (const chart of this.everyChart()) chart.plot.setSize({ width: chart.holder.clientWidth || 360, height: 210 });
    this.maps.forEach((map) => map.mark());
  }

  everyChart() {
    return [...this.charts, ...this.panels.flatMap(({ charts }) => charts)];
  }

  forPrint() {
    for (const chart of this.everyChart()) chart.print.innerHTML = svgOf(chart);
  }

  controls() {
    byId("along").append(...ALONG.map(([name, words]) => option([name, words])));
    byId("along").onchange = (event) => {
      this.along = event.target.value;
      this.remake();
    };
    for (const [id, name] of [["log-x", "logX"], ["log-y", "logY"]]) {
      byId(id).onchange = (event) => {
        this[name] = event.target.checked;
        this.remake();
      };
    }
    for (const [kind, units] of Object.entries(CHOICES)) {
      const select = byId(`unit-${kind}`);
      select.append(...units.map((unit) => option([unit, unit])));
      select.value = chosen[kind];
      select.onchange = () => {
        chosen[kind] = select.value;
        this.remake();
      };
    }
    byId("theme").onchange = (event) => {
      const { value } = event.target;
      if (value) document.documentElement.dataset.theme = value;
      else delete document.documentElement.dataset.theme;
      this.remake();
    };
    byId("lead").onchange = (event) => {
      const value = this.values[this.event];
      this.lead = Number(event.target.value);
      this.toValue(value);
    };
    byId("print").onclick = () => window.print();
    byId("play").onclick = () => this.play();
    byId("back").onclick = () => this.goTo(this.event - 1);
    byId("on").onclick = () => this.goTo(this.event + 1);
    const slider = byId("slider");
    slider.oninput = () => {
      this.stop();
      this.asked = Number(slider.value) / STEPS;
      // One picture for all that was asked for since the last.
      this.waiting ??= requestAnimationFrame(() => {
        this.waiting = undefined;
        this.sliding = true;
        this.goTo(this.eventAt(this.asked));
        this.sliding = false;
      });
    };
    addEventListener("keydown", (event) => this.key(event));
  }

  key(event) {
    const { target } = event, own = target.closest("select, input:not(#slider), button, .scroll, a");
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const hundredth = Math.max(1, Math.round(this.path.count / 100));
    const steps = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -hundredth, PageUp: hundredth, Home: -Infinity, End: Infinity };
    if (event.key === " ") {
      if (own) return;
      this.play();
    } else if (event.key === "[" || event.key === "]") {
      const events = this.path.states.map((state) => state.event);
      const next = event.key === "]" ? events.find((place) => place > this.event) : events.findLast((place) => place < this.event);
      if (next !== undefined) this.goTo(next);
    } else if (event.key in steps && (target.id === "slider" || !own)) {
      // Arrows up and down scroll the page unless the slider has the keyboard.
      if (target.id !== "slider" && event.key.match(/Arrow(Up|Down)/)) return;
      this.stop();
      this.goTo(this.event + steps[event.key]);
    } else return;
    event.preventDefault();
  }

  play() {
    if (this.playing) return this.stop();
    byId("play").textContent = "Stop";
    byId("play").setAttribute("aria-pressed", "true");
    let place = this.placeOf(this.event) >= 1 ? 0 : this.placeOf(this.event), before = performance.now();
    if (place === 0) this.goTo(this.eventAt(0));
    const frame = (now) => {
      place += (now - before) / 1000 / PLAY;
      before = now;
      // Where nothing happens for long, play waits for nobody.
      this.goTo(Math.max(this.event, this.eventAt(Math.min(1, place))));
      if (place < 1) this.playing = requestAnimationFrame(frame);
      else this.stop();
    };
    this.playing = requestAnimationFrame(frame);
  }

  stop() {
    cancelAnimationFrame(this.playing);
    this.playing = undefined;
    byId("play").textContent = "Play";
    byId("play").setAttribute("aria-pressed", "false");
  }
}

/** The paths of the data of a page, with their names above them; paths that are shown already go on. */
async function showPaths(data) {
  demand(data.format === 1, "The data of this file are not those of this page.");
  demand(Array.isArray(data.records) && data.records.length > 0, "There is no record in this file.");
  // Once there is a page, its reader chooses.
  if (!window.viewer) Object.assign(chosen, data.units);
  const paths = [];
  for (const record of data.records) paths.push(await ContactPath.of(record));
  const names = data.records.map(({ name }) => name);
  document.title = `${names.join(" and ")} – asperity`;
  byId("title").textContent = names.join(" and ");
  byId("subtitle").textContent = paths.map((path) => `${path.count} states of contact on ${path.nx} × ${path.ny} nodes, to ${quantity(path.columns.load.at(-1), "N")} and ${digits(100 * path.columns.area.at(-1))} %`).join("; ");
  byId("footer").textContent = `${data.program}${data.command ? `; this page: ${data.command}` : ""}`;
  byId("all").hidden = byId("page-controls").hidden = false;
  if (!window.viewer) window.viewer = new Viewer(paths, data);
  else if (window.viewer.canTake(paths)) window.viewer.take(paths, data);
  else window.viewer.begin(paths, data);
}
