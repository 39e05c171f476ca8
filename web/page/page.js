// The page: what it asks for, and what it does with what the worker says.

const UNITS_OF_LENGTH = ["µm", "nm", "mm", "m", "cm", "Å", "pm", "in"];
const GIGA = 1e9, MILLI = 1e-3, MICRO = 1e-6;

let worker, file = null, isReady = false, isRunning = false;
/** How many surfaces have been asked for. */
let asks = 0;

const send = (type, rest = {}) => worker.postMessage({ type, ...rest });

/** A number in a field, in SI units; nothing if it is empty. */
function number(id, factor = 1) {
  const field = byId(id), text = field.value.trim().replace("−", "-");
  if (text === "") return undefined;
  if (/^-?[1-9]\d{0,2},\d{3}$/.test(text)) throw new Fault(`“${field.value}” may be thousands or not: write a point, or no comma.`);
  const value = Number(text.replace(/^([^.]*),([^.,]*)$/, "$1.$2"));
  if (!Number.isFinite(value)) throw new Fault(`“${field.value}” is no number.`);
  // Powers of ten that are not whole are not what they say: 50 µm is 5e-5, and 50 · 1e-6 is not.
  return factor < 1 ? value / (1 / factor) : value * factor;
}

/** The same of a field that must not be empty. */
function needed(id, name, factor) {
  const value = number(id, factor);
  if (value === undefined) throw new Fault(`${name} is empty.`);
  return value;
}

const choice = (id) => byId(id).value || undefined;

function ask(words, name = null) {
  const question = byId("question");
  question.hidden = !words;
  question.textContent = words ?? "";
  document.querySelectorAll("#reading label").forEach((label) => label.classList.toggle("asked", name !== null && label.dataset.for === name));
  if (name) document.querySelector(`#reading label[data-for="${name}"] :is(select, input)`)?.focus();
}

function tell(words) {
  byId("told").textContent = words;
}

/** Work that tells its reader what is wrong with what it was given. */
const guarded = (work) => (event) => {
  event?.preventDefault?.();
  try {
    work(event);
  } catch (error) {
    ask(error instanceof Fault ? error.message : String(error));
  }
};

// Surface

const reading = () => ({
  channel: byId("channel").closest("label").hidden ? undefined : choice("channel"),
  height_unit: choice("height-unit"),
  lateral_unit: choice("lateral-unit"),
  side: number("side", MILLI),
  side_y: number("side-y", MILLI),
  fill: byId("fill").checked,
  level: byId("level").value,
  invert: byId("invert").checked,
  rows_are_y: byId("rows-are-y").checked,
  ignore_mask: byId("ignore-mask").checked,
  layout: choice("layout"),
});

/** Nothing can be run until a surface is there. */
function forget() {
  isReady = false;
  byId("run").disabled = true;
  byId("known").hidden = true;
}

function read(chosen) {
  if (isRunning) throw new Fault("A path is running: stop it first, or wait for its end.");
  if (chosen !== file) {
    file = chosen;
    byId("reading").reset();
    byId("channel").closest("label").hidden = true;
  }
  byId("reading").hidden = false;
  forget();
  const asked = reading();
  ask(null);
  tell(`${file.name} is being read`);
  send("read", { file, reading: asked, number: ++asks });
}

function generate() {
  const generation = {
    nodes: number("nodes"),
    side: number("generated-side", MILLI),
    rms_height: number("sq", MICRO),
    hurst: number("hurst"),
    rolloff: number("rolloff", MILLI),
    short_cutoff: number("shortest", MICRO),
    seed: number("seed"),
  };
  file = null;
  // The same file can be chosen again.
  byId("file").value = "";
  byId("reading").hidden = true;
  forget();
  ask(null);
  tell("the surface is being generated");
  send("generate", { generation, number: ++asks });
}

/** Heights from dark to light, y upwards as on the map. */
function draw([nx, ny], sides, levels) {
  const canvas = byId("picture"), context = canvas.getContext("2d");
  Object.assign(canvas, { width: nx, height: ny });
  canvas.style.aspectRatio = String(shown(...(sides ?? [nx, ny])));
  const image = context.createImageData(nx, ny), pixels = new Uint32Array(image.data.buffer);
  for (let iy = 0, node = 0; iy < ny; iy++) {
    for (let ix = 0; ix < nx; ix++, node++) pixels[(ny - 1 - iy) * nx + ix] = levels[node] ? viridis[levels[node]] : rgba(200, 40, 40);
  }
  context.putImageData(image, 0, 0);
}

