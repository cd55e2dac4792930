/// The moment in the address: #t=0.42 is a link to it.

import type { Player } from "./player";

/// t in [0, 1], if the address names one.
export function momentOf(hash: string): number | null {
  const text = new URLSearchParams(hash.replace(/^#/, "")).get("t");
  const t = text === null || text === "" ? NaN : Number(text);
  return t >= 0 && t <= 1 ? t : null;
}

/// Follows the address, and writes each moment that is stayed at into it.
export function linkMoments(player: Player): void {
  addEventListener("hashchange", () => {
    const t = momentOf(location.hash);
    if (t !== null) {
      player.seek(t);
    }
  });
  let timer = 0;
  const write = (): void => {
    if (!player.playing.value) {
      try {
        history.replaceState(null, "", `#t=${player.t.value}`);
      } catch {
        // Inside another page there may be no address to write to.
      }
    }
  };
  let first = true;
  player.t.subscribe(() => {
    if (!first) {
      clearTimeout(timer);
      timer = window.setTimeout(write, 200);
    }
    first = false;
  });
}
