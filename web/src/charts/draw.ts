/** Draws a picture: axes, population, curves, marks, colour bar, legend. The same on the screen and in a file. */

import { inferno, population, viridis, type Palette } from "./colours";
import type { Box, Pen, Place } from "./pen";
import type { Axis, Curve, Picture } from "./picture";
import { ticks } from "./ticks";

export interface Frame {
  box: Box;
  x: (value: number) => number;
  y: (value: number) => number;
}

/** Fraction of an axis at a value. */
const along = ({ low, high, log }: Axis, value: number): number =>
  log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);

/** The value at a fraction of an axis. */
export const back = ({ low, high, log }: Axis, part: number): number =>
  log ? low * (high / low) ** part : low + (high - low) * part;

export function frame(picture: Picture, width: number, height: number, font: number): Frame {
  const right = picture.lattice ? 4.9 * font : 1.4 * font;
  const box = { left: 0, top: 0.8 * font, width: 0, height: Math.max(height - 4.2 * font, 10) };
  box.left = (2.3 + 0.6 * Math.max(...upwards(picture, box, font).map(({ text }) => text.length), 2)) * font;
  box.width = Math.max(width - box.left - right, 10);
  return {
    box,
    x: (value) => box.left + box.width * along(picture.x, value),
    y: (value) => box.top + box.height * (1 - along(picture.y, value)),
  };
}

/** The lines behind everything. */
export function grid(pen: Pen, picture: Picture, at: Frame, colours: Palette, font: number): void {
  const { box } = at;
  for (const { value, text } of across(picture, box, font)) {
    if (text) pen.line([[at.x(value), box.top], [at.x(value), box.top + box.height]], colours.line, 1);
  }
  for (const { value, text } of upwards(picture, box, font)) {
    if (text) pen.line([[box.left, at.y(value)], [box.left + box.width, at.y(value)]], colours.line, 1);
  }
}

const across = ({ x }: Picture, box: Box, font: number) => ticks(x, box.width / (5 * font));
/** An axis without a name has no numbers. */
const upwards = ({ y }: Picture, box: Box, font: number) => (y.label ? ticks : () => [])(y, box.height / (2.6 * font));

/** Everything on top of the grid and the population. */
export function draw(pen: Pen, picture: Picture, at: Frame, colours: Palette, font: number): void {
  const { box } = at;
  axes(pen, picture, at, colours, font);
  pen.within(box, () => {
    for (const { y } of picture.levels ?? []) {
      pen.line([[box.left, at.y(y)], [box.left + box.width, at.y(y)]], colours.ink, 1, [5, 4]);
    }
    for (const curve of picture.curves) line(pen, curve, picture, at, colours);
    const { mark, spot } = picture;
    if (mark !== undefined && (mark > 0 || !picture.x.log)) {
      pen.line([[at.x(mark), box.top], [at.x(mark), box.top + box.height]], colours.ink, 1.5);
    }
    if (spot) {
      const middle: Place = [at.x(spot[0]), at.y(spot[1])];
      pen.ellipse(middle, [8, 8], 0, "none", colours.paper, 5);
      pen.ellipse(middle, [8, 8], 0, "none", colours.b, 2.5);
    }
  });
  levels(pen, picture, at, colours, font);
  if (picture.lattice) bar(pen, picture.lattice.most, picture.glow ? inferno : viridis, box, colours, font);
  legend(pen, picture, at, colours, font);
  if (picture.note) {
    picture.note.split("\n").forEach((part, k) => {
      const width = 0.65 * font * part.length;
      // A marked value is behind the words.
      if (picture.mark !== undefined) pen.rectangles([{ left: box.left + (box.width - width) / 2, top: box.top + box.height * 0.4 + (1.5 * k - 1.2) * font, width, height: 1.7 * font }], colours.paper);
      pen.text(part, [box.left + box.width / 2, box.top + box.height * 0.4 + 1.5 * k * font], { colour: colours.ink, size: 1.1 * font, anchor: "middle", rim: colours.paper });
    });
  }
}

