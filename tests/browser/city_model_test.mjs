// The 3-D models that `cuscus city --out` writes have no fault that Khronos' validator knows.
// node city_model_test.mjs PATH/TO/cuscus

import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import path from 'node:path';

const skipped = 77;
let validator;
try {
  validator = createRequire(import.meta.url)('gltf-validator');
} catch {
  console.log('SKIPPED: gltf-validator is not installed (npm ci)');
  process.exit(skipped);
}

const cuscus = process.argv[2];
const folder = mkdtempSync(path.join(tmpdir(), 'cuscus-model-'));
try {
  for (const style of ['old-town', 'grid']) {
    const map = path.join(folder, `${style}.osm`);
    const model = path.join(folder, `${style}.glb`);
    execFileSync(cuscus, ['city', 'generate', style, '--seed', '7', '--out', map]);
    execFileSync(cuscus, ['city', map, '--out', model]);
    const report = await validator.validateBytes(new Uint8Array(readFileSync(model)));
    const {numErrors, numWarnings, messages} = report.issues;
    if (numErrors + numWarnings > 0 || report.info.totalTriangleCount < 1000) {
      throw new Error(`${style}: ${JSON.stringify(messages.slice(0, 5))}, ` +
          `${report.info.totalTriangleCount} triangles`);
    }
    console.log(`${style}: ${report.info.totalTriangleCount} triangles, no fault`);
  }
} finally {
  rmSync(folder, {recursive: true});
}
