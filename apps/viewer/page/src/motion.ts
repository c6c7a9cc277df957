// A motion over time, recorded or live: what the views, the timeline and the plots ask.
import type { Scene } from "./scene";
import type { Course, TimeChunk } from "./wire";

/** Instant k of a stretch. */
export interface TimeStep {
  chunk: TimeChunk;
  k: number;
}

export const time_of = (moment: TimeStep): number => moment.chunk.time[moment.k];

export interface Motion {
  scene: Scene;
  /** s; what can be shown. */
  readonly first: number;
  readonly last: number;
  /** Grows where what was there has become another. */
  readonly revision: number;
  /** Called where the scene, or what is there of the motion, has changed. */
  on_change: () => void;
  /** The last instant at or before `time`; null where it is not here yet, and is then asked for. */
  at(time: number): TimeStep | null;
  /** The instant before, or after; null at the ends and where it is not here yet. */
  neighbour(moment: TimeStep, step: 1 | -1): TimeStep | null;
  /** A track over the whole time that is known. */
  course(track: number): Promise<Course>;
  /** How much was there over time, for the strip: [time (s), rows an instant], by growing time. */
  density(): [number, number][];
}

/** The last of growing `values` that is not above `value`; −1 where all are. */
export function last_at_or_before(values: ArrayLike<number>, value: number): number {
  let low = 0;
  let high = values.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle] <= value) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}
