/** Colours: a perceptual scale for populations, and those of the theme. */

/** Viridis at eight places; between, linear. */
const VIRIDIS = ["#440154", "#46327e", "#365c8d", "#277f8e", "#1fa187", "#4ac16d", "#a0da39", "#fde725"];
/** Inferno, from black. */
const INFERNO = ["#000004", "#280b53", "#65156e", "#9f2a63", "#d44842", "#f57d15", "#fac127", "#fcffa4"];

const scale = (colours: string[]) => {
  const stops = colours.map((hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16)));
  return (share: number): string => {
    const place = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
    const k = Math.min(Math.floor(place), stops.length - 2);
    const mix = (c: number) => Math.round(stops[k][c] + (place - k) * (stops[k + 1][c] - stops[k][c]));
    return `rgb(${mix(0)},${mix(1)},${mix(2)})`;
  };
};
/** The colour at a share of the scale, in [0, 1]. */
export const [viridis, inferno] = [scale(VIRIDIS), scale(INFERNO)];

/** Share of the scale for a population: its logarithm, for the largest is hundreds of times the usual one. */
export const population = (count: number, most: number): number => Math.log1p(count) / Math.log1p(most);

/** Ink, paper; set-ups A and B, which everybody can tell apart; velocity, angular velocity, impulse. */
const NAMES = ["ink", "soft", "line", "paper", "ground", "a", "b", "velocity", "spin", "impulse"] as const;
export type Palette = Record<(typeof NAMES)[number], string>;

/** The colours of the theme in force. */
export function theme(): Palette {
  const style = getComputedStyle(document.documentElement);
  return Object.fromEntries(NAMES.map((name) => [name, style.getPropertyValue(`--${name}`).trim()])) as Palette;
}

/** Of files, which are on white. */
export const PRINT: Palette = {
  ink: "#000000",
  soft: "#444444",
  line: "#dddddd",
  paper: "#ffffff",
  ground: "#d9dee4",
  a: "#0b5394",
  b: "#b45309",
  velocity: "#0a7d55",
  spin: "#8b3aa8",
  impulse: "#000000",
};
