/** The scene: bodies over the plane, each with its trace, its arrows and a camera that follows it. Lengths in R of set-up A. */

import {
  AmbientLight,
  BufferGeometry,
  CircleGeometry,
  DirectionalLight,
  Float32BufferAttribute,
  Fog,
  Group,
  Line,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  PlaneGeometry,
  ShadowMaterial,
  Vector3,
  VSMShadowMap,
} from "three";
import { theme } from "../charts/colours";
import type { Setup } from "../setup";
import { nice } from "../statistics";
import { Arrow } from "./arrow";
import { armOf, outlineOf } from "../outline";
import { isRigid } from "../setup";
import { solidOf } from "./body";
import { noteOf, rigidOf } from "./rigid";
import { write, type Arrowhead } from "./overlay";
import { impulseOf, type Moment, type Path } from "./path";
import { ANGLE, View } from "./view";

/** Points of the trace in a flight, and flights that it goes back. */
const TRACE = { each: 40, flights: 6 };
/** Cells of the ground to either side. */
const CELLS = 60;
/** Ghosts of the body at its contacts: so many before the last one, and the next. */
const GHOSTS = 4;
/** The body fills a third of the height of the picture. */
const SHARE = 1 / 3;
/** Distance of the camera in lengths of the body. */
const DISTANCE = 1 / SHARE / 2 / Math.tan((ANGLE * Math.PI) / 360);
/** Distances of the camera at which things begin to fade, and are gone. */
const FADE = { near: 1.5, far: 7 };
/** Lengths of arrows in lengths of the body: of a velocity that holds all energy of motion, and at most. */
const ARROW = { whole: 1.3, most: 1.3 };
/** Where arrows end, in halves of the picture: below the key, above the scale, beside the height. */
const ROOM = { left: -0.92, right: 0.8, bottom: -0.8, top: 0.68 };
/** A vertical speed less than this part of the speed has an arrow of its own, as long as this for the larger one before and after. */
const FLAT = { below: 0.5, long: 0.75 };

export interface Part {
  setup: Setup;
  path: Path;
  of: "a" | "b";
}

interface Actor extends Part {
  /** Everything that moves as the view follows the body. */
  world: Group;
  body: Group;
  velocity: Arrow;
  spin: Arrow;
  impulse: Arrow;
  /** The vertical part of the velocity, and how many times as large it is drawn; 0: not at all. */
  fall: Arrow;
  times: number;
  contact: Mesh;
  ghosts: Group[];
  trace: Line;
  /** A staff with marks as far apart as the lines on the ground, beside the body. */
  staff: LineSegments;
  /** Length of the body, and its radius, in R of A. */
  length: number;
  scale: number;
  /** The flight that the trace was made for. */
  traced: number;
}

export class Stage extends View {
  private readonly fog = new Fog("#ffffff");
  private readonly sun = new DirectionalLight("#ffffff", 2.2);
  /** Ground, shadow and lines lie in one another: what is below hides nothing of what is above it. */
  private readonly ground = new Mesh(new PlaneGeometry(2000, 2000), new MeshBasicMaterial({ depthWrite: false }));
  private readonly shade = new Mesh(new PlaneGeometry(2000, 2000), new ShadowMaterial({ opacity: 0.45, depthWrite: false }));
  private readonly grid = new LineSegments(cells(), new LineBasicMaterial({ transparent: true, opacity: 0.35 }));
  private readonly floor = new Group();
  /** Distance of the lines on the ground, in R of A. */
  private spacing = 1;
  private actors: Actor[] = [];
  private haunted = false;

  constructor(host: HTMLElement) {
    super(host, DISTANCE);
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = VSMShadowMap;
    this.renderer.setScissorTest(true);
    this.controls.maxPolarAngle = Math.PI / 2 - 0.02;
    this.sun.position.set(-4, -3, 12);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(256, 256);
    Object.assign(this.sun.shadow, { radius: 5, blurSamples: 10 });
    Object.assign(this.sun.shadow.camera, { left: -6, right: 6, bottom: -6, top: 6, near: 0.1, far: 60 });
    this.shade.receiveShadow = true;
    this.shade.position.z = 0.002;
    this.floor.add(this.ground, this.shade, this.grid);
    this.scene.add(new AmbientLight("#ffffff", 1.3), this.sun, this.sun.target, this.floor);
    this.scene.fog = this.fog;
    this.restyle();
  }

