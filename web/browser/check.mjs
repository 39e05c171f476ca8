// asperity in the browser, as its readers use it: `node web.mjs CHROMIUM FOLDER PAGE PROGRAM [PICTURES]`, on the surfaces and tables that
// `.ci/browser` has made in the folder.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import path from "node:path";
import { chromium } from "playwright-core";

const [executablePath, folder, served, program, pictures] = process.argv.slice(2);
if (pictures) mkdirSync(pictures, { recursive: true });

const TYPES = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm" };
const asked = [];
const server = createServer((request, response) => {
  const name = request.url === "/" ? "/index.html" : request.url;
  asked.push(name);
  try {
    const bytes = readFileSync(path.join(served, path.normalize(name)));
    response.writeHead(200, { "content-type": TYPES[path.extname(name)] ?? "application/octet-stream" });
    response.end(bytes);
  } catch {
    response.writeHead(404);
    response.end();
  }
});
await new Promise((done) => server.listen(0, "127.0.0.1", done));
const address = `http://127.0.0.1:${server.address().port}/`;

const browser = await chromium.launch({ executablePath, args: ["--no-sandbox"] });
const context = await browser.newContext({ viewport: { width: 1440, height: 1400 }, acceptDownloads: true });
const page = await context.newPage();
const said = [];
page.on("console", (message) => said.push(`${message.type()}: ${message.text()}`));
page.on("pageerror", (error) => said.push(`error: ${error.stack}`));
page.on("request", (request) => {
  if (!request.url().startsWith(address) && !/^(data|blob):/.test(request.url())) said.push(`request: ${request.url()}`);
});
await page.goto(address);

const step = async (words, work) => {
  const start = performance.now();
  await work();
  console.log(`${words} (${((performance.now() - start) / 1000).toFixed(1)} s)`);
};
const picture = async (name, options) => pictures && page.screenshot({ path: path.join(pictures, name), ...options });
const question = () => page.locator("#question");
const isReady = () => page.waitForFunction(() => !document.getElementById("run").disabled);

/** Drops a file on the page. */
async function drop(name, type = "") {
  const bytes = readFileSync(path.join(folder, name)).toString("base64");
  const transfer = await page.evaluateHandle(([name, type, bytes]) => {
    const transfer = new DataTransfer();
    transfer.items.add(new File([Uint8Array.from(atob(bytes), (letter) => letter.charCodeAt(0))], name, { type }));
    return transfer;
  }, [name, type, bytes]);
  await page.dispatchEvent("#drop", "drop", { dataTransfer: transfer });
}

/** What a button saves. */
async function saved(name) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name }).click()]);
  const file = path.join(folder, `saved-${download.suggestedFilename()}`);
  writeFileSync(file, readFileSync(await download.path()));
  return file;
}

/** Runs the path to its end; the seconds that it took. */
async function run() {
  await page.click("#run");
  await page.waitForFunction(() => document.getElementById("told").textContent.endsWith("; done"), undefined, { timeout: 600000 });
  await page.waitForFunction(() => window.viewer?.path.states.length > 0);
  return Number((await page.textContent("#told")).match(/, ([\d.]+) s; done$/)[1]);
}

function table(file) {
  const [head, ...lines] = readFileSync(file, "utf8").trim().split("\n").map((line) => line.split(","));
  return lines.map((line) => Object.fromEntries(line.map((cell, i) => [head[i], head[i] === "event" ? cell : Number(cell)])));
}

/** The same events in the same order as the program, and the same numbers but for rounding, which vectors of another width make another. */
const ROUNDING = 1e-9;
function agree(found, expected) {
  assert.equal(found.length, expected.length, "as many states");
  found.forEach((state, i) => {
    for (const name of ["step", "ix", "iy", "event"]) assert.equal(state[name], expected[i][name], `${name} of state ${i + 1}`);
    for (const name of ["approach", "load", "mean_gap", "contact_stiffness"]) {
      const [a, b] = [state[name], expected[i][name]];
      assert.ok(a === b || Math.abs(a - b) <= ROUNDING * Math.max(Math.abs(b), expected.at(-1)[name] || 0), `${name} of state ${i + 1}: ${a}, not ${b}`);
    }
  });
}

await step("the page is there, and says that nothing is uploaded", async () => {
  await page.waitForFunction(() => document.getElementById("ask").hidden === false);
  assert.match(await page.textContent("#about"), /Nothing is uploaded/);
  await picture("web_empty.png");
});
const loaded = asked.length;

await step("a text is dropped, and the page asks for its unit, its side and its missing nodes", async () => {
  await drop("matrix.txt", "text/plain");
  await page.waitForFunction(() => /In which unit are the heights/.test(document.getElementById("question").textContent));
  assert.ok(await page.isDisabled("#run"));
  await page.selectOption("#height-unit", "µm");
  await page.waitForFunction(() => /How large is the surface/.test(document.getElementById("question").textContent));
  await page.fill("#side", "two");
  await page.press("#side", "Enter");
  assert.match(await question().textContent(), /“two” is no number/);
  assert.doesNotMatch(await page.textContent("#told"), /is being read/);
  await page.fill("#side", "2");
  await page.press("#side", "Enter");
  await page.waitForFunction(() => /nodes are missing/.test(document.getElementById("question").textContent));
  await picture("web_asks.png");
  await page.check("#fill");
  await isReady();
  assert.ok(!(await question().isVisible()));
  assert.match(await page.textContent("#facts"), /3 missing nodes are interpolated.*rms height Sq/s);
});

