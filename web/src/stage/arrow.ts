/** An arrow that can be seen from afar and through the body. */

import { ConeGeometry, CylinderGeometry, Group, Mesh, MeshBasicMaterial, Vector3 } from "three";

const UP = new Vector3(0, 0, 1);
const SHAFT = new CylinderGeometry(1, 1, 1, 12).rotateX(Math.PI / 2).translate(0, 0, 0.5);
const HEAD = new ConeGeometry(1, 1, 20).rotateX(Math.PI / 2).translate(0, 0, -0.5);

/** One of each colour: a material that is made anew is compiled anew. */
const MATERIALS = new Map<string, MeshBasicMaterial>();

function materialOf(colour: string, opacity: number): MeshBasicMaterial {
  const key = `${colour} ${opacity}`;
  const found = MATERIALS.get(key) ?? new MeshBasicMaterial({ color: colour, depthTest: false, transparent: true, opacity, fog: false });
  MATERIALS.set(key, found);
  return found;
}

export class Arrow extends Group {
  private readonly shaft: Mesh;
  private readonly head: Mesh;
  readonly tip = new Vector3();

  constructor(colour: string, opacity = 1) {
    super();
    this.shaft = new Mesh(SHAFT, materialOf(colour, opacity));
    this.head = new Mesh(HEAD, materialOf(colour, opacity));
    this.shaft.renderOrder = this.head.renderOrder = 10;
    this.add(this.shaft, this.head);
  }

  /** Points from a place along a vector; `thick` is the diameter of the shaft. Too short to be seen, it is hidden. */
  point(from: Vector3, vector: Vector3, thick: number): void {
    const length = vector.length();
    this.visible = length > 1.5 * thick;
    this.tip.copy(from).add(vector);
    if (!this.visible) return;
    this.position.copy(from);
    this.quaternion.setFromUnitVectors(UP, vector.clone().divideScalar(length));
    const head = Math.min(4 * thick, 0.6 * length);
    this.shaft.scale.set(thick / 2, thick / 2, length - 0.9 * head);
    this.head.position.z = length;
    this.head.scale.set(0.4 * head, 0.4 * head, head);
  }
}
