// Everything that computes: the module of WebAssembly, away from the page, which stays awake.

import init, { begin, materials, WebSurface, WebPath } from "./asperity.js";

/** Milliseconds between two looks at what the page wants, and between two states that it shows. */
const LOOK = 40, SHOW = 500;
/** Showing takes at most one part in so many of the time. */
const PART = 12;
/** Larger files have no room beside what is read from them [bytes]. */
const LARGEST = 400e6;

let surface, path, isRunning = false, elapsed = 0;
/** How many surfaces the page has asked for. */
let asks = 0;

const ready = init({ module_or_path: new URL("asperity_bg.wasm", import.meta.url) }).then(() => {
  begin();
  postMessage({ type: "ready", materials: JSON.parse(materials()) });
});

/** What failed, as the page reads it. The module is of no use after a panic, or where its memory has ended. */
function fault(error) {
  if (typeof error === "string") return JSON.parse(error);
  const isMemory = error instanceof RangeError || (error instanceof WebAssembly.RuntimeError && /unreachable/.test(error.message));
  const why = isMemory ? "the 2 GB of memory that a browser gives this page are probably not enough. A smaller grid may do, or the program" : String(error.message ?? error);
  return { kind: "broken", message: `The computation broke down, and its surface is lost: ${why}` };
}

const told = (type, work, more = {}) => {
  try {
    work();
  } catch (error) {
    postMessage({ type: "fault", of: type, fault: fault(error), ...more });
  }
};

function take(made, number) {
  surface?.free();
  surface = made;
  const information = JSON.parse(made.information()), picture = made.picture();
  postMessage({ type: "surface", information, picture, number }, [picture.buffer]);
}

/** Lets messages of the page come in. */
const pause = () => new Promise((done) => {
  const { port1, port2 } = new MessageChannel();
  port1.onmessage = () => {
    port1.close();
    done();
  };
  port2.postMessage(null);
});

function progress() {
  postMessage({ type: "progress", progress: JSON.parse(path.progress()), seconds: elapsed / 1000 });
}

/** Follows the path to its end, or until the page stops it. */
async function run() {
  isRunning = true;
  let more = true, next = performance.now() + SHOW, failed = null;
  while (isRunning && more) {
    const start = performance.now();
    try {
      do more = path.step();
      while (more && performance.now() < start + LOOK);
    } catch (error) {
      failed = fault(error);
      more = false;
    }
    elapsed += performance.now() - start;
    if (more && performance.now() > next) {
      const before = performance.now();
      progress();
      postMessage({ type: "so-far", data: path.so_far() });
      next = performance.now() + Math.max(SHOW, PART * (performance.now() - before));
    }
    await pause();
  }
  isRunning = false;
  if (failed?.kind !== "broken" && path.states() > 0) {
    progress();
    postMessage({ type: "fields" });
    const isOver = !more;
    told("whole", () => postMessage({ type: "whole", data: path.whole(), isOver }), { isOver });
  } else postMessage({ type: "whole", data: null, isOver: true });
  if (failed) postMessage({ type: "fault", of: "path", fault: failed });
}

/** The same; what breaks outside of a step, as where a picture finds no memory, ends it and is told too. */
const follow = () => run().catch((error) => {
  isRunning = false;
  postMessage({ type: "whole", data: null, isOver: true });
  postMessage({ type: "fault", of: "path", fault: fault(error) });
});

const MADE = {
  record: () => ["path.npz", "application/octet-stream", path.record()],
  report: () => ["report.html", "text/html", path.report()],
  table: () => ["path.csv", "text/csv", path.table()],
};

onmessage = async ({ data: { type, ...asked } }) => {
  if (type === "read" || type === "generate") asks++;
  const mine = asks;
  await ready;
  if (type === "read") {
    const { file, reading, number } = asked;
    if (file.size > LARGEST) {
      const message = `${file.name} has ${(file.size / 1e6).toFixed(0)} MB: at most ${LARGEST / 1e6} MB have room here. The program reads larger files`;
      postMessage({ type: "fault", of: type, fault: { kind: "memory", message }, number });
      return;
    }
    let bytes;
    try {
      bytes = new Uint8Array(await file.arrayBuffer());
    } catch (error) {
      postMessage({ type: "fault", of: type, fault: { kind: "other", message: `${file.name} cannot be read: ${error.message}` }, number });
      return;
    }
    // While a large file was on its way, the page may have asked for another surface.
    if (mine !== asks) return;
    told(type, () => take(WebSurface.read(bytes, file.name, JSON.stringify(reading)), number), { number });
  } else if (type === "generate") {
    const { generation, number } = asked;
    told(type, () => take(WebSurface.generate(JSON.stringify(generation)), number), { number });
  } else if (type === "run") {
    told(type, () => {
      path?.free();
      path = undefined;
      path = new WebPath(surface, JSON.stringify(asked.job));
      elapsed = 0;
      follow();
    });
  } else if (type === "stop") isRunning = false;
  else if (type === "go-on") follow();
  else if (type === "save") told(type, () => postMessage({ type: "saved", made: MADE[asked.what]() }));
};
