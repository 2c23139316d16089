/** Colours: a perceptual scale for populations, and two that everybody can tell apart for set-ups A and B. */

/** Viridis at eight places; between, linear. */
const VIRIDIS = ["#440154", "#46327e", "#365c8d", "#277f8e", "#1fa187", "#4ac16d", "#a0da39", "#fde725"];

const rgb = (hex: string) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
const STOPS = VIRIDIS.map(rgb);

export function viridis(x: number): [number, number, number] {
  const place = Math.min(Math.max(x, 0), 1) * (STOPS.length - 1);
  const k = Math.min(Math.floor(place), STOPS.length - 2);
  const mix = (c: number) => Math.round(STOPS[k][c] + (place - k) * (STOPS[k + 1][c] - STOPS[k][c]));
  return [mix(0), mix(1), mix(2)];
}

/** Colour of a site: the logarithm of its population, for the largest one is hundreds of times the usual one. */
export const population = (count: number, most: number): [number, number, number] =>
  viridis(Math.log1p(count) / Math.log1p(most));

const style = (name: string) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** The colours of the theme in force. */
export const theme = () => ({
  ink: style("--ink"),
  soft: style("--soft"),
  line: style("--line"),
  paper: style("--paper"),
  a: style("--a"),
  b: style("--b"),
});
