/** The scene of a gas: its particles in a box. Velocities, spins and attitudes are those of the gas, places are drawn only. Half of the box is 1. */

import {
  BoxGeometry, BufferAttribute, BufferGeometry, Color, EdgesGeometry, InstancedMesh, LineBasicMaterial, LineSegments,
  Matrix4, type Mesh, Quaternion, Vector3,
} from "three";
import { theme } from "../charts/colours";
import { STATE, type Step } from "../gas/step";
import { isRigid, type Setup, sideOf } from "../setup";
import { solidOf } from "./body";
import { rigidOf } from "./rigid";
import { ANGLE, FreeView } from "./view";

const DISTANCE = 1.58 / Math.tan((ANGLE * Math.PI) / 360);
/** The line of a particle that has the thermal speed of the beginning, in halves of the box; a surface that turns with three times that has one as long. */
const NEEDLE = 0.16;
/** Bodies are drawn in few triangles, and without asperities. */
const [COARSE, MOST_BALLS] = [4, 50];

export class BoxScene extends FreeView {
  private grains: Step | undefined;
  private setup: Setup | undefined;
  /** Where each particle is at the beginning of a step. */
  private places: Vector3[] = [];
  /** Parts of a body, and where each is in it. */
  private parts: { mesh: InstancedMesh; within: Matrix4[] }[] = [];
  private velocities = needles(0, "");
  private spins = needles(0, "");
  private drawn = 0;

  constructor(host: HTMLElement) {
    super(host, DISTANCE);
  }

  /** A gas at its beginning. */
  show(grains: Step, setup: Setup): void {
    // Spread evenly (M. Roberts, R3), for the gas has no places.
    const root = 1.2207440846057596;
    this.places = Array.from({ length: grains.count }, (_, k) => new Vector3(...[1, 2, 3].map((i) => ((0.5 + (k + 1) / root ** i) % 1) * 2 - 1)));
    [this.setup, this.grains] = [setup, grains];
    this.restyle();
  }

  /** The next step begins: everybody is where the last one led. */
  take(grains: Step): void {
    const last = this.grains!;
    this.places.forEach((place, k) => place.copy(this.placeOf(last, k, this.drawn)));
    [this.grains, this.drawn] = [grains, 0];
    this.stale = true;
  }

  /** Takes the colours of the theme in force. */
  restyle(): void {
    const colours = theme();
    this.renderer.setClearColor(colours.paper);
    if (!this.setup || !this.grains) return;
    const [setup, { count }] = [this.setup, this.grains];
    this.world.traverse((part) => (part as Mesh).geometry?.dispose());
    this.world.clear();
    const body = isRigid(setup) ? rigidOf(setup, colours.a, COARSE) : solidOf(setup, colours.a, COARSE);
    this.parts = body.children.filter((part): part is Mesh => "isMesh" in part && !((part as InstancedMesh).count > MOST_BALLS)).map((part) => {
      const balls = part as InstancedMesh;
      const within = Array.from({ length: balls.isInstancedMesh ? balls.count : 1 }, (_, k) => {
        const matrix = new Matrix4();
        if (balls.isInstancedMesh) balls.getMatrixAt(k, matrix);
        return matrix;
      });
      const mesh = new InstancedMesh(part.geometry, part.material, count * within.length);
      if (balls.instanceColor) for (let k = 0; k < mesh.count; k++) mesh.setColorAt(k, balls.getColorAt(k % within.length, theColour));
      mesh.frustumCulled = false;
      return { mesh, within };
    });
    const frame = new LineSegments(new EdgesGeometry(new BoxGeometry(2, 2, 2)), new LineBasicMaterial({ color: colours.soft }));
    [this.velocities, this.spins] = [needles(count, colours.velocity), needles(count, colours.spin)];
    this.world.add(frame, this.velocities, this.spins, ...this.parts.map(({ mesh }) => mesh));
    this.stale = true;
  }

  override draw(time: number, moving: boolean): void {
    const { clientWidth: width, clientHeight: height } = this.host;
    const { grains, setup } = this;
    if (!grains || !setup || !width || !(moving || this.stale)) return;
    this.controls.update();
    this.stale = false;
    this.drawn = time;
    const scale = 2 / (sideOf(setup) * grains.reach);
    const [placed, size, whole] = [new Matrix4(), new Vector3(scale, scale, scale), new Matrix4()];
    const [lines, turns] = [this.velocities, this.spins].map(({ geometry }) => geometry.getAttribute("position") as BufferAttribute);
    for (let k = 0; k < grains.count; k++) {
      const [velocity, spin, attitude] = stateOf(grains, k);
      const now = grains.turn(attitude, spin, time);
      const place = this.placeOf(grains, k, time);
      placed.compose(place, now.attitude, size);
      for (const { mesh, within } of this.parts) within.forEach((part, i) => mesh.setMatrixAt(k * within.length + i, whole.multiplyMatrices(placed, part)));
      const needle = NEEDLE / setup.thermal_speed;
      [velocity.multiplyScalar(needle), now.spin.multiplyScalar((needle * grains.reach) / 3)].forEach((along, i) => {
        const line = i ? turns : lines;
        line.setXYZ(2 * k, place.x, place.y, place.z);
        line.setXYZ(2 * k + 1, place.x + along.x, place.y + along.y, place.z + along.z);
      });
    }
    for (const { mesh } of this.parts) mesh.instanceMatrix.needsUpdate = true;
    for (const line of [lines, turns]) line.needsUpdate = true;
    const home = this.camera.position.clone();
    this.render(width / height);
    this.camera.position.copy(home);
  }

  /** Straight on from where it was, in by the side opposite to the one by which it left. */
  private placeOf(grains: Step, k: number, time: number): Vector3 {
    const [velocity] = stateOf(grains, k);
    const moved = this.places[k].clone().addScaledVector(velocity, (2 * time) / (sideOf(this.setup!) * grains.reach));
    return moved.set(...(moved.toArray().map((x) => x - 2 * Math.floor((x + 1) / 2)) as [number, number, number]));
  }
}

const theColour = new Color();

function stateOf({ states }: Step, k: number): [Vector3, Vector3, Quaternion] {
  const at = STATE * k;
  return [new Vector3().fromArray(states, at), new Vector3().fromArray(states, at + 3), new Quaternion(states[at + 7], states[at + 8], states[at + 9], states[at + 6])];
}

function needles(count: number, colour: string): LineSegments<BufferGeometry, LineBasicMaterial> {
  const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(6 * count), 3));
  const lines = new LineSegments(geometry, new LineBasicMaterial({ color: colour || "#000000" }));
  lines.frustumCulled = false;
  return lines;
}
