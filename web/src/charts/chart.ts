/** A chart on the screen: as large as its place on the page, with a line to drag and impacts to pick. */

import type { Lattice } from "../statistics";
import { PRINT, theme } from "./colours";
import { back, draw, frame, grid, sites, type Frame } from "./draw";
import { CanvasPen, SvgPen } from "./pen";
import type { Picture } from "./picture";

export interface Touch {
  /** The vertical line was dragged to this x. */
  drag?: (x: number) => void;
  /** A place was picked; how much x and y a pixel is. */
  pick?: (x: number, y: number, perPixel: [number, number]) => void;
}

/** Of a file, in pixels. */
const FILE = { width: 640, height: 420, font: 13 };
/** How far from the line a press still takes hold of it, in pixels. */
const NEAR = 9;

export class Chart {
  private make: (() => Picture) | undefined;
  private made: Picture | undefined;
  /** Whether it is in the window, or nearly: what is not is drawn when it comes. */
  private near = true;
  readonly canvas = document.createElement("canvas");
  /** What is inside the axes: it takes the presses. */
  private readonly plot = document.createElement("div");
  private at: Frame | undefined;
  /** The drawing of the population, which is long, and what it is of. */
  private readonly population = { canvas: document.createElement("canvas"), of: undefined as Lattice | undefined, seen: 0, box: "" };

  constructor(readonly host: HTMLElement, private readonly touch: Touch = {}) {
    this.plot.className = "plot";
    host.append(this.canvas, this.plot);
    this.listen();
    new ResizeObserver(() => this.draw()).observe(host);
    new IntersectionObserver(([entry]) => {
      this.near = entry.isIntersecting;
      if (this.near) this.draw();
    }, { rootMargin: "200px" }).observe(host);
  }

  /** Shows a picture, which is made when it is looked at. */
  show(make: () => Picture): void {
    this.make = make;
    this.made = undefined;
    if (this.near) this.draw();
  }

  /** Of what is inside the axes, in pixels; 0 before it was drawn. */
  get inner(): [number, number] {
    return [this.plot.clientWidth, this.plot.clientHeight];
  }

  get picture(): Picture | undefined {
    return (this.made ??= this.make?.());
  }

  /** The picture as a file for print: on white, for every theme on the screen. */
  svg(): string {
    const { width, height, font } = FILE;
    const pen = new SvgPen();
    const picture = this.picture!;
    const at = frame(picture, width, height, font);
    grid(pen, picture, at, PRINT, font);
    if (picture.lattice) sites(pen, picture, at);
    draw(pen, picture, at, PRINT, font);
    return pen.file(picture.title, width, height);
  }

  /** Draws again: another size, other colours. */
  draw(): void {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (!this.make || !width || !height) return;
    const { canvas, plot } = this;
    const picture = this.picture!;
    const scale = devicePixelRatio;
    const context = cleared(canvas, width, height);
    this.host.setAttribute("aria-label", picture.title);
    const font = 0.8 * parseFloat(getComputedStyle(this.host).fontSize);
    this.at = frame(picture, width, height, font);
    const { box } = this.at;
    for (const side of ["left", "top", "width", "height"] as const) plot.style[side] = `${box[side]}px`;
    const [pen, colours] = [new CanvasPen(context), theme()];
    grid(pen, picture, this.at, colours, font);
    if (picture.lattice) context.drawImage(this.populated(picture.lattice, this.at, scale), 0, 0, width, height);
    draw(pen, picture, this.at, colours, font);
  }

  private populated(lattice: Lattice, at: Frame, scale: number): HTMLCanvasElement {
    const { population, host } = this;
    const box = JSON.stringify([at.box, scale]);
    if (population.of === lattice && population.seen === lattice.seen && population.box === box) return population.canvas;
    sites(new CanvasPen(cleared(population.canvas, host.clientWidth, host.clientHeight)), this.picture!, at);
    Object.assign(population, { of: lattice, seen: lattice.seen, box });
    return population.canvas;
  }

  /** A press near the line drags it; any other one picks. */
  private listen(): void {
    const { plot } = this;
    const { drag, pick } = this.touch;
    if (!drag) return;
    const x = (event: PointerEvent) => back(this.picture!.x, event.offsetX / plot.clientWidth);
    let dragging = false;
    plot.classList.add("touched");
    plot.addEventListener("pointerdown", (event) => {
      const { mark, y } = this.picture!;
      const off = mark === undefined ? Infinity : Math.abs(this.at!.x(mark) - this.at!.box.left - event.offsetX);
      dragging = off < NEAR || pick === undefined;
      if (dragging) {
        plot.setPointerCapture(event.pointerId);
        drag(x(event));
      } else {
        const { low, high } = this.picture!.x;
        const perPixel: [number, number] = [(high - low) / plot.clientWidth, (y.high - y.low) / plot.clientHeight];
        pick?.(x(event), back(y, 1 - event.offsetY / plot.clientHeight), perPixel);
      }
    });
    plot.addEventListener("pointermove", (event) => {
      if (dragging) drag(x(event));
    });
    for (const end of ["pointerup", "pointercancel"]) plot.addEventListener(end, () => (dragging = false));
  }
}

/** An empty canvas of this size, whose unit is that of the page. One that has the size already is not made anew, which takes long. */
export function cleared(canvas: HTMLCanvasElement, width: number, height: number): CanvasRenderingContext2D {
  const scale = devicePixelRatio;
  const [across, down] = [Math.round(width * scale), Math.round(height * scale)];
  if (canvas.width !== across || canvas.height !== down) [canvas.width, canvas.height] = [across, down];
  const context = canvas.getContext("2d")!;
  context.setTransform(scale, 0, 0, scale, 0, 0);
  context.clearRect(0, 0, width, height);
  return context;
}
