// A run that continues: the newest instants as they come, the last minute of them kept.
import { last_at_or_before, type TimeStep, type Motion } from "./motion";
import type { Scene } from "./scene";
import { TimeChunk, type Course } from "./wire";

const KEPT_S = 60;
const MAX_KEPT = 15000;
const THERE_S = 2; // who was not seen for longer is gone,
const LISTED_S = 10; // and after this not listed any more

export class Live implements Motion {
  readonly revision = 0;
  scene: Scene;
  on_change = () => {};
  private times: number[] = [];
  private here: TimeChunk[] = []; // of one instant each
  private place = new Map<TimeChunk, number>(); // counted from the first that ever came
  private gone = 0;
  private seen_at = new Map<number, number>();

  constructor(scene: Scene) {
    this.scene = scene;
  }

  get first(): number {
    return this.times.length ? Math.max(this.times[0], this.last - KEPT_S) : 0;
  }
  get last(): number {
    return this.times[this.times.length - 1] ?? 0;
  }

  take(scene: Scene): void {
    this.scene = scene;
    this.on_change();
  }

  add(chunk: TimeChunk): void {
    if (chunk.time[0] < this.last - 1) this.forget(); // another run
    this.place.set(chunk, this.gone + this.here.length);
    this.times.push(chunk.time[0]);
    this.here.push(chunk);
    for (const track of chunk.track) this.seen_at.set(track, chunk.time[0]);
    if (this.here.length > MAX_KEPT || (this.here.length > 400 && this.times[200] < this.last - KEPT_S)) {
      const drop = 200;
      for (const old of this.here.splice(0, drop)) this.place.delete(old);
      this.times.splice(0, drop);
      this.gone += drop;
    }
    this.on_change();
  }

  at(time: number): TimeStep | null {
    const i = Math.max(0, last_at_or_before(this.times, time + 1e-9));
    return i < this.here.length ? { chunk: this.here[i], k: 0 } : null;
  }

  neighbour(moment: TimeStep, step: 1 | -1): TimeStep | null {
    const at = this.place.get(moment.chunk);
    const chunk = at === undefined ? undefined : this.here[at - this.gone + step];
    return chunk ? { chunk: chunk, k: 0 } : null;
  }

  async course(track: number): Promise<Course> {
    const rows: [number, number, number, number, number][] = [];
    let has_z = false;
    for (const s of this.here) {
      const row = s.track.indexOf(track);
      if (row < 0) continue;
      has_z = s.z !== null;
      rows.push([s.time[0], s.x[row], s.y[row], s.z ? s.z[row] : 0, s.state[row]]);
    }
    const column = (i: number) => Float32Array.from(rows, (row) => row[i]);
    return { time: Float64Array.from(rows, (row) => row[0]), x: column(1), y: column(2), z: has_z ? column(3) : null, state: Uint8Array.from(rows, (row) => row[4]) };
  }

  density(): [number, number][] {
    const every = Math.max(1, Math.floor(this.here.length / 600));
    const list: [number, number][] = [];
    for (let i = 0; i < this.here.length; i += every) list.push([this.times[i], this.here[i].track.length]);
    return list;
  }

  /** Of the instants that are kept, the share in which this track was seen. */
  seen(track: number): number | null {
    if (this.here.length === 0) return null;
    let count = 0;
    let examined = 0;
    for (let i = Math.max(0, this.here.length - 600); i < this.here.length; ++i) {
      ++examined;
      const row = this.here[i].track.indexOf(track);
      if (row >= 0 && this.here[i].provenance(row) === 0) ++count;
    }
    return count / examined;
  }

  /** s since it was in an instant. */
  private absent(track: number): number {
    return this.last - (this.seen_at.get(track) ?? -Infinity);
  }
  is_there(track: number): boolean {
    return this.absent(track) <= THERE_S;
  }
  is_listed(track: number): boolean {
    return this.absent(track) <= LISTED_S;
  }
  /** How many are there now. */
  count(): number {
    return [...this.seen_at.keys()].filter((track) => this.is_there(track)).length;
  }

  /** Instants a second that arrived of late. */
  rate(): number {
    const n = Math.min(60, this.times.length - 1);
    if (n < 2) return 0;
    const span = this.last - this.times[this.times.length - 1 - n];
    return span > 0 ? n / span : 0;
  }

  private forget(): void {
    this.gone += this.here.length;
    this.here = [];
    this.times = [];
    this.place.clear();
    this.seen_at.clear();
  }
}
