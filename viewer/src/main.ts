/// Puts the page together.

import "./style.css";
import type { Commands } from "./commands";
import { element, iconButton } from "./core/dom";
import { icons } from "./core/icons";
import { Signal } from "./core/signal";
import { readPageData } from "./data/page_data";
import { readResultList, type ResultList } from "./data/result_list";
import { Display } from "./display";
import { download, fileName } from "./export/download";
import { animationOf } from "./export/glb";
import { listenToKeys } from "./keyboard";
import { linkMoments, momentOf, resultLink, resultOf } from "./link";
import { liveSession } from "./live";
import { startLive } from "./live_page";
import { isDrawn, Model, type Coordinate } from "./model";
import { bodiesPanel } from "./panels/bodies";
import { contactsPanel } from "./panels/contacts";
import { gapContent } from "./panels/gap_chart";
import { helpDialog } from "./panels/help";
import { jointContent, type Shown } from "./panels/joint_chart";
import { jointsPanel } from "./panels/joints";
import { pairsPanel } from "./panels/pairs";
import { pathPanel } from "./panels/path";
import { probePanel } from "./panels/probe";
import { resultTable } from "./panels/result_table";
import { runPanel } from "./panels/run";
import { runCharts, runChartsPanel, type RunChart } from "./panels/run_charts";
import { stepContactsPanel, stepImpactsPanel, stepPanel, stepTiesPanel } from "./panels/step";
import { summaryPanel } from "./panels/summary";
import { TimeChart, type ChartContent } from "./panels/time_chart";
import { toolbar } from "./panels/toolbar";
import { transport } from "./panels/transport";
import { filesPanel } from "./panels/files";
import { verdictBadge } from "./panels/verdict";
import { warningsPanel } from "./panels/warnings";
import { sendPicture, wantsPicture } from "./picture";
import { Player } from "./player";
import { Theme } from "./theme";
import { SceneView } from "./view/scene_view";
import { triad } from "./view/triad";

const narrow = "(max-width: 760px)";
const shortRun = 0.5; // [s] In real time nothing would be seen of it.
const coarseStep = 1 / 100;
const fineStep = 1 / 1000;
const clickSlack = 4; // [px] A press that moves farther turns the view.

/// A click on an edge of a planned path goes to its start; another one is for the probe.
function listenToClicks(view: SceneView, { path }: Model, player: Player): void {
  let down: PointerEvent | null = null;
  view.canvas.addEventListener("pointerdown", (event) => (down = event));
  view.canvas.addEventListener("pointerup", (event) => {
    const moved = down ? Math.hypot(event.x - down.x, event.y - down.y) : Infinity;
    if (moved <= clickSlack && event.button === 0) {
      const edge = view.edgeAt(event.x, event.y);
      const begin = edge === null ? undefined : path?.data.edges[edge]?.t[0];
      if (begin === undefined) {
        view.pick(event.x, event.y);
      } else {
        player.seek(begin);
      }
    }
  });
}

function notice(stage: HTMLElement, text: string): void {
  const bubble = element("p.notice", { role: "status" }, text);
  stage.append(bubble);
  setTimeout(() => bubble.remove(), 4000);
}

/// Shows one of several results, with a way back to their list.
function startOne(list: ResultList, index: number): void {
  const page = list.pageOf(index)!;
  document.body.replaceChildren();
  start(new Model(page), index);
  const back = iconButton(icons.list, "Back to the list", null, () => {
    location.hash = "";
  });
  const group = element("div.tool-group", { role: "group", "aria-label": "Results" }, back);
  document.querySelector(".toolbar")!.prepend(group);
}

function showList(list: ResultList): void {
  document.title = `${list.summaries.length} results · firstcontact`;
  new Theme();
  const table = resultTable(list, (index) => {
    location.hash = resultLink(index);
  });
  document.body.append(table);
  const go = (): void => {
    const index = resultOf(location.hash);
    if (index !== null && list.canPlay(index)) {
      removeEventListener("hashchange", go);
      startOne(list, index);
    }
  };
  addEventListener("hashchange", go);
  go();
}

