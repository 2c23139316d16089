/** The scene of an encounter: two bodies without a plane, seen from their centre of mass. Lengths in the reach of a body. */

import { BufferGeometry, type Group, Line, LineBasicMaterial, Matrix4, Mesh, MeshBasicMaterial, SphereGeometry, Vector3 } from "three";
import { theme } from "../charts/colours";
import type { Encounter } from "../pair/encounter";
import { isRigid, type Setup } from "../setup";
import { Arrow } from "./arrow";
import { solidOf } from "./body";
import { keyOf } from "./overlay";
import { rigidOf } from "./rigid";
import { ANGLE, FreeView } from "./view";

/** What is to be seen, from the centre of mass: both bodies as they come and go. */
const AROUND = 2.15;
const DISTANCE = AROUND / Math.tan((ANGLE * Math.PI) / 360);
/** Lengths of arrows: of the largest velocity, of a normal, and their diameter. */
const ARROW = { whole: 1.1, normal: 1, thick: 0.045 };
const [MARK, FAINT] = [new SphereGeometry(1, 20, 14), 0.3];

interface Actor {
  body: Group;
  velocity: Arrow;
  spin: Arrow;
}

/** The world is turned so that the first body comes from the left, above the second, in the plane of the picture. */
export class Space extends FreeView {
  private shown: { encounter: Encounter; setup: Setup } | undefined;
  private actors: Actor[] = [];
  private marks: { point: Mesh; normal: Arrow }[] = [];

  constructor(host: HTMLElement) {
    super(host, DISTANCE);
    this.restyle();
  }

  show(encounter: Encounter, setup: Setup): void {
    this.world.traverse((part) => (part as Mesh).geometry !== MARK && !(part.parent instanceof Arrow) && (part as Mesh).geometry?.dispose());
    this.world.clear();
    this.shown = { encounter, setup };
    const colours = theme();
    const { reach } = encounter.values;
    const [one, two] = encounter.flights[0].bodies;
    const along = one.velocity.clone().sub(two.velocity).normalize();
    const aside = one.place.clone().sub(two.place);
    aside.addScaledVector(along, -aside.dot(along)).normalize();
    this.world.quaternion.setFromRotationMatrix(new Matrix4().makeBasis(along, aside.clone().cross(along), aside)).invert();
    this.actors = (["a", "b"] as const).map((of) => {
      const body = isRigid(setup) ? rigidOf(setup, colours[of]) : solidOf(setup, colours[of]);
      body.scale.setScalar(1 / reach);
      return { body, velocity: new Arrow(colours.velocity), spin: new Arrow(colours.spin) };
    });
    this.marks = encounter.hits.map(({ time, point, normal }) => {
      const at = point.clone().sub(encounter.centre(time)).divideScalar(reach);
      const mark = new Mesh(MARK, new MeshBasicMaterial({ color: colours.impulse, depthTest: false, transparent: true }));
      mark.renderOrder = 9;
      mark.position.copy(at);
      mark.scale.setScalar(ARROW.thick * 1.3);
      const arrow = new Arrow(colours.impulse);
      arrow.point(at, normal.clone().multiplyScalar(ARROW.normal), 0.7 * ARROW.thick);
      return { point: mark, normal: arrow };
    });
    for (const { body, velocity, spin } of this.actors) this.world.add(body, velocity, spin);
    for (const { point, normal } of this.marks) this.world.add(point, normal);
    // The way of each centre of mass, straight between contacts.
    const times = [...encounter.flights.map(({ start }) => start), encounter.finish];
    this.actors.forEach((_, k) => {
      const places = times.map((time) => encounter.at(time).bodies[k].place.sub(encounter.centre(time)).divideScalar(reach));
      this.world.add(new Line(new BufferGeometry().setFromPoints(places), new LineBasicMaterial({ color: colours[k ? "b" : "a"], transparent: true, opacity: 0.6 })));
    });
    this.stale = true;
  }

  /** Takes the colours of the theme in force. */
  restyle(): void {
    this.renderer.setClearColor(theme().paper);
    if (this.shown) this.show(this.shown.encounter, this.shown.setup);
  }

  override draw(time: number, moving: boolean): void {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (!this.shown || !width || !(moving || this.stale)) return;
    this.controls.update();
    this.stale = false;
    const { encounter } = this.shown;
    const { bodies, contacts } = encounter.at(time);
    const { reach } = encounter.values;
    const centre = bodies[0].place.clone().add(bodies[1].place).multiplyScalar(0.5);
    const drift = bodies[0].velocity.clone().add(bodies[1].velocity).multiplyScalar(0.5);
    const fastest = Math.max(...encounter.flights.map((flight) => flight.bodies[0].velocity.distanceTo(flight.bodies[1].velocity) / 2));
    this.actors.forEach(({ body, velocity, spin }, k) => {
      const now = bodies[k];
      const place = now.place.clone().sub(centre).divideScalar(reach);
      body.position.copy(place);
      body.quaternion.copy(now.attitude);
      velocity.point(place, now.velocity.clone().sub(drift).multiplyScalar(ARROW.whole / fastest), ARROW.thick);
      // A surface that turns as fast as the fastest moves has an arrow as long.
      spin.point(place, now.spin.clone().multiplyScalar((ARROW.whole * reach) / fastest).clampLength(0, ARROW.whole), ARROW.thick);
    });
    // Those to come are faint.
    this.marks.forEach(({ point, normal }, k) => {
      (point.material as MeshBasicMaterial).opacity = k < contacts ? 1 : FAINT;
      normal.visible = k < contacts;
    });
    const home = this.camera.position.clone();
    this.render(width / height);
    const { context, font } = this.sheet();
    const tip = (place: Vector3) => this.onScreen(this.world.localToWorld(place.clone()), 0, width, height);
    const perMetre = height / (2 * Math.tan((ANGLE * Math.PI) / 360) * this.camera.position.length() * reach);
    keyOf(context, {
      left: 0,
      width,
      height,
      perMetre,
      note: "",
      bodies: bodies.map(({ velocity, spin }) => ({ speed: velocity.clone().sub(drift).length(), spin: spin.length() })),
      contact: [contacts, encounter.hits.length],
      names: [
        ...this.actors.flatMap(({ velocity, spin }) => [
          ...(velocity.visible ? [{ name: "v", hue: "velocity" as const, tip: tip(velocity.tip) }] : []),
          ...(spin.visible ? [{ name: "ω", hue: "spin" as const, tip: tip(spin.tip) }] : []),
        ]),
        ...this.marks.slice(Math.max(contacts - 1, 0), contacts).map(({ normal }) => ({ name: "n", hue: "impulse" as const, tip: tip(normal.tip) })),
      ],
    }, font);
    this.camera.position.copy(home);
  }
}
