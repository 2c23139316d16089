/** A rigid body, about its centre of mass, in three tones so that one sees it turn. Lengths in m. */

import {
  BufferGeometry, Color, DoubleSide, EdgesGeometry, Float32BufferAttribute, Group, IcosahedronGeometry, InstancedMesh, LineBasicMaterial, LineSegments,
  Matrix4, Mesh, MeshPhongMaterial, SphereGeometry, Vector3,
} from "three";
import { drawingOf, farthestOf, freeOf } from "../outline";
import { rowsOf, type Surface } from "../rigid";
import type { Setup } from "../setup";
import { quarters } from "./body";

const SHINE = { shininess: 40, specular: "#333333" };
/** Edges at which faces meet at a larger angle than this, in degrees, are drawn. */
const CREASE = 15;
/** Asperities are drawn as large as this part of the sphere, unless they would cover more of it than `cover`. */
const ASPERITY = { size: 0.03, cover: 0.25 };

interface Ball {
  place: Vector3;
  radius: number;
}

/** `coarse` as in `solidOf`. */
export function rigidOf(s: Setup, colour: string, coarse = 1): Group {
  const tones = [new Color(colour), new Color(colour).lerp(new Color("#ffffff"), 0.45), new Color(colour).lerp(new Color("#000000"), 0.35)];
  const { centre } = freeOf(s);
  const { surface, profile } = drawingOf(s);
  if (surface) return faces(surface, centre, tones, s.shape !== "mesh");
  if (profile) return revolved(profile.map(([z, r]) => [z - centre.z, r]), tones, coarse);
  if (s.shape === "rough-sphere") return rough(s, tones, coarse);
  if (s.shape !== "clump") return octants((normals) => farthestOf(s, normals), tones, coarse);
  const clump = rowsOf(s, "spheres").map(([x, y, z, radius]) => ({ place: new Vector3(x, y, z).sub(centre), radius }));
  return new Group().add(balls(clump, new SphereGeometry(1, 32 / coarse, 20 / coarse), tones));
}

/** Each of the balls in the next of the tones. */
function balls(all: Ball[], shape: BufferGeometry, tones: Color[]): InstancedMesh {
  const mesh = new InstancedMesh(shape, new MeshPhongMaterial(SHINE), all.length);
  all.forEach(({ place, radius }, k) => {
    mesh.setMatrixAt(k, new Matrix4().makeScale(radius, radius, radius).setPosition(place));
    mesh.setColorAt(k, tones[k % tones.length]);
  });
  mesh.frustumCulled = false;
  return mesh;
}

/** The triangles of a convex body are turned outwards, or each would have edges of its own. */
function faces({ points, triangles }: Surface, centre: Vector3, tones: Color[], convex: boolean): Group {
  const [places, colours]: [number[], number[]] = [[], []];
  for (const corners of triangles) {
    const [a, b, c] = corners.map((k) => new Vector3().fromArray(points[k]).sub(centre));
    const normal = b.clone().sub(a).cross(c.clone().sub(a));
    const sides = normal.toArray().map(Math.abs);
    const tone = tones[sides.indexOf(Math.max(...sides))];
    for (const corner of convex && normal.dot(a) < 0 ? [a, c, b] : [a, b, c]) {
      places.push(...corner);
      colours.push(tone.r, tone.g, tone.b);
    }
  }
  const geometry = new BufferGeometry().setAttribute("position", new Float32BufferAttribute(places, 3)).setAttribute("color", new Float32BufferAttribute(colours, 3));
  geometry.computeVertexNormals();
  const lines = new LineSegments(new EdgesGeometry(geometry, CREASE), new LineBasicMaterial({ color: tones[2].clone().lerp(new Color("#000000"), 0.4) }));
  return new Group().add(new Mesh(geometry, new MeshPhongMaterial({ ...SHINE, vertexColors: true, flatShading: true, side: DoubleSide })), lines);
}

/** A convex surface in octants, of its places with these outward normals. */
function octants(places: (normals: Vector3[]) => Vector3[], [base, light, dark]: Color[], coarse: number): Group {
  const group = new Group();
  for (let k = 0; k < 8; k++) {
    const upper = k < 4;
    const shape = new SphereGeometry(1, 16 / coarse, 16 / coarse, (k * Math.PI) / 2, Math.PI / 2, upper ? 0 : Math.PI / 2, Math.PI / 2).rotateX(Math.PI / 2);
    const normal = shape.getAttribute("normal");
    const found = places(Array.from({ length: normal.count }, (_, i) => new Vector3().fromBufferAttribute(normal, i)));
    shape.setAttribute("position", new Float32BufferAttribute(found.flatMap((place) => place.toArray()), 3));
    group.add(new Mesh(shape, new MeshPhongMaterial({ ...SHINE, color: (k % 2 === 1) === upper ? light : upper ? base : dark })));
  }
  return group;
}

/** A solid of revolution, line by line of its profile; the ends are joined to the axis, unless it is closed. */
function revolved(profile: number[][], [base, light, dark]: Color[], coarse: number): Group {
  const [[z, r], [end, last]] = [profile[0], profile.at(-1)!];
  const closed = z === end && r === last;
  const outline = closed ? profile : [[z, 0], ...profile, [end, 0]];
  const [above, pale, below] = [base, light, dark].map((color) => new MeshPhongMaterial({ ...SHINE, color, side: DoubleSide }));
  const group = new Group();
  outline.slice(1).forEach((to, k) => {
    const from = outline[k];
    if (from[0] !== to[0] || from[1] !== to[1]) group.add(...quarters([from, to], to[1] > from[1] ? below : above, pale, coarse));
  });
  return group;
}

/** How many times as large as they are the asperities are drawn. */
function exaggeration(s: Setup): number {
  const [radius, count, asperity] = [s.radius, s.asperities, s.asperity_radius].map(Number);
  const size = Math.min(ASPERITY.size, Math.sqrt((4 * ASPERITY.cover) / count)) * radius;
  return Math.max(1, Number((size / asperity).toPrecision(2)));
}

/** What is written into the picture. */
export function noteOf(s: Setup): string {
  const times = s.shape === "rough-sphere" ? exaggeration(s) : 1;
  return times > 1 ? `asperities drawn ${times} times as large` : "";
}

function rough(s: Setup, [base, light, dark]: Color[], coarse: number): Group {
  const [sphere, ...asperities] = freeOf(s).balls;
  const times = exaggeration(s);
  const large = asperities.map(({ place, radius }) => {
    const over = sphere.radius + times * (place.length() - sphere.radius);
    return { place: place.clone().setLength(over), radius: times * radius };
  });
  // Small ones have few faces.
  const shape = large.length > 2000 ? new IcosahedronGeometry(1, 0) : new IcosahedronGeometry(1, 2);
  return new Group().add(octants((normals) => normals.map((normal) => normal.setLength(sphere.radius)), [base, base, base.clone().lerp(dark, 0.5)], coarse), balls(large, shape, [light]));
}
