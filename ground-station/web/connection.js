// The WebSocket that brings the snapshots. It comes back by itself.

const FIRST_RETRY_MS = 500;
const LAST_RETRY_MS = 5000;
/** Silence after which a connection is not live, and after which it is given up for a new one. */
const SILENT_MS = 2000;
const ABANDONED_MS = 10_000;
const WATCH_MS = 500;

/**
 * Opens the page's WebSocket, for ever.
 * @param onSnapshot called with every snapshot
 * @param onState called with "live"; or with "connecting" and, while a connection that is open says
 *   nothing, the seconds since the latest snapshot
 */
export function connect(onSnapshot, onState) {
  let retry = FIRST_RETRY_MS;
  let latest = performance.now();
  const open = () => {
    const socket = new WebSocket(`ws://${location.host}/ws`);
    const opened = performance.now();
    let over = false;
    const leave = () => {
      if (over) return;
      over = true;
      clearInterval(watch);
      onState('connecting');
      setTimeout(open, retry);
      retry = Math.min(2 * retry, LAST_RETRY_MS);
    };
    const watch = setInterval(() => {
      const now = performance.now();
      const silent = now - Math.max(opened, latest);
      if (silent > ABANDONED_MS) {
        socket.close();
        leave();
      } else if (silent > SILENT_MS) {
        onState('connecting', (now - latest) / 1000);
      }
    }, WATCH_MS);
    socket.addEventListener('message', (event) => {
      if (over) return;
      const snapshot = JSON.parse(event.data);
      retry = FIRST_RETRY_MS;
      latest = performance.now();
      onState('live');
      onSnapshot(snapshot);
    });
    socket.addEventListener('close', leave);
  };
  open();
}