const NEEDS = {
  side: "How large is the surface? The file does not say: give its side along x.",
  fill: "Some nodes are missing: let them be filled from the nodes around, or take another map.",
};

function showSurface(information, picture) {
  const { name, source, shape, sides, missing, needs, notes, warnings } = information;
  draw(shape, sides, picture);
  byId("known").hidden = false;
  const list = (kind, words) => (words.length ? [make("ul", { class: kind }, ...words.map((one) => make("li", {}, one)))] : []);
  byId("facts").replaceChildren(
    make("p", {}, make("b", {}, name), ` – ${source}${missing && !source.includes("missing") ? `, ${missing} missing` : ""}`),
    ...list("warnings", warnings),
    ...list("note", notes),
    facts("Surface", factRows(information.facts)) ?? "",
  );
  isReady = needs.length === 0;
  byId("run").disabled = isRunning || !isReady;
  if (needs.length) ask(NEEDS[needs[0]], needs[0]);
  else ask(null);
  tell("");
}

/** What failed, and the question that answers it. */
function showFault({ kind, message, channels }) {
  tell("");
  if (kind === "height-unit") ask(`In which unit are the heights? ${message}`, kind);
  else if (kind === "lateral-unit") ask(`In which unit are the lengths along x and y? ${message}`, kind);
  else if (kind === "layout") ask(`How are the numbers arranged? ${message}`, kind);
  else if (kind === "channel") {
    byId("channel").replaceChildren(...channels.map((name) => option([name, name])));
    byId("channel").closest("label").hidden = false;
    ask("Which map of the file? Choose one, and read again.", kind);
  } else ask(message);
  if (kind === "broken") renew();
}

// Path

/** A body of the form: a name, two numbers, or nothing. */
function body(id, words) {
  const value = byId(id).value;
  const given = () => [needed(`${id}-young`, `E of ${words}`, GIGA), needed(`${id}-poisson`, `ν of ${words}`)];
  if (value === "given") return given();
  return value === "rigid" || value === "modulus" ? undefined : value;
}

function job() {
  const target = byId("target").selectedOptions[0];
  const value = number("target-value", Number(target.dataset.factor));
  if (value === undefined) throw new Fault("Where is the path to end?");
  const asked = { half_space: byId("half-space").value, hardness: number("hardness", GIGA), target: { [target.value]: value } };
  if (byId("body").value === "modulus") return { ...asked, e_star: needed("e-star", "E*", GIGA) };
  return { ...asked, body: body("body", "the body"), against: body("against", "the other body") };
}

function running(is) {
  isRunning = is;
  byId("run").disabled = is || !isReady;
  byId("stop").hidden = byId("progress").hidden = !is;
  if (is) byId("go-on").hidden = byId("saves").hidden = true;
  for (const id of ["generate", "read", "file"]) byId(id).disabled = is;
}

function run() {
  const asked = job();
  running(true);
  byId("progress").value = 0;
  byId("all").hidden = true;
  ask(null);
  tell("the path begins");
  send("run", { job: asked });
}

function showProgress({ share, nodes, load, area, states }, seconds) {
  byId("progress").value = share;
  tell(`${states} states, ${nodes} nodes in contact (${digits(100 * area, 3)} %), ${quantity(load, "N")}, ${seconds.toFixed(1)} s`);
}

/** Pages come faster than they can be drawn: the last one counts. */
let waiting = null, isShowing = false;
async function show(data) {
  waiting = data;
  if (isShowing) return;
  isShowing = true;
  while (waiting) {
    const next = waiting;
    waiting = null;
    try {
      await showPaths(JSON.parse(next));
    } catch (error) {
      ask(`The path cannot be shown: ${error.message}`);
    }
    await new Promise(requestAnimationFrame);
  }
  isShowing = false;
}

const FIELDS = "; pressure and gap are being computed";

