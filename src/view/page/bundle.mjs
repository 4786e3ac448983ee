// SPDX-License-Identifier: GPL-3.0-or-later
// Bundles the viewer: npm ci && npm run bundle. The result is committed, so that building pcbmesh needs no npm.
import { createHash } from "node:crypto";
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { build } from "esbuild";

const sources = ["package.json", ...readdirSync("viewer").filter((name) => name.endsWith(".mjs")).sort().map((name) => `viewer/${name}`)];
const hash = createHash("sha256");
for (const name of sources) hash.update(name).update("\0").update(readFileSync(name));

const licence = readFileSync("node_modules/three/LICENSE", "utf8").trim();
const banner = `/*! pcbmesh viewer, GPL-3.0-or-later. Sources: src/view/page/viewer, sha256 ${hash.digest("hex")}
 * Contains three.js (npm package three):
 * ${licence.replaceAll("\n", "\n * ").replaceAll(" * \n", " *\n")}
 */`;
const result = await build({
  entryPoints: ["viewer/main.mjs"],
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2022",
  legalComments: "none", // the banner has the text in full
  banner: { js: banner },
  charset: "ascii",
  write: false,
});
writeFileSync("viewer.bundle.js", result.outputFiles[0].text);
console.log(`viewer.bundle.js: ${result.outputFiles[0].text.length} bytes from ${sources.length} sources`);
