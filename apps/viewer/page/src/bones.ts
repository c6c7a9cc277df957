// Bones between body keypoints: of recordings in an image, whose rows have keypoints of their own, and in space, where each keypoint
// is a track with its person's name before it ("P1:left_knee").
import type { Scene, Track } from "./scene";
import type { TimeChunk } from "./wire";

const CERTAIN_M = 0.01; // standard deviation of a keypoint in space that is drawn opaque
const VAGUE_M = 0.08; // and of one that is drawn faintest
const FAINTEST = 0.15;

/** Ids of the tracks at both ends of each bone. */
export function bones_of(scene: Scene): [number, number][] {
  const bones: [number, number][] = [];
  if (!scene.named_bones) return bones;
  const people = new Map<string, Map<string, number>>();
  for (const track of scene.tracks) {
    const [person, point] = parts_of(track);
    if (!people.has(person)) people.set(person, new Map());
    people.get(person)!.set(point, track.id);
  }
  for (const points of people.values()) {
    for (const [from, to] of scene.named_bones) {
      const a = points.get(from);
      const b = points.get(to);
      if (a !== undefined && b !== undefined) bones.push([a, b]);
    }
  }
  return bones;
}

function parts_of(track: Track): [string, string] {
  const end = track.label.lastIndexOf(":") + 1;
  return [track.label.slice(0, end), track.label.slice(end)];
}

/** How opaque a keypoint in space is drawn, in [0, 1], by how well its position is known. */
export function certainty(chunk: TimeChunk, row: number): number {
  const sigma = chunk.sigma ? chunk.sigma[row] : NaN;
  if (Number.isNaN(sigma)) return 1;
  const vagueness = Math.log(sigma / CERTAIN_M) / Math.log(VAGUE_M / CERTAIN_M);
  return Math.max(FAINTEST, Math.min(1, 1 - (1 - FAINTEST) * vagueness));
}

/** A row's keypoints and the bones between them, on a canvas: the less they are visible, the fainter. */
export function draw_body(
  draw: CanvasRenderingContext2D, chunk: TimeChunk, row: number, bones: [number, number][],
  place: (x: number, y: number) => [number, number], colour: (alpha: number) => string, alpha: number, wide: number,
): void {
  const { keypoint_x, keypoint_y, confidence, keypoints } = chunk;
  if (keypoints === 0) return;
  const base = row * keypoints;
  const of = (i: number) => confidence[base + i] / 255;
  const at = (i: number) => place(keypoint_x[base + i], keypoint_y[base + i]);
  draw.lineCap = "round";
  draw.lineWidth = wide;
  for (const [from, to] of bones) {
    if (of(from) === 0 || of(to) === 0) continue;
    draw.strokeStyle = colour(alpha * Math.max(FAINTEST, Math.min(of(from), of(to))));
    draw.beginPath();
    draw.moveTo(...at(from));
    draw.lineTo(...at(to));
    draw.stroke();
  }
  for (let i = 0; i < keypoints; ++i) {
    if (of(i) === 0) continue;
    draw.fillStyle = colour(alpha * Math.max(FAINTEST, of(i)));
    draw.beginPath();
    draw.arc(...at(i), 1.1 * wide, 0, 7);
    draw.fill();
  }
}
