/** Where a picture is drawn: on a canvas, or into a file as SVG. Lengths in pixels. */

export type Place = [number, number];

export interface Text {
  colour: string;
  size: number;
  anchor?: "start" | "middle" | "end";
  /** Reads upwards. */
  turned?: boolean;
  bold?: boolean;
  /** A rim in this colour, so that it can be read on anything. */
  rim?: string;
}

export interface Box {
  left: number;
  top: number;
  width: number;
  height: number;
}

export interface Pen {
  line(places: readonly Place[], colour: string, width: number, dash?: readonly number[]): void;
  /** A closed figure. */
  fill(places: readonly Place[], colour: string): void;
  rectangles(boxes: readonly Box[], colour: string): void;
  ellipse(middle: Place, radii: Place, turned: number, fill: string, stroke: string, width: number): void;
  text(value: string, place: Place, text: Text): void;
  within(box: Box, draw: () => void): void;
}

export const FONT = 'system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "DejaVu Sans", sans-serif';

export class CanvasPen implements Pen {
  constructor(private readonly context: CanvasRenderingContext2D) {}

  line(places: readonly Place[], colour: string, width: number, dash: readonly number[] = []): void {
    const { context } = this;
    [context.strokeStyle, context.lineWidth, context.lineJoin] = [colour, width, "round"];
    context.setLineDash([...dash]);
    this.path(places);
    context.stroke();
    context.setLineDash([]);
  }

  fill(places: readonly Place[], colour: string): void {
    this.context.fillStyle = colour;
    this.path(places);
    this.context.fill();
  }

  rectangles(boxes: readonly Box[], colour: string): void {
    this.context.fillStyle = colour;
    for (const { left, top, width, height } of boxes) this.context.fillRect(left, top, width, height);
  }

  ellipse([x, y]: Place, [a, b]: Place, turned: number, fill: string, stroke: string, width: number): void {
    const { context } = this;
    context.beginPath();
    context.ellipse(x, y, a, b, turned, 0, 2 * Math.PI);
    [context.fillStyle, context.strokeStyle, context.lineWidth] = [fill, stroke, width];
    if (fill !== "none") context.fill();
    if (stroke !== "none") context.stroke();
  }

  text(value: string, [x, y]: Place, { colour, size, anchor = "start", turned = false, bold = false, rim }: Text): void {
    const { context } = this;
    context.save();
    context.translate(x, y);
    if (turned) context.rotate(-Math.PI / 2);
    context.font = `${bold ? "600 " : ""}${size}px ${FONT}`;
    context.textAlign = anchor === "middle" ? "center" : anchor;
    if (rim) {
      [context.strokeStyle, context.lineWidth, context.lineJoin] = [rim, 0.3 * size, "round"];
      context.strokeText(value, 0, 0);
    }
    context.fillStyle = colour;
    context.fillText(value, 0, 0);
    context.restore();
  }

  within({ left, top, width, height }: Box, draw: () => void): void {
    const { context } = this;
    context.save();
    context.beginPath();
    context.rect(left, top, width, height);
    context.clip();
    draw();
    context.restore();
  }

  private path(places: readonly Place[]): void {
    this.context.beginPath();
    for (const [x, y] of places) this.context.lineTo(x, y);
  }
}

const short = (x: number) => String(Math.round(x * 100) / 100);
const escaped = (value: string) => value.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);

export class SvgPen implements Pen {
  private readonly parts: string[] = [];
  private clips = 0;

  line(places: readonly Place[], colour: string, width: number, dash: readonly number[] = []): void {
    if (places.length < 2) return;
    const dashes = dash.length ? ` stroke-dasharray="${dash.join(" ")}"` : "";
    const look = `fill="none" stroke="${colour}" stroke-width="${width}"${dashes}`;
    this.parts.push(`<path d="${this.path(places)}" ${look} stroke-linejoin="round"/>`);
  }

  fill(places: readonly Place[], colour: string): void {
    this.parts.push(`<path d="${this.path(places)}Z" fill="${colour}"/>`);
  }

  rectangles(boxes: readonly Box[], colour: string): void {
    const path = boxes.map(({ left, top, width, height }) => `M${short(left)} ${short(top)}h${short(width)}v${short(height)}h${short(-width)}z`);
    this.parts.push(`<path d="${path.join("")}" fill="${colour}"/>`);
  }

  ellipse([x, y]: Place, [a, b]: Place, turned: number, fill: string, stroke: string, width: number): void {
    const place = `transform="translate(${short(x)} ${short(y)}) rotate(${short((turned * 180) / Math.PI)})"`;
    this.parts.push(`<ellipse rx="${short(a)}" ry="${short(b)}" ${place} fill="${fill}" stroke="${stroke}" stroke-width="${width}"/>`);
  }

  text(value: string, [x, y]: Place, { colour, size, anchor = "start", turned = false, bold = false, rim }: Text): void {
    const place = turned ? `transform="translate(${short(x)} ${short(y)}) rotate(-90)"` : `x="${short(x)}" y="${short(y)}"`;
    const look = (bold ? ' font-weight="600"' : "") + (rim ? ` stroke="${rim}" stroke-width="${short(0.3 * size)}" paint-order="stroke"` : "");
    this.parts.push(`<text ${place} fill="${colour}" font-size="${short(size)}" text-anchor="${anchor}"${look}>${escaped(value)}</text>`);
  }

  within({ left, top, width, height }: Box, draw: () => void): void {
    const name = `clip${++this.clips}`;
    this.parts.push(`<clipPath id="${name}"><rect x="${left}" y="${top}" width="${width}" height="${height}"/></clipPath><g clip-path="url(#${name})">`);
    draw();
    this.parts.push("</g>");
  }

  /** The file, on white. */
  file(title: string, width: number, height: number): string {
    const head = `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" width="${width}" height="${height}" font-family="Helvetica, Arial, sans-serif">`;
    const ground = `<rect width="${width}" height="${height}" fill="#fff"/>`;
    return [head, `<title>${escaped(title)}</title>`, ground, ...this.parts, "</svg>"].join("\n");
  }

  private path(places: readonly Place[]): string {
    return places.map(([x, y], k) => `${k ? "L" : "M"}${short(x)} ${short(y)}`).join("");
  }
}

/** A drawing in three pixels for each of its own. */
export async function rastered(svg: string, canvas: HTMLCanvasElement): Promise<void> {
  const image = new Image();
  image.src = `data:image/svg+xml,${encodeURIComponent(svg)}`;
  await image.decode();
  [canvas.width, canvas.height] = [3 * image.width, 3 * image.height];
  canvas.getContext("2d")!.drawImage(image, 0, 0, canvas.width, canvas.height);
}
