// Khronos's reports on the GLB files that are named, as a JSON array on stdout.
import { readFile } from "node:fs/promises";
import { validateBytes } from "gltf-validator";

const options = { maxIssues: 0 }; // all of them
const report = async (path) => validateBytes(new Uint8Array(await readFile(path)), options);
console.log(JSON.stringify(await Promise.all(process.argv.slice(2).map(report))));
