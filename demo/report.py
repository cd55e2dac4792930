"""Shows the results of the demo: a table on the terminal, and a page beside the results.

    report.py FOLDER NAME... [--simulations NAME...] [--plans NAME...] [--haptics NAME...]

FOLDER has NAME.json (the result), NAME.svg (the gap over time), NAME.html (the page that plays it)
and NAME.txt (what the tool said). Of a simulation there are NAME.jsonl (the run), NAME.txt and, where pages
were asked for, NAME.html. Of a plan there are NAME.json (the path), NAME.txt and NAME.html. A haptic session
has the files of a simulation, and NAME.svg (its forces over time).
"""

import html
import json
import pathlib
import re
import sys

UNITS = (("m", 1.0), ("mm", 1e-3), ("µm", 1e-6), ("nm", 1e-9))

COLUMNS = ("scene", "answer", "time", "triangles", "normal", "least gap")

WORDS = {"free": "Free", "contact": "Contact", "contact_at_start": "In contact at the start", "undecided": "Undecided"}


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


def plural(count: int, noun: str) -> str:
    return f"{count} {noun}{'' if count == 1 else 's'}"


def fact(result: dict) -> str:
    """What there is to know beside the verdict, in a line."""
    _, verdict, _, _, _, least_gap = row(result)
    if verdict == "free":
        return f"apart by {least_gap}" if least_gap.startswith(">") else f"closest {least_gap}" if least_gap else ""
    pair = " and ".join(result["pair"]) + " at " if result["pair"] else "after "
    return f"{pair}{result['time']:.4g} s"


def of_result(folder: pathlib.Path, name: str, result: dict) -> dict:
    """What the card of a scene says."""
    has_plot = (folder / f"{name}.svg").exists()
    return {"name": name, "title": result["id"], "kind": result["verdict"], "word": WORDS[result["verdict"]],
            "fact": fact(result), "tested": result["pair_counts"]["tested"],
            "warnings": len(result.get("warnings", [])), "data": f"{name}.json",
            "plot": f"{name}.svg" if has_plot else ""}


def of_run(folder: pathlib.Path, name: str, text: str, done: str) -> dict:
    """What the card of a simulation or of a haptic session says."""
    with open(folder / f"{name}.jsonl", encoding="utf-8") as run:
        title = json.loads(run.readline())["scene"]["id"]
        last = None
        steps = 0
        for line in run:
            steps += 1
            last = line
    seconds = json.loads(last)["time"] if last else 0.0
    proven = "jsonl: proven: " in text
    tested = next((line.split()[1] for line in text.splitlines() if line.split()[:1] == ["tested"]), None)
    return {"name": name, "title": title, "kind": "free" if proven else "undecided",
            "word": f"{done}, verified" if proven else done, "fact": f"{plural(steps, 'step')}, {seconds:.3g} s",
            "tested": int(tested) if tested else None, "warnings": text.count("warning:"), "data": f"{name}.jsonl",
            "plot": ""}


def of_session(folder: pathlib.Path, name: str, text: str) -> dict:
    force = re.search(r"force +at most (\S+ N)", text)
    facts = of_run(folder, name, text, "Felt")
    has_plot = (folder / f"{name}.svg").exists()
    return {**facts, "fact": facts["fact"] + (f", at most {force.group(1)}" if force else ""),
            "plot": f"{name}.svg" if has_plot else "", "plotted": "Forces over time"}


def of_plan(name: str, path: dict, text: str) -> dict:
    movers = path["moves"]
    moves = movers.get("robot") or movers.get("body") or " and ".join(movers["robots"])
    verified = "json: proven: " in text
    # What was not verified at all is as its planner proved it.
    others = re.search(r"json: (?!a path to the goal, proven edge by edge)", text)
    proven = verified or (not others and "json: a path to the goal, proven edge by edge" in text)
    tested = next((line.split()[1] for line in text.splitlines() if line.split()[:1] == ["tested"]), None)
    clearance = f", apart by > {length(path['clearance'])}" if path["clearance"] else ""
    return {"name": name, "title": f"A path of {moves}", "kind": "free" if proven else "undecided",
            "word": "Planned, verified" if verified else "Planned, proven" if proven else "Planned",
            "fact": plural(len(path["edges"]), "edge") + clearance,
            "tested": int(tested) if tested else None, "warnings": text.count("warning "), "data": f"{name}.json",
            "plot": ""}


