// The map of contact at a state.

/** An element with attributes and children; text is only ever text. */
function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (value !== null && value !== false) element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

/** Width over height of a map. One of a profile is made higher or wider than it is, to be seen. */
const shown = (lx, ly) => Math.min(8, Math.max(1 / 8, lx / ly));

const option = ([value, words]) => make("option", { value }, words);

/** The scalars that are read out: name, column, unit. */
const SCALARS = [
  ["load", "load", "N"],
  ["mean pressure", "mean_pressure", "Pa"],
  ["contact area", "area", "1"],
  ["corrected for edges", "corrected", "1"],
  ["yielded", "yielded", "1"],
  ["approach", "approach", "m"],
  ["mean gap", "mean_gap", "m"],
  ["contact stiffness K", "contact_stiffness", "N/m"],
  ["interfacial stiffness Kᵢ", "interfacial_stiffness", "N/m"],
  ["patches", "patches", ""],
  ["greatest patch", "largest_patch", "nodes"],
  ["plastic volume", "plastic_volume", "m³"],
];

/** How far back "touching now" reaches: this part of the nodes in contact. */
const NEWEST = 0.01;

class MapView {
  /** `scale` is the path whose loads the colours are of: the first of the page, for all maps. */
  constructor(path, index, scale, onEvent) {
    Object.assign(this, { index, onEvent, event: path.count - 1, node: null });
    const { nx, ny, record } = path;
    this.canvas = make("canvas", { width: nx, height: ny, class: "nodes" });
    this.marks = make("canvas", { class: "marks", tabindex: 0, role: "img" });
    this.colour = make("select", { "aria-label": "Colour of nodes in contact" });
    this.ground = make("select", { "aria-label": "Colour of nodes out of contact" });
    this.orange = make("input", { type: "checkbox", checked: true });
    this.bar = make("canvas", { class: "bar", width: 256, height: 1, "aria-hidden": "true" });
    this.ticks = make("div", { class: "ticks" });
    this.key = make("p", { class: "key" });
    this.under = make("p", { class: "under" });
    this.box = make("div", { class: "box" }, this.canvas, this.marks);
    this.box.style.aspectRatio = String(shown(record.lx, record.ly));
    this.ended = make("em", {}, "has ended here");
    this.readout = make("dl", { class: "readout" });
    this.isOrange = make("label", {}, this.orange, " yielded nodes orange");
    const save = make("button", { type: "button", class: "save", onclick: () => saveMap(this) }, "Save map as PNG");
    this.figure = make(
      "figure",
      { class: "map" },
      make("figcaption", { class: "name" }, record.name),
      this.box,
      this.bar,
      this.ticks,
      this.key,
      make("div", { class: "row small" }, make("label", {}, "contact ", this.colour), make("label", {}, "elsewhere ", this.ground), this.isOrange, save),
      this.under,
    );
    this.context = this.canvas.getContext("2d");
    this.image = this.context.createImageData(nx, ny);
    this.pixels = new Uint32Array(this.image.data.buffer);
    this.colour.onchange = this.ground.onchange = this.orange.onchange = () => this.recolour();
    this.marks.addEventListener("pointermove", (event) => this.point(this.nodeAt(event)));
    this.marks.addEventListener("pointerleave", () => this.point(null));
    this.marks.addEventListener("click", (event) => this.ask(this.nodeAt(event)));
    this.marks.addEventListener("keydown", (event) => this.steer(event));
    this.take(path, scale);
    this.describe();
  }

  /** The path, or one that goes on where it ended. */
  take(path, scale) {
    Object.assign(this, { path, scale, kept: undefined });
    this.event = Math.min(this.event, path.count - 1);
    const choose = (select, options) => {
      const { value } = select;
      select.replaceChildren(...options.map(option));
      if (options.some(([name]) => name === value)) select.value = value;
    };
    const some = path.states.length > 0;
    choose(this.colour, [["touch", "load at which it touched"], ...(some ? [["pressure", "pressure"]] : []), ["plain", "one colour"]]);
    choose(this.ground, [["plain", "plain"], ...(some ? [["gap", "gap"]] : []), ["heights", "heights"]]);
    this.isOrange.hidden = !path.hasYielded;
    this.values = SCALARS.filter(([, name]) => path.columns[name]).map(([words, name, unit]) => ({ words, name, unit, value: make("dd") }));
    this.readout.replaceChildren(...this.values.map(({ words, value }) => make("div", {}, make("dt", {}, words), value)));
    this.recolour();
  }

