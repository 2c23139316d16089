/** The page comes to life: what people do, and what it does to the explorer. */

import "./language"; // before the charts, which look at it as they load
import { answer } from "./class";
import { changed, Controls } from "./controls";
import { Engine } from "./engine/module";
import { Pool } from "./engine/pool";
import { Explorer, type ChartName } from "./explorer";
import { canRecord } from "./export/record";
import { save } from "./export/save";
import { csv, python, toml } from "./export/text";
import { CHARTS, fromHash, initial, lacks, PRESENT, type State } from "./link";
import { onChange, onClick, part } from "./page";
import { PAIR_KINDS } from "./pair/pairs";
import { KINDS, type Kind } from "./pick";
import { rastered } from "./charts/pen";
import { readBody } from "./files";
import { drawWith, fallSpeed, outlineOf } from "./outline";
import type { Pace } from "./stage/clock";
import { at, TOUR } from "./tour";

/** Put in by build.mjs: the core in base 64, and the source of the worker. */
declare const CORE: string;
declare const WORKER: string;
/** Where the page is published, if it is. */
declare const HOME: string;

/** The page as it came, before anything is changed in it: what is saved for others. */
const SELF = `<!DOCTYPE html>\n${document.documentElement.outerHTML}`;

const bytes = Uint8Array.from(atob(CORE), (letter) => letter.charCodeAt(0));
const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
const ready = WebAssembly.compile(bytes);

