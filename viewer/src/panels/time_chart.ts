/// The large chart over time, above the slider. It shades the time that is proven free. A click
/// goes to its moment.

import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { element, iconButton } from "../core/dom";
import { number, timeUnit, type Unit } from "../core/format";
import { icons } from "../core/icons";
import type { Signal } from "../core/signal";
import type { Model } from "../model";
import type { Player } from "../player";
import type { Theme } from "../theme";

export const chartLeft = 52; // [px] The slider below begins there too.
export const chartRight = 14;

/// A polyline over t in [0, 1]. Colours are those of the style sheet, by name.
export interface ChartLine {
  readonly t: readonly number[];
  readonly value: readonly number[];
  readonly color: string;
  readonly width: number;
  readonly fill?: string;
  /// Shown beside the title, where there are several.
  readonly label?: string;
  /// Its values are those of the stretches that end at its times.
  readonly stepped?: boolean;
}

/// A stretch of t in [0, 1] with a colour of its own.
export interface ChartBand {
  readonly from: number;
  readonly to: number;
  readonly color: string;
}

/// Another content that the chart may show in its place.
export interface ChartChoice {
  readonly name: string;
  readonly isShown: boolean;
  readonly pick: () => void;
}

/// The content of a chart, in its unit.
export interface ChartContent {
  readonly title: string;
  readonly unit: string;
  readonly range: readonly [number, number];
  /// By powers of ten.
  readonly logarithmic?: boolean;
  readonly lines: readonly ChartLine[];
  /// Drawn across all of the time.
  readonly levels: readonly number[];
  readonly bands: readonly ChartBand[];
  /// Contents of which one is shown.
  readonly choices?: readonly ChartChoice[];
  /// Returns to the content that was shown before.
  readonly close?: () => void;
}

const wheelZoom = 0.002; // By pixels of the wheel.
const wheelMove = 0.0005;

/// Clips all later drawing to the plot area of the chart, plus half a line width.
function clipTo(ctx: CanvasRenderingContext2D, { left, top, width, height }: uPlot.BBox): void {
  const edge = devicePixelRatio;
  ctx.beginPath();
  ctx.rect(left - edge, top, width + 2 * edge, height);
  ctx.clip();
}

function choiceButton({ name, isShown, pick }: ChartChoice): HTMLElement {
  const button = element(
    "button.chart-choice",
    { type: "button", "aria-pressed": String(isShown) },
    name,
  );
  button.addEventListener("click", pick);
  return button;
}

export class TimeChart {
  readonly element = element("div.chart", { "aria-label": "Chart over time", role: "figure" });
  private plot: uPlot | null = null;
  private readonly unit: Unit;

  constructor(
    private readonly model: Model,
    private readonly player: Player,
    private readonly theme: Theme,
    private readonly content: Signal<ChartContent | null>,
  ) {
    this.unit = timeUnit(model.duration);
    content.subscribe((value) => (this.element.hidden = value === null));
  }

  /// Once the element has a size.
  start(): void {
    this.theme.name.subscribe(() => this.make());
    this.content.subscribe(() => this.make());
    this.player.t.subscribe(() => this.plot?.redraw(false));
    this.player.window.shown.subscribe(() => this.zoom());
    new ResizeObserver(() => this.plot?.setSize(this.size())).observe(this.element);
  }

  private get timeRange(): [number, number] {
    const { from, to } = this.player.window.shown.value;
    const whole = this.model.duration / this.unit.size;
    return [from * whole, to * whole];
  }

  private zoom(): void {
    const [min, max] = this.timeRange;
    this.plot?.setScale("x", { min, max });
  }

  private size(): { width: number; height: number } {
    return { width: this.element.clientWidth, height: this.element.clientHeight };
  }

  private make(): void {
    this.plot?.destroy();
    this.plot = null;
    this.element.replaceChildren();
    const { value: content } = this.content;
    if (content === null) {
      return;
    }
    const { theme } = this;
    const axis = {
      stroke: theme.color("text-soft"),
      grid: { stroke: theme.color("chart-grid"), width: 1 },
      ticks: { show: false },
      font: "11px system-ui, sans-serif",
    };
    // Of a logarithmic axis some have no number, for lack of room.
    const values = (_: uPlot, splits: (number | null)[]): string[] =>
      splits.map((x) => (x === null ? "" : number(x)));
    const series = content.lines.map(({ color, width, fill, stepped }): uPlot.Series => ({
      spanGaps: true,
      points: { show: false },
      stroke: theme.color(color),
      width,
      ...(fill ? { fill: theme.color(fill) } : {}),
      ...(stepped ? { paths: uPlot.paths.stepped!({ align: -1 }) } : {}),
    }));
    this.plot = new uPlot(
      {
        ...this.size(),
        pxAlign: 0,
        padding: [20, chartRight, 0, 0],
        legend: { show: false },
        cursor: { y: false, drag: { x: false, y: false }, points: { show: false } },
        scales: {
          x: { time: false, range: () => this.timeRange },
          y: { range: [...content.range], distr: content.logarithmic ? 3 : 1 },
        },
        axes: [
          { ...axis, size: 24, gap: 3, values },
          { ...axis, size: chartLeft, gap: 6, values, space: 26 },
        ],
        series: [{}, ...series],
        hooks: {
          drawClear: [(plot) => this.shade(plot, content)],
          draw: [(plot) => this.mark(plot, content)],
        },
      },
      this.dataOf(content),
      this.element,
    );
    const unit = content.unit ? ` [${content.unit}]` : "";
    const labels = content.lines
      .filter(({ label }) => label)
      .map(({ label, color }) =>
        element("span.chart-label", { style: `--line-color:var(--${color})` }, label!),
      );
    const title = element("span.chart-title", {}, `${content.title}${unit}`, ...labels);
    title.append(...(content.choices ?? []).map(choiceButton));
    if (content.close) {
      const close = iconButton(icons.close, "Back to the gap", null, content.close);
      close.classList.add("chart-close");
      title.append(close);
    }
    this.element.append(title);
    this.element.append(
      element("span.chart-unit", {}, ...this.zoomButtons(), `time [${this.unit.name}]`),
    );
    this.followPointer(this.plot);
  }