  nodeAt(event) {
    const { nx, ny } = this.path, box = this.marks.getBoundingClientRect();
    const ix = Math.floor(((event.clientX - box.left) / box.width) * nx), iy = Math.floor((1 - (event.clientY - box.top) / box.height) * ny);
    return ix >= 0 && iy >= 0 && ix < nx && iy < ny ? ix + nx * iy : null;
  }

  /** To the state at which a node touches. */
  ask(node) {
    if (node !== null && this.path.first[node] >= 0) this.onEvent(this.index, this.path.first[node]);
  }

  /** Keys move from node to node. */
  steer(event) {
    const { nx, ny } = this.path, now = this.node ?? this.path.nodes[this.event];
    const step = event.shiftKey ? 10 : 1;
    const [dx, dy] = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] }[event.key] ?? [];
    if (dx !== undefined) {
      const held = (value, size) => Math.min(size - 1, Math.max(0, value));
      this.point(held((now % nx) + dx, nx) + nx * held(Math.floor(now / nx) + dy, ny));
    } else if (event.key === "Enter") this.ask(now);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  /** Which state has the pressure, or the gap, that is shown. */
  state() {
    return this.path.nearest(this.event);
  }

  /** How many nodes are "touching now". */
  newestNodes() {
    return Math.max(1, Math.ceil(NEWEST * this.path.contactNodes[this.event]));
  }

  /** The event after which they have touched: other events, and touches that were undone, do not count. */
  beforeNewest() {
    const { touched, nodes } = this.path;
    let from = this.event;
    for (let left = this.newestNodes(); left > 0 && from >= 0; from--) if (touched[nodes[from]] === from) left--;
    return from;
  }

  /** Colours of all nodes once they are in contact, by the order in which they touch. */
  recolour() {
    const { path, scale } = this, by = new Uint32Array(path.size);
    const { load } = path.columns, last = Math.max(1, scale.contactNodes[scale.count - 1]);
    for (let node = 0; node < path.size; node++) {
      const first = path.first[node];
      if (first < 0) continue;
      const event = path === scale ? first : scale.eventAt("load", load[first]);
      by[node] = viridis[Math.min(255, Math.floor((256 * (scale.contactNodes[event] - 1)) / last))];
    }
    this.byTouch = by;
    this.themed = themed();
    this.greys = greys(255);
    this.show(this.event);
  }

  show(event) {
    const { path, pixels } = this, { nx, ny } = path;
    this.event = event;
    path.goTo(event);
    const { touched, yielded, columns } = path;
    const state = this.state();
    const mode = this.colour.value, ground = this.ground.value;
    const newest = this.beforeNewest();
    const { out, newest: fresh } = this.themed, plain = viridis[110];
    const scale = state ? 255 / state.levels : 0, orange = this.orange.checked, shades = mode === "pressure" ? this.shadesOf(state) : null;
    for (let iy = 0, node = 0; iy < ny; iy++) {
      let pixel = (ny - 1 - iy) * nx;
      for (let ix = 0; ix < nx; ix++, node++, pixel++) {
        const at = touched[node];
        if (at < 0) {
          if (ground === "plain") pixels[pixel] = out;
          else if (ground === "gap") pixels[pixel] = this.greys[state.isIn[node] ? 0 : Math.round(state.codes[node] * scale)];
          else pixels[pixel] = this.greys[255 - path.heights[node]];
        } else if (orange && yielded[node] >= 0) pixels[pixel] = YIELDED;
        else if (mode === "touch") pixels[pixel] = at > newest ? fresh : this.byTouch[node];
        else if (mode === "pressure") pixels[pixel] = state.isIn[node] ? shades[state.codes[node]] : fresh;
        else pixels[pixel] = at > newest ? fresh : plain;
      }
    }
    this.context.putImageData(this.image, 0, 0);
    for (const { name, unit, value } of this.values) value.textContent = this.scalar(name, unit, columns[name][event]);
    this.words(state);
    this.mark();
  }

  scalar(name, unit, value) {
    const { path } = this;
    if (unit === "nodes") return `${value} nodes, ${digits((100 * value) / path.contactNodes[this.event], 3)} % of the contact`;
    if (name === "area") return `${quantity(value, "1", path.record.nominal_area)} (${path.contactNodes[this.event]} nodes)`;
    if (unit === "") return String(value);
    return quantity(value, unit, path.record.nominal_area);
  }

  /** The colour bar, and what its colours mean. */
  words(state) {
    const { path, event } = this, mode = this.colour.value;
    const kept = `${mode} ${this.ground.value} ${state?.number} ${Object.values(chosen)} ${isDark()} ${this.orange.checked}`;
    const newest = this.newestNodes();
    const fresh = mode === "pressure" ? (state.event < event ? "touched since that state" : "") : newest === 1 ? "touching now" : `touching now: the newest ${newest}`;
    if (kept === this.kept && fresh === this.fresh) return;
    Object.assign(this, { kept, fresh });
    const bar = this.bar.getContext("2d"), line = bar.createImageData(256, 1);
    new Uint32Array(line.data.buffer).set(viridis);
    bar.putImageData(line, 0, 0);
    this.bar.hidden = this.ticks.hidden = mode === "plain";
    this.ticks.replaceChildren(...this.scaleTicks(state).map((words) => make("span", {}, words)));
    const swatch = (colour, words) => make("span", {}, make("i", { style: `background: ${css(colour)}` }), words);
    const meaning = mode === "touch" ? `colour: load at which the node touched; each colour covers the same area${this.scale === path ? "" : " of A"}` : mode === "pressure" ? `pressure at ${this.nameOf(state)}` : "in contact";
    const gap = this.ground.value === "gap" ? `grey: gap at ${this.nameOf(state)}, dark up to ${quantity(state.gap, "m")}, by the root` : this.ground.value === "heights" ? `grey: heights over ${quantity(path.record.heights.greatest - path.record.heights.least, "m")}, light is high` : null;
    this.key.replaceChildren(
      make("span", {}, meaning),
      ...(fresh ? [swatch(this.themed.newest, fresh)] : []),
      ...(path.hasYielded && this.orange.checked ? [swatch(YIELDED, "yielded")] : []),
      this.ground.value === "plain" ? swatch(this.themed.out, "out of contact") : make("span", {}, gap),
    );
  }

  /** Colours of the levels of pressure: up to what a hundredth of the contact is above, so that a few peaks do not darken the rest. */
  shadesOf(state) {
    if (!state.shades) {
      const { codes, isIn, levels } = state, counts = new Uint32Array(levels + 1);
      codes.forEach((code, node) => (counts[code] += isIn[node]));
      let above = counts.reduce((sum, count) => sum + count, 0) / 100, top = levels;
      while (top > 1 && counts[top] <= above) above -= counts[top--];
      state.top = (top / levels) ** 2;
      state.shades = Uint32Array.from(counts, (_, code) => viridis[Math.min(255, Math.round((255 * (code / levels) ** 2) / state.top))]);
    }
    return state.shades;
  }

  nameOf(state) {
    return `${quantity(this.path.columns.load[state.event], "N")} (state ${state.number} of ${this.path.states.length}, the nearest)`;
  }

  scaleTicks(state) {
    if (this.colour.value === "pressure") return [0, 0.25, 0.5, 0.75, 1].map((part) => (part === 1 && state.top < 1 ? "≥ " : "") + quantity(part * state.top * state.pressure, "Pa"));
    const { scale } = this, last = scale.contactNodes[scale.count - 1];
    return [0, 0.25, 0.5, 0.75, 1].map((part) => {
      const nodes = Math.max(1, Math.round(part * last));
      const event = scale.contactNodes.findIndex((count) => count >= nodes);
      return quantity(scale.columns.load[event], "N");
    });
  }

  /** What is known of the node under the pointer. */
  point(node) {
    this.node = node;
    const { path } = this, { nx, record } = path;
    if (node === null) this.under.textContent = "Point at a node to read it; click it to go to the state at which it touches.";
    else {
      const ix = node % nx, iy = Math.floor(node / nx), first = path.first[node], state = this.state();
      const words = [`node (${ix}, ${iy}) at ${quantity((ix + 0.5) * (record.lx / nx), "m")}, ${quantity((iy + 0.5) * (record.ly / path.ny), "m")}`];
      words.push(`height ${quantity(path.heightOf(node), "m")}`);
      words.push(first < 0 ? "does not touch on this path" : `touches at ${quantity(path.columns.load[first], "N")} as number ${path.contactNodes[first]}`);
      if (path.yielded[node] >= 0) words.push(`has yielded at ${quantity(path.columns.load[path.yielded[node]], "N")}`);
      if (state) {
        const { pressure, gap } = path.fieldAt(state, node);
        words.push(`${pressure === undefined ? "gap" : "pressure"} about ${pressure === undefined ? quantity(gap, "m") : quantity(pressure, "Pa")} at state ${state.number}`);
      }
      this.under.textContent = words.join("; ") + ".";
    }
    this.mark();
  }

  /** Rings around the node of the event and the one that is pointed at, and a scale bar. */
  mark() {
    const { path, marks } = this, { nx, ny, record } = path;
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [Math.round(this.box.clientWidth * ratio), Math.round(this.box.clientHeight * ratio)];
    if (width === 0) return;
    if (marks.width !== width || marks.height !== height) Object.assign(marks, { width, height });
    drawMarks(marks.getContext("2d"), width, height, ratio, this);
  }

  describe() {
    const { path, event } = this;
    const words = `Map of contact of ${path.record.name} at ${quantity(path.columns.load[event], "N")}: ${path.contactNodes[event]} of ${path.size} nodes in contact. Arrow keys move over nodes, Enter goes to the state at which one touches.`;
    this.marks.setAttribute("aria-label", words);
  }
}

