// Numbers in the units that the reader chooses.

const PREFIXES = [["G", 1e9], ["M", 1e6], ["k", 1e3], ["", 1], ["m", 1e-3], ["µ", 1e-6], ["n", 1e-9], ["p", 1e-12], ["f", 1e-15], ["a", 1e-18]];
const CHOICES = {
  length: ["auto", "m", "mm", "µm", "nm"],
  force: ["auto", "MN", "kN", "N", "mN", "µN"],
  pressure: ["auto", "GPa", "MPa", "kPa", "Pa"],
  area: ["%", "auto", "m²", "mm²", "µm²"],
};
const FACTORS = {
  m: 1, mm: 1e-3, µm: 1e-6, nm: 1e-9, MN: 1e6, kN: 1e3, N: 1, mN: 1e-3, µN: 1e-6, GPa: 1e9, MPa: 1e6, kPa: 1e3, Pa: 1, "m²": 1, "mm²": 1e-6, "µm²": 1e-12,
};
const chosen = { length: "auto", force: "auto", pressure: "auto", area: "%" };

function prefixed(unit, greatest) {
  const size = Math.abs(greatest);
  const fits = PREFIXES.find(([, factor]) => size >= factor * 0.9999) ?? PREFIXES.at(-1);
  const [prefix, factor] = size > 0 && Number.isFinite(size) ? fits : ["", 1];
  return { name: prefix + unit, factor };
}

/** The unit for a quantity of this SI unit whose values go up to `greatest`; of an area fraction with the nominal area. */
function unitFor(unit, greatest, nominal) {
  const of = (name) => ({ name, factor: FACTORS[name] });
  if (unit === "m" && chosen.length !== "auto") return of(chosen.length);
  if (unit === "N" && chosen.force !== "auto") return of(chosen.force);
  if (unit === "Pa" && chosen.pressure !== "auto") return of(chosen.pressure);
  if (unit === "N/m" && (chosen.length !== "auto" || chosen.force !== "auto")) {
    const [force, length] = [chosen.force === "auto" ? "N" : chosen.force, chosen.length === "auto" ? "m" : chosen.length];
    return { name: `${force}/${length}`, factor: FACTORS[force] / FACTORS[length] };
  }
  if (unit === "1") {
    if (chosen.area === "%" || !nominal) return { name: "%", factor: 0.01 };
    const area = chosen.area === "auto" ? ["m²", "mm²", "µm²"].find((name) => greatest * nominal >= FACTORS[name]) ?? "µm²" : chosen.area;
    return { name: area, factor: FACTORS[area] / nominal };
  }
  if (unit === "") return { name: unit, factor: 1 };
  const [, power, rest] = unit.match(/^m([²³])(.*)/) ?? [];
  if (!power) return prefixed(unit, greatest);
  // A prefix would be raised to the power of its metre: areas and volumes have one, rates and permeabilities none.
  const times = power === "²" ? 2 : 3;
  const fitting = () => (rest || !greatest ? "m" : ["m", "mm"].find((name) => Math.abs(greatest) >= FACTORS[name] ** times) ?? "µm");
  const length = chosen.length === "auto" ? fitting() : chosen.length;
  return { name: length + power + rest, factor: FACTORS[length] ** times };
}

const SUPERSCRIPTS = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };

/** A number of so many digits, as people write it. */
function digits(value, count = 4) {
  if (Number.isNaN(value)) return "–";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) {
    const [mantissa, exponent] = value.toExponential(count - 1).split("e");
    return `${mantissa.replace("-", "−")} × 10${[...exponent.replace("+", "")].map((letter) => SUPERSCRIPTS[letter]).join("")}`;
  }
  const after = Math.max(0, count - 1 - Math.floor(Math.log10(size)));
  return value.toFixed(Math.min(after, 12)).replace("-", "−");
}

/** A quantity with its unit. */
function quantity(value, unit, nominal) {
  if (!Number.isFinite(value)) return digits(value);
  const { name, factor } = unitFor(unit, value, nominal);
  return `${digits(value / factor)}${name ? " " + name : ""}`;
}
