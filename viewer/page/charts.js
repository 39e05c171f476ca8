// Charts over the path, drawn by uPlot, with a cursor that follows the slider.

/** What charts can run over: column, words, unit. */
const ALONG = [["load", "load", "N"], ["mean_pressure", "mean pressure", "Pa"], ["area", "contact area", "1"], ["approach", "approach", "m"]];

/** The charts: title, unit, and series as column and words. */
const CHARTS = [
  ["Contact area", "1", [["area", "counted"], ["corrected", "corrected"], ["yielded", "yielded"]]],
  ["Mean gap", "m", [["mean_gap", ""]]],
  ["Stiffness", "N/m", [["contact_stiffness", "contact, K"], ["interfacial_stiffness", "interfacial, Kᵢ"]]],
  ["Patches", "", [["patches", ""]]],
  ["Greatest patch, of the contact", "part", [["largest_share", ""]]],
  ["Greatest pressure", "Pa", [["greatest_pressure", ""]]],
  ["Plastic volume", "m³", [["plastic_volume", ""]]],
];

/** Points of a line: more than pixels. */
const POINTS = 700;
const DASHES = [[], [7, 4], [2, 3]];

/** Places of events spread evenly over an axis. */
function spread(values, isLog) {
  const first = isLog ? values.findIndex((value) => value > 0) : 0;
  if (first < 0) return [];
  const last = values.length - 1, scale = (value) => (isLog ? Math.log(value) : value);
  const [from, to] = [scale(values[first]), scale(values[last])];
  const places = [first];
  const step = (to - from) / POINTS;
  for (let place = first + 1, next = from + step; place <= last; place++) {
    if (scale(values[place]) >= next || place === last) {
      places.push(place);
      next = Math.max(next + step, scale(values[place]));
    }
  }
  return places;
}

class Chart {
  /**
   * Lines are `{ label, colour, dash, x, y, at }` with whole columns, and the place at a value along x if there is one.
   * Those of a path have `{ record, nominal, of }`: its number, its nominal area, and which event is read in place of
   * another; those with `rows` are drawn in this order, forth and back. Axes are `{ words, unit, log, nominal }`.
   */
  constructor(title, x, y, lines, onPlace) {
    Object.assign(this, { title, x, y, lines });
    this.legend = make("div", { class: "legend" });
    this.holder = make("div", { class: "plot", role: "img", "aria-label": title });
    this.print = make("div", { class: "print-chart", "aria-hidden": "true" });
    const save = make("button", { type: "button", class: "save", onclick: () => saveText(`${title}.svg`, "image/svg+xml", svgOf(this)), "aria-label": `Save the chart ${title} as SVG` }, "SVG");
    this.figure = make("figure", { class: "chart" }, make("figcaption", {}, make("span", {}, title), save), this.legend, this.holder, this.print);
    this.cursor = make("div", { class: "cursor" });
    this.values = lines.map((line) => {
      const value = make("b");
      const swatch = make("i");
      swatch.style.borderTop = `2.5px ${["solid", "dashed", "dotted"][line.dash]} ${line.colour}`;
      this.legend.append(make("span", {}, swatch, line.label ? line.label + " " : "", value));
      return value;
    });
    this.onPlace = onPlace;
  }

