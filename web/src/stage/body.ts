/** The body as a solid, its symmetry axis along z, half of it in another colour so that one sees it turn. Lengths in R. */

import {
  CapsuleGeometry,
  Color,
  CylinderGeometry,
  Group,
  Mesh,
  MeshPhongMaterial,
  SphereGeometry,
  Vector3,
  type BufferGeometry,
} from "three";
import type { Setup } from "../setup";

const SHINE = { shininess: 40, specular: "#333333" };

/** Longitudes of a sphere in two colours: four quarters, seen to roll. `reach` is the angle from its pole that it goes to: what lies
 * inside another sphere would shine through where they nearly coincide. */
function patch(material: MeshPhongMaterial, second: MeshPhongMaterial, half: number, side: 1 | -1 = 1, reach = Math.PI): Group {
  const group = new Group();
  for (let k = 0; k < 4; k++) {
    const geometry = new SphereGeometry(1, 16, 32, (k * Math.PI) / 2, Math.PI / 2, 0, reach).rotateX((side * Math.PI) / 2);
    group.add(new Mesh(geometry, k % 2 === half ? material : second));
  }
  return group;
}

export function bodyOf(s: Setup, colour: string): Group {
  const base = new MeshPhongMaterial({ color: colour, ...SHINE });
  const light = new MeshPhongMaterial({ color: new Color(colour).lerp(new Color("#ffffff"), 0.45), ...SHINE });
  const dark = new MeshPhongMaterial({ color: new Color(colour).lerp(new Color("#000000"), 0.35), ...SHINE });
  const group = new Group();
  const half = s.elongation / 2;
  if (s.shape === "dumbbell") {
    for (const side of [1, -1] as const) {
      const ball = patch(base, side > 0 ? light : dark, side > 0 ? 0 : 1, side, Math.acos(-Math.min(half, 1)));
      ball.position.z = side * half;
      group.add(ball);
    }
    if (half > 1) group.add(new Mesh(upright(new CylinderGeometry(0.08, 0.08, 2 * half)), dark));
  } else if (s.shape === "spheroid") {
    const ball = patch(base, light, 0);
    ball.scale.z = 1 + half;
    group.add(ball);
  } else {
    group.add(new Mesh(upright(new CapsuleGeometry(1, 2 * half, 16, 32)), base));
    const band = new Mesh(upright(new CylinderGeometry(1.003, 1.003, Math.max(2 * half, 0.02), 32, 1, true, 0, Math.PI / 2)), light);
    group.add(band);
  }
  return group;
}

/** Three's solids of revolution stand along y. */
const upright = (geometry: BufferGeometry) => geometry.rotateX(Math.PI / 2);

/** From the centre of mass to the point that touches, in m, where the axis points along `axis`: (6). */
export function contactArm(s: Setup, axis: Vector3, sphere: number): Vector3 {
  if (s.shape === "spheroid") {
    const [a, c] = [1, 1 + s.elongation / 2];
    // The lowest point of an ellipsoid with the matrix Q = a²I + (c² − a²)ee: −Qn/√(n·Qn).
    const q = axis.clone().multiplyScalar((c * c - a * a) * axis.z).add(new Vector3(0, 0, a * a));
    return q.multiplyScalar(-s.radius / Math.sqrt(q.z));
  }
  const side = sphere === 1 ? 1 : -1;
  return axis.clone().multiplyScalar((side * s.elongation) / 2).add(new Vector3(0, 0, -1)).multiplyScalar(s.radius);
}