  /** Puts bodies on the stage, each on its path. */
  show(cast: Part[]): void {
    for (const { world, body, trace, staff } of this.actors) {
      this.scene.remove(world);
      for (const part of [body, trace, staff]) part.traverse((x) => (x as Mesh).geometry?.dispose());
    }
    const unit = cast[0] ? outlineOf(cast[0].setup).size : 1;
    this.spacing = nice(unit) / unit;
    this.actors = cast.map((part) => this.actor(part, unit));
    this.grid.scale.setScalar(this.spacing);
    this.stale = true;
  }

  /** Whether bodies leave ghosts; the camera then stands back, so that some are seen. */
  set ghosts(on: boolean) {
    if (on !== this.haunted) this.camera.position.multiplyScalar(on ? 1.8 : 1 / 1.8);
    this.haunted = on;
  }

  /** Takes the colours of the theme in force. */
  restyle(): void {
    const colours = theme();
    this.renderer.setClearColor(colours.paper);
    this.fog.color.set(colours.paper);
    (this.ground.material as MeshBasicMaterial).color.set(colours.ground);
    this.grid.material.color.set(colours.soft);
    this.show(this.actors);
  }

  /** Draws the bodies at a time, if something moves or has changed. */
  override draw(time: number, moving: boolean): Moment | undefined {
    const lead = this.actors[0]?.path.at(time);
    if (!lead || !(moving || this.stale)) return lead;
    this.controls.update();
    this.stale = false;
    const { clientWidth: width, clientHeight: height } = this.host;
    const { context, font } = this.sheet();
    const each = width / this.actors.length;
    // In lengths of the body: the viewer's own choice.
    const home = this.camera.position.clone();
    this.actors.forEach((actor, k) => {
      const moment = actor.path.at(time);
      for (const other of this.actors) other.world.visible = other === actor;
      this.camera.position.copy(home).multiplyScalar(actor.length);
      [this.fog.near, this.fog.far] = [FADE.near, FADE.far].map((x) => x * DISTANCE * actor.length);
      this.camera.aspect = each / height;
      this.camera.updateProjectionMatrix();
      this.camera.updateMatrixWorld();
      this.pose(actor, moment, each / height);
      this.renderer.setViewport(k * each, 0, each, height);
      this.renderer.setScissor(k * each, 0, each, height);
      this.renderer.render(this.scene, this.camera);
      const arrows = this.arrows(actor, moment).map((arrow) => ({ ...arrow, tip: arrow.tip && this.onScreen(arrow.tip, k * each, each, height) }));
      const perMetre = height / (2 * Math.tan((ANGLE * Math.PI) / 360) * this.camera.position.length() * outlineOf(this.actors[0].setup).size);
      const most = Math.max(...actor.path.peaks(moment.impacts));
      write(context, { left: k * each, width: each, height, of: actor.of, arrows, perMetre, now: moment.place.z, most, named: this.actors.length > 1, note: noteOf(actor.setup) }, font);
    });
    this.camera.position.copy(home);
    return lead;
  }

