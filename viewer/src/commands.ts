/// What buttons and keys do.

import type { Display } from "./display";
import type { Player } from "./player";

export interface Commands {
  readonly player: Player;
  readonly display: Display;
  readonly commands: {
    /// Coarse or fine steps in time; the coarse ones of a run are its own.
    readonly step: (direction: 1 | -1, fine?: boolean) => void;
    readonly fit: () => void;
    readonly toContact: () => void;
    readonly focusBody: (index: number) => void;
    readonly savePicture: () => void;
    readonly saveAnimation: () => void;
    readonly switchTheme: () => void;
    readonly togglePanel: () => void;
    readonly help: () => void;
  };
}
