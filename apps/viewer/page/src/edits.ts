// What can be done to a take: as `marey edit` takes it, and in words.
import type { Track } from "./scene";
import type { Range } from "./state";

/** What was done to a take, as apps/viewer/edit_session.cpp says it. */
export interface History {
  edits: Edit[];
  /** The edit up to which they count; 0: none does. */
  head: number;
  newest: number;
}

export interface Edit {
  id: number;
  parent?: number;
  operation: string;
  description: string;
  active: boolean;
  gaps?: { track: string; first: number; last: number; method: string; expected_mm: number }[];
}

export const KINDS = ["rename", "swap", "split", "join", "delete", "fill", "filter"] as const;
export type Kind = (typeof KINDS)[number];

/** What the user has chosen. */
export interface ControlRequest {
  kind: Kind;
  /** Selected, the first one first. */
  tracks: Track[];
  all: Track[];
  range: Range | null;
  /** The frame that is shown. */
  frame: number;
  name: string;
  method: string;
  longest: string;
  within: string;
  cutoff: string;
}

const REQUIRED: Record<Kind, [number, number]> = { rename: [1, 1], swap: [2, 2], split: [1, 1], join: [2, 2], delete: [1, Infinity], fill: [0, Infinity], filter: [0, Infinity] };

/** A name as a sentence has it. */
export const called = (track: Track): string => (track.label === "" ? `#${track.id}` : track.label);

/** A track as `marey edit` names it. */
function reference(track: Track, all: Track[]): string {
  const { label, id } = track;
  if (label === "" || label.startsWith("#") || /["\x00-\x1f]/.test(label) || all.some((other) => other !== track && other.label === label)) return `#${id}`;
  return /[\s,]/.test(label) ? `"${label}"` : label;
}

const names_of = (tracks: Track[]): string => {
  const names = tracks.slice(0, 4).map(called);
  if (tracks.length > 4) return `${names.slice(0, 3).join(", ")} and ${tracks.length - 3} more`;
  return names.length < 2 ? names.join("") : `${names.slice(0, -1).join(", ")} and ${names[names.length - 1]}`;
};

/** A word as a shell takes it. */
export const shell = (word: string): string => (/^[\w./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);

const is_all = (wish: ControlRequest): boolean => wish.tracks.length === 0 || wish.tracks.length === wish.all.length;
const quoted = (name: string): string => (/^[\w.-]+$/.test(name) ? name : `"${name}"`);

/** Why it cannot be done yet; empty if it can. What only the take knows, the program says. */
export function missing(wish: ControlRequest): string {
  const [least, most] = REQUIRED[wish.kind];
  const count = wish.tracks.length;
  if (count < least || count > most) {
    const how_many = least === most ? (least === 1 ? "one" : "two") : "at least one";
    return `Select ${how_many} in the view or in the list${count > most ? `; ${count} are selected` : ""}.`;
  }
  if (wish.name.includes('"')) return 'A name cannot hold a ".';
  if (wish.kind === "rename" && wish.name.trim() === "") return `What is ${called(wish.tracks[0])} to be called?`;
  return "";
}

/** The edit as `marey edit` takes it. */
export function command(wish: ControlRequest): string {
  const { tracks, all, kind } = wish;
  const range = wish.range ? ` ${wish.range.first}:${wish.range.last}` : "";
  const several = () => tracks.map((track) => reference(track, all)).join(",");
  const name = wish.name.trim();
  if (kind === "rename") return `rename ${several()} ${quoted(name)}`;
  if (kind === "swap") return `swap ${reference(tracks[0], all)} ${reference(tracks[1], all)}${range}`;
  if (kind === "split") return `split ${several()} ${wish.frame}${name ? ` ${quoted(name)}` : ""}`;
  if (kind === "join") return `join ${reference(tracks[0], all)} ${reference(tracks[1], all)}`;
  if (kind === "delete") return `delete ${several()}${range}`;
  const whose = is_all(wish) ? "all" : several();
  if (kind === "filter") return `filter ${whose} ${wish.cutoff.trim() || "auto"}${range}`;
  const settings = [wish.method, wish.longest.trim() && `longest=${wish.longest.trim()}`, wish.within.trim() && `within=${wish.within.trim()}`];
  return `fill ${whose}${range}${settings.filter(Boolean).map((word) => ` ${word}`).join("")}`;
}

/** What will be done, in a sentence. */
export function message_text(wish: ControlRequest, what: string): string {
  const { tracks, range } = wish;
  const frames = range ? (range.first === range.last ? `in frame ${range.first}` : `in frames ${range.first} to ${range.last}`) : "in all frames";
  const whose = is_all(wish) ? `all ${wish.all.length} ${what}` : names_of(tracks);
  switch (wish.kind) {
    case "rename":
      return `${called(tracks[0])} is called ${wish.name.trim()}, in all frames.`;
    case "swap":
      return `${called(tracks[0])} and ${called(tracks[1])} exchange what they have ${frames}.`;
    case "split":
      return `From frame ${wish.frame} on, which is shown, ${called(tracks[0])} is a track of its own${wish.name.trim() ? `, called ${wish.name.trim()}` : ""}.`;
    case "join":
      return `${called(tracks[0])} gets all that ${called(tracks[1])} has, which is there no more.`;
    case "delete":
      return range ? `What ${names_of(tracks)} ${tracks.length > 1 ? "have" : "has"} ${frames} is left out.` : `${names_of(tracks)} ${tracks.length > 1 ? "are" : "is"} left out of the take.`;
    case "fill": {
      const how = wish.method ? `by ${wish.method}` : "each by the method that does best on holes like it";
      return `Gaps of ${whose} ${frames} are filled, ${how}; those over ${wish.longest.trim() || 1} s, or expected to be off by over ${wish.within.trim() || 50} mm, stay open.`;
    }
    case "filter":
      return `The ${is_all(wish) || tracks.length > 1 ? "paths" : "path"} of ${whose} ${is_all(wish) || tracks.length > 1 ? "are" : "is"} smoothed ${frames}, with ${wish.cutoff.trim() ? `a cut-off of ${wish.cutoff.trim()} Hz` : "the cut-off that fits the noise of each"}.`;
  }
}
