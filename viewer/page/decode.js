// Numbers out of the text of the page: see blob.rs, column.rs and fields.rs for how they came in.

/** Something that makes the page useless, in words for its reader. */
class Fault extends Error {}

const demand = (holds, words) => {
  if (!holds) throw new Fault(words);
};

async function inflate(text, what) {
  const isNew = typeof DecompressionStream === "function" && "findLast" in Array.prototype;
  demand(isNew, "This browser is too old: the page needs Chrome 97, Firefox 113 or Safari 16.4, or newer.");
  try {
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  } catch (error) {
    throw new Fault(`The file is damaged: ${what} cannot be read.`);
  }
}

const isCount = (value) => Number.isInteger(value) && value >= 0 && value < 2 ** 31;

/** Whole numbers of four bytes at most. */
async function planes(blob, count, what) {
  demand(blob && blob.count === count && isCount(blob.planes) && blob.planes <= 4, `The file is damaged: ${what} are not ${count} numbers.`);
  const bytes = await inflate(blob.data, what);
  demand(bytes.length === count * blob.planes, `The file is damaged: ${what} are incomplete.`);
  const values = new Uint32Array(count);
  for (let plane = 0; plane < blob.planes; plane++) {
    for (let i = 0; i < count; i++) values[i] |= bytes[plane * count + i] << (8 * plane);
  }
  return values;
}

const ZERO = 2147483647, INFINITE = ZERO - 1, NOTHING = ZERO - 2;

/** A quantity at every event. */
async function column(blob, count, what) {
  const changes = await planes(blob.values, count, what);
  const values = new Float64Array(count);
  let code = 0;
  for (let i = 0; i < count; i++) {
    code = (code + ((changes[i] >>> 1) ^ -(changes[i] & 1))) | 0;
    if (blob.scale === "whole") values[i] = code;
    else if (code === ZERO) values[i] = 0;
    else if (code === INFINITE) values[i] = Infinity;
    else if (code === NOTHING) values[i] = NaN;
    else if (blob.scale === "signed") values[i] = Math.sign(code) * Math.exp(blob.least + (Math.abs(code) - 1) * blob.step);
    else values[i] = Math.exp(code * blob.step);
  }
  return values;
}

/** Levels of a field, from what is left of them besides what neighbours let expect. `isIn(node)` divides them into two kinds. */
function levelsOf(left, offset, isIn, nx, into) {
  for (let node = 0; node < into.length; node++) {
    const kind = isIn(node), hasLeft = node % nx > 0;
    const beside = (back, is) => is && node >= back && isIn(node - back) === kind ? into[node - back] : -1;
    const a = beside(1, hasLeft), b = beside(nx, true), c = beside(nx + 1, hasLeft);
    let expected = 0;
    if (a >= 0 && b >= 0) {
      expected = c >= 0 ? Math.min(Math.max(a + b - c, Math.min(a, b)), Math.max(a, b)) : (a + b) >> 1;
    } else if (a >= 0 || b >= 0) expected = Math.max(a, b);
    into[node] = left[offset + node] + expected;
  }
}
