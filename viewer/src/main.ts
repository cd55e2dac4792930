/// Puts the page together.

import "./style.css";
import type { Commands } from "./commands";
import { element } from "./core/dom";
import { Signal } from "./core/signal";
import { readPageData } from "./data/page_data";
import { Display } from "./display";
import { download, fileName } from "./export/download";
import { animationOf } from "./export/glb";
import { listenToKeys } from "./keyboard";
import { linkMoments, momentOf } from "./link";
import { Model } from "./model";
import { bodiesPanel } from "./panels/bodies";
import { contactsPanel } from "./panels/contacts";
import { GapChart } from "./panels/gap_chart";
import { helpDialog } from "./panels/help";
import { pairsPanel } from "./panels/pairs";
import { probePanel } from "./panels/probe";
import { summaryPanel } from "./panels/summary";
import { toolbar } from "./panels/toolbar";
import { transport } from "./panels/transport";
import { Player } from "./player";
import { Theme } from "./theme";
import { SceneView } from "./view/scene_view";
import { triad } from "./view/triad";

const narrow = "(max-width: 760px)";
const clickSlack = 4; // [px] A press that moves farther turns the view.

function listenToClicks(view: SceneView): void {
  let down: PointerEvent | null = null;
  view.canvas.addEventListener("pointerdown", (event) => (down = event));
  view.canvas.addEventListener("pointerup", (event) => {
    const moved = down ? Math.hypot(event.x - down.x, event.y - down.y) : Infinity;
    if (moved <= clickSlack && event.button === 0) {
      view.pick(event.x, event.y);
    }
  });
}

function notice(stage: HTMLElement, text: string): void {
  const bubble = element("p.notice", { role: "status" }, text);
  stage.append(bubble);
  setTimeout(() => bubble.remove(), 4000);
}

function start(model: Model): void {
  const title = model.result.id || "Scene";
  document.title = `${title} · firstcontact`;
  const theme = new Theme();
  const display = new Display();
  const player = new Player(model.duration, model.contactTime, momentOf(location.hash) ?? 0);
  const panelOpen = new Signal(!matchMedia(narrow).matches);
  const stage = element("main.stage");
  const app = element("div.app", {}, stage);
  document.body.append(app);

  const view = new SceneView(model, player, display, stage);
  const help = helpDialog(model.result.version);
  const firstContact = model.contacts[0];
  const commands: Commands = {
    player,
    display,
    commands: {
      fit: () => view.fitAll(),
      toContact: () => {
        player.toContact();
        if (firstContact) {
          view.showContacts(model.contacts);
          view.focusContact(firstContact);
        }
      },
      focusBody: (index) => {
        const body = model.bodies[index];
        if (body) {
          view.focusBody(body);
        }
      },
      savePicture: () => {
        view.draw();
        view.canvas.toBlob((blob) => blob && download(blob, fileName(title, "png")));
      },
      saveAnimation: () => {
        animationOf(model, view.bodies).then(
          (blob) => download(blob, fileName(title, "glb")),
          (error: unknown) => notice(stage, `The animation could not be made: ${String(error)}`),
        );
      },
      switchTheme: () => theme.flip(),
      togglePanel: () => (panelOpen.value = !panelOpen.value),
      help: () => help.showModal(),
    },
  };

  const chart = new GapChart(model, player, theme);
  const cards = [
    summaryPanel(model),
    probePanel(view, display, player),
    pairsPanel(model, view, player),
    bodiesPanel(model, view, display),
    contactsPanel(model, view, player),
  ].filter((card) => card !== null);
  stage.append(toolbar(commands, panelOpen), triad(view));
  app.append(element("aside.panel", { "aria-label": "Details" }, ...cards));
  app.append(transport(model, commands, chart.element), help);
  panelOpen.subscribe((open) => app.classList.toggle("panel-open", open));

  theme.name.subscribe(() => view.setColors(theme.color("stage"), theme.color("grid")));
  view.start();
  performance.mark("firstcontact:first-frame");
  chart.start();
  setTimeout(() => view.addEdges());
  listenToKeys(commands);
  listenToClicks(view);
  linkMoments(player);
  // For whoever embeds the page or asks it from the console.
  Object.assign(window, { firstcontact: { model, player, display, view } });
}

try {
  const text = document.getElementById("firstcontact-data")?.textContent ?? "";
  start(new Model(readPageData(text)));
} catch (error) {
  document.body.append(
    element("p.failure", { role: "alert" }, error instanceof Error ? error.message : String(error)),
  );
}