const ANSWERS = {
  ready({ materials }) {
    const names = materials.map(({ name, young }) => [name, `${name} (${quantity(young, "Pa")})`]);
    byId("body").replaceChildren(...[...names, ["given", "E and ν"], ["modulus", "E* of both bodies"]].map(option));
    byId("against").replaceChildren(...[["rigid", "a rigid body"], ...names, ["given", "E and ν"]].map(option));
    chooseBodies();
    byId("fault").hidden = true;
    byId("ask").hidden = false;
  },
  surface: ({ information, picture }) => showSurface(information, picture),
  progress: ({ progress, seconds }) => showProgress(progress, seconds),
  fields: () => (byId("told").textContent += FIELDS),
  "so-far": ({ data }) => show(data),
  whole({ data, isOver }) {
    running(false);
    if (!data) return;
    byId("go-on").hidden = isOver;
    byId("saves").hidden = false;
    byId("told").textContent = byId("told").textContent.replace(FIELDS, "") + (isOver ? "; done" : "; stopped");
    show(data);
  },
  saved: ({ made: [name, type, content] }) => saveBlob(name, new Blob([content], { type })),
  fault({ of, fault, isOver }) {
    if (of === "run" || of === "whole") running(false);
    if (of === "whole") {
      // The states are there, though the page of them is not.
      const isBroken = fault.kind === "broken";
      byId("saves").hidden = isBroken;
      byId("go-on").hidden = isBroken || isOver;
    }
    showFault(fault);
  },
};

/** A worker, in place of one that is of no use any more. */
function renew() {
  worker?.terminate();
  if (worker) {
    running(false);
    byId("saves").hidden = byId("go-on").hidden = true;
    forget();
  }
  worker = new Worker("worker.js", { type: "module" });
  worker.onmessage = ({ data: { type, number: asked, ...rest } }) => {
    // What is said of a surface in whose place another was asked for since is no answer, unless all is lost.
    if (asked === undefined || asked === asks || rest.fault?.kind === "broken") ANSWERS[type](rest);
  };
  worker.onerror = (event) => {
    byId("fault").hidden = false;
    byId("fault").textContent = `The page cannot compute here: ${event.message ?? "its worker does not start. Open it from a server, not from a folder"}`;
  };
}

/** Fields of what is chosen. */
function chooseBodies() {
  for (const id of ["body", "against"]) {
    const { value } = byId(id);
    document.querySelectorAll(`label[data-of=${id}]`).forEach((label) => (label.hidden = !label.classList.contains(value)));
  }
  byId("against").closest("label").hidden = byId("body").value === "modulus";
  if (byId("body").value === "modulus") document.querySelectorAll("label[data-of=against]").forEach((label) => (label.hidden = true));
}

function listen() {
  const units = [["", "as in the file"], ...UNITS_OF_LENGTH.map((unit) => [unit, unit])];
  for (const id of ["height-unit", "lateral-unit"]) byId(id).replaceChildren(...units.map(option));
  byId("file").onchange = guarded(({ target }) => target.files[0] && read(target.files[0]));
  byId("reading").onsubmit = guarded(() => read(file));
  byId("reading").onchange = guarded(() => read(file));
  byId("generation").onsubmit = guarded(generate);
  byId("job").onsubmit = guarded(run);
  // A path that has been stopped goes on as it was asked for.
  byId("job").onchange = () => (byId("go-on").hidden = true);
  byId("body").onchange = byId("against").onchange = chooseBodies;
  byId("target").onchange = ({ target: { selectedOptions: [{ dataset }] } }) => {
    byId("target-unit").textContent = dataset.unit;
    byId("target-value").value = dataset.usual;
  };
  byId("stop").onclick = () => send("stop");
  byId("go-on").onclick = () => {
    running(true);
    send("go-on");
  };
  for (const what of ["record", "report", "table"]) byId(`save-${what}`).onclick = () => send("save", { what });
  const drop = byId("drop");
  // Anywhere on the page: a file beside the frame would leave the page for itself.
  addEventListener("dragover", (event) => {
    event.preventDefault();
    drop.classList.add("over");
  });
  addEventListener("dragleave", () => drop.classList.remove("over"));
  addEventListener("drop", guarded((event) => {
    drop.classList.remove("over");
    const [first] = event.dataTransfer.files;
    if (first) read(first);
  }));
}

listen();
renew();