function axes(pen: Pen, picture: Picture, at: Frame, colours: Palette, font: number): void {
  const { box } = at;
  const [right, bottom] = [box.left + box.width, box.top + box.height];
  const small = { colour: colours.ink, size: font };
  for (const { value, text } of across(picture, box, font)) {
    pen.line([[at.x(value), bottom], [at.x(value), bottom + (text ? 5 : 3)]], colours.soft, 1);
    pen.text(text, [at.x(value), bottom + 1.4 * font], { ...small, anchor: "middle" });
  }
  for (const { value, text } of upwards(picture, box, font)) {
    pen.line([[box.left, at.y(value)], [box.left - (text ? 5 : 3), at.y(value)]], colours.soft, 1);
    pen.text(text, [box.left - 0.6 * font, at.y(value) + 0.35 * font], { ...small, anchor: "end" });
  }
  pen.line([[box.left, box.top], [right, box.top], [right, bottom], [box.left, bottom], [box.left, box.top]], colours.soft, 1);
  pen.text(picture.x.label, [box.left + box.width / 2, bottom + 2.9 * font], { ...small, anchor: "middle" });
  pen.text(picture.y.label, [font, box.top + box.height / 2], { ...small, anchor: "middle", turned: true });
}

/** Lattice sites as rectangles, by colour; none is smaller than it can be seen, and larger where there are few. */
export function sites(pen: Pen, picture: Picture, at: Frame): void {
  const { v, other, counts, most } = picture.lattice!;
  const shades = new Map<number, Box[]>();
  const few = counts.reduce((sum, count) => sum + (count ? 1 : 0), 0) < 500;
  const least = picture.glow ? 1 : few ? 5 : 2.5;
  const [width, height] = [v.step, other.step].map((step, k) =>
    Math.max(least, k ? at.y(0) - at.y(step) : at.x(step) - at.x(0)),
  );
  for (let row = 0; row < v.count; row++) {
    for (let k = 0; k < other.count; k++) {
      const count = counts[row * other.count + k];
      if (!count) continue;
      const shade = Math.round(255 * population(count, most));
      if (!shades.has(shade)) shades.set(shade, []);
      const [x, y] = [at.x(v.middle(row)), at.y(other.middle(k))];
      // A trifle larger, so that no seams show.
      shades.get(shade)!.push({ left: x - width / 2, top: y - height / 2, width: width + 0.4, height: height + 0.4 });
    }
  }
  // The most populous on top.
  const order = [...shades.keys()].sort((a, b) => a - b);
  pen.within(at.box, () => {
    if (picture.glow) pen.rectangles([at.box], inferno(0));
    for (const shade of order) pen.rectangles(shades.get(shade)!, (picture.glow ? inferno : viridis)(shade / 255));
  });
}

function line(pen: Pen, { x, y, of, kind }: Curve, picture: Picture, at: Frame, colours: Palette): void {
  if (kind === "points" || kind === "ticks") {
    const boxes = y.map((value, k) => {
      const [left, top] = [at.x(x[k]) - 1, value === null ? NaN : at.y(value)];
      return kind === "points" ? { left, top: top - 1, width: 2, height: 2 } : { left, top, width: 2, height: at.box.top + at.box.height - top };
    });
    return pen.rectangles(boxes.filter(({ top }) => Number.isFinite(top)), colours[of]);
  }
  let places: Place[] = [];
  const end = () => {
    if (picture.lattice) pen.line(places, colours.paper, 5); // on colours of every kind
    pen.line(places, colours[of], kind === "steps" ? 1.6 : 2, kind === "dashes" ? [6, 4] : []);
    places = [];
  };
  y.forEach((value, k) => {
    if (value === null || (picture.y.log && value <= 0)) return end();
    places.push([at.x(x[k]), at.y(value)]);
    if (kind === "steps") places.push([at.x(x[k + 1]), at.y(value)]);
    return undefined;
  });
  end();
}

