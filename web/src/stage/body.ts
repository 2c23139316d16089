/** The body as a solid of revolution, its symmetry axis along z, in two colours so that one sees it turn. Lengths in m. */

import { Color, DoubleSide, Group, LatheGeometry, Mesh, MeshPhongMaterial, Vector2 } from "three";
import { outlineOf, pointsOf } from "../outline";
import type { Setup } from "../setup";

const SHINE = { shininess: 40, specular: "#333333", side: DoubleSide };
/** A straight line of the outline that lies on the axis is a rod as thick as this, in sizes of the body. */
const ROD = 0.08;

/** `coarse` divides the numbers of points and segments, where there are many bodies. */
export function solidOf(s: Setup, colour: string, coarse = 1): Group {
  const { arcs, size } = outlineOf(s);
  const base = new MeshPhongMaterial({ color: colour, ...SHINE });
  const mixed = (other: string, share: number) => new MeshPhongMaterial({ color: new Color(colour).lerp(new Color(other), share), ...SHINE });
  const [light, dark] = [mixed("#ffffff", 0.45), mixed("#000000", 0.35)];
  const group = new Group();
  const turned = (points: [number, number][], second: MeshPhongMaterial) => group.add(...quarters(points, base, second, coarse));
  const [one, two] = arcs.map((arc) => pointsOf(arc).filter((_, k) => k % coarse === 0));
  turned(one, light);
  turned(two, dark);
  const side = [one.at(-1)!, two[0]];
  if (side[0][0] - side[1][0] > 1e-9 * size) turned(side.map(([z, r]) => [z, Math.max(r, ROD * size)]), base);
  return group;
}

/** What points (z, r) make as they turn about the axis: four quarters in two colours, seen to roll. */
export function quarters(points: number[][], base: MeshPhongMaterial, second: MeshPhongMaterial, coarse = 1): Mesh[] {
  const curve = points.map(([z, r]) => new Vector2(Math.max(r, 0), z)).reverse();
  return [0, 1, 2, 3].map((k) => {
    // Three's solids of revolution stand along y.
    const geometry = new LatheGeometry(curve, 16 / coarse, (k * Math.PI) / 2, Math.PI / 2).rotateX(Math.PI / 2);
    return new Mesh(geometry, k % 2 ? second : base);
  });
}