/** Rings and a scale bar over a map of this size. */
function drawMarks(context, width, height, ratio, view) {
  const { path, event, node } = view, { nx, ny, record } = path;
  context.clearRect(0, 0, width, height);
  const ring = (at, colour, size) => {
    const x = (((at % nx) + 0.5) * width) / nx, y = height - ((Math.floor(at / nx) + 0.5) * height) / ny;
    for (const [stroke, line] of [["rgb(255 255 255 / .85)", 4], [colour, 2]]) {
      Object.assign(context, { strokeStyle: stroke, lineWidth: line * ratio });
      context.beginPath();
      context.arc(x, y, size * ratio, 0, 2 * Math.PI);
      context.stroke();
    }
  };
  if (path.kinds[event] !== 2) ring(path.nodes[event], "#d6006c", 9);
  if (node !== null) ring(node, "#0072b2", 6);
  const { factor, name } = unitFor("m", record.lx);
  const target = (0.25 * record.lx) / factor, power = 10 ** Math.floor(Math.log10(target));
  // Where the logarithm is rounded up, the power is above the target.
  const length = ([5, 2, 1].find((digit) => digit * power <= target) ?? 1) * power;
  const pixels = ((length * factor) / record.lx) * width, margin = 10 * ratio;
  context.font = `${12 * ratio}px system-ui, sans-serif`;
  const words = `${digits(length, 3).replace(/\.0+$/, "")} ${name}`;
  const room = Math.max(pixels, context.measureText(words).width);
  context.fillStyle = "rgb(255 255 255 / .8)";
  context.fillRect(margin, height - margin - 26 * ratio, room + 12 * ratio, 26 * ratio);
  context.fillStyle = "#111";
  context.fillRect(margin + 6 * ratio, height - margin - 7 * ratio, pixels, 3 * ratio);
  context.textBaseline = "bottom";
  context.fillText(words, margin + 6 * ratio, height - margin - 9 * ratio);
}
