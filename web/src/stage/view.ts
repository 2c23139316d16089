/** A scene in three dimensions in its place on the page, with writing over it, and a camera that people turn. */

import { AmbientLight, DirectionalLight, Group, PerspectiveCamera, Scene, type Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

/** Of the view upwards, in degrees. */
export const ANGLE = 35;

/** A scene in its place, or a word there where the browser has none. */
export function viewIn<V extends View>(host: HTMLElement, Kind: new (host: HTMLElement) => V): V | undefined {
  try {
    return new Kind(host);
  } catch {
    host.textContent = "This browser shows no three-dimensional graphics (WebGL 2). All else works.";
    return undefined;
  }
}

/** Draws again and again; hears of the time since it did so last, in s, at most a tenth. */
export function eachFrame(draw: (lasted: number) => void): void {
  let last = performance.now();
  const frame = (now: number) => {
    draw(Math.min((now - last) / 1000, 0.1));
    last = now;
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
}

export abstract class View {
  protected readonly scene = new Scene();
  protected readonly camera = new PerspectiveCamera(ANGLE, 1, 0.1, 2000);
  protected readonly renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  protected readonly overlay = document.createElement("canvas");
  protected readonly controls: OrbitControls;
  /** Something has changed since it was drawn. */
  protected stale = true;

  /** `distance` is that of the camera. */
  constructor(protected readonly host: HTMLElement, distance: number) {
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    // Asking whether a shader is right waits for it.
    this.renderer.debug.checkShaderErrors = false;
    this.overlay.className = "overlay";
    for (const canvas of [this.renderer.domElement, this.overlay]) {
      canvas.setAttribute("aria-hidden", "true");
      host.append(canvas);
    }
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(0.12, -1, 0.24).setLength(distance);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.enablePan = false;
    this.controls.minDistance = distance / 4;
    this.controls.maxDistance = distance * 8;
    this.controls.listenToKeyEvents(host);
    this.controls.addEventListener("change", () => (this.stale = true));
    // The wheel and a finger that goes up or down scroll the page; who has chosen the scene comes nearer by the wheel.
    this.controls.enableZoom = false;
    this.renderer.domElement.style.touchAction = "pan-y";
    host.addEventListener("focus", () => (this.controls.enableZoom = true));
    host.addEventListener("blur", () => (this.controls.enableZoom = false));
    new ResizeObserver(() => this.resize()).observe(host);
  }

  /** Draws what there is at a time, if something moves or has changed. */
  abstract draw(time: number, moving: boolean): unknown;

  /** Scene and writing in one canvas, for a file. */
  compose(canvas: HTMLCanvasElement): void {
    const { width, height } = this.renderer.domElement;
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    const context = canvas.getContext("2d")!;
    context.drawImage(this.renderer.domElement, 0, 0);
    context.drawImage(this.overlay, 0, 0, width, height);
  }

  /** Draws for paper, which takes a WebGL canvas as it was before: behind the writing, in the canvas of that. */
  flatten(time: number): void {
    this.draw(time, true);
    const context = this.overlay.getContext("2d")!;
    context.save();
    context.resetTransform();
    context.globalCompositeOperation = "destination-over";
    context.drawImage(this.renderer.domElement, 0, 0);
    context.restore();
    this.stale = true;
  }

  /** The same in three pixels for each of the page. */
  large(canvas: HTMLCanvasElement, time: number): void {
    const ratio = this.renderer.getPixelRatio();
    for (const each of [3, ratio]) {
      this.renderer.setPixelRatio(each);
      this.resize();
      this.draw(time, true);
      if (each === 3) this.compose(canvas);
    }
  }

  /** The empty page for the writing, with the size of its letters. */
  protected sheet(): { context: CanvasRenderingContext2D; font: number } {
    const { clientWidth: width, clientHeight: height } = this.host;
    const context = this.overlay.getContext("2d")!;
    const scale = this.overlay.width / Math.max(width, 1);
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.clearRect(0, 0, width, height);
    return { context, font: 0.8 * parseFloat(getComputedStyle(this.host).fontSize) };
  }

  /** Where a place of the scene is in the picture. */
  protected onScreen(place: Vector3, left: number, width: number, height: number): [number, number] {
    const { x, y } = place.clone().project(this.camera);
    return [left + (width * (x + 1)) / 2, (height * (1 - y)) / 2];
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (!width || !height) return;
    this.renderer.setSize(width, height);
    const scale = this.renderer.getPixelRatio();
    [this.overlay.width, this.overlay.height] = [Math.round(width * scale), Math.round(height * scale)];
    this.stale = true;
  }
}

/** A scene without a ground, lit from the left and above. */
export abstract class FreeView extends View {
  protected readonly world = new Group();

  constructor(host: HTMLElement, distance: number) {
    super(host, distance);
    const sun = new DirectionalLight("#ffffff", 2.2);
    sun.position.set(-4, -6, 10);
    this.scene.add(new AmbientLight("#ffffff", 1.3), sun, this.world);
  }

  /** Draws the scene in a picture of this width over height; of a narrow one the camera goes back, where it stays. */
  protected render(aspect: number): void {
    this.camera.position.multiplyScalar(Math.max(1, 1 / aspect));
    this.camera.aspect = aspect;
    this.camera.updateProjectionMatrix();
    this.renderer.render(this.scene, this.camera);
  }
}