  draw() {
    this.plot?.destroy();
    const { x, y, lines } = this;
    const greatest = (values) => values.reduce((most, value) => (Number.isFinite(value) ? Math.max(most, Math.abs(value)) : most), 0);
    const all = lines.map((line) => {
      const places = line.places ?? spread(line.x, x.log);
      const number = (value, log, factor) => (Number.isFinite(value) && (!log || value > 0) ? value / factor : null);
      return { places, line, number };
    });
    // Parts of another nominal area are other areas.
    const share = (line) => (y.unit === "1" && chosen.area !== "%" && line.nominal ? line.nominal / y.nominal : 1);
    x.in = logarithmic(x, unitFor(x.unit, x.log ? 1 : Math.max(...lines.map((line) => greatest(line.x))), x.nominal), lines.map((line) => line.x));
    const tops = all.map(({ places, line }) => share(line) * greatest(places.map((place) => line.y[place])));
    const unit = y.unit === "part" ? { name: "%", factor: 0.01 } : unitFor(y.unit, y.log ? 1 : Math.max(...tops), y.nominal);
    y.in = logarithmic(y, unit, lines.map((line) => line.y));
    const tables = all.map(({ places, line, number }) => {
      const kept = places.filter((place) => number(line.x[place], x.log, 1) !== null);
      const factor = y.in.factor / share(line);
      return [kept.map((place) => line.x[place] / x.in.factor), kept.map((place) => number(line.y[place], y.log, factor))];
    });
    this.traces = all.map(({ line, number }) =>
      line.rows
        ?.map((row) => [number(line.x[row], x.log, x.in.factor), number(line.y[row], y.log, y.in.factor)])
        .filter((point) => !point.includes(null)),
    );
    this.data = uPlot.join(tables);
    const drawn = this.traces.map((points) => points && { paths: traced(points) });
    const axis = (words, { log, in: { tens } }) => ({
      label: words,
      labelSize: 18,
      labelFont: "12px system-ui, sans-serif",
      font: "11px system-ui, sans-serif",
      stroke: () => ink("--ink"),
      grid: { stroke: () => ink(log ? "--faint" : "--grid"), width: 1 },
      ticks: { stroke: () => ink("--grid"), width: 1, size: 4 },
      gap: 3,
      values: (plot, splits) => (log ? decades(splits, tens) : splits.map(short)),
    });
    const label = (axis) => `${axis.words}${axis.in.name ? " [" + axis.in.name + "]" : ""}`;
    const width = this.holder.clientWidth || 360;
    this.plot = new uPlot(
      {
        width,
        height: 210,
        legend: { show: false },
        cursor: { drag: { x: false, y: false }, points: { show: lines.every(({ rows }) => !rows) } },
        scales: { x: { time: false, distr: x.log ? 3 : 1, range: (plot, least, most) => (least < most && !x.log ? [least, most] : around(least, most, x.log)) }, y: { distr: y.log ? 3 : 1, range: (plot, least, most) => (y.log || !(least < most) ? around(least, most, y.log) : [Math.min(0, least), most + 0.04 * (most - Math.min(0, least))]) } },
        axes: [{ ...axis(label(x), x), size: 30 }, { ...axis(label(y), y), size: 48 }],
        series: [{}, ...lines.map((line, i) => ({ ...drawn[i], stroke: () => line.colour, width: 1.8, dash: DASHES[line.dash], spanGaps: true, points: { show: (line.places?.length ?? Infinity) < 50, size: 5, fill: line.colour } }))],
        hooks: { setCursor: [(plot) => this.hover(plot)], draw: [() => this.follow()] },
      },
      this.data,
      this.holder,
    );
    this.plot.over.append(this.cursor);
    this.plot.over.addEventListener("click", () => {
      const { left } = this.plot.cursor;
      if (left >= 0 && this.onPlace) this.onPlace(this.plot.posToVal(left, "x") * x.in.factor);
    });
    this.follow();
    this.describe();
  }

  /** The pointer's values in place of the slider's. */
  hover(plot) {
    const { left } = plot.cursor;
    this.hovered = left >= 0 ? plot.posToVal(left, "x") * this.x.in.factor : null;
    this.read();
  }

  /** The slider is at a value along x, and each path after an event of this value, or none beyond its end. */
  setPlace(value, events) {
    Object.assign(this, { place: value, events });
    this.follow();
  }

  follow() {
    if (!this.plot) return;
    const value = this.place / this.x.in.factor;
    const left = this.place === undefined || (this.x.log && !(value > 0)) ? -1 : this.plot.valToPos(value, "x");
    // Beyond the end of a table it would stand in another chart.
    this.cursor.hidden = !(left >= 0 && left <= this.plot.over.clientWidth);
    this.cursor.style.transform = `translateX(${left.toFixed(1)}px)`;
    this.read();
  }