  /// The lines, each at times of its own.
  private dataOf({ lines }: ChartContent): uPlot.AlignedData {
    const seconds = (t: number): number => (t * this.model.duration) / this.unit.size;
    return uPlot.join(lines.map(({ t, value }): uPlot.AlignedData => [t.map(seconds), [...value]]));
  }

  private zoomButtons(): HTMLElement[] {
    const { player } = this;
    const zoom = (factor: number) => () => player.window.zoom(player.t.value, factor);
    const all = iconButton(icons.whole, "All of the time", "0", () => player.window.showAll());
    player.window.shown.subscribe(() => (all.hidden = player.window.isWhole));
    return [
      all,
      iconButton(icons.minus, "More of the time", "-", zoom(0.5)),
      iconButton(icons.plus, "Less of the time", "+", zoom(2)),
    ];
  }

  private followPointer({ over }: uPlot): void {
    const { window } = this.player;
    const momentOf = ({ clientX }: MouseEvent): number => {
      const box = over.getBoundingClientRect();
      return window.at((clientX - box.left) / box.width);
    };
    const seek = (event: PointerEvent): void => this.player.seek(momentOf(event));
    over.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        const sideways = event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY);
        const by = event.deltaY + event.deltaX;
        if (sideways) {
          window.move(wheelMove * by);
        } else {
          window.zoom(momentOf(event), Math.exp(-wheelZoom * by));
        }
      },
      { passive: false },
    );
    over.addEventListener("dblclick", () => window.showAll());
    over.style.touchAction = "none";
    over.addEventListener("pointerdown", (event) => {
      over.setPointerCapture(event.pointerId);
      seek(event);
    });
    over.addEventListener("pointermove", (event) => {
      if (over.hasPointerCapture(event.pointerId)) {
        seek(event);
      }
    });
  }

  /// Shades the time that is proven free, the time after it, and the bands of the content.
  private shade({ ctx, bbox }: uPlot, { bands }: ChartContent): void {
    const t = this.model.provenUntil;
    const all = [
      { from: 0, to: t, color: "chart-proven" },
      { from: t, to: 1, color: "chart-after" },
      ...bands,
    ];
    const { window } = this.player;
    ctx.save();
    clipTo(ctx, bbox);
    for (const { from, to, color } of all) {
      ctx.fillStyle = this.theme.color(color);
      const [left, right] = [window.shareOf(from), window.shareOf(to)];
      const width = Math.max(bbox.width * (right - left), to > from ? devicePixelRatio : 0);
      ctx.fillRect(bbox.left + bbox.width * left, bbox.top, width, bbox.height);
    }
    ctx.restore();
  }

  private mark(plot: uPlot, { levels }: ChartContent): void {
    const { ctx, bbox } = plot;
    const line = (x1: number, y1: number, x2: number, y2: number, color: string, width: number) => {
      ctx.strokeStyle = this.theme.color(color);
      ctx.lineWidth = width * devicePixelRatio;
      ctx.beginPath();
      ctx.moveTo(x1, y1);
      ctx.lineTo(x2, y2);
      ctx.stroke();
    };
    const x = (t: number): number => bbox.left + bbox.width * this.player.window.shareOf(t);
    const bottom = bbox.top + bbox.height;
    ctx.save();
    clipTo(ctx, bbox);
    ctx.setLineDash([5 * devicePixelRatio, 4 * devicePixelRatio]);
    for (const level of levels) {
      const y = plot.valToPos(level, "y", true);
      line(bbox.left, y, bbox.left + bbox.width, y, "undecided", 1.2);
    }
    ctx.setLineDash([]);
    if (this.model.contactTime !== null) {
      line(x(this.model.contactTime), bbox.top, x(this.model.contactTime), bottom, "contact", 1.5);
    }
    line(x(this.player.t.value), bbox.top, x(this.player.t.value), bottom, "text", 1.5);
    ctx.restore();
  }
}
