/// The bodies, and the links of robots: show, hide, look at one.

import { element, icon } from "../core/dom";
import { icons } from "../core/icons";
import type { Display } from "../display";
import { isDrawn, type Body, type Model } from "../model";
import type { SceneView } from "../view/scene_view";

const mostRows = 200;
const filterFrom = 12; // Bodies; fewer are seen at a glance.

interface Row {
  readonly bodies: readonly Body[];
  readonly name: string;
  readonly detail: string;
  readonly kind: "body" | "robot" | "link";
}

const rowOf = (body: Body): Row => ({
  bodies: [body],
  name: body.robot === null ? body.name : body.label,
  detail: body.kind,
  kind: body.robot === null ? "body" : "link",
});

/// Robots with their links come first, as the question is about them.
function rowsOf({ robots, bodies }: Model): Row[] {
  const shown = bodies.filter(isDrawn);
  const ofRobots = robots.flatMap((name, robot): Row[] => {
    const links = shown.filter((body) => body.robot === robot);
    const detail = `${links.length} links`;
    return [{ bodies: links, name, detail, kind: "robot" }, ...links.map(rowOf)];
  });
  return [...ofRobots, ...shown.filter(({ robot }) => robot === null).map(rowOf)];
}

export function bodiesPanel(model: Model, view: SceneView, display: Display): HTMLElement {
  const list = element("ul.rows");
  const more = element("p.hint", { hidden: true });
  const all = rowsOf(model);
  let eyes: { button: HTMLButtonElement; bodies: readonly Body[] }[] = [];

  let sliders: { slider: HTMLInputElement; index: number }[] = [];

  const isHidden = (bodies: readonly Body[]): boolean =>
    bodies.every(({ index }) => display.hidden.value.has(index));

  const eyeOf = ({ bodies, name }: Row): HTMLButtonElement => {
    const button = element(
      "button.icon-button.small",
      { type: "button", "aria-label": `Show ${name}`, title: `Show or hide ${name}` },
      icon(icons.eye),
    );
    const indices = bodies.map(({ index }) => index);
    button.addEventListener("click", () => display.setAllVisible(indices, isHidden(bodies)));
    eyes.push({ button, bodies });
    return button;
  };

  const sliderOf = ({ bodies, name }: Row): HTMLElement => {
    const indices = bodies.map(({ index }) => index);
    const title = `Opacity of ${name}`;
    const slider = element("input.opacity", {
      type: "range",
      min: 0.05,
      max: 1,
      step: 0.05,
      title,
      "aria-label": title,
    });
    slider.addEventListener("input", () => display.setOpacity(indices, Number(slider.value)));
    sliders.push({ slider, index: indices[0]! });
    return slider;
  };

  const rowElement = (row: Row): HTMLElement => {
    const { bodies, name, detail, kind } = row;
    const [first] = bodies;
    const key = bodies.length === 1 && first!.index < 9 ? ` (${first!.index + 1})` : "";
    const color = view.bodies[first?.index ?? 0]?.color ?? "";
    const button = element(
      "button.row-name",
      { type: "button", title: `Look at ${name}${key}` },
      element("span.swatch", { style: `background:${color}` }),
      element("span.name", {}, name),
      element("span.detail", {}, detail),
    );
    button.addEventListener("click", () => view.focusBodies(bodies));
    return element("li", { "data-kind": kind }, button, sliderOf(row), eyeOf(row));
  };

  const fill = (filter: string): void => {
    const found = all.filter(({ bodies, name }) =>
      [name, ...bodies.map((body) => body.name)].some((text) =>
        text.toLowerCase().includes(filter.toLowerCase()),
      ),
    );
    eyes = [];
    sliders = [];
    list.replaceChildren(...found.slice(0, mostRows).map(rowElement));
    more.hidden = found.length <= mostRows;
    more.textContent = `${found.length - mostRows} more; type to find one`;
    showHidden();
    showOpacities();
  };

  const showOpacities = (): void =>
    sliders.forEach(({ slider, index }) => {
      slider.value = String(display.opacityOf(index));
      slider.classList.toggle("changed", display.opacityOf(index) < 1);
    });

  const showHidden = (): void =>
    eyes.forEach(({ button, bodies }) => {
      button.setAttribute("aria-pressed", String(!isHidden(bodies)));
      button.replaceChildren(icon(isHidden(bodies) ? icons.hidden : icons.eye));
    });

  const search = element("input.filter", {
    type: "search",
    placeholder: "Find a body",
    "aria-label": "Find a body",
    hidden: all.length < filterFrom,
  });
  search.addEventListener("input", () => fill(search.value));
  fill("");
  display.hidden.subscribe(showHidden);
  display.opacities.subscribe(showOpacities);
  const title = model.robots.length > 0 ? "Robots and bodies " : "Bodies ";
  const count = String(model.bodies.filter(isDrawn).length);
  return element(
    "section.card",
    { "aria-label": "Bodies" },
    element("h2", {}, title, element("span.count", {}, count)),
    search,
    list,
    more,
  );
}
