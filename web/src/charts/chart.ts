/** A chart on the screen: uPlot draws axes and curves, and the lattice below them. */

import uPlot from "uplot";
import { population, theme } from "./colours";
import type { Lattice } from "../statistics";
import type { Picture } from "./picture";

export interface Touch {
  /** The vertical line was dragged to this x. */
  drag?: (x: number) => void;
  /** A place was picked. */
  pick?: (x: number, y: number, perPixel: [number, number]) => void;
}

const HEIGHT = 270;

export class Chart {
  picture: Picture | undefined;
  private plot: uPlot | undefined;
  private shape = "";
  /** The drawing of the lattice, and what it is of. */
  private sites: { canvas: HTMLCanvasElement; of: Lattice; seen: number } | undefined;

  constructor(readonly host: HTMLElement, private readonly touch: Touch = {}) {
    new ResizeObserver(() => this.resize()).observe(host);
  }

  show(picture: Picture): void {
    this.picture = picture;
    const shape = JSON.stringify([picture.x.label, picture.y.label, picture.y.log, picture.curves.map((c) => [c.label, c.of, c.kind])]);
    const data = [picture.at, ...picture.curves.map((c) => c.y)] as uPlot.AlignedData;
    if (!this.plot || shape !== this.shape) {
      this.plot?.destroy();
      this.plot = new uPlot(this.options(picture), data, this.host);
      this.shape = shape;
      this.listen(this.plot);
    } else {
      this.plot.setData(data, false);
      this.scale();
    }
  }

  /** Draws again, in the colours of the theme in force. */
  restyle(): void {
    this.shape = "";
    if (this.picture) this.show(this.picture);
  }

  /** Moves the vertical line without new data. */
  mark(x: number): void {
    if (this.picture) this.picture.mark = x;
    this.plot?.redraw(false);
  }

  get canvas(): HTMLCanvasElement | undefined {
    return this.plot?.ctx.canvas;
  }

  private scale(): void {
    const { x, y } = this.picture!;
    this.plot!.batch(() => {
      this.plot!.setScale("x", { min: x.low, max: x.high });
      this.plot!.setScale("y", { min: y.low, max: y.high });
    });
  }

  private resize(): void {
    const width = this.host.clientWidth;
    if (this.plot && width && width !== this.plot.width) this.plot.setSize({ width, height: HEIGHT });
  }

  private options(picture: Picture): uPlot.Options {
    const colours = theme();
    const axis = (label: string): uPlot.Axis => ({
      label,
      stroke: colours.ink,
      grid: { stroke: colours.line, width: 1 },
      ticks: { stroke: colours.line, width: 1 },
      font: "12px system-ui, sans-serif",
      labelFont: "13px system-ui, sans-serif",
      labelSize: 22,
    });
    const y = axis(picture.y.label);
    y.size = 52;
    return {
      width: this.host.clientWidth || 400,
      height: HEIGHT,
      legend: { show: false },
      cursor: { drag: { x: false, y: false }, points: { show: false } },
      scales: {
        x: { time: false, range: () => [this.picture!.x.low, this.picture!.x.high] },
        y: { distr: picture.y.log ? 3 : 1, range: () => [this.picture!.y.low, this.picture!.y.high] },
      },
      axes: [axis(picture.x.label), y],
      series: [
        {},
        ...picture.curves.map((curve): uPlot.Series => ({
          label: curve.label,
          stroke: colours[curve.of],
          width: 1.6,
          ...(curve.kind === "steps" ? { paths: uPlot.paths.stepped!({ align: 1 }) } : {}),
          ...(curve.kind === "dashes" ? { dash: [5, 4] } : {}),
          points: { show: curve.kind === "points", size: 5, fill: colours[curve.of] },
          spanGaps: false,
        })),
      ],
      hooks: {
        drawClear: [(plot) => this.drawSites(plot)],
        draw: [(plot) => this.drawMarks(plot)],
      },
    };
  }

  /** The lattice as an image, one pixel a site. */
  private drawSites(plot: uPlot): void {
    const lattice = this.picture?.lattice;
    if (!lattice) return;
    const { v, other, counts } = lattice;
    if (this.sites?.of !== lattice || this.sites.seen !== lattice.seen) {
      const canvas = document.createElement("canvas");
      [canvas.width, canvas.height] = [v.count, other.count];
      const context = canvas.getContext("2d")!;
      const image = context.createImageData(v.count, other.count);
      let most = 1;
      for (const count of counts) if (count > most) most = count;
      for (let row = 0; row < v.count; row++) {
        for (let k = 0; k < other.count; k++) {
          const count = counts[row * other.count + k];
          if (!count) continue;
          const [r, g, b] = population(count, most);
          image.data.set([r, g, b, 255], 4 * ((other.count - 1 - k) * v.count + row));
        }
      }
      context.putImageData(image, 0, 0);
      this.sites = { canvas, of: lattice, seen: lattice.seen };
    }
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.imageSmoothingEnabled = false;
    const [left, right] = [v.low, v.high].map((x) => plot.valToPos(x, "x", true));
    const [bottom, top] = [other.low, other.high].map((y) => plot.valToPos(y, "y", true));
    ctx.drawImage(this.sites.canvas, left, top, right - left, bottom - top);
    ctx.restore();
  }

  private drawMarks(plot: uPlot): void {
    const { mark, spot } = this.picture!;
    const { ctx, bbox } = plot;
    const colours = theme();
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    if (mark !== undefined) {
      const x = plot.valToPos(mark, "x", true);
      ctx.strokeStyle = colours.ink;
      ctx.lineWidth = 1.5 * devicePixelRatio;
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
    }
    if (spot) {
      ctx.strokeStyle = colours.b;
      ctx.lineWidth = 2.5 * devicePixelRatio;
      ctx.beginPath();
      ctx.arc(plot.valToPos(spot[0], "x", true), plot.valToPos(spot[1], "y", true), 7 * devicePixelRatio, 0, 7);
      ctx.stroke();
    }
    ctx.restore();
  }

  /** A press near the line drags it; any other one picks. */
  private listen(plot: uPlot): void {
    const { drag, pick } = this.touch;
    const over = plot.over;
    let dragging = false;
    over.style.touchAction = drag ? "pan-y" : "";
    over.addEventListener("pointerdown", (event) => {
      const mark = this.picture?.mark;
      const off = mark === undefined ? Infinity : Math.abs(plot.valToPos(mark, "x") - event.offsetX);
      dragging = drag !== undefined && (off < 9 || pick === undefined);
      if (dragging) over.setPointerCapture(event.pointerId);
      else pick?.(plot.posToVal(event.offsetX, "x"), plot.posToVal(event.offsetY, "y"), this.perPixel(plot));
      if (dragging) drag!(plot.posToVal(event.offsetX, "x"));
    });
    over.addEventListener("pointermove", (event) => {
      if (dragging) drag!(plot.posToVal(event.offsetX, "x"));
    });
    for (const end of ["pointerup", "pointercancel"]) over.addEventListener(end, () => (dragging = false));
  }

  private perPixel(plot: uPlot): [number, number] {
    const across = Math.abs(plot.posToVal(1, "x") - plot.posToVal(0, "x"));
    return [across, Math.abs(plot.posToVal(1, "y") - plot.posToVal(0, "y"))];
  }
}
