"""Tables of measurements: printed, and written into docs/performance_tables.md."""

import re


def number(value):
    """A figure as people read it: thousands apart, three digits below a hundred."""
    if value is None:
        return "-"
    if isinstance(value, str):
        return value
    if isinstance(value, int) or abs(value) >= 100:
        return f"{value:,.0f}"
    return f"{value:.3g}"


class Report:
    """Prints each table as it comes, and keeps those that have a name for the page."""

    def __init__(self):
        self.tables = {}
        self.targets = []

    def table(self, name, title, header, rows):
        texts = [header] + [[number(cell) for cell in row] for row in rows]
        if name is not None:
            self.tables[name] = markdown(texts)
        widths = [max(len(row[i]) for row in texts) for i in range(len(header))]
        print(f"\n{title}\n")
        for i, row in enumerate(texts):
            cells = [cell.ljust(w) if k == 0 else cell.rjust(w) for k, (cell, w) in
                     enumerate(zip(row, widths))]
            print("  " + "  ".join(cells).rstrip())
            if i == 0:
                print("  " + "-" * (sum(widths) + 2 * len(widths) - 2))

    def at_most(self, name, value, limit, unit):
        self.target(name, value <= limit, f"{number(value)} {unit}", f"≤ {number(limit)} {unit}")

    def at_least(self, name, value, limit):
        self.target(name, value >= limit, number(value), f"≥ {number(limit)}")

    def target(self, name, met, value, limit):
        self.targets.append([name, value, limit, "met" if met else "**missed**"])

    def write_into(self, page):
        """Replaces the tables of a page whose names stand there as <!-- table NAME --> before and
        <!-- end --> after; the others stay as they are."""
        text = page.read_text()
        for name, table in self.tables.items():
            place = re.compile(rf"(<!-- table {re.escape(name)} -->\n).*?(<!-- end -->)", re.DOTALL)
            text, found = place.subn(lambda m, t=table: f"{m[1]}\n{t}\n{m[2]}", text)
            if found != 1:
                raise ValueError(f"{page}: expected <!-- table {name} --> once, found {found}")
        page.write_text(text)


def markdown(texts):
    header, *rows = texts
    lines = [header, ["---"] + ["---:"] * (len(header) - 1)] + rows
    return "".join("| " + " | ".join(line) + " |\n" for line in lines)