  read() {
    const place = this.hovered ?? this.place, events = this.hovered === place ? undefined : this.events;
    if (place === undefined || place === null) {
      this.values.forEach((value) => (value.textContent = ""));
      return;
    }
    const values = this.lines.map((line) => {
      const at = events ? events[line.record] : line.at?.(place) ?? null;
      return at === null ? NaN : line.y[line.of ? line.of(at) : at];
    });
    const { unit } = this.y;
    const words = values.map((value, i) => {
      if (unit === "part" && Number.isFinite(value)) return `${digits(100 * value)} %`;
      return unit === "" && Number.isInteger(value) ? String(value) : quantity(value, unit, this.lines[i].nominal);
    });
    words.forEach((text, i) => {
      const shown = this.hovered === null || this.hovered === undefined || i < words.length - 1 ? text : `${text} at ${quantity(place, this.x.unit, this.x.nominal)}`;
      if (this.values[i].textContent !== shown) this.values[i].textContent = shown;
    });
    this.said = `${this.title} over ${this.x.words}, at ${quantity(place, this.x.unit, this.x.nominal)}: ${this.lines.map((line, i) => `${line.label} ${words[i]}`).join(", ")}`;
  }

  describe() {
    if (this.said) this.holder.setAttribute("aria-label", this.said);
  }
}

/** A line through these points in their order. */
const traced = (points) => (plot) => {
  const stroke = new Path2D();
  for (const [x, y] of points) stroke.lineTo(plot.valToPos(x, "x", true), plot.valToPos(y, "y", true));
  return { stroke };
};

/** Ends of an axis for values that are all the same, for logarithms in whole decades, or for none at all. */
function around(least, most, log) {
  if (!Number.isFinite(least) || !Number.isFinite(most)) return log ? [1, 10] : [0, 1];
  if (log) return uPlot.rangeLog(least, most, 10, true);
  return least === 0 ? [0, 1] : [Math.min(0, 1.5 * least), Math.max(0, 1.5 * most)];
}

/**
 * A unit for an axis of logarithms, whose numbers are put about 1 by a power of ten: axes of far smaller numbers are not
 * drawn.
 */
function logarithmic({ log }, { name, factor }, columns) {
  const sizes = log ? columns.flatMap((values) => [...values].filter((value) => value > 0 && Number.isFinite(value))) : [];
  if (!sizes.length) return { name, factor, tens: 0 };
  const logs = sizes.map((value) => Math.log10(value / factor));
  const extent = logs.reduce(([least, most], log) => [Math.min(least, log), Math.max(most, log)], [Infinity, -Infinity]);
  const tens = Math.round((extent[0] + extent[1]) / 2);
  return { name, factor: factor * 10 ** tens, tens };
}

/** Labels of whole powers of ten, of numbers that are so many powers of ten smaller; of few if there are many. */
function decades(splits, tens) {
  const isPower = (value) => value > 0 && Math.abs(Math.log10(value) - Math.round(Math.log10(value))) < 1e-6;
  const every = Math.ceil(splits.filter(isPower).length / 6);
  return splits.map((value) => {
    const power = Math.round(Math.log10(value)) + tens;
    return isPower(value) && power % every === 0 ? short(Number(`1e${power}`)) : "";
  });
}

/** A number beside a tick. */
function short(value) {
  if (value === null || value === undefined) return "";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) {
    const [mantissa, exponent] = value.toExponential(2).split("e");
    const power = `10${[...exponent.replace("+", "")].map((letter) => SUPERSCRIPTS[letter]).join("")}`;
    const trimmed = mantissa.replace(/\.?0+$/, "");
    return trimmed === "1" ? power : `${trimmed}·${power}`;
  }
  return String(+value.toPrecision(6));
}
