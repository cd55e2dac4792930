/// Elements in one expression.

type Attributes = Readonly<Record<string, string | number | boolean | null>>;
type Child = Node | string;

/// @param name  such as "button.play": an element with classes
export function element<K extends keyof HTMLElementTagNameMap>(
  name: K | `${K}.${string}`,
  attributes: Attributes = {},
  ...children: readonly Child[]
): HTMLElementTagNameMap[K] {
  const [tag, ...classes] = name.split(".") as [K, ...string[]];
  const made = document.createElement(tag);
  made.classList.add(...classes);
  for (const [key, value] of Object.entries(attributes)) {
    if (value !== null && value !== false) {
      made.setAttribute(key, value === true ? "" : String(value));
    }
  }
  made.append(...children);
  return made;
}

/// The drawing is decoration: the button around it has the name.
export function icon(path: string): SVGSVGElement {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "0 0 24 24");
  svg.setAttribute("aria-hidden", "true");
  svg.classList.add("icon");
  const drawing = document.createElementNS("http://www.w3.org/2000/svg", "path");
  drawing.setAttribute("d", path);
  svg.append(drawing);
  return svg;
}

/// A button with a drawing; `label` is its name for everyone, `key` the key that does the same.
export function iconButton(path: string, label: string, key: string | null, act: () => void) {
  const title = key ? `${label} (${key})` : label;
  const button = element(
    "button.icon-button",
    { type: "button", "aria-label": label, title },
    icon(path),
  );
  button.addEventListener("click", act);
  return button;
}