await step("its path has the events of the program, in their order", async () => {
  await page.selectOption("#target", "area_fraction");
  await page.fill("#target-value", "20");
  await run();
  agree(table(await saved("Save the table")), table(path.join(folder, "matrix/path.csv")));
});

await step("the program opens the record, and goes on with it", async () => {
  const record = await saved("Save the record");
  const on = (args) => execFileSync(program, ["-q", ...args], { cwd: folder, stdio: ["ignore", "pipe", "inherit"] });
  on(["patches", record, "--out", "patches"]);
  on(["path", "--resume", record, "--max-area-fraction", "0.3", "--out", "resumed"]);
  agree(table(path.join(folder, "resumed/path.csv")), table(path.join(folder, "further/path.csv")));
});

await step("the report is a page of its own", async () => {
  const report = await saved("Save the report");
  const other = await context.newPage();
  await other.goto(`file://${report}`);
  await other.waitForFunction(() => window.viewer !== undefined);
  assert.equal(await other.evaluate(() => viewer.path.count), await page.evaluate(() => viewer.path.count));
  await other.close();
});

await step("a file of an instrument, bodies by numbers, a periodic half-space, a hardness, a mean pressure", async () => {
  await drop("rough.x3p");
  await isReady();
  await page.selectOption("#body", "given");
  for (const [id, name] of [["young", "E"], ["poisson", "ν"]]) {
    const kept = await page.inputValue(`#body-${id}`);
    await page.fill(`#body-${id}`, "");
    await page.click("#run");
    assert.equal(await question().textContent(), `${name} of the body is empty.`);
    await page.fill(`#body-${id}`, kept);
  }
  await page.fill("#body-young", "70");
  await page.fill("#body-poisson", "0.33");
  await page.selectOption("#against", "steel");
  await page.selectOption("#half-space", "love");
  await page.fill("#hardness", "2.5");
  await page.selectOption("#target", "mean_pressure");
  await page.fill("#target-value", "300");
  await run();
  agree(table(await saved("Save the table")), table(path.join(folder, "rough/path.csv")));
  await page.fill("#hardness", "");
  await page.selectOption("#half-space", "free");
});

await step("what cannot be read is said", async () => {
  await drop("nothing.bin");
  await page.waitForFunction(() => document.getElementById("question").textContent.includes("nothing.bin"));
  assert.ok(await page.isDisabled("#run"));
  // Nor is there a surface once a path has ended, whose states can be saved even if its page cannot be made.
  await page.evaluate(() => {
    running(true);
    ANSWERS.fault({ of: "whole", fault: { kind: "other", message: "there is no page" } });
  });
  assert.ok(await page.isDisabled("#run"));
  assert.ok(await page.isVisible("#saves"));
});

await step("what there is no room for is said before", async () => {
  await page.fill("#nodes", "6000");
  await page.click("#generate");
  await page.waitForFunction(() => /2 GB of memory.*6000 × 6000 nodes.*largest square grid/.test(document.getElementById("question").textContent));
});

await step("a path of 256 × 256 nodes grows on the page, stops, and goes on", async () => {
  await page.fill("#nodes", "256");
  await page.click("#generate");
  await isReady();
  await page.selectOption("#body", "steel");
  await page.selectOption("#against", "rigid");
  await page.selectOption("#target", "area_fraction");
  await page.fill("#target-value", "10");
  await page.click("#run");
  await page.waitForFunction(() => window.viewer?.path.size === 65536 && window.viewer.path.count > 500, undefined, { timeout: 120000 });
  const first = await page.evaluate(() => viewer.path.count);
  await page.waitForFunction((first) => viewer.path.count > first, first, { timeout: 120000 });
  await picture("web_grows.png");
  await drop("matrix.txt", "text/plain");
  assert.match(await question().textContent(), /A path is running/);
  await page.click("#stop");
  await page.waitForSelector("#go-on", { state: "visible", timeout: 120000 });
  const stopped = await page.evaluate(() => viewer.path.count);
  assert.ok(stopped < 6553, `${stopped} states`);
  await page.click("#go-on");
  await page.waitForFunction(() => document.getElementById("told").textContent.endsWith("; done"), undefined, { timeout: 600000 });
  agree(table(await saved("Save the table")), table(path.join(folder, "example/path.csv")));
});

await step("how long it takes at one go, beside the program with one thread", async () => {
  const seconds = await run();
  const native = Number(readFileSync(path.join(folder, "example/seconds"), "utf8"));
  console.log(`  256 × 256 nodes to 10 %: ${seconds.toFixed(1)} s in the browser, ${native.toFixed(1)} s in the program: ${(seconds / native).toFixed(1)} times`);
  await page.evaluate(() => {
    viewer.goTo(viewer.path.eventAt("area", 0.06));
    scrollTo(0, 0);
  });
  await page.setViewportSize({ width: 1440, height: 1900 });
  await picture("web.png");
});

assert.equal(asked.length, loaded, `asked later for ${asked.slice(loaded)}`);
assert.deepEqual(said, []);
await browser.close();
server.close();
console.log("the page computes as it should");
