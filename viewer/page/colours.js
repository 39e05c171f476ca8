// Colours: viridis, as the maps of the program have, and those of the theme.

const VIRIDIS = [
  [0.2777273272234177, 0.1050930431085774, -0.3308618287255563, -4.634230498983486, 6.228269936347081, 4.776384997670288, -5.435455855934631],
  [0.005407344544966578, 1.404613529898575, 0.214847559468213, -5.799100973351585, 14.17993336680509, -13.74514537774601, 4.645852612178535],
  [0.3340998053353061, 1.384590162594685, 0.09509516302823659, -19.33244095627987, 56.69055260068105, -65.35303263337234, 26.3124352495832],
];

const rgba = (r, g, b) => ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;

/** 256 colours from dark to light, by a polynomial that is within a hundredth of the table of viridis. */
const viridis = Uint32Array.from({ length: 256 }, (_, i) => {
  const channel = (terms) => Math.round(255 * Math.min(1, Math.max(0, terms.reduceRight((sum, term) => sum * (i / 255) + term, 0))));
  return rgba(...VIRIDIS.map(channel));
});

const css = (colour) => `rgb(${colour & 255} ${(colour >> 8) & 255} ${(colour >> 16) & 255})`;

/** Nodes that have yielded, as in the maps of the program. */
const YIELDED = rgba(240, 120, 0);

const isDark = () => {
  const asked = document.documentElement.dataset.theme;
  return asked ? asked === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
};

const DARK = { out: rgba(84, 93, 105), newest: rgba(255, 255, 255), grey: [150, 50] };
const LIGHT = { out: rgba(233, 236, 241), newest: rgba(0, 0, 0), grey: [252, 150] };
const themed = () => (isDark() ? DARK : LIGHT);

/** Greys for what is out of contact, from light to dark in every theme, as the words beside the map say. */
const greys = (levels) => {
  const [from, to] = themed().grey;
  return Uint32Array.from({ length: levels + 1 }, (_, i) => {
    const value = Math.round(from + ((to - from) * i) / levels);
    return rgba(value, value, value);
  });
};

/** Lines of charts, which colour-blind readers tell apart: one colour for each record, by Okabe and Ito. */
const lineColour = (record) => (isDark() ? ["#56b4e9", "#e69f00"] : ["#0072b2", "#d55e00"])[record % 2];
const ink = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
