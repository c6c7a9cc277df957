// Which colour a track has: its own where the recording says one, its team's on a pitch, its side's on a body, else one of its number.
import type { Scene, Track } from "./scene";
import { sides_of, type Side } from "./sides";

export type Rgb = [number, number, number]; // 0 to 1

const LEFT: Rgb = [0.96, 0.52, 0.36];
const RIGHT: Rgb = [0.33, 0.72, 0.9];
const MIDDLE: Rgb = [0.93, 0.83, 0.55];
const TEAMS: Rgb[] = [
  [0.3, 0.62, 0.95],
  [0.95, 0.42, 0.4],
  [0.98, 0.8, 0.35],
  [0.62, 0.8, 0.45],
];

/** Teams are often called by their shirts. */
const SHIRTS: Record<string, Rgb> = {
  white: [0.92, 0.93, 0.95], black: [0.24, 0.26, 0.3], red: [0.9, 0.33, 0.32], blue: [0.3, 0.58, 0.95], yellow: [0.96, 0.82, 0.3],
  green: [0.36, 0.74, 0.42], orange: [0.96, 0.6, 0.26], referee: [0.98, 0.8, 0.35],
};

function from_hsl(hue: number, saturation: number, lightness: number): Rgb {
  const amount = saturation * Math.min(lightness, 1 - lightness);
  const channel = (n: number) => {
    const k = (n + hue * 12) % 12;
    return lightness - amount * Math.max(-1, Math.min(k - 3, 9 - k, 1));
  };
  return [channel(0), channel(8), channel(4)];
}

/** Neighbouring numbers are a golden angle apart. */
function of_number(id: number): Rgb {
  return from_hsl(((id * 137.50776 + 205) % 360) / 360, 0.62, 0.6 + 0.07 * ((id % 3) - 1));
}

export class Colours {
  private of = new Map<number, Rgb>();
  private sides = false;
  private side: Map<string, Side> = new Map();
  private teams: string[] = [];
  private frame: Scene["frame"] = "space";
  /** On white, colours are darker. */
  dark: boolean | null = null;

  take(scene: Scene): void {
    this.of.clear();
    this.frame = scene.frame;
    const labelled = scene.tracks.filter((track) => track.label !== "");
    this.side = sides_of(labelled.map((track) => track.label));
    const on = (side: Side) => labelled.filter((track) => this.side.get(track.label) === side).length;
    const [left, right] = [on("left"), on("right")];
    this.sides = scene.frame === "space" && Math.min(left, right) >= 0.15 * labelled.length && labelled.length > 3;
    const counts = new Map<string, number>();
    for (const track of scene.tracks) if (track.team !== "") counts.set(track.team, (counts.get(track.team) ?? 0) + 1);
    this.teams = [...counts.keys()].sort((a, b) => counts.get(b)! - counts.get(a)! || a.localeCompare(b));
    this.teams = [...this.teams.slice(0, 2).sort(), ...this.teams.slice(2)];
    for (const track of scene.tracks) this.of.set(track.id, this.chosen(track));
  }

  rgb(id: number): Rgb {
    let colour = this.of.get(id);
    if (!colour) this.of.set(id, (colour = of_number(id)));
    return this.shown(colour);
  }
  private shown([r, g, b]: Rgb): Rgb {
    if (this.dark !== false) return [r, g, b];
    const by = 1 - 0.42 * Math.max(0, 0.299 * r + 0.587 * g + 0.114 * b - 0.35) / 0.65;
    return [by * r, by * g, by * b];
  }
  css(id: number, alpha = 1): string {
    const [r, g, b] = this.rgb(id);
    return `rgba(${Math.round(255 * r)},${Math.round(255 * g)},${Math.round(255 * b)},${alpha})`;
  }
  /** Whether dark text is easier to read on it than white. */
  is_light(id: number): boolean {
    const [r, g, b] = this.rgb(id);
    return 0.299 * r + 0.587 * g + 0.114 * b > 0.55;
  }
  /** What the colours stand for, for the legend. */
  legend(): [string, string][] {
    const css = (c: Rgb) => `rgb(${this.shown(c).map((v) => Math.round(255 * v)).join(",")})`;
    if (this.sides) return [["left", css(LEFT)], ["right", css(RIGHT)], ["middle", css(MIDDLE)]];
    if (this.frame === "ground") return this.teams.slice(0, 4).map((team, i) => [team, css(SHIRTS[team.toLowerCase()] ?? TEAMS[i])]);
    return [];
  }

  private chosen(track: Track): Rgb {
    if (track.colour) return track.colour.map((v) => v / 255) as Rgb;
    const team = this.teams.indexOf(track.team);
    if (track.team !== "" && team >= 0 && team < TEAMS.length) return SHIRTS[track.team.toLowerCase()] ?? TEAMS[team];
    if (this.sides) return { left: LEFT, right: RIGHT, middle: MIDDLE }[this.side.get(track.label) ?? "middle"];
    return of_number(track.id);
  }
}
