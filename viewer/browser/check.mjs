// The page of a path, as its readers use it: `node check.mjs CHROMIUM FOLDER [PICTURES]`, on what `.ci/browser` has made there.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const [executablePath, folder, pictures] = process.argv.slice(2);
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox"] });
if (pictures) mkdirSync(pictures, { recursive: true });

/** A page that must say nothing, and ask nobody. */
async function open(file, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1440, height: 1000 }, acceptDownloads: true, ...options });
  const page = await context.newPage();
  const said = [];
  // That this program reads pixels is no fault of the page.
  page.on("console", (message) => message.text().includes("willReadFrequently") || said.push(`${message.type()}: ${message.text()}`));
  page.on("pageerror", (error) => said.push(`error: ${error.stack}`));
  page.on("request", (request) => {
    if (!/^(file|data|blob):/.test(request.url())) said.push(`request: ${request.url()}`);
  });
  page.on("dialog", (dialog) => {
    said.push(`dialog: ${dialog.message()}`);
    dialog.dismiss();
  });
  await page.goto(pathToFileURL(path.join(folder, file)).href);
  page.quiet = () => assert.deepEqual(said, [], file);
  return page;
}

/** A page with other data, made of one that is there. */
function changed(file, name, change) {
  const text = readFileSync(path.join(folder, file), "utf8");
  const from = text.indexOf('id="data">') + 10, to = text.indexOf("</script>", from);
  const data = JSON.parse(text.slice(from, to));
  change(data);
  const json = JSON.stringify(data).replaceAll("<", "\\u003c");
  writeFileSync(path.join(folder, name), text.slice(0, from) + json + text.slice(to));
}

const shown = (page) => page.waitForFunction(() => window.viewer !== undefined);
const picture = async (page, name) => pictures && page.screenshot({ path: path.join(pictures, name) });
const step = async (words, work) => {
  const start = performance.now();
  await work();
  console.log(`${words} (${((performance.now() - start) / 1000).toFixed(1)} s)`);
};

/** Columns of path.csv. */
function table(name) {
  const [head, ...lines] = readFileSync(path.join(folder, name), "utf8").trim().split("\n").map((line) => line.split(","));
  return Object.fromEntries(head.map((column, i) => [column, lines.map((line) => (column === "event" ? line[i] : line[i] === "" ? NaN : Number(line[i].replace("inf", "Infinity"))))]));
}

/** Colours of the map, row by row from the top, counted. */
const colours = (page) =>
  page.evaluate(() => {
    const canvas = document.querySelector("canvas.nodes");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    const counts = {};
    for (let i = 0; i < data.length; i += 4) {
      const name = `${data[i]},${data[i + 1]},${data[i + 2]}`;
      counts[name] = (counts[name] ?? 0) + 1;
    }
    return counts;
  });

/** A number that the page has written, in SI units. */
function number(text) {
  const [, mantissa, power, unit] = text.match(/^([−\d.]+)(?: × 10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+))? ?([^ ]*)/);
  const exponent = [...(power ?? "⁰")].map((letter) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(letter)).map((digit) => (digit === 0 ? "-" : digit - 1)).join("");
  const prefixes = { G: 1e9, M: 1e6, k: 1e3, m: 1e-3, µ: 1e-6, n: 1e-9, p: 1e-12, f: 1e-15, a: 1e-18 };
  const factor = unit === "%" ? 0.01 : unit.length > 1 && unit !== "m²" && unit !== "N/m" ? prefixes[unit[0]] ?? 1 : 1;
  return Number(mantissa.replace("−", "-")) * 10 ** exponent * factor;
}

// Four digits are written, of numbers that are within 1e-5: half of the last digit, of a number that begins with 1, and that.
const FOUR_DIGITS = 5e-4 + 1e-5;
const near = (found, expected, what) => {
  if (!Number.isFinite(expected)) return;
  assert.ok(Math.abs(found - expected) <= FOUR_DIGITS * Math.abs(expected), `${what}: ${found} and not ${expected}`);
};