/** Names of the levels at the right, the upper one above its line and the other below, clear of an impact that is marked there. */
function levels(pen: Pen, { levels = [], y, spot }: Picture, at: Frame, colours: Palette, font: number): void {
  const { box } = at;
  const seen = levels.filter((x) => x.y > y.low && x.y < y.high).sort((a, b) => b.y - a.y);
  seen.forEach((level, k) => {
    let place = at.y(level.y) + (k === 0 ? -0.35 : 1.05) * font;
    const right = box.left + box.width - 5;
    if (spot && at.x(spot[0]) > right - 3 * font - 11 && Math.abs(place - 0.35 * font - at.y(spot[1])) < 11 + 0.5 * font) {
      place = at.y(spot[1]) + (k === 0 ? -13 : 13 + 0.8 * font);
    }
    pen.text(level.label, [right, place], { colour: colours.ink, size: font, anchor: "end", rim: colours.paper });
  });
}

/** The colour bar, with the number of impacts in a site. */
function bar(pen: Pen, most: number, shade: typeof viridis, box: Box, colours: Palette, font: number): void {
  const left = box.left + box.width + 0.9 * font;
  const width = 0.8 * font;
  const height = (share: number) => box.top + box.height * (1 - share);
  const steps = 64;
  for (let k = 0; k < steps; k++) {
    const top = height((k + 1) / steps);
    pen.rectangles([{ left, top, width, height: box.height / steps + 0.5 }], shade((k + 0.5) / steps));
  }
  // Powers of ten first, then what fits between them.
  const powers = Array.from({ length: 1 + Math.floor(Math.log10(most) + 1e-9) }, (_, k) => 10 ** k);
  const taken: number[] = [];
  for (const count of [...powers, ...powers.map((x) => 2 * x), ...powers.map((x) => 5 * x)]) {
    const place = height(population(count, most));
    if (count > most || taken.some((other) => Math.abs(other - place) < 1.4 * font)) continue;
    taken.push(place);
    pen.line([[left + width, place], [left + width + 4, place]], colours.soft, 1);
    const text = count >= 1e4 ? `${count / 1000}k` : String(count);
    pen.text(text, [left + width + 0.5 * font, place + 0.35 * font], { colour: colours.ink, size: 0.9 * font });
  }
  const label = { colour: colours.ink, size: 0.9 * font, anchor: "middle", turned: true } as const;
  pen.text("impacts", [left + width + 3.1 * font, box.top + box.height / 2], label);
}

function legend(pen: Pen, { curves }: Picture, at: Frame, colours: Palette, font: number): void {
  if (curves.length < 2) return;
  const { box } = at;
  const width = 0.58 * font * Math.max(...curves.map(({ label }) => label.length)) + 2.6 * font;
  const height = 1.45 * font * curves.length + 4;
  const corners = [box.top + 4, box.top + box.height - height - 4].flatMap((top) =>
    [box.left + box.width - width - 0.6 * font, box.left + 0.6 * font].map((left) => ({ left, top, width, height })),
  );
  const hidden = ({ left, top }: Box) =>
    curves.reduce((sum, { x, y }) => sum + y.filter((value, k) => value !== null && at.x(x[k]) > left && at.x(x[k]) < left + width && at.y(value) > top && at.y(value) < top + height).length, 0);
  // In the corner where it hides least of the curves.
  const least = Math.min(...corners.map(hidden));
  const { left, top } = corners.find((corner) => hidden(corner) === least)!;
  pen.rectangles([{ left, top, width, height }], colours.paper);
  curves.forEach(({ label, of, kind }, k) => {
    const y = top - 4 + 1.45 * font * (k + 0.75);
    pen.line([[left + 0.3 * font, y], [left + 2 * font, y]], colours[of], 2, kind === "dashes" ? [6, 4] : []);
    pen.text(label, [left + 2.4 * font, y + 0.35 * font], { colour: colours.ink, size: font });
  });
}
