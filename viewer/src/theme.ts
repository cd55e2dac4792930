/// Dark or light: as the system has it, until someone chooses.

import { Signal } from "./core/signal";

export type ThemeName = "dark" | "light";

const key = "firstcontact-theme";

/// Some browsers refuse storage to files, and to pages inside of others.
function remembered(): string | null {
  try {
    return localStorage.getItem(key);
  } catch {
    return null;
  }
}

function remember(theme: ThemeName): void {
  try {
    localStorage.setItem(key, theme);
  } catch {
    // Then it is chosen anew next time.
  }
}

export class Theme {
  readonly name: Signal<ThemeName>;

  constructor() {
    const system = matchMedia("(prefers-color-scheme: light)");
    const chosen = remembered();
    const start = chosen === "dark" || chosen === "light" ? chosen : null;
    this.name = new Signal<ThemeName>(start ?? (system.matches ? "light" : "dark"));
    if (start === null) {
      system.addEventListener(
        "change",
        ({ matches }) => (this.name.value = matches ? "light" : "dark"),
      );
    }
    this.name.subscribe((name) => (document.documentElement.dataset.theme = name));
  }

  flip(): void {
    this.name.value = this.name.value === "dark" ? "light" : "dark";
    remember(this.name.value);
  }

  /// A colour of the style sheet.
  color(name: string): string {
    return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
  }
}