/** At five places of the slider the map has as many nodes in contact as path.csv says, and the charts read its numbers. */
async function sliderAgrees(page, csv) {
  const outside = Object.keys(await page.evaluate(() => {
    const { out } = themed();
    return { [`${out & 255},${(out >> 8) & 255},${(out >> 16) & 255}`]: 1 };
  }))[0];
  const nodes = await page.evaluate(() => viewer.path.size);
  await page.uncheck("#log-x");
  const box = await page.locator("#slider").boundingBox();
  for (const place of [0.02, 0.2, 0.5, 0.8, 0.999]) {
    // Along the thumb's way.
    await page.mouse.click(box.x + 8 + place * (box.width - 16), box.y + box.height / 2);
    await page.waitForFunction(() => viewer.waiting === undefined);
    const event = await page.evaluate(() => viewer.event);
    const counted = await colours(page);
    const inContact = nodes - (counted[outside] ?? 0);
    const expected = Math.round(csv.contact_area_fraction[event] * nodes);
    assert.equal(inContact, expected, `nodes in contact at event ${event + 1}`);
    const reads = await page.$$eval(".readout div", (all) => Object.fromEntries(all.map((one) => [one.children[0].textContent, one.children[1].textContent])));
    const charts = await page.$$eval("#charts .legend", (all) => all.map((one) => [...one.querySelectorAll("b")].map((value) => value.textContent)));
    near(number(reads.load), csv.load[event], "load");
    near(number(reads.approach), csv.approach[event], "approach");
    near(number(reads["contact stiffness K"]), csv.contact_stiffness[event], "stiffness");
    near(number(charts[0][0]), csv.contact_area_fraction[event], "area in the chart");
    near(number(charts[0][1]), csv.corrected_contact_area[event] / (csv.contact_area[event] / csv.contact_area_fraction[event]), "corrected area in the chart");
    near(number(charts[1][0]), csv.mean_gap[event], "mean gap in the chart");
    near(number(charts[2][0]), csv.contact_stiffness[event], "stiffness in the chart");
    near(number(charts[2][1]), csv.interfacial_stiffness[event], "interfacial stiffness in the chart");
    // A pixel of the slider is a thousandth.
    const asked = (shift) => (place + shift) * csv.load.at(-1);
    assert.ok(csv.load[event] <= asked(0.005) && !(csv.load[event + 1] <= asked(-0.005)), `the slider at ${place} shows event ${event + 1}`);
  }
}

async function saved(page, button, check) {
  const [download] = await Promise.all([page.waitForEvent("download"), button.click()]);
  check(readFileSync(await download.path()), download.suggestedFilename());
}

const full = await open("full.html");
await shown(full);
assert.ok(await full.isChecked("#log-x"), "to full contact the axes are logarithmic at first");
const csv = table("full/path.csv");

await step("full contact: slider, map and charts agree with path.csv", () => sliderAgrees(full, csv));

await step("a click on a node goes to the state at which it touches", async () => {
  const at = Math.floor(csv.load.length / 3), { nx, ny } = await full.evaluate(() => ({ nx: viewer.path.nx, ny: viewer.path.ny }));
  const box = await full.locator("canvas.marks").boundingBox();
  const { ix, iy } = { ix: csv.ix[at], iy: csv.iy[at] };
  await full.mouse.click(box.x + ((ix + 0.5) / nx) * box.width, box.y + (1 - (iy + 0.5) / ny) * box.height);
  assert.equal(await full.evaluate(() => viewer.event), at);
  assert.match(await full.locator(".under").textContent(), new RegExp(`node \\(${ix}, ${iy}\\) .* as number ${at + 1}(\\.|;)`));
});

