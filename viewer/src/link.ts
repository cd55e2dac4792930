/// The moment in the address: #t=0.42 is a link to it.

import type { Player } from "./player";

/// t in [0, 1], if the address names one.
export function momentOf(hash: string): number | null {
  const text = new URLSearchParams(hash.replace(/^#/, "")).get("t");
  const t = text === null || text === "" ? NaN : Number(text);
  return t >= 0 && t <= 1 ? t : null;
}

/// The index of the result that an address names, counted from 1 there; null if it names none.
export function resultOf(hash: string): number | null {
  const index = Number(new URLSearchParams(hash.replace(/^#/, "")).get("result")) - 1;
  return Number.isInteger(index) && index >= 0 ? index : null;
}

export const resultLink = (index: number): string => `result=${index + 1}`;

/// Follows the address, and writes each moment that is stayed at into it.
///
/// @param result  the index of the one that is shown, of several
export function linkMoments(player: Player, result: number | null): void {
  const before = result === null ? "" : `${resultLink(result)}&`;
  addEventListener("hashchange", () => {
    if (resultOf(location.hash) !== result) {
      location.reload();
    }
    const t = momentOf(location.hash);
    if (t !== null) {
      player.seek(t);
    }
  });
  let timer = 0;
  const write = (): void => {
    if (!player.playing.value) {
      try {
        history.replaceState(null, "", `#${before}t=${player.t.value}`);
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
