/** What a chart shows, apart from how it is drawn: on the screen by uPlot, in a file as SVG. */

import type { Lattice } from "../statistics";

export interface Curve {
  label: string;
  /** Which set-up, and so which colour. */
  of: "a" | "b";
  y: (number | null)[];
  /** Steps of bins, a line, or points. */
  kind: "steps" | "line" | "points" | "dashes";
}

export interface Picture {
  title: string;
  x: { label: string; low: number; high: number };
  y: { label: string; low: number; high: number; log?: boolean };
  /** Shared by all curves. */
  at: number[];
  curves: Curve[];
  /** Population, drawn below the curves. */
  lattice?: Lattice;
  /** A vertical line that can be dragged, or marks a value. */
  mark?: number;
  /** A point to look at. */
  spot?: [number, number];
}
