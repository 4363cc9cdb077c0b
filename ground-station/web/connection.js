// The WebSocket that brings the snapshots. It comes back by itself.

const FIRST_RETRY_MS = 500;
const LAST_RETRY_MS = 5000;

/**
 * Opens the page's WebSocket, for ever.
 * @param onSnapshot called with every snapshot
 * @param onState called with "live" or "connecting"
 */
export function connect(onSnapshot, onState) {
  let retry = FIRST_RETRY_MS;
  const open = () => {
    const socket = new WebSocket(`ws://${location.host}/ws`);
    socket.addEventListener('message', (event) => {
      const snapshot = JSON.parse(event.data);
      retry = FIRST_RETRY_MS;
      onState('live');
      onSnapshot(snapshot);
    });
    socket.addEventListener('close', () => {
      onState('connecting');
      setTimeout(open, retry);
      retry = Math.min(2 * retry, LAST_RETRY_MS);
    });
  };
  open();
}