  private actor({ setup, path, of }: Part, unit: number): Actor {
    const colours = theme();
    const outline = outlineOf(setup);
    const scale = outline.size / unit;
    const ink = new LineBasicMaterial({ color: colours[of], transparent: true, opacity: 0.8 });
    const actor: Actor = {
      setup,
      path,
      of,
      world: new Group(),
      body: isRigid(setup) ? rigidOf(setup, colours[of]) : solidOf(setup, colours[of]),
      velocity: new Arrow(colours.velocity),
      spin: new Arrow(colours.spin),
      impulse: new Arrow(colours.impulse),
      fall: new Arrow(colours.velocity, 0.55),
      times: 0,
      ghosts: [],
      contact: new Mesh(new CircleGeometry(0.12, 24), new MeshBasicMaterial({ color: colours.impulse })),
      trace: new Line(new BufferGeometry(), ink),
      staff: new LineSegments(new BufferGeometry(), new LineBasicMaterial({ color: colours.soft, transparent: true, opacity: 0.7 })),
      length: Math.max(2 * scale, outline.length / unit),
      scale,
      traced: -1,
    };
    actor.body.scale.setScalar(1 / unit);
    actor.body.traverse((part) => (part.castShadow = true));
    actor.trace.frustumCulled = false;
    actor.world.add(actor.body, actor.velocity, actor.spin, actor.impulse, actor.fall, actor.contact, actor.trace, actor.staff);
    if (this.haunted) actor.ghosts = Array.from({ length: GHOSTS + 1 }, () => ghostOf(actor.body));
    if (actor.ghosts.length) actor.world.add(...actor.ghosts);
    const top = (1.2 * Math.max(...path.peaks(path.flights.length - 1), ...path.peaks(0))) / unit;
    const marks: Vector3[] = [new Vector3(), new Vector3(0, 0, top)];
    for (let k = 0; k * this.spacing < top && k < 2000; k++) {
      const wide = (k % 5 ? 0.08 : 0.2) * actor.length;
      marks.push(new Vector3(-wide, 0, k * this.spacing), new Vector3(wide, 0, k * this.spacing));
    }
    actor.staff.geometry.setFromPoints(marks);
    this.scene.add(actor.world);
    return actor;
  }

  private pose(actor: Actor, moment: Moment, aspect: number): void {
    const { world, body, length } = actor;
    const unit = outlineOf(this.actors[0].setup).size;
    const place = moment.place.clone().divideScalar(unit);
    // Near the plane the camera waits, so that one sees the body come down and leave.
    const look = Math.max(place.z, 0.9 * length);
    world.position.set(-place.x, -place.y, -look);
    this.floor.position.set(0, 0, -look);
    this.grid.position.set(-place.x % this.spacing, -place.y % this.spacing, 0.004);
    actor.staff.position.set(place.x + Math.min(1.1, 1.1 * aspect) * length, place.y + 1.2 * length, 0);
    this.sun.shadow.camera.top = this.sun.shadow.camera.right = 3 * length;
    this.sun.shadow.camera.bottom = this.sun.shadow.camera.left = -3 * length;
    this.sun.position.set(-1, -0.8, 3).multiplyScalar(2 * length);
    this.sun.shadow.camera.far = 20 * length;
    this.sun.shadow.camera.updateProjectionMatrix();
    body.position.copy(place);
    body.quaternion.copy(moment.attitude);
    actor.ghosts.forEach((ghost, k) => {
      const number = moment.impacts + k + 1 - GHOSTS;
      const flight = number > 0 ? actor.path.flights[number] : undefined;
      ghost.visible = flight !== undefined;
      if (!flight) return;
      ghost.position.copy(flight.place).divideScalar(unit);
      ghost.quaternion.copy(flight.attitude);
    });
    world.updateMatrixWorld();
    this.point(actor, moment, place, unit);
    if (actor.traced !== moment.impacts) this.trace(actor, moment.impacts, unit);
  }

