/** What the tests import: parts of the page that need no browser. */

export { Engine } from "./engine/module";
export { COLUMNS, gasNumbers, numbers, pairNumbers } from "./engine/layout";
export { digested } from "./engine/run";
export { pairPython, python, toml } from "./export/text";
export { stepOf } from "./gas/step";
export { Encounter } from "./pair/encounter";
export { restitution, transverseInertia } from "./first-impact";
export { density as laplaceDensity, laplace } from "./laplace";
export * as pictures from "./charts/pictures";
export { ticks } from "./charts/ticks";
export { fromHash, initial, toHash } from "./link";
export { armOf, contactArm, drawWith, farthestOf, freely, outlineOf, pointsOf } from "./outline";
export { readBody } from "./files";
export { Vector3 } from "three";
export { DEFAULT, particlesOf, sideOf } from "./setup";
export { BODIES, LAWS, LISTS, RIGID, written } from "./table";
export { Path } from "./stage/path";
export { Statistics } from "./statistics";
export { at, TOUR } from "./tour";
