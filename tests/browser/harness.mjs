// page_harness as a child process: a ground station with a fleet around it.

import { spawn } from 'node:child_process';
import { createInterface } from 'node:readline';

/**
 * Starts the harness; gives {url, stop, pause, resume, abandon}: stop() ends the run and gives its
 * report, pause() lets the ground station stand still with its connections open.
 */
export async function startHarness(harness, gcs, ...options) {
  const child = spawn(harness, ['--gcs', gcs, ...options], { stdio: ['pipe', 'pipe', 'inherit'] });
  const lines = createInterface({ input: child.stdout })[Symbol.asyncIterator]();
  const next = async () => {
    const { value, done } = await lines.next();
    if (done) throw new Error('page_harness ended');
    return JSON.parse(value);
  };
  const { url, gcs_pid: gcsPid } = await next();
  return {
    url,
    pause: () => process.kill(gcsPid, 'SIGSTOP'),
    resume: () => process.kill(gcsPid, 'SIGCONT'),
    stop: async () => {
      child.stdin.end('stop\n');
      return next();
    },
    abandon: () => child.kill(),
  };
}
