"""Shows the results of the demo: a table on the terminal, and a page beside the results.

    report.py FOLDER NAME... [--simulations NAME...]

FOLDER has NAME.json (the result), NAME.svg (the gap over time), NAME.html (the page that plays it)
and NAME.txt (what the tool said). Of a simulation there are NAME.jsonl (the run), NAME.txt and, where pages
were asked for, NAME.html.
"""

import html
import json
import pathlib
import sys

UNITS = (("m", 1.0), ("mm", 1e-3), ("µm", 1e-6), ("nm", 1e-9))

PAGE = """<!DOCTYPE html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>firstcontact: demo</title>
<style>
  body {{ font: 16px/1.5 Helvetica, Arial, sans-serif; color: #222; max-width: 860px; margin: 2em auto; padding: 0 1em; }}
  h2 {{ margin: 2.5em 0 .3em; font-size: 1.2em; }}
  img {{ width: 100%; border: 1px solid #dde3e7; }}
  pre {{ background: #f5f7f8; padding: .8em 1em; overflow-x: auto; font-size: 13px; line-height: 1.45; }}
  table {{ border-collapse: collapse; font-size: 14px; }}
  td, th {{ text-align: left; padding: .25em 1em .25em 0; border-bottom: 1px solid #dde3e7; vertical-align: top; }}
  .free {{ color: #2e7d32; font-weight: bold; }}
  .contact {{ color: #c0392b; font-weight: bold; }}
</style>
<h1>When do they touch for the first time?</h1>
<p>Green is proven free of contact, for every instant and not only for those that are drawn. The curve is the least
distance of any two bodies at single instants; it goes on after a contact, as if nothing stopped the bodies.</p>
{table}
{sections}
</html>
"""

SECTION = """<h2 id="{name}">{title}</h2>
<img src="{name}.svg" alt="The gap over time. {title}: {verdict}">
<pre>{text}</pre>
<p><a href="{name}.html">Play it</a> · <a href="{name}.json">{name}.json</a></p>
"""

SIMULATION = """<h2 id="{name}">{title}</h2>
<pre>{text}</pre>
<p>{links}</p>
"""

COLUMNS = ("scene", "answer", "time", "triangles", "normal", "least gap")


def length(metres: float) -> str:
    name, size = next(((n, s) for n, s in UNITS if abs(metres) >= s), UNITS[-1] if metres else UNITS[0])
    return f"{metres / size:.4g} {name}"


def row(result: dict) -> tuple:
    contact = result["contacts"][0] if result["contacts"] else None
    triangles = normal = least_gap = time = ""
    if result["verdict"] != "free":
        time = f"{result['time']:.6g} s"
    if contact:
        triangles = ", ".join(f"{body} {k}" for body, k in zip(contact["bodies"], contact["triangles"]))
        if contact["normal"]:
            normal = "({:.3f}, {:.3f}, {:.3f})".format(*(round(x, 3) + 0.0 for x in contact["normal"]))
    if "closest" in result:
        least_gap = length(result["closest"]["distance"])
    elif result["verdict"] == "free" and result["clearance"]:
        least_gap = "> " + length(result["clearance"])
    return result["id"], result["verdict"], time, triangles, normal, least_gap


def sampling_note(result: dict) -> str:
    seen = result["sampling"]
    return (f"{result['id']}: sampling {seen['rate']:g} times a second sees {seen['in_contact']} contacts in "
            f"{seen['samples']} samples; the least gap that it sees is {length(seen['least_distance'])}.")


def terminal_table(rows: list) -> str:
    widths = [max(len(line[k]) for line in [COLUMNS, *rows]) for k in range(len(COLUMNS))]
    lines = ["  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip()
             for line in [COLUMNS, *rows]]
    return "\n".join([lines[0], "-" * max(map(len, lines)), *lines[1:]])


def html_table(names: list, rows: list) -> str:
    head = "".join(f"<th>{column}</th>" for column in COLUMNS)
    body = ""
    for name, (title, verdict, *others) in zip(names, rows):
        cells = "".join(f"<td>{html.escape(cell)}</td>" for cell in others)
        body += (f'<tr><td><a href="#{name}">{html.escape(title)}</a></td>'
                 f'<td class="{verdict}">{verdict}</td>{cells}</tr>\n')
    return f"<table>\n<tr>{head}</tr>\n{body}</table>"


def section(folder: pathlib.Path, name: str, result: dict) -> str:
    text = (folder / f"{name}.txt").read_text(encoding="utf-8")
    return SECTION.format(name=name, title=html.escape(result["id"]), verdict=result["verdict"],
                          text=html.escape(text.strip()))


def simulation_section(folder: pathlib.Path, name: str) -> str:
    with open(folder / f"{name}.jsonl", encoding="utf-8") as run:
        title = json.loads(run.readline())["scene"]["id"]
    text = (folder / f"{name}.txt").read_text(encoding="utf-8")
    page = f'<a href="{name}.html">Play it</a> · ' if (folder / f"{name}.html").exists() else ""
    return SIMULATION.format(name=name, title=html.escape(title), text=html.escape(text.strip()),
                             links=f'{page}<a href="{name}.jsonl">{name}.jsonl</a>')


def main(folder: pathlib.Path, names: list, simulations: list) -> int:
    names = [name for name in names if (folder / f"{name}.json").exists()]
    results = [json.loads((folder / f"{name}.json").read_text(encoding="utf-8")) for name in names]
    rows = [row(result) for result in results]
    print(terminal_table(rows) + "\n")
    for result in results:
        if "sampling" in result:
            print(sampling_note(result))
    sections = "".join(section(folder, name, result) for name, result in zip(names, results))
    sections += "".join(simulation_section(folder, name) for name in simulations
                        if (folder / f"{name}.jsonl").exists())
    (folder / "index.html").write_text(PAGE.format(table=html_table(names, rows), sections=sections),
                                       encoding="utf-8")
    print(f"\nPlots and results: {folder / 'index.html'}")
    return 0


if __name__ == "__main__":
    asked = sys.argv[2:]
    split = asked.index("--simulations") if "--simulations" in asked else len(asked)
    sys.exit(main(pathlib.Path(sys.argv[1]), asked[:split], asked[split + 1:]))
