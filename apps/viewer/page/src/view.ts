import type { TimeStep, Motion } from "./motion";
import { time_of } from "./motion";
import type { Scene } from "./scene";
import type { Overlay } from "./overlay";

/** One way to look at a scene. It draws when it is reported to, into an element that the page sizes. */
export interface View {
  readonly element: HTMLElement;
  readonly overlay: Overlay;
  take(scene: Scene): void;
  resize(width: number, height: number): void;
  draw(motion: Motion, moment: TimeStep | null): void;
  /** Everything in sight again. */
  reset(): void;
  /** A preset, "top" or "front", where there are any. */
  view_from?(side: "top" | "front" | "side"): void;
}

/** The instants of the last `seconds` before and with this one, the newest first, at most `most` of them. */
export function time_steps_back(motion: Motion, from: TimeStep, seconds: number, most: number): TimeStep[] {
  const list = [from];
  const begin = time_of(from) - seconds;
  const min_gap_s = seconds / most;
  let kept = time_of(from);
  for (let at = motion.neighbour(from, -1); at && time_of(at) >= begin; at = motion.neighbour(at, -1)) {
    if (kept - time_of(at) < min_gap_s - 1e-9) continue;
    kept = time_of(at);
    list.push(at);
  }
  return list;
}