await step("pointing at a chart reads its numbers, a click goes there", async () => {
  const over = full.locator("#charts .u-over").first(), box = await over.boundingBox();
  await full.mouse.move(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
  const text = await full.locator("#charts .legend").first().textContent();
  const load = number(text.match(/ at (.*)$/)[1]);
  // A pixel of some three hundred.
  assert.ok(Math.abs(load / csv.load.at(-1) - 0.5) < 0.005, `${load} under the pointer`);
  const event = csv.load.findLastIndex((value) => value <= load * (1 + 1e-5));
  const area = number(text.match(/counted ([^ ]+ %)/)[1]);
  assert.ok(Math.abs(area - csv.contact_area_fraction[event]) < 1e-3, text);
  await full.mouse.click(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
  const there = await full.evaluate(() => viewer.event);
  assert.ok(Math.abs(csv.load[there] / csv.load.at(-1) - 0.5) < 0.005);
});

await step("pressure is that of the nearest state", async () => {
  const wrong = await full.evaluate(() => {
    viewer.goTo(viewer.path.states[12].event);
    const view = viewer.maps[0];
    view.colour.value = "pressure";
    view.recolour();
    return view.state().number !== 13 || !view.key.textContent.includes("state 13 of 24");
  });
  assert.ok(!wrong);
  // Pressures of a state add up to its load, to their levels.
  const parts = await full.evaluate(() => {
    const { path } = viewer, cell = path.record.nominal_area / path.size;
    return path.states.slice(4).map((state) => {
      const half = 0.5 / state.levels;
      let sum = 0, bound = 0;
      for (let node = 0; node < path.size; node++) {
        const { pressure } = path.fieldAt(state, node);
        if (pressure === undefined) continue;
        sum += pressure;
        // Levels are of the root.
        bound += state.pressure * (2 * half * Math.sqrt(pressure / state.pressure) + half ** 2);
      }
      return [(sum * cell) / path.columns.load[state.event], (bound * cell) / path.columns.load[state.event]];
    });
  });
  for (const [part, bound] of parts) assert.ok(Math.abs(part - 1) <= bound, `the pressures add up to ${part} of the load, not within ${bound}`);
  await picture(full, "pressure.png");
  await full.evaluate(() => {
    viewer.maps[0].colour.value = "touch";
    viewer.maps[0].recolour();
  });
});

await step("map, chart and table are saved", async () => {
  await saved(full, full.getByRole("button", { name: "Save map as PNG" }), (bytes, name) => {
    assert.deepEqual([...bytes.subarray(1, 4)], [80, 78, 71], name);
    assert.ok(bytes.length > 10000);
  });
  await saved(full, full.getByRole("button", { name: "Save the chart Mean gap as SVG" }), (bytes, name) => {
    const text = bytes.toString();
    assert.match(name, /^Mean gap\.svg$/);
    assert.match(text, /^<svg [^>]*>.*mean gap \[.*<path d="M.*<\/svg>\s*$/s);
    assert.ok((text.match(/<path d="([^"]*)"/)[1].match(/L/g) ?? []).length > 100);
  });
  await saved(full, full.getByRole("button", { name: "Save as CSV" }), (bytes) => {
    const [head, ...lines] = bytes.toString().trim().split("\n").map((line) => line.split(","));
    assert.equal(lines.length, 24);
    for (const line of lines) {
      const event = Number(line[head.indexOf("event")]) - 1;
      const load = Number(line[head.indexOf("load [N]")]);
      near(load, csv.load[event], "load in the table");
      assert.equal(load, +load.toPrecision(5), "as many digits as are known");
      near(Number(line[head.indexOf("mean_gap [m]")]), csv.mean_gap[event], "mean gap in the table");
    }
  });
  await full.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await full.getByRole("button", { name: "Copy the table" }).click();
  await full.waitForFunction(() => document.querySelector(".told").textContent === "copied");
  assert.equal((await full.evaluate(() => navigator.clipboard.readText())).trim().split("\n").length, 25);
});

await step("the keyboard alone reaches everything", async () => {
  await full.evaluate(() => viewer.goTo(1000));
  await full.keyboard.press("Tab");
  await full.evaluate(() => document.activeElement.blur());
  const reached = new Set();
  for (let i = 0; i < 150; i++) {
    await full.keyboard.press("Tab");
    const name = await full.evaluate(() => document.activeElement.id || document.activeElement.className || document.activeElement.tagName);
    if (reached.has("slider") && name === "BODY") break;
    reached.add(name);
  }
  for (const name of ["slider", "play", "back", "on", "along", "log-x", "log-y", "unit-length", "unit-force", "unit-pressure", "unit-area", "theme", "print", "marks", "save", "go"]) {
    assert.ok(reached.has(name), `${name} is not reached: ${[...reached]}`);
  }
  await full.focus("#slider");
  const at = () => full.evaluate(() => viewer.event);
  await full.keyboard.press("ArrowRight");
  assert.equal(await at(), 1001);
  await full.keyboard.press("ArrowLeft");
  await full.keyboard.press("ArrowLeft");
  assert.equal(await at(), 999);
  await full.keyboard.press("PageUp");
  assert.equal(await at(), 999 + Math.round(csv.load.length / 100));
  await full.keyboard.press("]");
  assert.ok(await full.evaluate(() => viewer.path.states.some((state) => state.event === viewer.event)));
  await full.keyboard.press("Home");
  assert.equal(await at(), 0);
  await full.keyboard.press("End");
  assert.equal(await at(), csv.load.length - 1);
  assert.match(await full.getAttribute("#slider", "aria-valuetext"), /65536 nodes in contact/);
  await full.waitForFunction(() => document.getElementById("said").textContent.includes("65536 nodes in contact"));
  // They are keys of the page, but for a choice that has the keyboard.
  await full.focus("#along");
  await full.keyboard.press("Home");
  assert.equal(await at(), csv.load.length - 1);
  await full.evaluate(() => document.activeElement.blur());
  await full.keyboard.press("PageDown");
  assert.equal(await at(), csv.load.length - 1 - Math.round(csv.load.length / 100));
  await full.keyboard.press("PageUp");
  assert.equal(await at(), csv.load.length - 1);
  await full.keyboard.press("ArrowDown");
  assert.equal(await at(), csv.load.length - 1);
  await full.keyboard.press("Home");
  assert.equal(await at(), 0);
  await full.keyboard.press("End");
  assert.equal(await at(), csv.load.length - 1);
  await full.focus("#slider");
  await full.keyboard.press("Home");
  await full.keyboard.press(" ");
  await full.waitForFunction(() => viewer.event > 100);
  await full.keyboard.press(" ");
  assert.equal(await full.textContent("#play"), "Play");
  await full.focus("canvas.marks");
  await full.keyboard.press("ArrowRight");
  await full.keyboard.press("Enter");
  assert.match(await full.textContent(".under"), /touches at/);
  assert.ok(await full.evaluate(() => viewer.event === viewer.path.first[viewer.maps[0].node]));
});

await step("every control has a name", async () => {
  const nameless = await full.$$eval("button, select, input, canvas.marks, [role=region], [role=img]", (all) =>
    all.filter((one) => !(one.getAttribute("aria-label") || one.labels?.length || one.textContent.trim())).map((one) => one.outerHTML));
  assert.deepEqual(nameless, []);
});

await step("units are as the reader chooses", async () => {
  await full.evaluate(() => viewer.goTo(20000));
  for (const [unit, choice, name, column] of [["force", "N", "load", "load"], ["length", "nm", "mean gap", "mean_gap"], ["length", "mm", "approach", "approach"]]) {
    await full.selectOption(`#unit-${unit}`, choice);
    const text = await full.$$eval(".readout div", (all, name) => all.find((one) => one.children[0].textContent === name).children[1].textContent, name);
    assert.ok(text.endsWith(` ${choice}`), text);
    near(number(text.replace(/nm$/, "nm")), csv[column][20000], name);
  }
  for (const unit of ["force", "length"]) await full.selectOption(`#unit-${unit}`, "auto");
});

await step("charts that are made again leave nothing of the old ones", async () => {
  const [gone, all] = await full.evaluate(() => {
    const old = viewer.everyChart(), gone = [];
    old.forEach(({ plot }) => (plot.hooks.destroy = [(plot) => gone.push(plot)]));
    viewer.remake();
    return [gone.length, old.length];
  });
  assert.equal(gone, all);
});

await step("the scale bar is there where the logarithm of its length is rounded up", async () => {
  const words = await full.evaluate(() => {
    const said = [], context = document.createElement("canvas").getContext("2d");
    context.fillText = (words) => said.push(words);
    // A quarter of them is 10 µm less one unit in the last place.
    const record = { lx: 4e-5 * (1 - 2 ** -52), ly: 4e-5 };
    drawMarks(context, 400, 400, 1, { path: { record, nx: 1, ny: 1, kinds: [2] }, event: 0, node: null });
    return said;
  });
  assert.deepEqual(words, ["10 µm"]);
});

await step("logarithmic axes, and other quantities along the slider", async () => {
  await full.check("#log-x");
  await full.check("#log-y");
  for (const along of ["mean_pressure", "area", "approach", "load"]) {
    await full.selectOption("#along", along);
    await full.evaluate(() => viewer.goTo(20000));
    assert.equal(await full.evaluate(() => viewer.eventAt(viewer.placeOf(20000))), 20000, along);
  }
  await picture(full, "logarithmic.png");
  await full.uncheck("#log-x");
  await full.uncheck("#log-y");
});

/** Pages of the print. */
const printed = async (page, name) => {
  const pdf = await page.pdf({ preferCSSPageSize: true, printBackground: true });
  const pages = pdf.toString("latin1").match(/\/Type\s*\/Page[^s]/g).length;
  assert.equal(pages, 2, `${name} prints on ${pages} pages`);
};
await step("it prints on two pages", () => printed(full, "the path to full contact"));

await step("frames a second while the slider moves", async () => {
  const frames = await full.evaluate(
    () =>
      new Promise((done) => {
        const { count } = viewer.path, times = [];
        const frame = (now) => {
          times.push(now);
          viewer.goTo(Math.round(((count - 1) * times.length) / 120));
          if (times.length < 120) requestAnimationFrame(frame);
          else done(((times.length - 1) * 1000) / (times.at(-1) - times[0]));
        };
        requestAnimationFrame(frame);
      }),
  );
  console.log(`  ${frames.toFixed(0)} frames a second`);
  assert.ok(frames > 10, `${frames} frames a second`);
});
full.quiet();
const size = statSync(path.join(folder, "full.html")).size;
assert.ok(size <= 1e6, `the page has ${size} bytes`);
console.log(`  the page has ${size} bytes`);

await step("dark mode", async () => {
  const dark = await open("full.html", { colorScheme: "dark" });
  await shown(dark);
  const paper = (page) => page.evaluate(() => getComputedStyle(document.documentElement).backgroundColor);
  assert.equal(await paper(dark), "rgb(18, 22, 28)");
  await dark.evaluate(() => viewer.goTo(9000));
  assert.ok((await colours(dark))["84,93,105"] > 20000);
  await picture(dark, "dark.png");
  // High is light and a wide gap is dark, as the words say, in both themes.
  const ends = () => dark.evaluate(() => {
    const [view] = viewer.maps, { path } = view;
    const open = [...path.touched.keys()].filter((node) => path.touched[node] < 0);
    const grey = (ground, node) => {
      view.ground.value = ground;
      view.recolour();
      return view.pixels[(node % path.nx) + path.nx * (path.ny - 1 - Math.floor(node / path.nx))] & 255;
    };
    const greysOf = (ground, of) => {
      const sorted = open.toSorted((a, b) => of[b] - of[a]);
      return [sorted[0], sorted.at(-1)].map((node) => grey(ground, node));
    };
    const greys = { heights: greysOf("heights", path.heights), gap: greysOf("gap", view.state().codes) };
    grey("plain", 0);
    return greys;
  });
  const agree = ({ heights: [highest, lowest], gap: [widest, least] }) => {
    assert.ok(highest > lowest + 30, `heights: ${highest} and ${lowest}`);
    assert.ok(widest < least - 30, `gap: ${widest} and ${least}`);
  };
  agree(await ends());
  await dark.selectOption("#theme", "light");
  assert.equal(await paper(dark), "rgb(255, 255, 255)");
  assert.ok((await colours(dark))["233,236,241"] > 20000);
  agree(await ends());
  dark.quiet();
});

await step("a path that yields, and what lies beside it", async () => {
  const steel = await open("steel.html");
  await shown(steel);
  const csv = table("steel/path.csv");
  await sliderAgrees(steel, csv);
  const event = csv.event.findLastIndex((event) => event === "yield") - 50;
  await steel.evaluate((event) => viewer.goTo(event), event);
  const orange = (await colours(steel))["240,120,0"];
  const nodes = await steel.evaluate(() => viewer.path.size);
  assert.equal(orange, Math.round(csv.yielded_area_fraction[event] * nodes));
  // Backwards it is what it was.
  const before = await colours(steel);
  await steel.evaluate((event) => [viewer.goTo(10), viewer.goTo(event)], event);
  assert.deepEqual(await colours(steel), before);
  // However many cells have yielded since, so many nodes are the newest.
  const { black, newest, words } = await steel.evaluate(() => {
    const [view] = viewer.maps;
    view.orange.checked = false;
    view.recolour();
    return { black: view.pixels.filter((pixel) => pixel === view.themed.newest).length, newest: view.newestNodes(), words: view.fresh };
  });
  assert.ok(newest > 1 && words.endsWith(`the newest ${newest}`), words);
  assert.equal(black, newest);
  await steel.evaluate(() => {
    viewer.maps[0].orange.checked = true;
    viewer.maps[0].recolour();
  });
  const titles = await steel.$$eval("#panels h2", (all) => all.map((one) => one.textContent));
  assert.deepEqual(titles, ["Unloading from the last state"]);
  await picture(steel, "yields.png");
  await printed(steel, "the path that yields");
  steel.quiet();
});

await step("two records", async () => {
  const two = await open("two.html");
  await shown(two);
  await two.evaluate(() => viewer.goTo(viewer.path.eventAt("load", 0.4 * viewer.path.columns.load.at(-1))));
  const [a, b] = await two.evaluate(() => viewer.maps.map(({ path, event }) => path.columns.load[event]));
  assert.ok(b <= a && b > 0.99 * a, `${a} and ${b}`);
  assert.equal(await two.locator(".map").count(), 2);
  await picture(two, "two.png");
  two.quiet();
});

await step("two records of different sizes", async () => {
  const two = await open("sizes.html");
  await shown(two);
  const [small, half] = [table("small/path.csv"), table("half/path.csv")];
  const longer = small.load.at(-1) > half.load.at(-1) ? 0 : 1, shorter = 1 - longer;
  await two.selectOption("#unit-area", "mm²");
  const areas = () => two.$$eval("#charts figure:first-child .legend > span", (all) => all.filter((one) => one.textContent.includes("counted")).map((one) => one.lastElementChild.textContent));
  // The last state of the shorter path is known on both.
  await two.evaluate(([lead]) => viewer.goTo(viewer.paths[lead].count - 1, lead), [shorter]);
  const read = await areas(), at = await two.evaluate(() => viewer.maps.map(({ event }) => event));
  [small, half].forEach(({ contact_area: area }, i) => near(Number(read[i].replace(/ mm²$/, "")), area[at[i]] * 1e6, `area of ${"AB"[i]} in mm²`));
  // The lines stand on one axis of areas.
  const drawn = await two.evaluate(() => {
    const [{ data, lines }] = viewer.charts;
    return ["A counted", "B counted"].map((label) => Math.max(...data[1 + lines.findIndex((line) => line.label === label)].filter(Number.isFinite)));
  });
  [small, half].forEach(({ contact_area: area }, i) => near(drawn[i], area.at(-1) * 1e6, `line of ${"AB"[i]} in mm²`));
  await two.evaluate(([lead]) => viewer.goTo(viewer.paths[lead].count - 1, lead), [longer]);
  assert.equal((await areas())[shorter], "–", "nothing beyond the end");
  // Parts of the area are what the slider compares.
  await two.selectOption("#along", "area");
  assert.equal(await two.evaluate(() => viewer.charts[0].x.in.name), "%");
  await two.selectOption("#along", "load");
  // Rows of a table are those of its path.
  for (const lead of [0, 1]) {
    const now = await two.evaluate((lead) => {
      viewer.goTo(viewer.paths[lead].states[5].event, lead);
      return [...document.querySelectorAll("#tables .table")].map((table) => table.querySelector(".now")?.dataset.event);
    }, lead);
    assert.equal(Number(now[lead]), await two.evaluate((lead) => viewer.paths[lead].states[5].event, lead));
    assert.ok(now[1 - lead] === undefined || Number(now[1 - lead]) === (await two.evaluate((i) => viewer.maps[i].event, 1 - lead)));
  }
  two.quiet();
});

await step("a loop is drawn as it was run, and a leak down to where it ends", async () => {
  const beside = await open("beside.html");
  await shown(beside);
  const titles = await beside.$$eval("#panels figcaption span", (all) => all.map((one) => one.textContent));
  assert.deepEqual(titles, ["Cycles: dissipation", "Cycles: loss factor", "Leak: leak rate", "History: tangential load"]);
  const [leak, words] = await beside.evaluate(() => {
    const { y } = viewer.panels[1].charts[0];
    return [{ log: y.log, unit: y.in.name }, quantity(4e-12, "m³/s")];
  });
  assert.deepEqual(leak, { log: true, unit: "m³/s" });
  assert.equal(words, "4.000 × 10⁻¹² m³/s");
  const loop = table("beside/history.csv");
  const { bare, svg } = await beside.evaluate((loop) => {
    const [chart] = viewer.panels[2].charts, { plot, x, y } = chart;
    const at = (i) => [plot.valToPos(loop.displacement[i] / x.in.factor, "x", true), plot.valToPos(loop.tangential_load[i] / y.in.factor, "y", true)];
    // Between two rows there is a line, and none where they are not neighbours.
    const isDrawn = (i, k) => {
      const [a, b] = [at(i), at(k)].map((point) => point.map(Math.round)), middle = [0, 1].map((axis) => Math.round((a[axis] + b[axis]) / 2));
      const { data } = plot.ctx.getImageData(middle[0] - 2, middle[1] - 2, 5, 5);
      return data.some((value, k) => k % 4 === 2 && value - data[k - 2] > 60 && data[k + 1] > 60);
    };
    return { bare: loop.load.slice(1).flatMap((_, i) => (isDrawn(i, i + 1) ? [] : [i])).concat(isDrawn(1, 3) ? ["1 to 3"] : []), svg: svgOf(chart) };
  }, loop);
  assert.deepEqual(bare, [], "rows that no line joins");
  const places = svg.match(/<path d="M([^"]*)"/)[1].split("L").map((point) => Number(point.split(" ")[0]));
  assert.equal(places.length, loop.load.length);
  places.slice(1).forEach((place, i) => assert.equal(Math.sign(place - places[i]), Math.sign(loop.displacement[i + 1] - loop.displacement[i])));
  await picture(beside, "beside.png");
  beside.quiet();
});

await step("time is logarithmic for creep that begins at zero, and a table of even steps is not; all axes have numbers", async () => {
  // To three years.
  const times = [0, ...Array.from({ length: 41 }, (_, i) => 10 ** (i / 4 - 2))];
  const even = Array.from({ length: 301 }, (_, i) => i * 1e-9);
  const table = (short, log, along, values, chart) => {
    const columns = [{ name: along, values }, { name: chart, values: values.map((_, i) => 1 + i) }];
    return { title: short, short, file: `${short}.csv`, log, along, charts: [chart], lines: values.length, columns };
  };
  changed("beside.html", "creep.html", ({ records: [record] }) => {
    const slip = table("Slip", false, "displacement", even, "slip_area");
    // Down to 10⁻²⁹ m³/s, over loads that the path goes beyond.
    const leak = table("Leak", false, "load", Array.from({ length: 24 }, (_, i) => 1e-3 * (1 + i)), "leak_rate");
    leak.columns[1].values = leak.columns[1].values.map((_, i) => 10 ** (-6 - i));
    record.panels = [table("Creep", true, "time", times, "load"), slip, leak];
  });
  const creep = await open("creep.html");
  await shown(creep);
  const [[time, first], [displacement]] = await creep.evaluate(() => {
    return viewer.panels.map(({ charts: [{ x, data }] }) => [x.log, data[0][0] * x.in.factor]);
  });
  assert.ok(time && !displacement);
  near(first, 0.01, "the first time on the axis");
  const drawn = await creep.evaluate(() =>
    viewer.panels.map(({ charts: [{ plot, cursor }] }) => [plot.axes.map(({ _values }) => _values.filter((words) => words)), cursor.hidden, plot.scales.y.min]),
  );
  for (const [labels, isHidden, least] of drawn) {
    assert.ok(labels.every((words) => words.length > 2) && Number.isFinite(least), JSON.stringify(labels));
    assert.ok(isHidden, "the load of the slider is beyond the table, or on no axis of it");
  }
  const [, , [[, rates]]] = drawn;
  assert.ok(rates.includes("10⁻⁶") || rates.includes("10⁻¹⁰"), rates.join());
  creep.quiet();
});

await step("a table tells where it lies, and of two records which one it is of", async () => {
  const told = (page) => {
    const words = (all) => all.map((one) => ["h2", ".note"].map((part) => one.querySelector(part).textContent));
    return page.$$eval("#panels .panel", words);
  };
  const beside = await open("beside.html");
  await shown(beside);
  assert.deepEqual((await told(beside))[1], ["Leak", "4 lines of leak.csv, in beside"]);
  const leak = await beside.evaluate(() => viewer.path.record.panels.find(({ file }) => file === "leak.csv"));
  changed("two.html", "tables.html", ({ records: [a, b] }) => {
    a.panels = [{ ...leak, folder: "<b>one</b>" }, { ...leak, folder: null, both: true }];
    b.panels = [{ ...leak, folder: null }];
  });
  const two = await open("tables.html");
  await shown(two);
  assert.deepEqual(await told(two), [
    ["A: Leak", "4 lines of leak.csv, in <b>one</b>"],
    ["Leak", "4 lines of leak.csv, beside both records"],
    ["B: Leak", "4 lines of leak.csv, beside the record"],
  ]);
  const { titles, colours, records } = await two.evaluate(() => {
    const charts = viewer.panels.map(({ charts: [chart] }) => chart);
    const colours = charts.map(({ lines: [{ colour }] }) => colour);
    return { titles: charts.map(({ title }) => title), colours, records: [0, 1].map(lineColour) };
  });
  assert.deepEqual(titles, ["A Leak: leak rate", "Leak: leak rate", "B Leak: leak rate"]);
  assert.deepEqual([colours[0], colours[2]], records);
  assert.ok(!records.includes(colours[1]), colours[1]);
  await picture(two, "tables.png");
  two.quiet();
});

await step("the page begins in the units that were asked for", async () => {
  changed("steel.html", "millimetres.html", (data) => (data.units = { length: "mm", force: "N", pressure: "MPa" }));
  const page = await open("millimetres.html");
  await shown(page);
  for (const [kind, unit] of [["length", "mm"], ["force", "N"], ["pressure", "MPa"], ["area", "%"]]) {
    assert.equal(await page.inputValue(`#unit-${kind}`), unit);
  }
  const words = (all) => all.map(({ children: [name, value] }) => [name.textContent, value.textContent]);
  const reads = Object.fromEntries(await page.$$eval(".readout div", words));
  const lengths = { "mean gap": "mm", "plastic volume": "mm³" }, forces = { load: "N", "mean pressure": "MPa" };
  for (const [name, unit] of Object.entries({ ...lengths, ...forces, "contact stiffness K": "N/mm" })) {
    assert.ok(reads[name].endsWith(` ${unit}`), `${name}: ${reads[name]}`);
  }
  // Cubic millimetres are no thousandths of cubic metres.
  const volume = await page.evaluate(() => viewer.path.columns.plastic_volume.at(-1));
  near(Number(reads["plastic volume"].replace(/ mm³$/, "")), volume * 1e9, "plastic volume in mm³");
  assert.match(await page.textContent("#subtitle"), / N and /);
  await page.selectOption("#unit-force", "kN");
  assert.equal(await page.inputValue("#unit-force"), "kN");
  page.quiet();
});

await step("settings are written in full, and lists of lists are told apart", async () => {
  const settings = {
    "surface.seed": 123456789,
    bodies: [[2.1e11, 0.3], [7e10, 0.33]],
    "layers.base": [2.1e11, 0.3],
    "grid.nodes": [32, 20],
    "grid.sides": [3.2e-3, 4e-3],
  };
  changed("steel.html", "settings.html", ({ records: [record] }) => (record.settings = settings));
  const page = await open("settings.html");
  await shown(page);
  const rows = await page.$$eval(".settings tr", (all) => all.map((one) => one.lastElementChild.textContent));
  const bodies = "[210000000000, 0.3000], [70000000000, 0.3300]";
  assert.deepEqual(rows, ["123456789", bodies, "210000000000, 0.3000", "32 × 20", "0.003200 × 0.004000"]);
  const facts = await page.$$eval(".facts tr", (all) => all.map((one) => one.textContent));
  assert.ok(facts.includes("sides10.00 mm × 10.00 mm"), facts);
  page.quiet();
});

await step("a profile can be seen and saved", async () => {
  const profile = await open("profile.html");
  await shown(profile);
  const { width, height } = await profile.locator("canvas.marks").boundingBox();
  assert.ok(Math.abs(width / height - 8) < 0.3, `${width} × ${height}`);
  await saved(profile, profile.getByRole("button", { name: "Save map as PNG" }), (bytes) => {
    assert.deepEqual([bytes.readUInt32BE(16), bytes.readUInt32BE(20)], [1240, 150 + 190]);
  });
  profile.quiet();
});

await step("a browser that is too old is told so", async () => {
  const context = await browser.newContext(), page = await context.newPage();
  await page.addInitScript(() => delete Array.prototype.findLast);
  await page.goto(pathToFileURL(path.join(folder, "flat.html")).href);
  await page.waitForFunction(() => /too old: the page needs Chrome 97/.test(document.getElementById("fault").textContent));
  await context.close();
});

await step("a path of one load", async () => {
  const flat = await open("flat.html");
  await shown(flat);
  // Of states under the same load charts read the one of the slider.
  for (const event of [0, 1, 2, 3]) {
    await flat.evaluate((event) => viewer.goTo(event), event);
    assert.equal(await flat.textContent("#charts .legend b"), `${(12.5 * (event + 1)).toFixed(2)} %`);
  }
  for (const along of ["approach", "area", "mean_pressure", "load"]) {
    for (const logarithmic of [true, false]) {
      await flat.selectOption("#along", along);
      await flat.setChecked("#log-x", logarithmic);
      await flat.setChecked("#log-y", logarithmic);
      await flat.focus("#slider");
      await flat.keyboard.press("Home");
      await flat.keyboard.press("End");
    }
  }
  await flat.selectOption("[aria-label='Colour of nodes in contact']", "pressure");
  await printed(flat, "a path of one load");
  flat.quiet();
});

await step("a hostile name runs nothing", async () => {
  const hostile = await open("hostile.html");
  await shown(hostile);
  assert.ok((await hostile.title()).includes("<script>"));
  assert.ok((await hostile.textContent("h1")).includes("<img src=x onerror=alert(2)>"));
  assert.equal(await hostile.evaluate(() => document.querySelectorAll("img, h1 script, main script").length), 0);
  await hostile.evaluate(() => viewer.forPrint());
  hostile.quiet();
});

await step("a notebook shows it in a frame of its own", async () => {
  const context = await browser.newContext({ viewport: { width: 1440, height: 1000 }, acceptDownloads: true });
  const page = await context.newPage();
  // As `_repr_html_` of Python writes it.
  const text = readFileSync(path.join(folder, "steel.html"), "utf8").replace(/[&"<>]/g, (letter) => `&#${letter.charCodeAt(0)};`);
  await page.setContent(`<iframe width="100%" height="900" sandbox="allow-scripts allow-downloads allow-modals" srcdoc="${text}"></iframe>`);
  const frame = page.frames()[1];
  await shown(frame);
  const [download] = await Promise.all([page.waitForEvent("download"), frame.getByRole("button", { name: "Save map as PNG" }).click()]);
  assert.ok(statSync(await download.path()).size > 10000);
  await context.close();
});

for (const [file, words] of [["cut.html", /incomplete/], ["damaged.html", /damaged/], ["outside.html", /outside the grid|damaged/], ["empty.html", /no record/i]]) {
  await step(`${file}: an error in words`, async () => {
    const page = await open(file);
    await page.waitForFunction(() => document.readyState === "complete" && !document.getElementById("fault").textContent.startsWith("The path is being read"));
    assert.match(await page.textContent("#fault"), words);
    assert.ok(await page.isVisible("#fault"));
    assert.ok(!(await page.isVisible("#all")));
    page.quiet();
  });
}

await browser.close();
console.log("the pages are as they should be");
