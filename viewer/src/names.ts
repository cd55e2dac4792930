/// Which part of a name tells it from others.

/// A beginning that ends here may be shared.
const separator = /[_\-/.:\s]/g;

function beginningsOf(name: string): string[] {
  return [...name.matchAll(separator)]
    .map(({ index }) => name.slice(0, index + 1))
    .filter((beginning) => beginning.length < name.length);
}

/// Of each name, the longest beginning that another one has too: it tells nothing.
export function sharedBeginnings(names: readonly string[]): ReadonlyMap<string, string> {
  const counts = new Map<string, number>();
  const all = [...new Set(names)].map((name) => ({ name, beginnings: beginningsOf(name) }));
  for (const beginning of all.flatMap(({ beginnings }) => beginnings)) {
    counts.set(beginning, (counts.get(beginning) ?? 0) + 1);
  }
  return new Map(
    all.map(({ name, beginnings }) => [
      name,
      beginnings.filter((beginning) => counts.get(beginning)! > 1).at(-1) ?? "",
    ]),
  );
}
