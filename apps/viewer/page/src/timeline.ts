// Play, pause, step, speed, and the strip on which time is scrubbed.
import { range_between, times_of } from "./frames";
import type { Motion } from "./motion";
import { put, SPEEDS, type State } from "./state";

const two = (n: number) => String(n).padStart(2, "0");
export function clock(seconds: number): string {
  const sign = seconds < -0.005 ? "−" : "";
  const s = Math.abs(seconds);
  const minutes = Math.floor(s / 60);
  const rest = `${two(Math.floor(s % 60))}.${two(Math.floor((s * 100) % 100))}`;
  return minutes >= 60 ? `${sign}${Math.floor(minutes / 60)}:${two(minutes % 60)}:${rest}` : `${sign}${minutes}:${rest}`;
}

export class Timeline {
  private strip = document.querySelector<HTMLCanvasElement>("#strip")!;
  private play = document.querySelector<HTMLButtonElement>("#play")!;
  private now = document.querySelector<HTMLElement>("#now")!;
  private total = document.querySelector<HTMLElement>("#total")!;
  private speed = document.querySelector<HTMLSelectElement>("#speed")!;
  private to_live = document.querySelector<HTMLButtonElement>("#live")!;
  private shape: Path2D | null = null;
  private shaped_for = "";
  private ran: boolean | null = null;
  private marked_from: number | null = null;
  private style = getComputedStyle(this.strip);

  constructor(private state: State, private motion: () => Motion, step: (by: number) => void) {
    for (const value of SPEEDS) this.speed.add(new Option(`${value < 0.1 ? "1/20" : value < 0.25 ? "1/10" : value === 0.25 ? "¼" : value === 0.5 ? "½" : value}×`, `${value}`));
    this.speed.value = "1";
    this.speed.addEventListener("change", () => {
      state.speed = Number(this.speed.value);
      state.changed();
      this.speed.blur();
    });
    this.play.addEventListener("click", () => this.toggle());
    document.querySelector("#back")!.addEventListener("click", () => step(-1));
    document.querySelector("#forth")!.addEventListener("click", () => step(1));
    this.to_live.addEventListener("click", () => {
      state.stays_at_end = true;
      state.changed();
    });
    this.strip.addEventListener("pointerdown", (event) => {
      this.strip.setPointerCapture(event.pointerId);
      this.marked_from = event.shiftKey && motion().scene.can_edit ? this.time_at(event) : null;
      this.scrub(event);
    });
    this.strip.addEventListener("pointermove", (event) => {
      if (this.strip.hasPointerCapture(event.pointerId)) this.scrub(event);
    });
  }

  toggle(): void {
    const { state } = this;
    const motion = this.motion();
    if (motion.scene.kind === "live") {
      state.stays_at_end = !state.stays_at_end;
      state.playing = false;
    } else {
      state.playing = !state.playing;
      if (state.playing && state.time >= motion.last - 1e-6) state.time = motion.first;
    }
    state.changed();
  }

  faster(by: 1 | -1): void {
    const at = SPEEDS.indexOf(this.state.speed) + by;
    if (at < 0 || at >= SPEEDS.length) return;
    this.state.speed = SPEEDS[at];
    this.speed.value = `${this.state.speed}`;
    this.state.changed();
  }

  draw(): void {
    const { state } = this;
    const motion = this.motion();
    const live = motion.scene.kind === "live";
    const running = live ? state.stays_at_end : state.playing;
    this.play.classList.toggle("running", running);
    if (this.ran !== running) {
      this.ran = running;
      this.play.title = running ? "Pause (space)" : "Play (space)";
      this.play.setAttribute("aria-label", running ? "Pause" : "Play");
    }
    this.to_live.hidden = !live || state.stays_at_end;
    this.speed.hidden = live;
    put(this.now, live ? clock(state.time) : clock(state.time - motion.first));
    put(this.total, live ? (state.stays_at_end ? "live" : `${clock(motion.last - state.time)} behind`) : clock(motion.last - motion.first));
    this.draw_strip(motion);
  }