  private point(actor: Actor, moment: Moment, place: Vector3, unit: number): void {
    const { length, setup } = actor;
    const thick = 0.035 * length;
    const whole = actor.path.speed(moment.impacts);
    const arrow = (vector: Vector3, unit: number, from = place) =>
      this.inside(actor, from, vector.multiplyScalar((ARROW.whole * length) / unit).clampLength(0, ARROW.most * length));
    actor.velocity.point(place, arrow(moment.velocity.clone(), whole), thick);
    const most = Math.max(...[moment.impacts - 1, moment.impacts].map((k) => actor.path.steepest(k)));
    const times = (FLAT.long * whole) / (ARROW.whole * most);
    actor.times = moment.impacts > 0 && most < FLAT.below * whole ? times : 0;
    actor.fall.point(place, arrow(new Vector3(0, 0, actor.times * moment.velocity.z), whole), thick);
    // A surface that turns with a third of that speed has an arrow as long.
    actor.spin.point(place, arrow(moment.spin.clone(), whole / (3 * outlineOf(setup).size)), thick);
    const { flight, impacts } = moment;
    const hit = impacts > 0;
    actor.contact.visible = actor.impulse.visible = hit;
    if (!hit) return;
    const at = flight.place.clone().add(armOf(setup, flight)).divideScalar(unit);
    actor.contact.position.set(at.x, at.y, 0.01);
    actor.contact.scale.setScalar(length / 2);
    actor.impulse.point(at, arrow(impulseOf(actor.path, impacts), 2 * whole, at), thick);
  }

  /** An arrow from a place, shortened until it ends in the picture. */
  private inside(actor: Actor, from: Vector3, vector: Vector3): Vector3 {
    const out = () => {
      const { x, y } = actor.world.localToWorld(from.clone().add(vector)).project(this.camera);
      return x < ROOM.left || x > ROOM.right || y < ROOM.bottom || y > ROOM.top;
    };
    for (let k = 0; k < 20 && out(); k++) vector.multiplyScalar(0.9);
    return vector;
  }

  private arrows(actor: Actor, moment: Moment): (Omit<Arrowhead, "tip"> & { tip: Vector3 | undefined })[] {
    const tip = (arrow: Arrow) => (arrow.visible ? actor.world.localToWorld(arrow.tip.clone()) : undefined);
    const impulse = moment.impacts > 0 ? impulseOf(actor.path, moment.impacts).length() : 0;
    const fall = { name: "v↓", hue: "velocity", value: -moment.velocity.z, unit: "m/s", words: `its part downwards, drawn ×${Number(actor.times.toPrecision(2))}`, tip: tip(actor.fall) } as const;
    return [
      { name: "v", hue: "velocity", value: moment.velocity.length(), unit: "m/s", words: "velocity of the centre of mass", tip: tip(actor.velocity) },
      ...(actor.times ? [fall] : []),
      { name: "ω", hue: "spin", value: moment.spin.length(), unit: "rad/s", words: "angular velocity", tip: tip(actor.spin) },
      { name: "P/m", hue: "impulse", value: impulse, unit: "m/s", words: "impulse of the last impact, over the mass", tip: tip(actor.impulse) },
    ];
  }

  private trace(actor: Actor, impacts: number, unit: number): void {
    const { path } = actor;
    const points: Vector3[] = [];
    for (let k = Math.max(0, impacts - TRACE.flights); k <= impacts; k++) {
      const { start } = path.flights[k];
      // A hair before the end: at the impact itself the next flight has begun.
      for (let i = 0; i <= TRACE.each; i++) {
        points.push(path.at(start + path.duration(k) * (i / TRACE.each) * (1 - 1e-9)).place.divideScalar(unit));
      }
    }
    actor.trace.geometry.dispose();
    actor.trace.geometry = new BufferGeometry().setFromPoints(points);
    actor.traced = impacts;
  }
}

/** The lines on the ground, one apart. Each cell has its own: one that begins behind the camera is lost where there is no graphics card. */
function cells(): BufferGeometry {
  const places: number[] = [];
  for (let k = -CELLS; k <= CELLS; k++) {
    for (let i = -CELLS; i < CELLS; i++) places.push(k, i, 0, k, i + 1, 0, i, k, 0, i + 1, k, 0);
  }
  return new BufferGeometry().setAttribute("position", new Float32BufferAttribute(places, 3));
}

/** A body that one sees through, of the same shape. */
function ghostOf(body: Group): Group {
  const ghost = body.clone();
  ghost.traverse((part) => {
    part.castShadow = false;
    const { material } = part as Mesh;
    if (material) (part as Mesh).material = Object.assign((material as MeshBasicMaterial).clone(), { transparent: true, opacity: 0.22, depthWrite: false });
  });
  return ghost;
}
