/// What buttons and keys do.

import type { Display } from "./display";
import type { Player } from "./player";

export interface Commands {
  readonly player: Player;
  readonly display: Display;
  readonly commands: {
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
