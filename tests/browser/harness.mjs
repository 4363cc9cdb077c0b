// page_harness as a child process: a ground station with a fleet around it.

import { spawn } from 'node:child_process';
import { createInterface } from 'node:readline';

/** Starts the harness; gives {url, stop}, where stop() ends the run and gives its report. */
export async function startHarness(harness, gcs, ...options) {
  const child = spawn(harness, ['--gcs', gcs, ...options], { stdio: ['pipe', 'pipe', 'inherit'] });
  const lines = createInterface({ input: child.stdout })[Symbol.asyncIterator]();
  const next = async () => {
    const { value, done } = await lines.next();
    if (done) throw new Error('page_harness ended');
    return JSON.parse(value);
  };
  const { url } = await next();
  return {
    url,
    pid: child.pid,
    stop: async () => {
      child.stdin.end('stop\n');
      return next();
    },
    abandon: () => child.kill(),
  };
}
