/** What is written over the scene: the key to the arrows with their values, their names, a scale bar, the height. */

import { theme } from "../charts/colours";
import { CanvasPen, type Place } from "../charts/pen";
import { nice } from "../statistics";

export interface Arrowhead {
  name: "v" | "v↓" | "ω" | "P/m";
  hue: "velocity" | "spin" | "impulse";
  value: number;
  unit: string;
  /** What it is, in words. */
  words: string;
  /** Where it ends, in pixels; nowhere, if it cannot be seen. */
  tip: Place | undefined;
}

export interface Written {
  left: number;
  width: number;
  height: number;
  of: "a" | "b";
  arrows: Arrowhead[];
  /** Pixels of a metre at the body. */
  perMetre: number;
  /** Height of the centre of mass, and the largest that it has here, in m. */
  now: number;
  most: number;
  /** Two bodies are shown, so that each has a name. */
  named: boolean;
  /** What of the picture is not to scale, or "". */
  note: string;
}

/** Three digits; what is rounding is nothing. */
export const short = (x: number): string => (Math.abs(x) < 1e-9 ? "0" : String(Number(x.toPrecision(3))).replace("-", "−"));

export function write(context: CanvasRenderingContext2D, written: Written, font: number): void {
  const colours = theme();
  const pen = new CanvasPen(context);
  const { left, width, arrows, of } = written;
  const line = 1.45 * font;
  const small = { colour: colours.ink, size: font, rim: colours.paper };
  if (written.named) {
    pen.text(of.toUpperCase(), [left + width - 2 * font, 1.4 * font], { colour: colours[of], size: 1.2 * font, bold: true, anchor: "end" });
  }
  arrows.forEach(({ name, hue, value, unit, words }, k) => {
    const y = line * (k + 0.8);
    const from = left + 0.8 * font;
    pen.line([[from, y], [from + 1.3 * font, y]], colours[hue], 0.2 * font);
    pen.fill([[from + 2 * font, y], [from + 1.2 * font, y - 0.35 * font], [from + 1.2 * font, y + 0.35 * font]], colours[hue]);
    pen.text(name, [from + 2.5 * font, y + 0.35 * font], { ...small, bold: true });
    pen.text(`${short(value)} ${unit}`, [from + 5.2 * font, y + 0.35 * font], small);
    if (width > 37 * font) pen.text(words, [from + 12.8 * font, y + 0.35 * font], { ...small, colour: colours.soft });
  });
  for (const { name, hue, tip } of arrows) {
    if (tip) pen.text(name, [tip[0] + 0.5 * font, tip[1]], { colour: colours[hue], size: 1.15 * font, bold: true, rim: colours.paper });
  }
  scale(pen, written, font);
  altimeter(pen, written, font);
}

/** Of two bodies in free flight, by their colours: speeds as seen from their centre of mass, spins, and the contacts so far. */
export interface Key extends Pick<Written, "left" | "width" | "height" | "perMetre" | "note"> {
  bodies: { speed: number; spin: number }[];
  contact: [number, number];
  names: { name: string; hue: "velocity" | "spin" | "impulse"; tip: Place }[];
}

export function keyOf(context: CanvasRenderingContext2D, key: Key, font: number): void {
  const colours = theme();
  const pen = new CanvasPen(context);
  const [line, small] = [1.45 * font, { size: font, rim: colours.paper }];
  const narrow = key.width < 37 * font;
  key.bodies.forEach(({ speed, spin }, k) => {
    const y = line * ((narrow ? 2 : 1) * k + 0.8);
    const [right, down] = narrow ? [2.6 * font, y + line] : [9.6 * font, y];
    pen.ellipse([1.5 * font, y], [0.45 * font, 0.45 * font], 0, colours[k ? "b" : "a"], "none", 0);
    pen.text("v", [2.6 * font, y + 0.35 * font], { ...small, colour: colours.velocity, bold: true });
    pen.text(`${short(speed)} m/s`, [3.9 * font, y + 0.35 * font], { ...small, colour: colours.ink });
    pen.text("ω", [right, down + 0.35 * font], { ...small, colour: colours.spin, bold: true });
    pen.text(`${short(spin)} rad/s`, [right + 1.3 * font, down + 0.35 * font], { ...small, colour: colours.ink });
  });
  const [so, all] = key.contact;
  const text = all === 0 ? "no contact" : `contact ${so} of ${all}`;
  pen.text(text, [key.width - 0.8 * font, 1.15 * font], { colour: colours.ink, size: font, anchor: "end", rim: colours.paper });
  for (const { name, hue, tip } of key.names) {
    pen.text(name, [tip[0] + 0.4 * font, tip[1]], { colour: colours[hue], size: 1.15 * font, bold: true, rim: colours.paper });
  }
  scale(pen, key, font);
}

function scale(pen: CanvasPen, { left, height, width, perMetre, note }: Pick<Written, "left" | "width" | "height" | "perMetre" | "note">, font: number): void {
  const { ink, paper } = theme();
  const length = nice((0.1 * width) / perMetre);
  const [from, y] = [left + 0.8 * font, height - 0.9 * font];
  const to = from + length * perMetre;
  pen.line([[from, y - 4], [from, y], [to, y], [to, y - 4]], ink, 2);
  pen.text(`${Number((length * 1e3).toPrecision(3))} mm`, [from, y - 0.6 * font], { colour: ink, size: font, rim: paper });
  if (note) pen.text(note, [from, y - 2 * font], { colour: ink, size: font, rim: paper });
}

/** A line as high as the flight, with the body on it. */
function altimeter(pen: CanvasPen, { left, width, height, now, most, of }: Written, font: number): void {
  const colours = theme();
  const x = left + width - 1.2 * font;
  // In a narrow picture it begins below the key.
  const narrow = width < 26 * font;
  const [top, bottom] = [(narrow ? 6 : 2.4) * font, height - 1.2 * font];
  const at = (value: number) => bottom - (bottom - top) * Math.min(Math.max(value / most, 0), 1);
  pen.line([[x, top], [x, bottom]], colours.soft, 2);
  for (const y of [top, bottom]) pen.line([[x - 4, y], [x + 4, y]], colours.soft, 2);
  pen.ellipse([x, at(now)], [0.42 * font, 0.42 * font], 0, colours[of], "none", 0);
  const text = `${narrow ? "" : "height "}${short(now * 1e3)} mm`;
  pen.text(text, [x - 0.8 * font, Math.min(Math.max(at(now) + 0.35 * font, top + 0.4 * font), bottom)], { colour: colours.ink, size: font, anchor: "end", rim: colours.paper });
}
