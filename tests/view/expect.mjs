// Named checks; all run even if some fail.

const results = [];

/** Runs a check and prints its result. */
export async function check(id, what, act) {
  const begun = Date.now();
  try {
    const said = await act();
    results.push({ id, good: true });
    console.log(`ok   ${id.padEnd(7)} ${what}${said ? `: ${said}` : ''} (${((Date.now() - begun) / 1000).toFixed(1)} s)`);
  } catch (error) {
    results.push({ id, good: false });
    console.log(`FAIL ${id.padEnd(7)} ${what}: ${error.message.split('\n')[0]}`);
  }
}

/** Throws unless `holds`. */
export function expect(holds, message) {
  if (!holds) throw new Error(message);
}

/** Prints the total; true if all passed. */
export function sum() {
  const bad = results.filter((r) => !r.good);
  console.log(`${results.length} checks, ${bad.length} failed${bad.length ? `: ${bad.map((r) => r.id).join(', ')}` : ''}`);
  return bad.length === 0;
}
