// A recording that lies with the server: stretches are fetched as they are needed, all of them where it is short.
import { last_at_or_before, type TimeStep, type Motion } from "./motion";
import type { Scene } from "./scene";
import { course_of, TimeChunk, type Course } from "./wire";

const AT_ONCE = 160; // stretches that are fetched without being asked for
const MAX_KEPT = 600;
const AHEAD = 4;

export class Recorded implements Motion {
  scene: Scene;
  on_change = () => {};
  private begins: number[] = [];
  revision = 0;
  private here = new Map<number, { chunk: TimeChunk; version: number }>(); // in the order of their last use
  private asked = new Set<number>();

  constructor(scene: Scene) {
    this.scene = scene;
    this.take(scene);
  }

  get first(): number {
    return this.begins[0] ?? 0;
  }
  get last(): number {
    return this.scene.last ?? 0;
  }

  take(scene: Scene): void {
    this.scene = scene;
    this.begins = (scene.chunks ?? []).map((chunk) => chunk[0]);
    const count = Math.min(this.begins.length, AT_ONCE);
    for (let n = 0; n < count; ++n) this.fetch(n);
    this.on_change();
  }

  at(time: number): TimeStep | null {
    const n = Math.max(0, last_at_or_before(this.begins, time + 1e-9));
    if (n >= this.begins.length) return null;
    for (let ahead = 1; ahead <= AHEAD && n + ahead < this.begins.length; ++ahead) this.fetch(n + ahead);
    const chunk = this.chunk(n);
    if (!chunk) return null;
    return { chunk: chunk, k: Math.max(0, last_at_or_before(chunk.time, time + 1e-9)) };
  }

  neighbour(moment: TimeStep, step: 1 | -1): TimeStep | null {
    const k = moment.k + step;
    if (k >= 0 && k < moment.chunk.time.length) return { chunk: moment.chunk, k };
    const n = last_at_or_before(this.begins, moment.chunk.time[0] + 1e-9) + step;
    if (n < 0 || n >= this.begins.length) return null;
    const chunk = this.chunk(n);
    return chunk ? { chunk: chunk, k: step > 0 ? 0 : chunk.time.length - 1 } : null;
  }

  async course(track: number): Promise<Course> {
    const answer = await fetch(`course?track=${track}`);
    return course_of(await answer.arrayBuffer());
  }

  density(): [number, number][] {
    const list = this.scene.chunks ?? [];
    if (list.length > AT_ONCE || this.here.size < list.length) return list.map(([time, n, rows]) => [time, rows / Math.max(1, n)]);
    const fine: [number, number][] = [];
    for (let n = 0; n < list.length; ++n) {
      const { chunk: chunk } = this.here.get(n)!;
      for (let k = 0; k < chunk.time.length; ++k) fine.push([chunk.time[k], chunk.row_end[k] - chunk.begin(k)]);
    }
    return fine;
  }

  private chunk(n: number): TimeChunk | null {
    const held = this.here.get(n);
    if (!held || held.version !== this.version(n)) this.fetch(n);
    if (!held) return null;
    this.here.delete(n);
    this.here.set(n, held);
    return held.chunk; // the one from before an edit, until the new one is here
  }

  private version(n: number): number {
    return this.scene.chunks?.[n]?.[3] ?? 0;
  }

  private async fetch(n: number): Promise<void> {
    const version = this.version(n);
    const held = this.here.get(n);
    if (held?.version === version || this.asked.has(n)) return;
    this.asked.add(n);
    try {
      const answer = await fetch(`stretch?n=${n}`);
      if (!answer.ok) return;
      this.here.set(n, { chunk: new TimeChunk(await answer.arrayBuffer()), version });
      if (held) ++this.revision;
      if (this.here.size > MAX_KEPT) this.here.delete(this.here.keys().next().value!);
      this.on_change();
    } catch {
      // the server has gone, which the socket tells
    } finally {
      this.asked.delete(n);
    }
    if (this.version(n) !== version) this.fetch(n); // it was edited again in the meantime
  }
}
