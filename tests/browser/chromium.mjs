// Chromium for tests: Debian's own, driven by playwright-core, with a profile that is thrown away.

import { access, mkdtemp, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

export const EXIT_SKIPPED = 77;
const CHROMIUM = process.env.CUSCUS_CHROMIUM ?? '/usr/bin/chromium';
const TIMEOUT_MS = 60_000;

/** Why the browser tests cannot run here, or null. */
export async function missing() {
  try {
    await access(CHROMIUM);
  } catch {
    return `${CHROMIUM} is missing: apt-get install chromium`;
  }
  try {
    await import('playwright-core');
  } catch {
    return 'playwright-core is missing: npm ci in tests/browser';
  }
  return null;
}

/** Ends the process with EXIT_SKIPPED, saying why, when the tests cannot run here. */
export async function skipIfMissing() {
  const reason = await missing();
  if (reason) {
    console.log(`SKIPPED: ${reason}`);
    process.exit(EXIT_SKIPPED);
  }
}

/**
 * Opens a page and calls `body(page, complaints)`; `complaints` gathers what the page should never
 * produce: console errors, uncaught exceptions, violations of its content security policy,
 * failed requests, requests to other hosts.
 * @param options {url, colorScheme: "light" | "dark", width, height}
 */
export async function withPage({ url, colorScheme = 'light', width = 1440, height = 900 }, body) {
  const { chromium } = await import('playwright-core');
  const profile = await mkdtemp(join(tmpdir(), 'cuscus-chromium-'));
  try {
    const context = await chromium.launchPersistentContext(profile, {
      executablePath: CHROMIUM,
      headless: true,
      colorScheme,
      viewport: { width, height },
      timeout: TIMEOUT_MS,
      args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run',
        '--disable-background-networking', '--disable-component-update', '--disable-sync'],
    });
    try {
      context.setDefaultTimeout(TIMEOUT_MS);
      const page = context.pages()[0] ?? await context.newPage();
      const complaints = [];
      const { host } = new URL(url);
      page.on('console', (message) => {
        if (['error', 'warning'].includes(message.type())) complaints.push(`console: ${message.text()}`);
      });
      page.on('pageerror', (error) => complaints.push(`exception: ${error.message}`));
      page.on('requestfailed', (request) => complaints.push(`failed: ${request.url()}`));
      page.on('request', (request) => {
        if (new URL(request.url()).host !== host) complaints.push(`foreign: ${request.url()}`);
      });
      await page.addInitScript(() => {
        document.addEventListener('securitypolicyviolation', (event) => {
          console.error(`policy violation: ${event.violatedDirective} ${event.blockedURI}`);
        });
      });
      await page.goto(url, { waitUntil: 'load' });
      return await body(page, complaints);
    } finally {
      await context.close();
    }
  } finally {
    await rm(profile, { recursive: true, force: true, maxRetries: 5 });
  }
}
