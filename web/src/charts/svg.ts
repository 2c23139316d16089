/** A picture as an SVG file for print: black on white, with axes, whatever the theme on the screen. */

import { population } from "./colours";
import type { Curve, Picture } from "./picture";

const [WIDTH, HEIGHT] = [640, 420];
const BOX = { left: 70, top: 36, width: 550, height: 320 };
const COLOURS = { a: "#0b5394", b: "#b45309" };

const text = (value: string) => value.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);
const short = (x: number) => String(Math.round(x * 100) / 100);

/** Round values in [low, high], some six of them. */
function ticks(low: number, high: number, log: boolean): number[] {
  if (log) {
    const powers = Array.from({ length: 40 }, (_, k) => 10 ** (k - 20));
    return powers.filter((x) => x >= low * 0.999 && x <= high * 1.001);
  }
  const rough = (high - low) / 6;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((k) => k * power).find((x) => x >= rough)!;
  const first = Math.ceil(low / step - 1e-9);
  const number = Math.floor(high / step + 1e-9) - first + 1;
  return Array.from({ length: number }, (_, k) => Number(((first + k) * step).toPrecision(12)));
}

export function svg(picture: Picture): string {
  const { x, y } = picture;
  const scale = (value: number, low: number, high: number, log = false) =>
    log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  const px = (value: number) => BOX.left + BOX.width * scale(value, x.low, x.high);
  const py = (value: number) => BOX.top + BOX.height * (1 - scale(value, y.low, y.high, y.log));
  const parts: string[] = [];
  const add = (line: string) => parts.push(line);

  add(`<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${WIDTH} ${HEIGHT}" width="${WIDTH}" height="${HEIGHT}" font-family="Helvetica, Arial, sans-serif" font-size="13">`);
  add(`<title>${text(picture.title)}</title><rect width="${WIDTH}" height="${HEIGHT}" fill="#fff"/>`);
  add(`<text x="${BOX.left}" y="22">${text(picture.title)}</text>`);
  add(`<clipPath id="box"><rect x="${BOX.left}" y="${BOX.top}" width="${BOX.width}" height="${BOX.height}"/></clipPath><g clip-path="url(#box)">`);
  if (picture.lattice) sites(picture, px, py, add);
  for (const curve of picture.curves) line(curve, picture.at, px, py, y, add);
  if (picture.mark !== undefined) {
    const at = short(px(picture.mark));
    add(`<path d="M${at} ${BOX.top}v${BOX.height}" stroke="#000" stroke-dasharray="2 3"/>`);
  }
  add(`</g><rect x="${BOX.left}" y="${BOX.top}" width="${BOX.width}" height="${BOX.height}" fill="none" stroke="#000"/>`);
  for (const value of ticks(x.low, x.high, false)) {
    add(`<path d="M${short(px(value))} ${BOX.top + BOX.height}v5" stroke="#000"/><text x="${short(px(value))}" y="${BOX.top + BOX.height + 19}" text-anchor="middle">${value}</text>`);
  }
  for (const value of ticks(y.low, y.high, y.log ?? false)) {
    add(`<path d="M${BOX.left} ${short(py(value))}h-5" stroke="#000"/><text x="${BOX.left - 8}" y="${short(py(value) + 4)}" text-anchor="end">${value}</text>`);
  }
  add(`<text x="${BOX.left + BOX.width / 2}" y="${HEIGHT - 14}" text-anchor="middle">${text(x.label)}</text>`);
  add(`<text transform="translate(18 ${BOX.top + BOX.height / 2}) rotate(-90)" text-anchor="middle">${text(y.label)}</text>`);
  picture.curves.forEach((curve, k) => {
    if (picture.curves.length < 2) return;
    add(`<text x="${BOX.left + BOX.width - 8}" y="${BOX.top + 18 + 17 * k}" text-anchor="end" fill="${COLOURS[curve.of]}">${text(curve.label)}</text>`);
  });
  add("</svg>");
  return parts.join("\n");
}

function sites(
  { lattice, x, y }: Picture,
  px: (v: number) => number,
  py: (v: number) => number,
  add: (line: string) => void,
): void {
  const { v, other, counts } = lattice!;
  let most = 1;
  for (const count of counts) most = Math.max(most, count);
  for (let row = 0; row < v.count; row++) {
    if (v.edge(row + 1) < x.low || v.edge(row) > x.high) continue;
    for (let k = 0; k < other.count; k++) {
      const count = counts[row * other.count + k];
      if (!count || other.edge(k + 1) < y.low || other.edge(k) > y.high) continue;
      const [r, g, b] = population(count, most);
      const [left, top] = [px(v.edge(row)), py(other.edge(k + 1))];
      const size = `width="${short(px(v.edge(row + 1)) - left)}" height="${short(py(other.edge(k)) - top)}"`;
      add(`<rect x="${short(left)}" y="${short(top)}" ${size} fill="rgb(${r},${g},${b})"/>`);
    }
  }
}

function line(
  curve: Curve,
  at: number[],
  px: (v: number) => number,
  py: (v: number) => number,
  y: Picture["y"],
  add: (line: string) => void,
): void {
  const colour = COLOURS[curve.of];
  if (curve.kind === "points") {
    curve.y.forEach((value, k) => {
      if (value !== null) add(`<circle cx="${short(px(at[k]))}" cy="${short(py(value))}" r="2.5" fill="${colour}"/>`);
    });
  }
  let [path, pen] = ["", false];
  curve.y.forEach((value, k) => {
    if (value === null || (y.log && value <= 0)) {
      pen = false;
      return;
    }
    const place = `${short(px(at[k]))} ${short(py(value))}`;
    path += pen ? `L${place}` : `M${place}`;
    if (curve.kind === "steps" && k + 1 < at.length) path += `H${short(px(at[k + 1]))}`;
    pen = true;
  });
  add(`<path d="${path}" fill="none" stroke="${colour}" stroke-width="1.5"${curve.kind === "dashes" ? ' stroke-dasharray="5 4"' : ""}/>`);
}

/** The canvas of a chart on a ground of this colour, for a PNG file. */
export function onGround(canvas: HTMLCanvasElement, ground: string): HTMLCanvasElement {
  const copy = document.createElement("canvas");
  [copy.width, copy.height] = [canvas.width, canvas.height];
  const context = copy.getContext("2d")!;
  context.fillStyle = ground;
  context.fillRect(0, 0, copy.width, copy.height);
  context.drawImage(canvas, 0, 0);
  return copy;
}

