/// The report on each file: what was read, and what was left out.

import { element } from "../core/dom";
import type { FileReport } from "../data/reports";
import type { Model } from "../model";

const mostRows = 100;

function lines({ format, contents, unit, left_out, warnings, also_read }: FileReport): string[] {
  const taken = [format, ...contents.map(({ what, count }) => `${count} ${what}`)].join(", ");
  const passedOver = (left_out ?? []).map(
    ({ name, reason, count }) => `${count} ${name} (${reason})`,
  );
  return [
    taken + (unit ? `; unit of lengths: ${unit}` : ""),
    ...(passedOver.length > 0 ? [`left out: ${passedOver.join(", ")}`] : []),
    ...(also_read ?? []).map((path) => `with: ${path}`),
    ...(warnings ?? []).map((warning) => `warning: ${warning}`),
  ];
}

const row = (report: FileReport): HTMLElement =>
  element(
    "li",
    {},
    element("span.file-path", {}, report.path),
    ...lines(report).map((line) => element("p.file-line", {}, line)),
  );

/// Null where no file was read. Closed at first: it is long.
export function filesPanel({ files }: Model): HTMLElement | null {
  if (files.length === 0) {
    return null;
  }
  const left = files.length - mostRows;
  return element(
    "section.card",
    { "aria-label": "Files" },
    element(
      "details",
      {},
      element(
        "summary",
        {},
        element("h2", {}, "Files ", element("span.count", {}, String(files.length))),
      ),
      element(
        "ul.files",
        {},
        ...files.slice(0, mostRows).map(row),
        ...(left > 0 ? [element("li", {}, `${left} more`)] : []),
      ),
    ),
  );
}
