/** What a chart shows, apart from how it is drawn. */

import type { Lattice } from "../statistics";

export interface Axis {
  label: string;
  low: number;
  high: number;
  log?: boolean;
}

export interface Curve {
  label: string;
  /** Of set-up A or B, or of something that is computed otherwise. */
  of: "a" | "b" | "ink";
  /** Steps of bins, whose edges are one more than their values, a line, dashes, points, or a tick of the x axis for each value. */
  kind: "steps" | "line" | "dashes" | "points" | "ticks";
  x: ArrayLike<number>;
  /** Where there is nothing, the line is broken. */
  y: (number | null)[];
}

export interface Picture {
  title: string;
  x: Axis;
  y: Axis;
  curves: Curve[];
  /** Population, drawn below the curves, with a colour bar. */
  lattice?: Lattice;
  /** The population is drawn as it shines, on black, in sites of one pixel. */
  glow?: boolean;
  /** Horizontal lines with a name. */
  levels?: { y: number; label: string }[];
  /** A vertical line that can be dragged, or marks a value. */
  mark?: number;
  /** A point to look at. */
  spot?: [number, number];
  /** Why there is nothing to draw. */
  note?: string;
}