/// @param result  the index of the model's, of several
function start(model: Model, result: number | null = null): void {
  document.title = `${model.title} · firstcontact`;
  const theme = new Theme();
  const display = new Display();
  display.trees.value = model.path?.failed === true;
  const player = new Player(model.duration, model.contactTime, momentOf(location.hash) ?? 0);
  if (model.run && model.duration > shortRun) {
    player.speed.value = 1; // Real time.
  }
  const panelOpen = new Signal(!matchMedia(narrow).matches);
  const stage = element("main.stage");
  const app = element("div.app", {}, stage);
  document.body.append(app);

  const view = new SceneView(model, player, display, stage);
  const help = helpDialog(model.version);
  const firstContact = model.contacts[0];
  const commands: Commands = {
    player,
    display,
    commands: {
      step: (direction, fine = false) =>
        model.run && !fine
          ? player.seek(model.run.neighbour(player.t.value, direction))
          : player.step(
              direction *
                (fine ? (model.run?.fineStep(player.t.value, fineStep) ?? fineStep) : coarseStep),
            ),
      fit: () => view.fitAll(),
      toContact: () => {
        player.toContact();
        if (firstContact) {
          view.showContacts(model.contacts, model.contactTime);
          view.focusContact(firstContact);
        }
      },
      focusBody: (index) => {
        const body = model.bodies[index];
        if (body && isDrawn(body)) {
          view.focusBodies([body]);
        }
      },
      savePicture: () => {
        view.draw();
        view.canvas.toBlob((blob) => blob && download(blob, fileName(model.title, "png")));
      },
      saveAnimation: () => {
        animationOf(model, view.bodies).then(
          (blob) => download(blob, fileName(model.title, "glb")),
          (error: unknown) => notice(stage, `The animation could not be made: ${String(error)}`),
        );
      },
      switchTheme: () => theme.flip(),
      togglePanel: () => (panelOpen.value = !panelOpen.value),
      help: () => help.showModal(),
    },
  };

  const joint = new Signal<Coordinate | null>(null);
  const charts = model.run ? runCharts(model.run, model.devices) : [];
  const shownChart = new Signal<RunChart | null>(charts[0] ?? null);
  const content = new Signal<ChartContent | null>(null);
  const ofJoint = new Signal<Shown>("position");
  const showJoint = (): void => {
    const close = (): void => void (joint.value = null);
    const pick = (next: Shown): void => void (ofJoint.value = next);
    content.value = joint.value
      ? jointContent(joint.value, model.duration, { shown: ofJoint.value, close, pick })
      : gapContent(model);
  };
  joint.subscribe(showJoint);
  ofJoint.subscribe(showJoint);
  shownChart.subscribe((one) => {
    if (one) {
      content.value = one.content;
    }
  });
  const chart = new TimeChart(model, player, theme, content);
  const cards = [
    ...(model.result ? [summaryPanel(model, model.result)] : []),
    ...(model.run ? [runPanel(model, model.run)] : []),
    ...(model.path ? [pathPanel(model.path, model.grain, player)] : []),
    warningsPanel(model),
    probePanel(view, display, player),
    ...(model.run
      ? [stepPanel(model, model.run, player), runChartsPanel(model.run, charts, player, shownChart)]
      : []),
    pairsPanel(model, view, player),
    contactsPanel(model, view, player),
    jointsPanel(model, player, joint),
    bodiesPanel(model, view, display),
    model.run && stepContactsPanel(model, model.run, view, player),
    ...(model.run ? stepTiesPanel(model, model.run, view, player) : []),
    ...(model.run ? stepImpactsPanel(model, model.run, view, player) : []),
    filesPanel(model),
  ].filter((card) => card !== null);
  stage.append(toolbar(model, commands, panelOpen), triad(view), verdictBadge(model, panelOpen));
  app.append(element("aside.panel", { "aria-label": "Details" }, ...cards));
  app.append(...(model.isStill ? [] : [transport(model, commands, chart.element)]), help);
  panelOpen.subscribe((open) => app.classList.toggle("panel-open", open));

  theme.name.subscribe(() => view.setColors(theme.color("stage"), theme.color("grid")));
  view.start();
  performance.mark("firstcontact:first-frame");
  chart.start();
  setTimeout(() => view.addEdges());
  listenToKeys(model, commands);
  listenToClicks(view, model, player);
  linkMoments(player, result);
  // For whoever embeds the page or asks it from the console.
  Object.assign(window, { firstcontact: { model, player, display, view } });
}

try {
  const text = document.getElementById("firstcontact-data")?.textContent ?? "";
  const list = readResultList(text);
  const live = liveSession();
  if (list) {
    showList(list);
  } else if (wantsPicture(location.hash)) {
    sendPicture(new Model(readPageData(text)));
  } else if (live !== null) {
    startLive(new Model(readPageData(text)), live);
  } else {
    start(new Model(readPageData(text)));
  }
} catch (error) {
  document.body.append(
    element("p.failure", { role: "alert" }, error instanceof Error ? error.message : String(error)),
  );
}
