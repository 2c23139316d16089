/** One impact, drawn: the body, the contact point and the arm to it, v and ω just before and just after, the impulse P. */

import type { Setup } from "../setup";
import { contactArm, outlineOf, pointsOf } from "../outline";
import { short } from "../stage/overlay";
import { arrivalOf, impulseOf, type Path } from "../stage/path";
import { Vector3 } from "three";
import { cleared } from "./chart";
import { PRINT, theme, type Palette } from "./colours";
import { CanvasPen, SvgPen, type Pen, type Place } from "./pen";

/** Of the centre of mass and about it: across and up in m/s, and counter-clockwise in rad/s. */
interface Motion {
  velocity: Place;
  spin: number;
}

/** An impact in the upright plane in which the axis of the body lies. */
export interface Struck {
  setup: Setup;
  /** From the plane's trace to the axis, counter-clockwise. */
  tilt: number;
  /** From the centre of mass to the contact point, in R. */
  arm: Place;
  before: Motion;
  after: Motion;
  impulse: Place;
}

/** The impact with this number, counted from 1. */
export function drawing(path: Path, setup: Setup, impacts: number): Struck {
  const [old, flight] = [path.flights[impacts - 1], path.flights[impacts]];
  const along = [flight.axis, flight.velocity, new Vector3(1, 0, 0)]
    .map(({ x, y }) => new Vector3(x, y, 0))
    .find((x) => x.length() > 1e-9)!
    .normalize();
  // Seen as in the scene, whose camera looks along y.
  if (along.x < 0) along.negate();
  const flat = (x: Vector3): Place => [x.dot(along), x.z];
  const normal = along.clone().cross(new Vector3(0, 0, 1));
  // The precession is constant in a flight; the rest of ω is along the axis, which lies in the plane of the drawing.
  const arm = contactArm(setup, flight.axis, flight.sphere).divideScalar(outlineOf(setup).size);
  return {
    setup,
    tilt: Math.atan2(flight.axis.z, flight.axis.dot(along)),
    arm: flat(arm),
    before: { velocity: flat(arrivalOf(path, impacts)), spin: old.turning.dot(normal) },
    after: { velocity: flat(flight.velocity), spin: flight.turning.dot(normal) },
    impulse: flat(impulseOf(path, impacts)),
  };
}

/** Of a file, in pixels. */
const FILE = { width: 720, height: 360, font: 14 };

/** The place on the page where it is drawn. */
export class Paper {
  readonly canvas = document.createElement("canvas");
  private struck: Struck | string = "";

  constructor(readonly host: HTMLElement) {
    host.append(this.canvas);
    new ResizeObserver(() => this.draw()).observe(host);
  }

  show(struck: Struck | string): void {
    this.struck = struck;
    this.draw();
  }

  draw(): void {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (!width || !height) return;
    const context = cleared(this.canvas, width, height);
    const font = 0.8 * parseFloat(getComputedStyle(this.host).fontSize);
    draw(new CanvasPen(context), this.struck, width, height, theme(), font);
  }

  svg(): string {
    const { width, height, font } = FILE;
    const pen = new SvgPen();
    draw(pen, this.struck, width, height, PRINT, font);
    return pen.file("One impact: just before and just after", width, height);
  }
}

function draw(pen: Pen, struck: Struck | string, width: number, height: number, colours: Palette, font: number): void {
  if (typeof struck === "string") {
    pen.text(struck, [width / 2, height / 2], { colour: colours.ink, size: 1.1 * font, anchor: "middle" });
    return;
  }
  for (const [name, k] of [["just before", 0], ["just after", 1]] as const) {
    panel(pen, struck, k === 1, (k * width) / 2, width / 2, height, name, colours, font);
  }
  pen.line([[width / 2, font], [width / 2, height - font]], colours.line, 1);
}

