// A real browser for the tests: Debian's Chromium where it is installed, else the one that @sparticuz/chromium brings along.
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { brotliDecompressSync } from "node:zlib";
import { chromium } from "playwright-core";

// Without a graphics card, in software; root has no sandbox.
const args = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"];
const UNPACKED = fileURLToPath(new URL("../node_modules/.browser", import.meta.url));

/** The name of the library that a program which did not start was looking for. */
const lacking = (error) => /error while loading shared libraries: (\S+):/.exec(error.message)?.[1];

/** NSS and what it needs, which the package keeps for systems that have none: their folder. */
function bundledLibraries() {
  const folder = join(UNPACKED, "al2023");
  if (!existsSync(join(folder, "lib"))) {
    const packed = createRequire(import.meta.url).resolve("@sparticuz/chromium").replace(/build[/\\].*$/, "bin/al2023.tar.br");
    mkdirSync(folder, { recursive: true });
    execFileSync("tar", ["-x", "-C", folder], { input: brotliDecompressSync(readFileSync(packed)) });
  }
  return join(folder, "lib");
}

export async function launch() {
  // In the C locale a browser says that its language is en-US@posix: the page must do with that, too.
  const locale = { ...process.env, LC_ALL: "C" };
  const system = ["/usr/bin/chromium", "/usr/bin/chromium-browser"].find(existsSync);
  if (system) return chromium.launch({ executablePath: system, args, env: locale });
  if (process.arch !== "x64") throw new Error(`no browser for ${process.arch}: install Debian's chromium`);
  const whole = join(UNPACKED, "whole");
  if (!existsSync(whole)) rmSync(UNPACKED, { recursive: true, force: true });
  // The package unpacks into the folder for temporary files, where something of that name may be somebody else's.
  mkdirSync(UNPACKED, { recursive: true });
  const temporary = process.env.TMPDIR;
  process.env.TMPDIR = UNPACKED;
  const { default: bundled } = await import("@sparticuz/chromium");
  bundled.setGraphicsMode = true;
  const executablePath = await bundled.executablePath();
  writeFileSync(whole, "");
  if (temporary === undefined) delete process.env.TMPDIR;
  else process.env.TMPDIR = temporary;
  const fonts = existsSync("/etc/fonts") ? {} : { FONTCONFIG_PATH: join(UNPACKED, "fonts") };
  const environments = [() => ({ ...locale, ...fonts }), () => ({ ...locale, ...fonts, LD_LIBRARY_PATH: bundledLibraries() })];
  let missing;
  for (const env of environments) {
    try {
      return await chromium.launch({ executablePath, args, env: env() });
    } catch (error) {
      missing = lacking(error);
      if (!missing) throw error;
    }
  }
  throw new Error(`the browser of ${dirname(executablePath)} lacks ${missing}: install libnss3 and libnspr4, or Debian's chromium`);
}
