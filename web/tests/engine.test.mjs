// The engine in the browser is the engine of the desktop: the same bits; and what the page derives from it is right.
import assert from "node:assert/strict";
import { mkdtempSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { test } from "node:test";
import { command, digest, engine, native, page, simulate } from "./library.mjs";

const small = { particles: 20, impacts: 60 };
const SETUPS = {
  "the paper's": {},
  "no friction, long": { law: "frictionless", separation: 9e-3, normal: 0.9, orientation: "isotropic" },
  "friction, with spin": { law: "coulomb", hypothesis: "poisson", friction: 0.2, spin_y: 40, spin_z: -25, velocity_x: 0.3 },
  "Newton's hypothesis": { law: "coulomb", hypothesis: "newton", normal: 0.8 },
  "Chatterjee and Ruina, on a slope": { law: "chatterjee-ruina", tangential: -0.5, incline: 0.2 },
  "a spherocylinder": { shape: "spherocylinder", separation: 6.15e-3, radius: 0.0123, release_height: 0.2 },
  "a spheroid, on the Moon": { shape: "spheroid", polar: 3.6e-3, gravity: 1.62, normal: 0.7 },
  "a flat spheroid": { shape: "spheroid", polar: 2e-3 },
  "a loaded sphere": { shape: "loaded-sphere" },
  "a sphere": { separation: 0 },
  "one angle, stopped early": { orientation: "given", angle: 1.1, minimum_speed: 0.3 },
  "a large seed": { seed: 2 ** 52 + 12345 },
};

test("the same bits as the native engine, by the lines of Python that the page shows", () => {
  const setups = Object.entries(SETUPS).map(([name, change]) => [name, { ...page.DEFAULT, ...small, ...change }]);
  // One process: each starts the whole of Python.
  const printed = native(setups.map(([, setup]) => page.python(setup)).join("\n")).split("\n");
  assert.equal(printed.length, setups.length);
  setups.forEach(([name, setup], k) => assert.equal(digest(setup), printed[k], name));
  assert.equal(new Set(printed).size, printed.length, "every set-up has its own digest");
});

test("the TOML file of the page is the same run on the desktop", () => {
  const setup = { ...page.DEFAULT, ...small, ...SETUPS["friction, with spin"] };
  const folder = mkdtempSync(join(tmpdir(), "restitution-"));
  writeFileSync(join(folder, "run.toml"), page.toml(setup));
  command("simulate", join(folder, "run.toml"), "--out", join(folder, "run.nc"));
  const names = JSON.stringify(page.digested(setup));
  const lines = `import hashlib, xarray\ndata = xarray.open_dataset(${JSON.stringify(join(folder, "run.nc"))})\n` +
    `print(hashlib.sha256(b"".join(data[name].values.tobytes() for name in ${names})).hexdigest())`;
  assert.equal(digest(setup), native(lines));
});

test("portions of a run are the run", () => {
  const setup = { ...page.DEFAULT, particles: 7, impacts: 30 };
  const { columns } = simulate(setup);
  const part = engine.simulate(page.numbers(setup), 3, 2);
  assert.deepEqual(part.subarray(0, 60), columns.time.subarray(90, 150));
});

test("every body under every law of the table is that of the native engine", () => {
  const setups = page.BODIES.flatMap((body) => page.LAWS.map((law) => ({ ...page.DEFAULT, particles: 3, impacts: 20, shape: body.key, law: law.key })));
  const printed = native(setups.map((setup) => page.python(setup)).join("\n")).split("\n");
  setups.forEach((setup, k) => assert.equal(digest(setup), printed[k], `${setup.shape}, ${setup.law}`));
});

const RIGID = {
  "a box": { shape: "box", orientation: "given" },
  "a box, thrown with spin": { shape: "box", spin_y: 40, spin_z: -25, velocity_x: 0.3, incline: 0.1 },
  ...Object.fromEntries(["4", "6", "8", "12", "20"].map((faces) => [`a die with ${faces} faces`, { shape: "die", faces }])),
  "a flat ellipsoid": { shape: "ellipsoid", axis_z: 5e-4 },
  "a clump": { shape: "clump" },
  "a rough sphere": { shape: "rough-sphere", asperities: 300 },
  "a mesh": { shape: "mesh" },
  "a superellipsoid": { shape: "superellipsoid" },
  "a superellipsoid with edges": { shape: "superellipsoid", exponent_1: 1.3, exponent_2: 6.5 },
  "a coin": { shape: "cylinder", height: 6e-4 },
  "a ring": { shape: "ring" },
  "an egg": { shape: "egg" },
  ...Object.fromEntries(["points", "profile"].flatMap((name) => Object.entries(page.LISTS[name].presets).map(([preset, rows]) => [preset, { shape: page.LISTS[name].shape, [name]: page.written(rows, 1e-3) }]))),
};

test("bodies without an axis have the same bits as in Python, by the lines that the page shows", () => {
  const setups = Object.entries(RIGID).map(([name, change]) => [name, { ...page.DEFAULT, particles: 4, impacts: 20, law: "coulomb", normal: 0.9, ...change }]);
  const printed = native(setups.map(([, setup]) => page.python(setup)).join("\n")).split("\n");
  setups.forEach(([name, setup], k) => assert.equal(digest(setup), printed[k], name));
  assert.equal(new Set(printed).size, printed.length);
});

test("the path of a body without an axis goes through its impacts, with the lowest point on the plane", () => {
  for (const [name, change] of Object.entries(RIGID)) {
    const setup = { ...page.DEFAULT, particles: 4, impacts: 8, law: "coulomb", normal: 0.9, ...change };
    const { columns, counts } = simulate(setup);
    const path = new page.Path(engine.follow(page.numbers(setup), 2), setup.gravity, setup.incline, page.freely(setup));
    const { reach, size } = page.outlineOf(setup);
    assert.ok(size > 0 && size <= reach, name);
    assert.equal(path.flights.length, counts[2] + 1);
    for (let i = 0; i < counts[2]; i++) {
      const [flight, next] = [path.flights[i], path.flights[i + 1]];
      assert.equal(next.start, columns.time[2 * setup.impacts + i]);
      assert.equal(next.sphere, columns.contact[2 * setup.impacts + i]);
      const arm = page.armOf(setup, next);
      assert.ok(Math.abs(next.place.z + arm.z) < 1e-9 * reach, `${name}: gap ${next.place.z + arm.z}`);
      // It is on the surface, and nothing is lower.
      const [lowest] = page.farthestOf(setup, [new page.Vector3(0, 0, -1).applyQuaternion(next.attitude.clone().invert())]);
      assert.ok(Math.abs(lowest.applyQuaternion(next.attitude).z - arm.z) < 1e-9 * reach && arm.length() < reach * (1 + 1e-9), `${name}: ${lowest.z} for ${arm.z}`);
      // The flight ends where the next one begins: the same place and attitude; and its energy of rotation does not change on the way.
      const end = path.at(flight.start + (next.start - flight.start) * (1 - 1e-9));
      assert.ok(end.place.distanceTo(next.place) < 1e-6 * reach, `${name}: ${end.place.distanceTo(next.place)}`);
      assert.ok(end.attitude.angleTo(next.attitude) < 1e-5, `${name}: turned by ${end.attitude.angleTo(next.attitude)}`);
    }
  }
});

/** Encounters of two bodies, by how they meet; numbers of the first that touch, and of the first with several contacts. */
const PAIRS = {
  "dumbbells of a gas": { separation: 3e-3, normal: 0.9 },
  "dumbbells, as given": { meeting: "given", separation: 6e-3, law: "frictionless", impact_parameter: 0.4, spin_1: 120, spin_2: -40 },
  "spheroids with friction": { shape: "spheroid", polar: 6e-3, law: "coulomb", normal: 0.8, temperature_ratio: 3 },
  boxes: { shape: "box", law: "frictionless", normal: 0.7 },
  clumps: { shape: "clump", law: "coulomb", seed: 2 ** 40 + 3 },
};
function encounters(change) {
  const setup = { ...page.DEFAULT, ...change };
  const parameters = page.pairNumbers(setup);
  const table = engine.survey(parameters, 0, 200);
  const contacts = Array.from({ length: 200 }, (_, k) => table[3 * k]);
  const numbers = [contacts.indexOf(1), contacts.findIndex((n) => n > 1), contacts.indexOf(0)].filter((k) => k >= 0);
  return { setup, found: numbers.map((number) => [number, new page.Encounter(engine.meet(parameters, number)), contacts[number]]) };
}

test("an encounter has the numbers of the native engine, by the lines of Python that the page shows, and its flights lead there", () => {
  const all = Object.values(PAIRS).map(encounters);
  const lines = all.flatMap(({ setup, found }) => found.map(([number, encounter]) => page.pairPython(setup, number, encounter).replace(/^print\((.*)\)$/m, `
import json
one = $1
print(json.dumps({name: one[name].values.tolist() for name in one.data_vars}))`)));
  const printed = native(lines.join("\n")).split("\n").map((line) => JSON.parse(line.replaceAll("NaN", "null")));
  const near = (found, exact, size, what) => exact.forEach((x, k) => assert.ok(Math.abs(found.getComponent(k) - x) < 1e-11 * size, `${what}: ${found.getComponent(k)} for ${x}`));
  Object.keys(PAIRS).forEach((name, i) => {
    // Given states are normalised once more on the way through Python.
    const same = PAIRS[name].meeting === "given" ? (x, y) => Math.abs(x - y) <= 1e-11 * Math.abs(y) + 1e-15 : Object.is;
    for (const [number, encounter, surveyed] of all[i].found) {
      const [exact, { values, hits, flights }] = [printed.shift(), encounter];
      assert.equal(values.contacts, surveyed);
      for (const key of ["contacts", "ending", "duration", "deflection", "contact_speed", "restitution_centres", "restitution_contact", "restitution_energy"]) {
        assert.ok(exact[key] === null ? Number.isNaN(values[key]) : same(values[key], exact[key]), `${name}, ${number}: ${key} = ${values[key]} for ${exact[key]}`);
      }
      assert.equal(flights.length, values.contacts + 1);
      hits.forEach((hit, k) => {
        assert.ok(same(hit.time, exact.time[k]));
        for (const key of ["normal", "point", "impulse"]) hit[key].toArray().forEach((x, n) => assert.ok(same(x, exact[key][k][n]), `${name}: ${key} ${x} for ${exact[key][k][n]}`));
        // Both bodies reach the contact, and each flight ends where the next begins.
        const [end, start] = [encounter.at(hit.time * (1 - 1e-15)).bodies, flights[k + 1].bodies];
        for (const side of [0, 1]) {
          assert.ok(hit.point.distanceTo(start[side].place) < values.reach * (1 + 1e-12));
          near(end[side].place, start[side].place.toArray(), values.reach, `${name}, place at contact ${k}`);
          assert.ok(end[side].attitude.angleTo(start[side].attitude) < 1e-7);
        }
      });
      const last = encounter.at(encounter.finish).bodies;
      for (const side of [0, 1]) {
        const { place, velocity, spin, attitude, translation, rotation } = last[side];
        near(place, exact.position_after[side], values.reach, `${name}, place`);
        near(velocity, exact.velocity_after[side], velocity.length(), `${name}, velocity`);
        near(spin, exact.angular_velocity_after[side], spin.length() + 1e-9, `${name}, spin`);
        const [w, x, y, z] = exact.attitude_after[side];
        assert.ok(Math.abs(Math.abs(attitude.w * w + attitude.x * x + attitude.y * y + attitude.z * z) - 1) < 1e-12);
        for (const [energy, kind] of [[translation, "translational"], [rotation, "rotational"]]) {
          const native = exact[`${kind}_energy_after`][side];
          assert.ok(Math.abs(energy - native) <= 1e-11 * native, `${name}: ${kind} energy ${energy} for ${native}`);
        }
      }
    }
  });
  assert.equal(printed.length, 0);
});

const GASES = {
  dumbbells: { separation: 3e-3, normal: 0.9, law: "frictionless", temperature_ratio: 0.5 },
  "boxes with friction": { shape: "box", law: "coulomb", normal: 0.8, grains: 40 },
};

test("a gas is that of the native engine, step by step, with its temperatures", () => {
  const steps = Object.values(GASES).map((change) => {
    const setup = { ...page.DEFAULT, grains: 60, ...change };
    let states = new Float64Array();
    return [setup, [0, 1, 2].map((number) => {
      const parameters = Float64Array.of(...page.gasNumbers(setup, 0.5, number), ...states);
      const step = page.stepOf(engine.cool(parameters, states.length / 10));
      states = step.states;
      return step;
    })];
  });
  const lines = steps.map(([setup, [{ reach }]]) => `
from restitution import _core
from restitution.pair.partners import turned_axes
import json, numpy as np
${page.python(setup).split("\n").filter((line) => /^(import restitution|body|law) /.test(line)).join("\n")}
count, T, side = ${setup.grains}, body.mass * ${setup.thermal_speed} ** 2, ${page.sideOf(setup)} * ${reach}
turned, given, found = turned_axes(body, law), None, []
course = dict(number_density=count / (side * side * side), uniform=False, batches=1, collisions=0.5, heating=0.0, keep=True, distributions=False, samples=1)
for step in range(3):
    kind = (body.compiled, count, T, (${setup.temperature_ratio} * T,) * 3, turned)
    (rows, given, _), _ = _core.cool([kind], law.compiled, course | {"seed": ${setup.seed} + step}, 1, given, None)
    row = dict(zip([*_core.GAS_WHOLE, *_core.GAS_KIND], rows[0, 1]))
    energies = np.array([row[f"rotational_{axis}"] for axis in "xyz"])[list(turned)]
    found.append([given.ravel().tolist(), row["time"], 2 * row["collisions"] / count, 2 * row["contacts"] / count, body.mass * row["speed_squared"] / 3, 2 * energies.mean()])
print(json.dumps(found))`);
  const printed = native(lines.join("\n")).split("\n").map((line) => JSON.parse(line));
  steps.forEach(([, course], i) => {
    course.forEach(({ states, looks }, k) => {
      const [exact, ...numbers] = printed[i][k];
      assert.deepEqual([...states], exact, `${Object.keys(GASES)[i]}, step ${k}`);
      Object.values(looks[1]).forEach((value, n) => assert.ok(Math.abs(value - numbers[n]) <= 1e-14 * numbers[n], `${value} for ${numbers[n]}`));
      // Each step begins as the one before ended.
      if (k) assert.ok(Math.abs(looks[0].translational / course[k - 1].looks[1].translational - 1) < 1e-12);
    });
    const [first, last] = [course[0].looks[0], course[2].looks[1]];
    assert.ok(last.translational < first.translational, "it cools");
  });
});

test("a body that no encounter can have is refused by name", () => {
  assert.throws(() => engine.meet(page.pairNumbers({ ...page.DEFAULT, shape: "ring" }), 0), /shape = 'this body': must be made of balls/);
});

test("where a smooth body lies farthest is on its surface, with that normal", () => {
  const at = ([a, b, c], [m, n], { x, y, z }) => (Math.abs(x / a) ** n + Math.abs(y / b) ** n) ** (m / n) + Math.abs(z / c) ** m;
  const directions = [[0.6, 0, 0.8], [0.48, 0.64, -0.6], [-2 / 3, 1 / 3, 2 / 3]].map((u) => new page.Vector3(...u));
  for (const [change, exponents] of [[{ shape: "ellipsoid" }, [2, 2]], [{ shape: "superellipsoid", exponent_1: 3, exponent_2: 5 }, [3, 5]]]) {
    const found = page.farthestOf({ ...page.DEFAULT, ...change }, directions);
    found.forEach((place, k) => {
      assert.ok(Math.abs(at([4e-3, 3e-3, 2e-3], exponents, place) - 1) < 1e-12);
      // No place of a grid of the surface lies farther.
      for (let i = 0; i < 400; i++) {
        const other = new page.Vector3(Math.sin(i), Math.sin(7.3 * i + 1), Math.sin(3.1 * i + 2));
        other.multiplyScalar(at([4e-3, 3e-3, 2e-3], exponents, other) ** (-1 / exponents[0]));
        assert.ok(other.dot(directions[k]) <= place.dot(directions[k]) * (1 + 1e-12));
      }
    });
  }
});

test("the spin of an ellipsoid keeps its angular momentum in flight, and is not constant", () => {
  const setup = { ...page.DEFAULT, particles: 1, impacts: 3, law: "coulomb", normal: 0.9, shape: "ellipsoid" };
  const path = new page.Path(engine.follow(page.numbers(setup), 0), setup.gravity, 0, page.freely(setup));
  const squares = [setup.axis_x, setup.axis_y, setup.axis_z].map((x) => x * x);
  const whole = squares.reduce((a, b) => a + b);
  const momentum = ({ attitude, spin }) => {
    const within = spin.clone().applyQuaternion(attitude.clone().invert());
    return new page.Vector3(...within.toArray().map((x, k) => x * (whole - squares[k]))).applyQuaternion(attitude);
  };
  const start = path.flights[2].start;
  const [one, two] = [path.at(start), path.at(start + 0.6 * path.duration(2))];
  assert.ok(momentum(one).distanceTo(momentum(two)) < 1e-12 * momentum(one).length());
  assert.ok(one.spin.distanceTo(two.spin) > 1e-3 * one.spin.length());
});

test("files are the bodies in them, to the bits that the package reads", () => {
  const folder = mkdtempSync(join(tmpdir(), "restitution-"));
  const files = {
    "dem.txt": ["# x y z r\n0 0 0 2.5\n1.5, 0.1 0 2 7\n", 1e-3, "rs.Clump.from_file"],
    "engine.csv": ["type,x,y,z,r\n1,0,0,0,0.003\n1,0,0,0.001,0.002\n", 1, "rs.Clump.from_file"],
    "corner.obj": ["v 0 0 0\nv 6 0 0\nv 0 7 0\nv 0 0 8\nf 1/1 3/1 2/1\nf 1 2 4\nf 1 4 3\nf -3 -2 -1\n", 1e-3, "rs.Mesh.from_file"],
  };
  const facet = (...corners) => `facet normal 0 0 0\nouter loop\n${corners.map((corner) => `vertex ${corner}\n`).join("")}endloop\nendfacet\n`;
  const [o, x, y, z] = ["0 0 0", "6e-3 0 0", "0 7e-3 0", "0 0 8e-3"];
  files["corner.stl"] = [`solid\n${facet(o, y, x)}${facet(o, x, z)}${facet(o, z, y)}${facet(x, y, z)}endsolid\n`, 1, "rs.Mesh.from_file"];
  const setups = Object.entries(files).map(([name, [text, unit]]) => {
    const { shape, key, text: table } = page.readBody(name, text, unit);
    writeFileSync(join(folder, name), text);
    return { ...page.DEFAULT, particles: 3, impacts: 10, law: "coulomb", normal: 0.9, shape, [key]: table };
  });
  const lines = Object.entries(files).map(([name, [, unit, from]], k) =>
    page.python(setups[k]).replace(/^body = .*$/m, `body = ${from}(${JSON.stringify(join(folder, name))}, scale=${unit})`));
  const printed = native(lines.join("\n")).split("\n");
  setups.forEach((setup, k) => assert.equal(digest(setup), printed[k], Object.keys(files)[k]));
});

test("a file that is none is refused, with the line and the reason", () => {
  const refused = (name, text, words) => assert.throws(() => page.readBody(name, text, 1), words);
  refused("a.txt", "0 0 0 1\n\n1 2 3\n", /^Error: a\.txt, line 3: 1 2 3: must be x y z r/);
  refused("a.txt", "0 0 0 -1\n", /line 1: .*r > 0/);
  refused("a.txt", "0 0 zero 1\n", /line 1: .*finite/);
  refused("a.txt", "", /1 to 1000 rows/);
  refused("a.txt", "0 0 0\n1 0\n", /line 2: 1 0: must be x y z, with/);
  refused("a.txt", "0 0 0\n", /points: must be 4 to 1000 rows/);
  refused("a.txt", "0 1\n2 -1\n", /line 2: 2 -1: .*r >= 0/);
  refused("a.txt", "0 1\n2 1\n0 2\n1 0\n", /profile = 4: must be an outline whose lines do not cross; those from the points 0 and 2 cross/);
  refused("a.bin", "\0\0", /not a text file/);
  refused("a.csv", "x,y,z\n0,0,0\n", /line 1: x y z: must be a header with the columns x, y, z and r/);
  refused("a.csv", "x,y,z,r\n0,0,0,1\n0,0,0\n", /line 3: .*4 values/);
  refused("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", /line 4: f 1 2 4: must be f with the numbers of vertices/);
  refused("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", /not closed at 3 edges/);
  refused("x.obj", "hello world\n", /^Error: x\.obj: has no triangle; must be a mesh as OBJ, with lines v x y z and f 1 2 3/);
  refused("a.stl", "solid\nvertex 0 0\n", /line 2: vertex 0 0: must be vertex x y z/);
});

test("an outline is the same after many others were asked for", () => {
  const at = (separation) => page.outlineOf({ ...page.DEFAULT, separation });
  const before = Array.from({ length: 40 }, (_, k) => at(1e-4 * k));
  assert.equal(at(1e-4 * 39), before[39], "kept");
  assert.notEqual(at(0), before[0], "made anew");
  assert.deepEqual(at(0), before[0]);
});

test("the contact of every body is on its outline, at every tilt", () => {
  for (const { key } of page.BODIES) {
    const setup = { ...page.DEFAULT, shape: key };
    const { arcs, reach } = page.outlineOf(setup);
    for (const end of [1, 2]) {
      // The end that is down touches, at the lowest of its points.
      for (const tilt of [0.3, 1.2]) {
        const axis = new page.Vector3(Math.sin(tilt), 0, end === 1 ? -Math.cos(tilt) : Math.cos(tilt));
        const arm = page.contactArm(setup, axis, end);
        const lowest = Math.min(...page.pointsOf({ ...arcs[end - 1], from: 0, to: Math.PI }).map(([z, r]) => z * axis.z - r * Math.abs(axis.x)));
        assert.ok(Math.abs(arm.z - lowest) < 3e-3 * reach && arm.z <= lowest + 1e-15, `${key}: ${arm.z} for ${lowest}`);
        assert.ok(arm.length() <= reach * (1 + 1e-12));
      }
    }
  }
});

test("a set-up that cannot be is refused in the engine's words", () => {
  const refused = (change, words) =>
    assert.throws(() => engine.simulate(page.numbers({ ...page.DEFAULT, ...change }), 0, 1), words);
  refused({ release_height: 1e-3 }, /release_height = 0\.001: must be finite and high enough/);
  refused({ normal: 1.5 }, /1\.5: must be/);
  refused({ gravity: 0 }, /gravity = 0\.0: must be finite and > 0/);
  refused({ shape: "ring", inner: 4e-3 }, /inner = 0\.004: must be less than outer/);
  refused({ shape: "egg", width: 7e-3 }, /width = 0\.007: must be > 0 and <= length/);
  for (const points of ["0_0_0_1_0_0_0_1_0_1_1_0", "0_0_0_1_0_0_2_0_0_3_0_0", "1_1_1_1_1_1_1_1_1_1_1_1"]) refused({ shape: "convex-polyhedron", points }, /must be four or more, finite, not all in one plane/);
});

test("the closed form of the first impact agrees with the engine, angle by angle", () => {
  for (const law of ["tangential-restitution", "frictionless"]) {
    for (const [elongation, normal] of [[0.1, 0.98], [0.7, 0.6], [2, 0.4]]) {
      const setup = { ...page.DEFAULT, law, separation: elongation * 3e-3, normal, particles: 200, impacts: 1 };
      const { columns } = simulate(setup);
      columns.restitution.forEach((epsilon, k) => {
        const exact = page.restitution(setup, Math.abs(Math.cos(columns.angle[k])));
        assert.ok(Math.abs(epsilon - exact) < 1e-13, `${law}, L/R ${elongation}: ${epsilon} against ${exact}`);
      });
    }
  }
});

test("the path of the scene goes through the impacts, with the lowest point on the plane", () => {
  for (const change of [{}, SETUPS["friction, with spin"], SETUPS["a spheroid, on the Moon"], SETUPS["Chatterjee and Ruina, on a slope"]]) {
    const setup = { ...page.DEFAULT, ...small, ...change };
    const { columns, counts } = simulate(setup);
    const path = new page.Path(engine.follow(page.numbers(setup), 4), setup.gravity, setup.incline);
    assert.equal(path.flights.length, counts[4] + 1);
    for (let i = 0; i < counts[4]; i++) {
      const place = 4 * setup.impacts + i;
      const [flight, next] = [path.flights[i], path.flights[i + 1]];
      assert.equal(next.start, columns.time[place]);
      const before = path.at(next.start * (1 - 1e-15) - 1e-15);
      const end = before.impacts === i ? before : path.at(flight.start);
      if (before.impacts === i) {
        assert.ok(Math.abs(-end.velocity.z - columns.impact_velocity[place]) < 1e-9);
        // What it falls in the moment that is left, and roundings of the height.
        const left = Math.abs(end.velocity.z) * (next.start * 2e-15 + 2e-15);
        assert.ok(Math.abs(end.place.z - next.place.z) < 1e-9 * setup.radius + 1e-12 + left);
      }
      // The attitude that is carried along ends where the engine says that the axis points, and the contact touches.
      const arm = page.contactArm(setup, next.axis, next.sphere);
      assert.ok(Math.abs(next.place.z + arm.z) < 1e-9 * setup.radius, `gap ${next.place.z + arm.z}`);
      const carried = end.attitude.clone().invert().multiply(next.attitude);
      if (before.impacts === i) assert.ok(carried.angleTo(carried.identity()) < 1e-6);
    }
  }
});

test("a link is a set-up: what goes in comes out, and nonsense is named", () => {
  const state = page.initial();
  assert.equal(page.toHash(state), "");
  state.a = { ...state.a, law: "coulomb", friction: 0.25, radius: 1e-3, seed: 77 };
  state.b = { ...state.a, separation: 2e-5 };
  Object.assign(state, { speed: -0.05, range: "fig7", density: "fraction", particle: 12, impact: 3, show: "pair", encounter: 9, stop: 4 });
  const { state: read, problems } = page.fromHash(`#${page.toHash(state)}`);
  assert.deepEqual(problems, []);
  assert.deepEqual(read, state);
  const bad = page.fromHash("#normal=2&law=magic&particles=1e9&impacts=0.5&speed=fast&seed=");
  assert.equal(bad.problems.length, 6);
  assert.match(bad.problems.join("\n"), /normal = 2: must be in \[0, 1\]/);
  assert.deepEqual(bad.state.a, page.DEFAULT);
  for (const hash of ["#b.normal=", "#%zz", "#b&b.seed=-1", "#particles=2000000&impacts=400"]) {
    const { state: safe } = page.fromHash(hash);
    assert.ok(safe.a.particles * safe.a.impacts <= 2_000_000);
  }
});

test("a link holds a rigid body, a clump with its spheres; of a large one it says that the file is needed", () => {
  for (const change of [...Object.values(RIGID), { shape: "clump", spheres: "0_0_0_0.001_0.001_0_0_0.002" }]) {
    const state = page.initial();
    state.a = { ...state.a, ...change, axis_y: 2.5e-3 };
    state.b = { ...state.a, edge: 7e-3 };
    assert.deepEqual(page.fromHash(`#${page.toHash(state)}`), { state, problems: [] });
  }
  const state = page.initial();
  Object.assign(state.a, { shape: "clump", spheres: Array.from({ length: 900 }, (_, k) => `${k / 7}_0_0_0.123456789`).join("_") });
  const { problems } = page.fromHash(`#${page.toHash(state)}`);
  assert.match(problems.join(), /spheres: of a file too large for a link/);
  assert.match(page.fromHash("#exponent_1=1").problems.join(), /exponent_1 = 1: must be in \[1\.1, 100\]/);
  const bad = page.fromHash("#shape=clump&spheres=0_0_1&faces=5&mesh=0_0_0*0_1_2&asperities=1.5").problems;
  assert.equal(bad.length, 4, bad.join("\n"));
});

test("links that give L/R are still those of their bodies", () => {
  const read = (hash) => page.fromHash(`#${hash}`).state.a;
  assert.equal(read("elongation=0.5").separation, 1.5e-3);
  assert.equal(read("elongation=0.5&radius=0.002").separation, 1e-3);
  const egg = read("shape=spheroid&radius=0.002&elongation=1");
  assert.deepEqual([egg.equatorial, egg.polar], [2e-3, 3e-3]);
});

test("a link to a stop of the tour is that stop, and what was changed there is not lost", () => {
  for (let stop = 1; stop <= page.TOUR.length; stop++) {
    const there = page.at(stop, page.initial());
    assert.deepEqual(page.fromHash(`#stop=${stop}`), { state: there, problems: [] });
    assert.equal(page.toHash(there), `stop=${stop}`);
    for (const change of [{ a: page.DEFAULT, b: undefined, speed: 0.4, range: "fig2", density: "restitution" }, { impact: 3 }]) {
      const state = { ...there, ...change };
      assert.deepEqual(page.fromHash(page.toHash(state)).state, state);
    }
  }
});

test("links of the pages to the explorer are set-ups", () => {
  const folder = fileURLToPath(new URL("../../docs/", import.meta.url));
  let seen = 0;
  for (const name of readdirSync(folder).filter((file) => file.endsWith(".md"))) {
    for (const [, state] of readFileSync(folder + name, "utf8").matchAll(/\]\([^)]*explorer\.html#([^)]*)\)/g)) {
      assert.deepEqual(page.fromHash(`#${state}`).problems, [], `${name}: ${state}`);
      seen++;
    }
  }
  assert.ok(seen > 5);
});

test("what the tour says of its runs is so", () => {
  const run = (stop, of = "a", change = {}) => simulate({ ...page.at(stop, page.initial())[of], ...change });
  const sigma = ({ columns }, low, high) => {
    const seen = [...columns.restitution].filter((_, i) => columns.impact_velocity[i] >= low && columns.impact_velocity[i] < high);
    const mean = seen.reduce((a, b) => a + b) / seen.length;
    return Math.sqrt(seen.reduce((a, b) => a + (b - mean) ** 2, 0) / seen.length);
  };
  // 1: a sphere has one coefficient.
  assert.ok(run(1).columns.restitution.every((x) => Math.abs(x - 0.98) < 1e-13));
  // 6: twice the elongation, four to five times the scatter; between seeds the ratio varies by 0.3.
  const beads = { particles: 100 };
  const ratio = sigma(run(6, "b", beads), 0.3, 0.5) / sigma(run(6, "a", beads), 0.3, 0.5);
  assert.ok(ratio > 3.5 && ratio < 5.7, `ratio ${ratio}`);
  // 8: 2.95 % of 20 000, with a standard error of 0.12 %; 4 of them here.
  const first = run(8).columns.restitution;
  const negative = first.filter((x) => x < 0).length / first.length;
  assert.ok(Math.abs(negative - 0.0295) < 4 * 0.0012, `${negative}`);
  // 9: energy grows under the paper's law, never without friction; and the scatter of B is larger.
  const [paper, smooth] = [run(9), run(9, "b")];
  assert.ok(paper.columns.energy_ratio.some((x) => x > 1.5));
  assert.ok(smooth.columns.energy_ratio.every((x) => !(x > 1 + 1e-12)));
  assert.ok(sigma(smooth, 0.38, 0.42) > 1.5 * sigma(paper, 0.38, 0.42));
});

/** What the page counts of a stop, without its workers. */
function counted(stop, of = "a", change = {}) {
  const state = page.at(stop, page.initial());
  const setup = { ...state[of], ...change };
  const { columns, counts } = simulate(setup);
  const particles = page.particlesOf(setup);
  const run = { setup, columns, counts, particles, reasons: new Float64Array(particles), impacts: counts.reduce((a, b) => a + b) };
  const statistics = new page.Statistics(run);
  statistics.add({ first: 0, count: particles });
  return { state, statistics };
}
const area = ({ x, y }) => y.reduce((sum, value, k) => sum + (value ?? 0) * (x[k + 1] - x[k]), 0);
const beads = { particles: 100 };

test("of a sphere the pictures say that there is nothing to see, and why", () => {
  const { state, statistics: a } = counted(1);
  assert.match(page.pictures.density(state, { a }).note, /All \d+ impacts have ε = 0\.98/);
  assert.match(page.pictures.scatterWidth(state, { a }).note, /σ\(ε\) = 0/);
  assert.match(page.pictures.reservoir(state, { a }).note, /Nothing rotates/);
});

test("the bins of p(ε | v) show its cusp, and the Laplace density over it is that of the package", () => {
  const { state, statistics: a } = counted(5);
  const { curves } = page.pictures.density(state, { a });
  assert.deepEqual(curves.map(({ of, kind }) => [of, kind]), [["a", "steps"], ["ink", "line"]]);
  const all = a.values("restitution", ...a.window(state.speed));
  // A command line does not hold all of them.
  const values = all.filter((_, k) => k % 3 === 0);
  const fit = page.laplace(values);
  const step = curves[0].x[1] - curves[0].x[0];
  assert.ok(step < Math.min(fit.above, fit.below) / 5, `bins of ${step}, decay lengths ${fit.above} and ${fit.below}`);
  assert.ok(area(curves[0]) > 0.998 && area(curves[0]) < 1 + 1e-9);
  const lines = `import json, sys, numpy as np\nfrom restitution import fit\n` +
    `found = fit.asymmetric_laplace(np.array(${JSON.stringify([...values])})).parameters\nprint(json.dumps({k: float(v) for k, v in found.items()}))`;
  const [location, above, below] = Object.values(JSON.parse(native(lines)));
  for (const [ours, theirs] of [[fit.location, location], [fit.above, above], [fit.below, below]]) {
    assert.ok(Math.abs(ours / theirs - 1) < 1e-6, `${ours} against ${theirs}`);
  }
  const fine = Array.from({ length: 20001 }, (_, k) => fit.location - 1 + k * 1e-4);
  const whole = fine.reduce((sum, x) => sum + 1e-4 * page.laplaceDensity(fit, x), 0);
  assert.ok(Math.abs(whole - 1) < 1e-3, `${whole}`);
});

test("σ(ε) of glass beads is drawn as in Fig. 6, both axes logarithmic, at twenty speeds and more", () => {
  const { state, statistics: a } = counted(6, "a", beads);
  const { statistics: b } = counted(6, "b", beads);
  const { x, y, curves } = page.pictures.scatterWidth(state, { a, b });
  assert.ok(x.log && y.log && y.low > 0);
  assert.deepEqual(curves.map(({ label }) => label), ["A: separation/radius = 0.01", "B: separation/radius = 0.02"]);
  for (const curve of curves) {
    const seen = curve.y.filter((value) => value > 0);
    assert.ok(seen.length > 20 && seen.every((value) => value > y.low && value < y.high));
  }
  // And the map shows how they scatter: more than a few rows of it are filled.
  const { lattice, y: axis } = page.pictures.scatter(state, a, "a", [600, 400]);
  assert.ok(axis.high - axis.low < 0.05);
  const rows = new Set([...lattice.counts].flatMap((count, k) => (count ? [k % lattice.other.count] : [])));
  assert.ok(rows.size > 50, `${rows.size} rows`);
});

test("the exact density of the first impact lies over that of its impacts, in a colour of its own", () => {
  const { state, statistics: a } = counted(8);
  const { curves, y } = page.pictures.density(state, { a });
  const [seen, exact] = curves;
  assert.equal(exact.of, "ink");
  assert.ok(!y.log && Math.abs(area(seen) - 1) < 1e-9);
  // In each bin of n impacts the count scatters by √n; the ends, where the density is infinite or ends, aside.
  for (let k = 2; k < seen.y.length - 3; k++) {
    const inside = [...exact.x].map((x, i) => [x, exact.y[i]]).filter(([x, p]) => x > seen.x[k] && x < seen.x[k + 1] && p !== null);
    const mean = inside.reduce((sum, [, p]) => sum + p, 0) / inside.length;
    const error = Math.sqrt(mean / (20000 * (seen.x[k + 1] - seen.x[k])));
    assert.ok(Math.abs(seen.y[k] - mean) < 5 * error, `bin ${k}: ${seen.y[k]} against ${mean}`);
  }
  assert.match(page.pictures.scatterWidth(state, { a }).note, /One impact each/);
  assert.match(page.pictures.reservoir(state, { a }).note, /Released without spin/);
});

test("a map is the same however its impacts arrive", () => {
  const { state, statistics: whole } = counted(2, "a", { particles: 40 });
  const { run } = whole;
  const parts = new page.Statistics({ ...run, counts: new Float64Array(40) });
  page.pictures.scatter(state, parts, "a", [600, 400]);
  for (const first of [30, 10, 0, 20]) {
    parts.run.counts.set(run.counts.subarray(first, first + 10), first);
    parts.add({ first, count: 10 });
  }
  const [one, other] = [whole, parts].map((s) => page.pictures.scatter(state, s, "a", [600, 400]).lattice);
  assert.deepEqual(one.counts, other.counts);
  assert.equal(one.most, Math.max(...one.counts));
  assert.equal(one.most, other.most);
});

test("no two ticks of an axis read alike, and some have a number", () => {
  for (const [low, high, log] of [[0, 1], [0, 1e-3], [0.979, 0.981], [-3, 4], [0.4, 1.6], [0, 2e-5], [1e-5, 2e-2, true], [0.03, 1.16, true], [0.2, 0.9, true], [1e-9, 1e3, true]]) {
    const texts = page.ticks({ label: "", low, high, log }, 6).map(({ text }) => text).filter(Boolean);
    assert.equal(new Set(texts).size, texts.length, `${low} to ${high}: ${texts}`);
    assert.ok(texts.length >= 2 && texts.length <= 12, `${low} to ${high}: ${texts}`);
  }
});
