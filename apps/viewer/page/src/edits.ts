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

const is_all = (request: ControlRequest): boolean => request.tracks.length === 0 || request.tracks.length === request.all.length;
const quoted = (name: string): string => (/^[\w.-]+$/.test(name) ? name : `"${name}"`);

/** Why it cannot be done yet; empty if it can. What only the take knows, the program says. */
export function missing(request: ControlRequest): string {
  const [min_tracks, max_tracks] = REQUIRED[request.kind];
  const count = request.tracks.length;
  if (count < min_tracks || count > max_tracks) {
    const how_many = min_tracks === max_tracks ? (min_tracks === 1 ? "one" : "two") : "at least one";
    return `Select ${how_many} in the view or in the list${count > max_tracks ? `; ${count} are selected` : ""}.`;
  }
  if (request.name.includes('"')) return 'A name cannot hold a ".';
  if (request.kind === "rename" && request.name.trim() === "") return `What is ${called(request.tracks[0])} to be called?`;
  return "";
}

/** The edit as `marey edit` takes it. */
export function command(request: ControlRequest): string {
  const { tracks, all, kind } = request;
  const range = request.range ? ` ${request.range.first}:${request.range.last}` : "";
  const several = () => tracks.map((track) => reference(track, all)).join(",");
  const name = request.name.trim();
  if (kind === "rename") return `rename ${several()} ${quoted(name)}`;
  if (kind === "swap") return `swap ${reference(tracks[0], all)} ${reference(tracks[1], all)}${range}`;
  if (kind === "split") return `split ${several()} ${request.frame}${name ? ` ${quoted(name)}` : ""}`;
  if (kind === "join") return `join ${reference(tracks[0], all)} ${reference(tracks[1], all)}`;
  if (kind === "delete") return `delete ${several()}${range}`;
  const tracks_or_all = is_all(request) ? "all" : several();
  if (kind === "filter") return `filter ${tracks_or_all} ${request.cutoff.trim() || "auto"}${range}`;
  const settings = [request.method, request.longest.trim() && `longest=${request.longest.trim()}`, request.within.trim() && `within=${request.within.trim()}`];
  return `fill ${tracks_or_all}${range}${settings.filter(Boolean).map((word) => ` ${word}`).join("")}`;
}

/** What will be done, in a sentence. */
export function message_text(request: ControlRequest, what: string): string {
  const { tracks, range } = request;
  const frames = range ? (range.first === range.last ? `in frame ${range.first}` : `in frames ${range.first} to ${range.last}`) : "in all frames";
  const tracks_or_all = is_all(request) ? `all ${request.all.length} ${what}` : names_of(tracks);
  switch (request.kind) {
    case "rename":
      return `${called(tracks[0])} is called ${request.name.trim()}, in all frames.`;
    case "swap":
      return `${called(tracks[0])} and ${called(tracks[1])} exchange what they have ${frames}.`;
    case "split":
      return `From frame ${request.frame} on, which is shown, ${called(tracks[0])} is a track of its own${request.name.trim() ? `, called ${request.name.trim()}` : ""}.`;
    case "join":
      return `${called(tracks[0])} gets all that ${called(tracks[1])} has, which is there no more.`;
    case "delete":
      return range ? `What ${names_of(tracks)} ${tracks.length > 1 ? "have" : "has"} ${frames} is left out.` : `${names_of(tracks)} ${tracks.length > 1 ? "are" : "is"} left out of the take.`;
    case "fill": {
      const how = request.method ? `by ${request.method}` : "each by the method that does best on holes like it";
      return `Gaps of ${tracks_or_all} ${frames} are filled, ${how}; those over ${request.longest.trim() || 1} s, or expected to be off by over ${request.within.trim() || 50} mm, stay open.`;
    }
    case "filter":
      return `The ${is_all(request) || tracks.length > 1 ? "paths" : "path"} of ${tracks_or_all} ${is_all(request) || tracks.length > 1 ? "are" : "is"} smoothed ${frames}, with ${request.cutoff.trim() ? `a cut-off of ${request.cutoff.trim()} Hz` : "the cut-off that fits the noise of each"}.`;
  }
}