  private time_at(event: PointerEvent): number {
    const motion = this.motion();
    const rect = this.strip.getBoundingClientRect();
    const fraction = Math.max(0, Math.min(1, (event.clientX - rect.left) / rect.width));
    return motion.first + fraction * (motion.last - motion.first);
  }

  /** With Shift, where a take is edited, it marks a range of frames. */
  private scrub(event: PointerEvent): void {
    this.state.time = this.time_at(event);
    this.state.stays_at_end = false;
    if (this.marked_from !== null) this.state.range = range_between(this.motion(), this.marked_from, this.state.time);
    this.state.changed();
  }

  /** How many were there over time, as a quiet shape behind the playhead. */
  private draw_strip(motion: Motion): void {
    const ratio = Math.min(devicePixelRatio, 2);
    const { clientWidth: width, clientHeight: height } = this.strip;
    if (this.strip.width !== Math.round(width * ratio) || this.strip.height !== Math.round(height * ratio)) {
      this.strip.width = Math.round(width * ratio);
      this.strip.height = Math.round(height * ratio);
    }
    const draw = this.strip.getContext("2d")!;
    draw.setTransform(ratio, 0, 0, ratio, 0, 0);
    draw.clearRect(0, 0, width, height);
    const { style } = this;
    const span = Math.max(1e-9, motion.last - motion.first);
    const at = (time: number) => ((time - motion.first) / span) * width;
    const list = motion.density();
    const key = `${width} ${list.length} ${list[0]?.[0]} ${motion.last} ${motion.revision}`;
    if (key !== this.shaped_for) {
      this.shaped_for = key;
      this.shape = this.shape_of(list, at, width, height);
    }
    draw.fillStyle = style.getPropertyValue("--strip");
    if (this.shape) draw.fill(this.shape);
    const x = at(Math.max(motion.first, Math.min(motion.last, this.state.time)));
    draw.fillStyle = style.getPropertyValue("--past");
    draw.save();
    draw.beginPath();
    draw.rect(0, 0, x, height);
    draw.clip();
    if (this.shape) draw.fill(this.shape);
    draw.restore();
    if (this.state.range) {
      const [from, to] = times_of(motion, this.state.range).map((time) => Math.max(0, Math.min(width, at(time))));
      draw.fillStyle = style.getPropertyValue("--marked");
      draw.fillRect(from, 0, Math.max(2, to - from), height);
      draw.fillStyle = style.getPropertyValue("--warn");
      for (const edge of [from, Math.max(from + 2, to) - 2]) draw.fillRect(edge, 0, 2, height);
    }
    draw.fillStyle = style.getPropertyValue("--accent");
    draw.fillRect(Math.max(0, Math.min(width - 2, x - 1)), 0, 2, height);
  }

  private shape_of(list: [number, number][], at: (time: number) => number, width: number, height: number): Path2D {
    const columns = Math.max(1, Math.floor(width / 2));
    const sum = new Float64Array(columns);
    const count = new Float64Array(columns);
    for (let i = 0; i < list.length; ++i) {
      const from = Math.max(0, Math.min(columns - 1, Math.floor(at(list[i][0]) / 2)));
      const to = i + 1 < list.length ? Math.max(from + 1, Math.min(columns, Math.floor(at(list[i + 1][0]) / 2))) : columns;
      for (let c = from; c < to; ++c) {
        sum[c] += list[i][1];
        ++count[c];
      }
    }
    let highest = 1e-9;
    for (let c = 0; c < columns; ++c) if (count[c]) highest = Math.max(highest, sum[c] / count[c]);
    const shape = new Path2D();
    for (let c = 0; c < columns; ++c) {
      const tall = count[c] ? (0.78 * height * (sum[c] / count[c])) / highest : 0;
      shape.rect(2 * c, height - 2 - tall, 2, tall + 2);
    }
    return shape;
  }
}
