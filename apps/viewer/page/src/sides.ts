// Which side of the body a label names, in the spellings of the programs that name markers and joints: LANK, Anna:LANK, LeftArm, HandLeft,
// l_knee, femur_r, Bip01 L Thigh, and lfemur where there is an rfemur too.

export type Side = "left" | "right" | null;

const side_named = (letter: string): Side => (letter[0].toLowerCase() === "l" ? "left" : "right");

/** What follows the subject's name, which stands before a colon. */
const bare = (label: string): string => label.slice(label.lastIndexOf(":") + 1).trim();

function spelt_out(name: string): Side {
  const found =
    /^(left|right)/i.exec(name) ??
    /[_. -](left|right)/i.exec(name) ??
    /[a-z0-9](Left|Right)(?![a-z])/.exec(name) ??
    /(?:^|[_. -])([lr])(?:$|[_. -])/i.exec(name) ??
    /(?:^|[_. -])([LR])[A-Z]/.exec(name);
  return found ? side_named(found[1]) : null;
}

/** The side of each of `labels`. */
export function sides_of(labels: string[]): Map<string, Side> {
  const names = new Set(labels.map((label) => bare(label).toLowerCase()));
  const as_its_twin = (name: string): Side => {
    const lower = name.toLowerCase();
    if (!/^[lr][a-z]{2}/.test(lower)) return null;
    return names.has((lower[0] === "l" ? "r" : "l") + lower.slice(1)) ? side_named(lower) : null;
  };
  return new Map(labels.map((label) => [label, spelt_out(bare(label)) ?? as_its_twin(bare(label))]));
}