def card(folder: pathlib.Path, facts: dict, text: str) -> str:
    name = facts["name"]
    title = html.escape(facts["title"])
    playable = (folder / f"{name}.html").exists()
    plot = f'<img class="plot" src="{facts["plot"]}" alt="">' if facts["plot"] else ""
    picture = f'<span class="picture" data-page="{name}.html">{plot}</span>' if playable else plot
    top = f'<a href="{name}.html" title="Play {title}">{picture}</a>' if playable else picture
    worth = [plural(facts["tested"], "pair") + " tested"] if facts["tested"] is not None else []
    worth += [f'<em>⚠ {plural(facts["warnings"], "warning")}</em>'] if facts["warnings"] else []
    links = [f'<a href="{name}.html">Play</a>'] if playable else []
    links += [f'<a href="{facts["plot"]}">{facts.get("plotted", "Gap over time")}</a>'] if facts["plot"] else []
    links += [f'<a href="{facts["data"]}">{facts["data"]}</a>']
    return f"""<article id="{name}" data-kind="{facts["kind"]}">
{top}
<div class="words">
<h3>{title}</h3>
<p><strong>{facts["word"]}</strong> {html.escape(facts["fact"])}</p>
<p class="worth">{" · ".join(worth)}</p>
<p>{" · ".join(links)}</p>
<details><summary>What the tool says</summary><pre>{html.escape(text.strip())}</pre></details>
</div>
</article>"""


def main(folder: pathlib.Path, names: list, simulations: list, plans: list, sessions: list) -> int:
    names = [name for name in names if (folder / f"{name}.json").exists()]
    results = [json.loads((folder / f"{name}.json").read_text(encoding="utf-8")) for name in names]
    print(terminal_table([row(result) for result in results]) + "\n")
    for result in results:
        if "sampling" in result:
            print(sampling_note(result))

    def said(name: str) -> str:
        return (folder / f"{name}.txt").read_text(encoding="utf-8")

    scenes = [card(folder, of_result(folder, name, result), said(name)) for name, result in zip(names, results)]
    runs = [card(folder, of_run(folder, name, said(name), "Simulated"), said(name)) for name in simulations
            if (folder / f"{name}.jsonl").exists()]
    felt = [card(folder, of_session(folder, name, said(name)), said(name)) for name in sessions
            if (folder / f"{name}.jsonl").exists()]
    plans = [name for name in plans if (folder / f"{name}.json").exists()]
    paths = [card(folder, of_plan(name, json.loads((folder / f"{name}.json").read_text(encoding="utf-8")), said(name)),
                  said(name)) for name in plans]
    page = (pathlib.Path(__file__).parent / "index_template.html").read_text(encoding="utf-8")
    (folder / "index.html").write_text(page.replace("<!-- scenes -->", "\n".join(scenes))
                                           .replace("<!-- plans -->", "\n".join(paths))
                                           .replace("<!-- sessions -->", "\n".join(felt))
                                           .replace("<!-- simulations -->", "\n".join(runs)), encoding="utf-8")
    print(f"\nPlots and results: {folder / 'index.html'}")
    return 0


if __name__ == "__main__":
    asked = {"names": [], "--simulations": [], "--plans": [], "--haptics": []}
    section = "names"
    for word in sys.argv[2:]:
        if word in asked:
            section = word
        else:
            asked[section].append(word)
    sys.exit(main(pathlib.Path(sys.argv[1]), *asked.values()))
