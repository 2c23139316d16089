/** The page comes to life: what people do, and what it does to the explorer. */

import "./language"; // before the charts, which look at it as they load
import { changed, Controls } from "./controls";
import { Pool } from "./engine/pool";
import { Explorer, type ChartName } from "./explorer";
import { save } from "./export/save";
import { csv, python, toml } from "./export/text";
import { fromHash, initial, type State } from "./link";
import { onChange, onClick, part } from "./page";
import { KINDS, type Kind } from "./pick";
import { onGround } from "./charts/svg";
import { svg } from "./charts/svg";
import { theme } from "./charts/colours";
import { fallSpeed } from "./setup";
import type { Pace } from "./stage/clock";
import { at, TOUR } from "./tour";

/** Put in by build.mjs: the core in base 64, and the source of the worker. */
declare const CORE: string;
declare const WORKER: string;

const bytes = Uint8Array.from(atob(CORE), (letter) => letter.charCodeAt(0));
const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
const ready = WebAssembly.compile(bytes);

ready.then(
  (module) => begin(new Pool(WORKER, module)),
  (error: Error) => {
    part("problem").hidden = false;
    part("problem").textContent = `This browser cannot run the engine: ${error.message}`;
  },
);

function begin(pool: Pool): void {
  let which: "a" | "b" = "a";
  const controls = new Controls(part<HTMLFormElement>("controls"), (key, value) => {
    const { state } = explorer;
    const setup = changed(state[which]!, key, value);
    explorer.go({ ...state, [which]: setup, particle: 0, impact: 0, stop: state.stop }, explorer.player.clock.playing);
  });
  const explorer = new Explorer(pool, () => refresh());

  function refresh(): void {
    if (!explorer) return; // the first frame
    const { state, player } = explorer;
    if (!state.b) which = "a";
    controls.show(state[which]!);
    part("set-up").dataset.which = which;
    part<HTMLInputElement>("compare").checked = state.b !== undefined;
    part("compare-note").hidden = !state.b;
    for (const radio of document.querySelectorAll<HTMLInputElement>("input[name=which]")) {
      radio.checked = radio.value === which;
      radio.disabled = radio.value === "b" && !state.b;
    }
    part("play").textContent = player.clock.playing ? "Pause" : "Play";
    part<HTMLInputElement>("particle").value = String(state.particle);
    part<HTMLSelectElement>("range").value = state.range;
    part<HTMLSelectElement>("density").value = state.density;
    part("density-title").textContent = state.a.impacts === 1 && state.density === "restitution" ? "p(ε) of the first impact" : state.density === "fraction" ? "p(E_rot/E_tot | v) at this speed" : "p(ε | v) at this speed";
    const speed = part<HTMLInputElement>("speed");
    const most = 1.1 * fallSpeed(state.a);
    [speed.min, speed.max] = [String(-0.1 * most), String(most)];
    speed.step = String(most / 500);
    speed.value = String(state.speed);
    part("speed-value").textContent = `${state.speed} m/s`;
    speed.setAttribute("aria-valuetext", `${state.speed} metres per second`);
    part("of").textContent = which.toUpperCase();
    part("code").textContent = python(state[which]!);
    tour();
    const hash = `#${explorer.hash()}`;
    // An address that cannot be changed (a page inside another) is not a reason to stop.
    try {
      if (location.hash !== hash && (location.hash || hash !== "#")) history.replaceState(null, "", hash);
    } catch {
      /* the link button still works */
    }
    if (!explorer.done) document.documentElement.dataset.state = "busy";
  }

  let found = 0;
  const kinds = part<HTMLSelectElement>("kind");
  for (const [kind, name] of Object.entries(KINDS)) kinds.add(new Option(name, kind));

  /** "Next one" goes on from what is replayed: at a stop of the tour, from its impact. */
  function replayed(kind?: Kind): Kind | undefined {
    found = 0;
    if (kind) kinds.value = kind;
    return kind;
  }

  function tour(): void {
    const { stop } = explorer.state;
    part("tour").hidden = !stop;
    if (!stop) return;
    part("tour-number").textContent = `Stop ${stop} of ${TOUR.length}`;
    part("tour-title").textContent = TOUR[stop - 1].title;
    part("tour-text").textContent = TOUR[stop - 1].text;
    part<HTMLButtonElement>("tour-back").disabled = stop === 1;
    part<HTMLButtonElement>("tour-next").disabled = stop === TOUR.length;
  }

  function visit(stop: number): void {
    explorer.go(at(stop, explorer.state), !calm, replayed(TOUR[stop - 1].kind));
    part("tour-title").focus();
  }

  function load(): void {
    const { state, problems } = fromHash(location.hash);
    const kind = state.impact === 0 && state.stop ? TOUR[state.stop - 1].kind : undefined;
    explorer.go(state, !calm && state.impact === 0, replayed(kind));
    explorer.problem(problems.length ? `This link asks for what cannot be:\n${problems.join("\n")}` : "");
  }

  const view = (change: Partial<State>) => {
    Object.assign(explorer.state, change);
    explorer.redraw();
    refresh();
  };

  // No link: what follows # in the address is the state.
  onClick("to-set-up", () => {
    part("set-up").focus();
    part("set-up").scrollIntoView();
  });
  onClick("tour-start", () => visit(1));
  onClick("tour-back", () => visit(explorer.state.stop - 1));
  onClick("tour-next", () => visit(explorer.state.stop + 1));
  onClick("tour-end", () => view({ stop: 0 }));
  onClick("reset", () => explorer.go(initial(), !calm));
  onClick("share", () => void share(explorer));
  onClick("play", () => explorer.player.play(!explorer.player.clock.playing));
  onClick("earlier", () => explorer.player.step(-1));
  onClick("later", () => explorer.player.step(1));
  onChange("pace", (pace) => (explorer.player.clock.pace = pace as Pace));
  onChange("particle", (text) => {
    const most = explorer.runs.a!.run.particles - 1;
    explorer.state.particle = Math.min(Math.max(Math.floor(Number(text)) || 0, 0), most);
    explorer.state.impact = 0;
    void explorer.replay(undefined, explorer.player.clock.playing);
    refresh();
  });
  onChange("kind", () => replayed());
  onClick("find", () => explorer.find(kinds.value as Kind, (found = 0), !calm));
  onClick("find-next", () => explorer.find(kinds.value as Kind, ++found, !calm));
  onChange("range", (range) => view({ range: range as State["range"] }));
  onChange("density", (density) => view({ density: density as State["density"] }));
  part<HTMLInputElement>("speed").addEventListener("input", (event) => {
    explorer.setSpeed(Number((event.target as HTMLInputElement).value));
  });
  onChange("compare", () => {
    const { state } = explorer;
    const on = part<HTMLInputElement>("compare").checked;
    which = on ? "b" : "a";
    explorer.go({ ...state, b: on ? { ...state.a, law: state.a.law === "frictionless" ? "tangential-restitution" : "frictionless" } : undefined });
  });
  for (const radio of document.querySelectorAll<HTMLInputElement>("input[name=which]")) {
    radio.addEventListener("change", () => {
      which = radio.value as "a" | "b";
      refresh();
    });
  }
  addEventListener("hashchange", () => {
    if (location.hash !== `#${explorer.hash()}`) load();
  });

  const setup = () => explorer.state[which]!;
  onClick("toml", () => save("run.toml", toml(setup()), "application/toml"));
  onClick("python", () => save("run.py", python(setup()), "text/x-python"));
  onClick("csv", () => {
    const { run } = explorer.runs[which]!;
    save("impacts.csv", csv(run), "text/csv");
  });
  const what = part<HTMLSelectElement>("what");
  onChange("what", (name) => (part<HTMLButtonElement>("svg").disabled = name === "stage"));
  part<HTMLButtonElement>("svg").disabled = true;
  onClick("png", () => {
    const canvas = what.value === "stage" ? explorer.player.stage?.canvas : explorer.charts[what.value as ChartName].canvas;
    if (canvas) onGround(canvas, theme().paper).toBlob((blob) => blob && save(`${what.value}.png`, blob));
  });
  onClick("svg", () => {
    const { picture } = explorer.charts[what.value as ChartName];
    if (picture) save(`${what.value}.svg`, svg(picture), "image/svg+xml");
  });
  onClick("licences", () => {
    const text = part("licence-text");
    text.hidden = !text.hidden;
    part("licences").setAttribute("aria-expanded", String(!text.hidden));
  });
  dress(explorer);
  load();
}

/** Light or dark: as the system has it, until somebody chooses. */
function dress(explorer: Explorer): void {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const put = (on: boolean) => {
    document.documentElement.dataset.theme = on ? "dark" : "light";
    part("theme").setAttribute("aria-pressed", String(on));
    for (const chart of Object.values(explorer.charts)) chart.restyle();
    explorer.player.stage?.restyle();
  };
  put(dark.matches);
  dark.addEventListener("change", () => put(dark.matches));
  onClick("theme", () => put(document.documentElement.dataset.theme !== "dark"));
}

async function share(explorer: Explorer): Promise<void> {
  const link = `${location.href.split("#")[0]}#${explorer.hash()}`;
  const button = part("share");
  try {
    await navigator.clipboard.writeText(link);
    button.textContent = "Copied";
  } catch {
    prompt("The link to this set-up:", link);
  }
  setTimeout(() => (button.textContent = "Copy link"), 2000);
}
