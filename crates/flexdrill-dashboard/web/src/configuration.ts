// Numbers of the run's configuration, which comes with the session as YAML in block style.

/**
 * The scalar at `path`, such as `stick_slip.levels.watch`; NaN where there is none or it is no number. Reads nested
 * mappings only, which is all that the page needs.
 */
export function configured(yaml: string, path: string): number {
  const keys = path.split(".");
  let depth = 0;
  let indents: number[] = [-1];
  for (const line of yaml.split("\n")) {
    const match = /^( *)([A-Za-z_][A-Za-z0-9_]*):(?: +(.*))?$/.exec(line);
    if (!match) continue;
    const indent = match[1].length;
    while (depth > 0 && indent <= indents[depth]) depth--;
    indents = indents.slice(0, depth + 1);
    if (match[2] !== keys[depth]) continue;
    // Nested deeper than its parent, but below another mapping that is not on the path.
    if (indent !== (depth === 0 ? 0 : indents[depth] + 2)) continue;
    if (depth === keys.length - 1) {
      const value = Number(match[3]);
      return match[3] === undefined || match[3].trim() === "" || Number.isNaN(value) ? NaN : value;
    }
    depth++;
    indents.push(indent);
  }
  return NaN;
}
