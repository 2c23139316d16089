/** The scene: bodies over the plane, their traces, contacts and impulses, in slow motion. Lengths in R of set-up A. */

import {
  AmbientLight,
  ArrowHelper,
  BufferGeometry,
  CircleGeometry,
  DirectionalLight,
  Group,
  Line,
  LineBasicMaterial,
  Mesh,
  MeshBasicMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  Vector3,
  WebGLRenderer,
  GridHelper,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { theme } from "../charts/colours";
import type { Setup } from "../setup";
import { bodyOf, contactArm } from "./body";
import type { Moment, Path } from "./path";

/** Points of the trace in a flight, and flights that it goes back. */
const TRACE = { each: 40, flights: 6 };

/** Distance of the lines on the ground. */
const GRID = 4;

interface Actor {
  setup: Setup;
  path: Path;
  group: Group;
  axis: ArrowHelper;
  impulse: ArrowHelper;
  contact: Mesh;
  trace: Line;
  /** What stays on the ground, and so moves as the view follows the body. */
  behind: Group;
  /** Where it plays, across the view. */
  aside: number;
  /** The place along the plane that the view of this body follows, in R; each has its own, for they part. */
  anchor: Vector3;
  /** The flight that the trace was made for. */
  traced: number;
}

export class Stage {
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(35, 1, 0.1, 2000);
  private readonly renderer: WebGLRenderer;
  private readonly controls: OrbitControls;
  private readonly ground = new Mesh(new PlaneGeometry(400, 400), new MeshBasicMaterial());
  private grid = new GridHelper();
  private actors: Actor[] = [];
  private look = new Vector3(0, 0, 8);
  private reach = 20;
  private settled = false;
  private stale = true;

  constructor(private readonly host: HTMLElement) {
    this.renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    host.append(this.renderer.domElement);
    this.renderer.domElement.setAttribute("aria-hidden", "true");
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(4, -36, 14);
    const sun = new DirectionalLight("#ffffff", 2.2);
    sun.position.set(-30, -50, 80);
    this.scene.add(new AmbientLight("#ffffff", 1.3), sun, this.ground);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.enablePan = false;
    this.controls.maxPolarAngle = Math.PI / 2 - 0.02;
    this.controls.listenToKeyEvents(host);
    this.controls.addEventListener("change", () => (this.stale = true));
    this.restyle();
    new ResizeObserver(() => this.resize()).observe(host);
  }

  get canvas(): HTMLCanvasElement {
    return this.renderer.domElement;
  }

  /** Puts bodies on the stage, each on its path. */
  show(cast: { setup: Setup; path: Path; of: "a" | "b" }[]): void {
    for (const actor of this.actors) {
      this.scene.remove(actor.group, actor.axis, actor.behind);
    }
    const colours = theme();
    const widest = Math.max(...cast.map(({ setup }) => 1 + setup.elongation / 2));
    this.actors = cast.map(({ setup, path, of }, k) => {
      const colour = colours[of];
      const group = bodyOf(setup, colour);
      const ink = new LineBasicMaterial({ color: colour, transparent: true, opacity: 0.75 });
      const trace = new Line(new BufferGeometry(), ink);
      trace.frustumCulled = false;
      const contact = new Mesh(new CircleGeometry(0.28, 24), new MeshBasicMaterial({ color: colours.ink }));
      const arrow = (hue: string) => new ArrowHelper(new Vector3(0, 0, 1), new Vector3(), 1, hue, 0.45, 0.28);
      const actor: Actor = {
        setup,
        path,
        group,
        axis: arrow(colours.soft),
        impulse: arrow(colours.ink),
        contact,
        trace,
        behind: new Group(),
        anchor: new Vector3(),
        aside: cast.length > 1 ? (k - 0.5) * 3.6 * widest : 0,
        traced: -1,
      };
      actor.behind.add(actor.impulse, contact, trace);
      this.scene.add(group, actor.axis, actor.behind);
      return actor;
    });
    this.settled = false;
    this.stale = true;
  }

  restyle(): void {
    const colours = theme();
    this.renderer.setClearColor(colours.paper);
    (this.ground.material as MeshBasicMaterial).color.set(colours.line);
    this.scene.remove(this.grid);
    this.grid.dispose();
    this.grid = new GridHelper(400, 400 / GRID, colours.soft, colours.soft);
    this.grid.rotateX(Math.PI / 2);
    this.grid.material.transparent = true;
    this.grid.material.opacity = 0.35;
    this.scene.add(this.grid);
    this.stale = true;
  }

  /** Draws the bodies at a time, given how long the picture before lasted, in s of the viewer; nothing if nothing moves. */
  draw(time: number, lasted: number, moving: boolean): Moment | undefined {
    const lead = this.actors[0]?.path.at(time);
    if (!lead || !(moving || this.stale)) return lead;
    this.stale = false;
    const unit = this.actors[0].setup.radius;
    const pace = this.settled ? 1 - Math.exp(-3 * lasted) : 1;
    this.settled = true;
    let peak = this.actors.length > 1 ? 6 * (1 + this.actors[0].setup.elongation / 2) : 3;
    for (const actor of this.actors) {
      const moment = actor.path.at(time);
      this.pose(actor, moment, unit, pace);
      peak = Math.max(peak, actor.path.peak(moment.impacts) / unit + 2 * (1 + actor.setup.elongation / 2));
    }
    this.follow(peak, pace);
    this.renderer.render(this.scene, this.camera);
    return lead;
  }

  private pose(actor: Actor, moment: Moment, unit: number, pace: number): void {
    const { setup, path, group, anchor } = actor;
    const scale = setup.radius / unit;
    const at = (place: Vector3) => place.clone().divideScalar(unit);
    const place = at(moment.place);
    const ahead = new Vector3(place.x, place.y, 0).sub(anchor);
    if (ahead.length() > 0.01) this.stale = true;
    anchor.addScaledVector(ahead, pace);
    actor.behind.position.set(actor.aside - anchor.x, -anchor.y, 0);
    group.scale.setScalar(scale);
    group.position.copy(place).add(actor.behind.position);
    group.quaternion.copy(moment.attitude);
    const axis = new Vector3(0, 0, 1).applyQuaternion(moment.attitude);
    const long = scale * (1 + setup.elongation / 2);
    actor.axis.position.copy(group.position).addScaledVector(axis, -1.5 * long);
    actor.axis.setDirection(axis);
    actor.axis.setLength(3 * long, 0.45 * scale, 0.28 * scale);
    this.mark(actor, moment, at, unit, scale);
    if (actor.traced !== moment.impacts) this.trace(actor, moment.impacts, at, path);
  }

  /** The last contact and its impulse: its length is the change of the velocity over that of the fall. */
  private mark(actor: Actor, moment: Moment, at: (v: Vector3) => Vector3, unit: number, scale: number): void {
    const { flight, impacts } = moment;
    const hit = impacts > 0;
    actor.contact.visible = actor.impulse.visible = hit;
    if (!hit) return;
    const before = actor.path.flights[impacts - 1];
    const arm = contactArm(actor.setup, flight.axis, flight.sphere);
    const place = at(flight.place.clone().add(arm));
    actor.contact.position.set(place.x, place.y, 0.03);
    actor.contact.scale.setScalar(scale);
    const arrival = before.velocity.clone().addScaledVector(actor.path.gravity, flight.start - before.start);
    const change = flight.velocity.clone().sub(arrival);
    const fall = Math.sqrt(2 * -actor.path.gravity.z * Math.max(actor.path.flights[0].place.z, unit));
    const size = change.length();
    actor.impulse.visible = size > 0;
    actor.impulse.position.set(place.x, place.y, 0.05);
    actor.impulse.setDirection(change.clone().normalize());
    actor.impulse.setLength(Math.max(1.2 * scale, (6 * scale * size) / fall), 0.5 * scale, 0.3 * scale);
  }

  private trace(actor: Actor, impacts: number, at: (v: Vector3) => Vector3, path: Path): void {
    const points: Vector3[] = [];
    const first = Math.max(0, impacts - TRACE.flights);
    for (let k = first; k <= impacts; k++) {
      const { start } = path.flights[k];
      const steps = TRACE.each;
      // A hair before the end: at the impact itself the next flight has begun.
      for (let i = 0; i <= steps; i++) points.push(at(path.at(start + path.duration(k) * (i / steps) * (1 - 1e-9)).place));
    }
    actor.trace.geometry.dispose();
    actor.trace.geometry = new BufferGeometry().setFromPoints(points);
    actor.traced = impacts;
  }

  /** The camera is as near as the height of the flight allows; the grid passes below. */
  private follow(peak: number, pace: number): void {
    const old = this.look.clone();
    this.look.lerp(new Vector3(0, 0, peak / 2), pace);
    const reach = this.reach + (peak - this.reach) * pace;
    const offset = this.camera.position.clone().sub(old);
    // The viewer's own choices stay: the direction, and the distance in units of what is to be seen.
    this.camera.position.copy(this.look).add(offset.multiplyScalar(reach / this.reach));
    if (Math.abs(reach - peak) > 1e-3 * peak) this.stale = true;
    this.reach = reach;
    this.controls.target.copy(this.look);
    const { x, y } = this.actors[0].anchor;
    this.grid.position.set(-x % GRID, -y % GRID, 0.01);
    const stale = this.stale;
    this.controls.update();
    this.stale = stale;
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (!width || !height) return;
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    // Two bodies side by side need the width that a narrow window lacks.
    this.camera.fov = 35 / Math.min(1, this.camera.aspect / 0.9);
    this.camera.updateProjectionMatrix();
    this.stale = true;
  }
}