ready.then(
  (module) => {
    drawWith(new Engine(module));
    begin(new Pool(WORKER, module));
  },
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
    // Another body has its own range.
    const range = key === "shape" && which === "a" ? "near" : state.range;
    explorer.go({ ...state, [which]: setup, particle: 0, impact: 0, stop: state.stop, range }, explorer.playing.playing);
  }, (file, unit, key) => void take(file, unit, key));
  const explorer = new Explorer(pool, () => refresh());

  /** Takes the body of a file, or says what is wrong with it. */
  async function take(file: File, unit: number, key?: string): Promise<void> {
    const { state } = explorer;
    try {
      const read = readBody(file.name, await file.text(), unit, key);
      const setup = changed({ ...state[which]!, shape: read.shape }, read.key, read.text);
      const { reach } = outlineOf(setup);
      if (!(reach > 1e-6 && reach < 1)) {
        const mend = reach >= 1 && unit === 1 ? { name: "Read it in mm", act: () => void take(file, 1e-3, key) } : undefined;
        return explorer.problem(`${file.name}: a body of ${Number((2 * reach).toPrecision(2))} m${mend ? "." : "; must be from 2 µm to 2 m: choose another unit of the file"}`, mend);
      }
      explorer.problem("");
      explorer.go({ ...state, [which]: setup, particle: 0, impact: 0, range: "near" }, explorer.player.clock.playing);
    } catch (error) {
      explorer.problem((error as Error).message);
    }
  }
  addEventListener("dragover", (event) => {
    if (event.dataTransfer?.types.includes("Files")) event.preventDefault();
  });
  addEventListener("drop", (event) => {
    const file = event.dataTransfer?.files[0];
    if (!file) return;
    event.preventDefault();
    void take(file, controls.unit);
  });

  const shows = [...document.querySelectorAll<HTMLButtonElement>("button[data-show]")];

  function refresh(): void {
    if (!explorer) return; // the first frame
    const { state, player } = explorer;
    if (!state.b || state.show !== "plane") which = "a";
    controls.show(state[which]!, state.show);
    document.documentElement.dataset.show = state.show;
    for (const button of shows) button.setAttribute("aria-pressed", String(button.dataset.show === state.show));
    for (const name of ["pair-play", "gas-play"]) part(name).textContent = explorer.playing.playing ? "Pause" : "Play";
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
    part<HTMLSelectElement>("density-of").value = state.density;
    const given = state.a.impacts === 1 ? "" : " | v";
    part("density-title").textContent = state.density === "fraction" ? `p(rotational share${given})` : `p(ε${given})`;
    arrange(state);
    const speed = part<HTMLInputElement>("speed");
    const most = 1.1 * fallSpeed(state.a);
    [speed.min, speed.max] = [String(-0.1 * most), String(most)];
    speed.step = String(most / 500);
    speed.value = String(state.speed);
    speed.disabled = state.a.impacts === 1;
    part("speed-value").textContent = `${state.speed} m/s`;
    speed.setAttribute("aria-valuetext", `${state.speed} metres per second`);
    part("of").textContent = which.toUpperCase();
    part("code").textContent = python(state[which]!);
    tour();
    const hash = address();
    // An address that cannot be changed (a page inside another) is not a reason to stop.
    try {
      if (location.hash !== hash && (location.hash || hash !== "#")) history.replaceState(null, "", hash);
    } catch {
      /* the link button still works */
    }
    if (!explorer.done) document.documentElement.dataset.state = "busy";
  }

  const presenting = () => PRESENT in document.documentElement.dataset;
  /** What follows the name of the page in its address. */
  const address = () => `#${[explorer.hash(), presenting() ? `${PRESENT}=1` : ""].filter(Boolean).join("&")}`;

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
    part("first").classList.toggle("touring", stop > 0);
    part("tour").hidden = !stop;
    if (!stop) return;
    part("tour-number").textContent = `Stop ${stop} of ${TOUR.length}.`;
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
    present(new URLSearchParams(location.hash.slice(1)).has(PRESENT));
    const kind = state.impact === 0 && state.stop ? TOUR[state.stop - 1].kind : undefined;
    explorer.go(state, !calm && state.impact === 0, replayed(kind));
    explorer.problem(problems.length ? `This link asks for what cannot be:\n${problems.join("\n")}` : "");
  }

  const view = (change: Partial<State>) => {
    Object.assign(explorer.state, change);
    explorer.redraw();
    refresh();
  };

  for (const section of document.querySelectorAll<HTMLElement>("[data-chart]")) {
    const button = document.createElement("button");
    [button.type, button.className, button.textContent] = ["button", "beside", "Beside the scene"];
    button.addEventListener("click", () => {
      view({ chart: section.dataset.chart as State["chart"] });
      part("stage").scrollIntoView({ block: "nearest" });
    });
    section.querySelector(".head")!.append(button);
  }
  onClick("sheet", () => {
    const open = part("set-up").classList.toggle("open");
    part("sheet").textContent = open ? "Less" : "All";
    part("sheet").setAttribute("aria-expanded", String(open));
  });

  function present(on: boolean): void {
    const root = document.documentElement;
    if (on === presenting()) return;
    if (on) root.dataset[PRESENT] = "";
    else delete root.dataset[PRESENT];
    part("present").setAttribute("aria-pressed", String(on));
    explorer.restyle();
    refresh();
  }
  onClick("present", () => {
    const on = !presenting();
    present(on);
    // A page inside another may not fill the screen; it is large in its frame all the same.
    if (on) document.documentElement.requestFullscreen?.().catch(() => {});
    else if (document.fullscreenElement) void document.exitFullscreen();
  });
  document.addEventListener("fullscreenchange", () => {
    if (!document.fullscreenElement) present(false);
  });
  addEventListener("keydown", (event) => {
    if (!presenting()) return;
    const { stop } = explorer.state;
    if (event.key === "Escape") present(false);
    else if (event.key === "PageDown" && stop < TOUR.length) visit(stop + 1);
    else if (event.key === "PageUp" && stop > 1) visit(stop - 1);
    else if (event.key === " " && !(event.target instanceof HTMLButtonElement)) {
      explorer.playing.play(!explorer.playing.playing);
    }
    else return;
    event.preventDefault();
  });
  for (const button of shows) button.addEventListener("click", () => explorer.go({ ...explorer.state, show: button.dataset.show as State["show"], stop: 0 }, !calm));
  const kindsOfPairs = part<HTMLSelectElement>("pair-kind");
  for (const [kind, [name]] of Object.entries(PAIR_KINDS)) kindsOfPairs.add(new Option(name, kind));
  async function seek(by: 1 | -1): Promise<void> {
    const encounter = await explorer.meeting.find(kindsOfPairs.value, explorer.state, by);
    if (encounter !== undefined) explorer.go({ ...explorer.state, encounter }, !calm);
  }
  onClick("pair-next", () => void seek(1));
  onClick("pair-back", () => void seek(-1));
  onClick("pair-several", () => {
    kindsOfPairs.value = "several";
    void seek(1);
  });
  onClick("pair-play", () => explorer.meeting.play(!explorer.meeting.clock.playing));
  onClick("pair-earlier", () => explorer.meeting.step(-1));
  onClick("pair-later", () => explorer.meeting.step(1));
  onClick("gas-play", () => explorer.gas.play(!explorer.gas.playing));
  onClick("gas-again", () => explorer.go(explorer.state, true));
  onChange("gas-pace", (pace) => (explorer.gas.pace = Number(pace)));
  onChange("pair-pace", (pace) => (explorer.meeting.clock.pace = pace as Pace));
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
  onChange("density-of", (density) => view({ density: density as State["density"] }));
  part<HTMLInputElement>("speed").addEventListener("input", (event) => {
    explorer.setSpeed(Number((event.target as HTMLInputElement).value));
  });
  onChange("compare", () => {
    const { state } = explorer;
    const on = part<HTMLInputElement>("compare").checked;
    which = on ? "b" : "a";
    const law = state.a.law === "frictionless" ? "tangential-restitution" : "frictionless";
    explorer.go({ ...state, chart: on ? "scatter-b" : "map", b: on ? { ...state.a, law } : undefined });
  });
  for (const radio of document.querySelectorAll<HTMLInputElement>("input[name=which]")) {
    radio.addEventListener("change", () => {
      which = radio.value as "a" | "b";
      refresh();
    });
  }
  addEventListener("hashchange", () => {
    if (location.hash !== address()) load();
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
  const picture = () => (what.value === "drawing" ? explorer.paper : explorer.charts[what.value as ChartName]);
  onClick("png", async () => {
    const canvas = document.createElement("canvas");
    if (what.value === "stage") explorer.player.stage?.large(canvas, explorer.player.clock.time);
    else await rastered(picture().svg(), canvas);
    canvas.toBlob((blob) => blob && save(`${what.value}.png`, blob));
  });
  onClick("svg", () => save(`${what.value}.svg`, picture().svg(), "image/svg+xml"));
  const film = part<HTMLButtonElement>("record");
  film.hidden = !canRecord() || !explorer.player.stage;
  onClick("record", () => void shoot(explorer, film));
  onClick("save-page", () => save("explorer.html", SELF, "text/html"));
  part("results").addEventListener("input", () => {
    part("class-answer").textContent = answer(part<HTMLTextAreaElement>("results").value);
  });
  onClick("licences", () => {
    const text = part("licence-text");
    text.hidden = !text.hidden;
    part("licences").setAttribute("aria-expanded", String(!text.hidden));
  });
  dress(explorer);
  load();
}

/** Puts the picture that the state speaks of beside the scene, and the others below. */
function arrange({ chart, density, b }: State): void {
  const beside = chart === "map" || (chart === "scatter-b" && !b) ? "density" : chart;
  // The share against v and its density at a speed belong together, in the place of the map.
  const shares = chart === "reservoir" && density === "fraction";
  for (const name of CHARTS) {
    const section = document.querySelector<HTMLElement>(`[data-chart="${name}"]`)!;
    section.hidden = name === "scatter-b" && !b;
    const place = part(name === beside || (shares && name === "density") ? "slot" : "others");
    if (section.parentElement !== place) place.append(section);
  }
  if (shares) part("others").prepend(part("map"));
  else if (part("map").parentElement !== part("bench")) part("slot").before(part("map"));
  document.documentElement.dataset.looks = shares ? "shares" : chart === "map" ? "map" : "other";
  part("ledger-of").textContent = b ? " of A" : "";
}

/** Light or dark: as the system has it, until somebody chooses. */
function dress(explorer: Explorer): void {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const put = (on: boolean) => {
    document.documentElement.dataset.theme = on ? "dark" : "light";
    part("theme").setAttribute("aria-pressed", String(on));
    explorer.restyle();
  };
  put(dark.matches);
  dark.addEventListener("change", () => put(dark.matches));
  onClick("theme", () => put(document.documentElement.dataset.theme !== "dark"));
  // Paper is white.
  let on = false;
  addEventListener("beforeprint", () => {
    on = document.documentElement.dataset.theme === "dark";
    if (on) put(false);
    explorer.drawAll();
  });
  addEventListener("afterprint", () => {
    if (on) put(true);
  });
}

/** Saves the replay of the impact that is shown. */
async function shoot(explorer: Explorer, button: HTMLButtonElement): Promise<void> {
  const { particle, impact } = explorer.state;
  button.disabled = true;
  button.textContent = "Recording";
  const { content, ending } = await explorer.player.record(impact);
  save(`particle-${particle}-impact-${impact + 1}.${ending}`, content);
  button.disabled = false;
  button.textContent = "Record";
}

/** What leads others here: of a page on this disk or this machine the published one, if there is one, else what follows the name of the
 * file that they have. */
function linkFor(state: string): { text: string; note: string } {
  const here = location.href.split("#")[0];
  const local = !/^https?:/.test(here) || ["localhost", "127.0.0.1", "[::1]"].includes(location.hostname);
  const end = state ? `#${state}` : "";
  if (!local) return { text: here + end, note: "Copied" };
  if (HOME) return { text: `${HOME}explorer.html${end}`, note: "Copied" };
  return { text: `explorer.html${end}`, note: "Copied: for who has the file" };
}

async function share(explorer: Explorer): Promise<void> {
  const { text, note } = linkFor(explorer.hash());
  const button = part("share");
  if (lacks(explorer.hash())) return explorer.problem("This body is too large for a link: send its file as well, to be dropped on the page.");
  try {
    await navigator.clipboard.writeText(text);
    button.textContent = note;
  } catch {
    prompt("The link to this set-up:", text);
  }
  setTimeout(() => (button.textContent = "Copy link"), 3000);
}