function panel(
  pen: Pen, struck: Struck, after: boolean, left: number, width: number, height: number, name: string, colours: Palette, font: number,
): void {
  const { setup, tilt, arm, before, impulse } = struck;
  const motion = after ? struck.after : before;
  const floor = height - 5 * font;
  // The body is a third of the drawing, and an arrow as long as the body is the fastest velocity of the two.
  const { size, length } = outlineOf(setup);
  const half = Math.max(1, length / size / 2);
  const unit = Math.min(width, floor) / (3 * half) / 1.2;
  const middle: Place = [left + width / 2, floor + arm[1] * unit];
  const at = ([x, y]: Place, from = middle): Place => [from[0] + x * unit, from[1] - y * unit];
  pen.line([[left + font, floor], [left + width - font, floor]], colours.soft, 2);
  outline(pen, setup, tilt, middle, unit, colours);
  const contact = at(arm);
  pen.line([middle, contact], colours.soft, 1.5, [4, 3]);
  pen.ellipse(middle, [3, 3], 0, colours.ink, "none", 0);
  pen.ellipse(contact, [4, 4], 0, colours.ink, "none", 0);

  const longest = 1.6 * half;
  const fastest = Math.max(...[before, struck.after].map(({ velocity }) => Math.hypot(...velocity)), Math.hypot(...impulse) / 2);
  const scaled = ([x, y]: Place, whole: number): Place => [(x * longest) / whole, (y * longest) / whole];
  // It arrives at the centre of mass, and leaves from there: neither arrow points through the plane unless the body does go on downwards.
  const way = scaled(motion.velocity, fastest);
  if (after) arrow(pen, middle, at(way), colours.velocity, font, "v", at(way));
  else arrow(pen, at([-way[0], -way[1]]), middle, colours.velocity, font, "v", at([-way[0], -way[1]]));
  turning(pen, motion.spin, middle, 0.62 * unit, colours.spin, font, Math.max(Math.abs(before.spin), Math.abs(struck.after.spin)));
  if (after) {
    const tip = at(scaled(impulse, 2 * fastest), contact);
    arrow(pen, contact, tip, colours.impulse, font, "P", tip);
  }

  const ink = { colour: colours.ink, size: font };
  pen.text(name, [left + 0.8 * font, 1.4 * font], { ...ink, bold: true });
  const [, up] = motion.velocity;
  const lines = [
    `${short(Math.abs(up))} m/s ${up < 0 ? "downwards" : "upwards"}`,
    `ω = ${short(Math.abs(motion.spin))} rad/s`,
    after ? `ε = ${short(struck.after.velocity[1] / -before.velocity[1])}, P/m = ${short(Math.hypot(...impulse))} m/s` : "dashed: arm of the contact",
  ];
  lines.forEach((line, k) => pen.text(line, [left + width / 2, height - (3.3 - 1.35 * k) * font], { ...ink, anchor: "middle" }));
}

function outline(pen: Pen, setup: Setup, tilt: number, [x, y]: Place, unit: number, colours: Palette): void {
  const { arcs, size } = outlineOf(setup);
  const [c, s] = [(unit / size) * Math.cos(tilt), (unit / size) * Math.sin(tilt)];
  const points = arcs.flatMap(pointsOf);
  const round = [...points, ...points.map(([z, r]): Place => [z, -r]).reverse()];
  pen.line([...round, round[0]].map(([z, r]): Place => [x + z * c - r * s, y - z * s - r * c]), colours.a, 2.5);
}

/** With its name beside `named`, its tip or its tail. */
function arrow(pen: Pen, from: Place, to: Place, colour: string, font: number, name: string, named: Place): void {
  const [x, y] = [to[0] - from[0], to[1] - from[1]];
  const length = Math.hypot(x, y);
  if (length < 2) return;
  head(pen, to, Math.atan2(y, x), Math.min(0.9 * font, length), colour);
  pen.line([from, [to[0] - (0.5 * font * x) / length, to[1] - (0.5 * font * y) / length]], colour, 0.22 * font);
  const right = named[0] >= (from[0] + to[0]) / 2;
  pen.text(name, [named[0] + (right ? 0.5 : -1.1) * font, named[1] + 0.2 * font], { colour, size: 1.15 * font, bold: true });
}

function head(pen: Pen, [x, y]: Place, angle: number, size: number, colour: string): void {
  const corner = (off: number): Place => [x - size * Math.cos(angle + off), y - size * Math.sin(angle + off)];
  pen.fill([[x, y], corner(0.4), corner(-0.4)], colour);
}

/** An arc about the centre, as long as the turn is fast. */
function turning(pen: Pen, spin: number, [x, y]: Place, radius: number, colour: string, font: number, fastest: number): void {
  const sweep = (1.5 * Math.PI * spin) / fastest;
  if (!(Math.abs(sweep) > 0.05)) return;
  const start = Math.PI / 2 - sweep / 2;
  const place = (angle: number): Place => [x + radius * Math.cos(angle), y - radius * Math.sin(angle)];
  pen.line(Array.from({ length: 49 }, (_, k) => place(start + (sweep * k) / 48)), colour, 0.2 * font);
  const end = start + sweep;
  head(pen, place(end), -(end + (Math.sign(spin) * Math.PI) / 2), 0.8 * font, colour);
  // Its name at its tail.
  const [tx, ty] = [x + (radius + 0.9 * font) * Math.cos(start), y - (radius + 0.9 * font) * Math.sin(start)];
  pen.text("ω", [tx, ty + 0.4 * font], { colour, size: 1.15 * font, bold: true, anchor: "middle" });
}
