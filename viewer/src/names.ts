/// Finds the part of a name that differs from other names.

/// A beginning that ends here may be shared.
const separator = /[_\-/.:\s]/g;

function beginningsOf(name: string): string[] {
  return [...name.matchAll(separator)]
    .map(({ index }) => name.slice(0, index + 1))
    .filter((beginning) => beginning.length < name.length);
}

/// Finds for each name the longest beginning that another name has, too.
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
