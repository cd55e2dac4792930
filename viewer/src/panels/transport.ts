/// Play, pause, scrub, and the gap over time above the slider.

import { element, icon, iconButton } from "../core/dom";
import { number, timeUnit } from "../core/format";
import { icons } from "../core/icons";
import type { Commands } from "../commands";
import type { Model } from "../model";
import { speeds } from "../player";

function slider(model: Model, { player }: Commands): HTMLElement {
  const input = element("input", {
    type: "range",
    min: 0,
    max: 1,
    step: "any",
    "aria-label": "Time",
  });
  const track = element("div.slider", {}, input);
  const unit = timeUnit(model.duration);
  input.addEventListener("input", () => player.seek(Number(input.value)));
  const percent = (t: number): string =>
    `${100 * Math.min(Math.max(player.window.shareOf(t), 0), 1)}%`;
  const place = (t: number): void => {
    input.value = String(t);
    track.style.setProperty("--done", percent(t));
  };
  player.t.subscribe((t) => {
    place(t);
    input.setAttribute(
      "aria-valuetext",
      `${number((t * model.duration) / unit.size, 5)} ${unit.name}`,
    );
  });
  const mark = element("span.contact-mark", { "aria-hidden": "true" });
  track.prepend(mark);
  player.window.shown.subscribe(({ from, to }) => {
    input.min = String(from);
    input.max = String(to);
    place(player.t.value);
    track.style.setProperty("--free", percent(model.provenUntil));
    const { contactTime } = model;
    mark.hidden = contactTime === null || contactTime < from || contactTime > to;
    mark.style.left = percent(contactTime ?? 0);
  });
  return track;
}

function speedChoice({ player }: Commands): HTMLElement {
  const choice = element(
    "select",
    { "aria-label": "Speed", title: "Speed: seconds of the scene for each second" },
    ...speeds.map((speed) => element("option", { value: speed }, `${speed}×`)),
  );
  choice.addEventListener("change", () => (player.speed.value = Number(choice.value)));
  player.speed.subscribe((speed) => (choice.value = String(speed)));
  return choice;
}

function playButton({ player }: Commands): HTMLElement {
  const button = iconButton(icons.play, "Play", "space", () => player.toggle());
  button.classList.add("play");
  player.playing.subscribe((playing) => {
    const label = playing ? "Pause" : "Play";
    button.setAttribute("aria-label", label);
    button.title = `${label} (space)`;
    button.replaceChildren(icon(playing ? icons.pause : icons.play));
  });
  return button;
}

function contactButton(model: Model, { commands }: Commands): HTMLElement {
  const none = model.contactTime === null;
  const button = element(
    "button.text-button",
    {
      type: "button",
      disabled: none,
      title: none ? "Nothing touches" : "To the first contact (Enter)",
    },
    icon(icons.contact),
    "First contact",
  );
  button.addEventListener("click", commands.toContact);
  return button;
}

/// The moment in seconds, and in the t that results or the steps that runs speak of.
function clock(model: Model, { player }: Commands): HTMLElement {
  const unit = timeUnit(model.duration);
  const now = element("span.now");
  const detail = element("span.detail");
  const digits = (x: number): string =>
    (x / unit.size).toFixed(decimals(model.duration / unit.size));
  player.t.subscribe((t) => {
    now.textContent = `${digits(t * model.duration)} ${unit.name}`;
    detail.textContent = model.run
      ? `step ${model.run.stepAt(t) + 1} of ${model.run.steps.length}`
      : `t = ${t.toFixed(6)}`;
  });
  return element("div.clock", { "aria-live": "off" }, now, detail);
}

/// Returns the number of decimals that gives about five digits.
const decimals = (size: number): number => Math.max(0, 4 - Math.floor(Math.log10(size)));

export function transport(model: Model, commands: Commands, chart: HTMLElement): HTMLElement {
  const { player } = commands;
  const loop = iconButton(
    icons.loop,
    "Repeat",
    "l",
    () => (player.loop.value = !player.loop.value),
  );
  player.loop.subscribe((on) => loop.setAttribute("aria-pressed", String(on)));
  return element(
    "footer.transport",
    {},
    chart,
    slider(model, commands),
    element(
      "div.controls",
      {},
      element(
        "div.tool-group",
        { role: "group", "aria-label": "Play" },
        iconButton(icons.start, "To the start", "Home", () => player.seek(0)),
        iconButton(icons.back, "Step back", "←", () => commands.commands.step(-1)),
        playButton(commands),
        iconButton(icons.forward, "Step forward", "→", () => commands.commands.step(1)),
        loop,
      ),
      ...(model.result && !model.path?.failed ? [contactButton(model, commands)] : []),
      clock(model, commands),
      speedChoice(commands),
    ),
  );
}
