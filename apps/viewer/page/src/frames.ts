// Frames by their indices, as edits name them, and when they were.
import { time_of, type Motion } from "./motion";
import type { Range } from "./state";

export function frame_at(motion: Motion, time: number): number {
  const step = motion.at(time);
  if (step) return step.chunk.index[step.k];
  return Math.max(0, Math.round((time - motion.first) * motion.scene.rate)); // it is not here yet
}

export function time_of_frame(motion: Motion, frame: number): number {
  const rate = Math.max(0.1, motion.scene.rate);
  let time = motion.first + (frame - frame_at(motion, motion.first)) / rate;
  for (let tries = 0; tries < 4; ++tries) {
    const step = motion.at(Math.max(motion.first, Math.min(motion.last, time)));
    if (!step) break;
    const off = frame - step.chunk.index[step.k];
    time = time_of(step) + off / rate;
    if (off === 0) break;
  }
  return time;
}

/** From when to when a range goes (s): up to the end of its last frame. */
export function times_of(motion: Motion, range: Range): [number, number] {
  return [time_of_frame(motion, range.first), time_of_frame(motion, range.last) + 1 / Math.max(0.1, motion.scene.rate)];
}

/** The range between two times, whichever came first. */
export function range_between(motion: Motion, one: number, other: number): Range {
  return { first: frame_at(motion, Math.min(one, other)), last: frame_at(motion, Math.max(one, other)) };
}
