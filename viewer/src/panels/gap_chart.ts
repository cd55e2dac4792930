/// The gap over time. What is proven free is shaded; a click goes to its moment.

import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { element } from "../core/dom";
import { lengthUnit, number, timeUnit, type Unit } from "../core/format";
import type { GapLine } from "../data/page_data";
import type { Model } from "../model";
import type { Player } from "../player";
import type { Theme } from "../theme";

export const chartLeft = 52; // [px] The slider below begins there too.
export const chartRight = 14;

interface ChartUnits {
  readonly time: Unit;
  readonly gap: Unit;
}

function unitsOf(model: Model): ChartUnits {
  return {
    time: timeUnit(model.duration),
    gap: lengthUnit(Math.max(...model.gap.distance, 0)),
  };
}

/// The samples and the proven bound, each at times of its own.
function dataOf({ gap, gapBound, duration }: Model, units: ChartUnits): uPlot.AlignedData {
  const line = ({ t, distance }: GapLine): uPlot.AlignedData => [
    t.map((at) => (at * duration) / units.time.size),
    distance.map((d) => d / units.gap.size),
  ];
  return uPlot.join([line(gap), line(gapBound)]);
}

export class GapChart {
  readonly element = element("div.chart", { "aria-label": "Gap over time", role: "figure" });
  private plot: uPlot | null = null;
  private readonly units: ChartUnits;

  constructor(
    private readonly model: Model,
    private readonly player: Player,
    private readonly theme: Theme,
  ) {
    this.units = unitsOf(model);
    this.element.hidden = model.gap.t.length < 2;
  }

  /// Once the element has a size.
  start(): void {
    if (this.element.hidden) {
      return;
    }
    this.theme.name.subscribe(() => this.make());
    this.player.t.subscribe(() => this.plot?.redraw(false));
    new ResizeObserver(() => this.plot?.setSize(this.size())).observe(this.element);
  }

  private size(): { width: number; height: number } {
    return { width: this.element.clientWidth, height: this.element.clientHeight };
  }

  private make(): void {
    this.plot?.destroy();
    const { theme, units } = this;
    const axis = {
      stroke: theme.color("text-soft"),
      grid: { stroke: theme.color("chart-grid"), width: 1 },
      ticks: { show: false },
      font: "11px system-ui, sans-serif",
    };
    const values = (_: uPlot, splits: number[]): string[] => splits.map((x) => number(x));
    const end = this.model.duration / units.time.size;
    const line = { spanGaps: true, points: { show: false } };
    const series: uPlot.Series[] = [
      {},
      { ...line, stroke: theme.color("accent"), width: 2 },
      { ...line, stroke: theme.color("proven"), fill: theme.color("chart-bound"), width: 1 },
    ];
    this.plot = new uPlot(
      {
        ...this.size(),
        padding: [20, chartRight, 0, 0],
        legend: { show: false },
        cursor: { y: false, drag: { x: false, y: false }, points: { show: false } },
        scales: {
          x: { time: false, range: [0, end] },
          y: { range: (_, __, greatest) => [0, 1.08 * (greatest || 1)] },
        },
        axes: [
          { ...axis, size: 24, gap: 3, values },
          { ...axis, size: chartLeft, gap: 6, values, space: 26 },
        ],
        series,
        hooks: { drawClear: [(plot) => this.shade(plot)], draw: [(plot) => this.mark(plot)] },
      },
      dataOf(this.model, units),
      this.element,
    );
    this.element.append(element("span.chart-title", {}, `gap [${units.gap.name}]`));
    this.element.append(element("span.chart-unit", {}, `time [${units.time.name}]`));
    this.followPointer(this.plot);
  }

  private followPointer({ over }: uPlot): void {
    const seek = (event: PointerEvent): void => {
      const box = over.getBoundingClientRect();
      this.player.seek((event.clientX - box.left) / box.width);
    };
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

  /// Proven free, and what lies after it.
  private shade({ ctx, bbox }: uPlot): void {
    const middle = bbox.left + bbox.width * this.model.result.t;
    ctx.save();
    ctx.fillStyle = this.theme.color("chart-proven");
    ctx.fillRect(bbox.left, bbox.top, middle - bbox.left, bbox.height);
    ctx.fillStyle = this.theme.color("chart-after");
    ctx.fillRect(middle, bbox.top, bbox.left + bbox.width - middle, bbox.height);
    ctx.restore();
  }

  private mark(plot: uPlot): void {
    const { ctx, bbox } = plot;
    const line = (x1: number, y1: number, x2: number, y2: number, color: string, width: number) => {
      ctx.strokeStyle = this.theme.color(color);
      ctx.lineWidth = width * devicePixelRatio;
      ctx.beginPath();
      ctx.moveTo(x1, y1);
      ctx.lineTo(x2, y2);
      ctx.stroke();
    };
    const x = (t: number): number => bbox.left + bbox.width * t;
    const bottom = bbox.top + bbox.height;
    ctx.save();
    if (this.model.contactTime !== null) {
      line(x(this.model.contactTime), bbox.top, x(this.model.contactTime), bottom, "contact", 1.5);
    }
    line(x(this.player.t.value), bbox.top, x(this.player.t.value), bottom, "text", 1.5);
    ctx.restore();
  }
}
