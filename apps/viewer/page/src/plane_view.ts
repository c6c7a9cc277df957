// What lies in a plane: people on a pitch or another ground, seen from above; tracks in an image. Dragged and zoomed with the
// pointer, two fingers or the wheel.
import { draw_body } from "./bones";
import type { Colours } from "./colours";
import { time_of, type TimeStep, type Motion } from "./motion";
import { Overlay, type Mark } from "./overlay";
import { name_of, type Scene, type Track } from "./scene";
import { TYPEFACE, type State } from "./state";
import { time_steps_back, type View } from "./view";

const TRAIL_STEPS = 120;

export class PlaneView implements View {
  readonly element = document.createElement("div");
  readonly overlay: Overlay;
  private base = document.createElement("canvas");
  private tracks = new Map<number, Track>();
  private scene: Scene | null = null;
  private width = 1;
  private height = 1;
  // The part of the plane that all of it needs, and how it is shown: css px = origin + scale * place.
  private low: [number, number] = [0, 0];
  private high: [number, number] = [1, 1];
  private scale = 1;
  private origin: [number, number] = [0, 0];
  private fitted = true;
  private fingers = new Map<number, [number, number]>();
  /** The newest image of the video, and of which frame it is. */
  video_image: { image: ImageBitmap; frame: number } | null = null;

  constructor(private state: State, private colours: Colours, private redraw: () => void) {
    this.overlay = new Overlay(state, colours);
    this.element.className = "view plane";
    this.element.append(this.base, this.overlay.canvas);
    this.element.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    this.element.addEventListener("pointerdown", (event) => this.fingers.set(event.pointerId, [event.offsetX, event.offsetY]));
    this.element.addEventListener("pointermove", (event) => this.drag(event));
    for (const end of ["pointerup", "pointercancel", "pointerleave"] as const)
      this.element.addEventListener(end, (event) => this.fingers.delete(event.pointerId));
  }

  get pixels_wide(): number {
    return Math.round((this.high[0] - this.low[0]) * this.scale * Math.min(devicePixelRatio, 2));
  }

  take(scene: Scene): void {
    this.scene = scene;
    this.tracks = new Map(scene.tracks.map((track) => [track.id, track]));
    const before = `${this.low},${this.high}`;
    if (scene.frame === "image") {
      const size = scene.size ?? [scene.high?.[0] ?? 640, scene.high?.[1] ?? 480];
      this.low = [-0.5, -0.5];
      this.high = [size[0] - 0.5, size[1] - 0.5];
    } else if (scene.pitch) {
      const { x, y, length, width } = scene.pitch;
      this.low = [x - 4, y - 4];
      this.high = [x + length + 4, y + width + 4];
    } else if (scene.low && scene.high) {
      const margin = 0.06 * Math.max(scene.high[0] - scene.low[0], scene.high[1] - scene.low[1], 1);
      this.low = [scene.low[0] - margin, scene.low[1] - margin];
      this.high = [scene.high[0] + margin, scene.high[1] + margin];
    }
    if (this.fitted && before !== `${this.low},${this.high}`) this.reset();
  }

  resize(width: number, height: number): void {
    this.width = width;
    this.height = height;
    const ratio = Math.min(devicePixelRatio, 2);
    this.base.width = Math.round(width * ratio);
    this.base.height = Math.round(height * ratio);
    this.base.style.width = `${width}px`;
    this.base.style.height = `${height}px`;
    this.base.getContext("2d")!.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.overlay.resize(width, height);
    if (this.fitted) this.reset();
  }

  reset(): void {
    const size = [this.high[0] - this.low[0], this.high[1] - this.low[1]];
    const margin = this.width < 600 ? 6 : 18;
    const top = this.scene?.frame === "image" ? margin : 34; // the view's buttons
    this.scale = Math.max(1e-6, Math.min((this.width - 2 * margin) / size[0], (this.height - margin - top) / size[1]));
    const left = (this.width - this.scale * size[0]) / 2;
    const up = top + (this.height - top - margin - this.scale * size[1]) / 2;
    this.origin = [left - this.scale * this.low[0], this.upwards ? up + this.scale * this.high[1] : up - this.scale * this.low[1]];
    this.fitted = true;
    this.redraw();
  }

  draw(motion: Motion, moment: TimeStep | null): void {
    const draw = this.base.getContext("2d")!;
    draw.clearRect(0, 0, this.width, this.height);
    if (this.scene?.frame === "image") this.draw_picture(draw);
    else this.draw_ground(draw);
    this.overlay.clear();
    if (!moment) return;
    if (this.state.trail_s > 0) this.draw_trails(this.overlay.draw, motion, moment);
    if (this.scene?.frame === "image") this.draw_boxes(moment);
    else this.draw_people(moment);
  }

  private get upwards(): boolean {
    return this.scene?.frame === "ground" && !this.scene.y_down;
  }
  private x(x: number): number {
    return this.origin[0] + this.scale * x;
  }
  private y(y: number): number {
    return this.origin[1] + (this.upwards ? -1 : 1) * this.scale * y;
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    this.zoom(Math.exp(-0.0015 * event.deltaY * (event.deltaMode === 1 ? 20 : 1)), event.offsetX, event.offsetY);
  }
  private zoom(by: number, x: number, y: number): void {
    const factor = Math.max(0.2, Math.min(5, by));
    this.scale *= factor;
    this.origin = [x - factor * (x - this.origin[0]), y - factor * (y - this.origin[1])];
    this.fitted = false;
    this.redraw();
  }
  private drag(event: PointerEvent): void {
    const before = this.fingers.get(event.pointerId);
    if (!before || (event.pointerType === "mouse" && event.buttons === 0)) return;
    const other = [...this.fingers].find(([id]) => id !== event.pointerId)?.[1];
    const now: [number, number] = [event.offsetX, event.offsetY];
    if (other) {
      const apart = (p: [number, number]) => Math.hypot(p[0] - other[0], p[1] - other[1]);
      this.zoom(apart(now) / Math.max(1, apart(before)), (now[0] + other[0]) / 2, (now[1] + other[1]) / 2);
    } else {
      this.origin = [this.origin[0] + now[0] - before[0], this.origin[1] + now[1] - before[1]];
      this.fitted = false;
      this.redraw();
    }
    this.fingers.set(event.pointerId, now);
  }

  private draw_picture(draw: CanvasRenderingContext2D): void {
    const [left, top] = [this.x(this.low[0]), this.y(this.low[1])];
    const [width, height] = [this.scale * (this.high[0] - this.low[0]), this.scale * (this.high[1] - this.low[1])];
    draw.fillStyle = this.state.dark ? "#171c22" : "#e6e9ed";
    draw.fillRect(left, top, width, height);
    if (this.video_image) draw.drawImage(this.video_image.image, left, top, width, height);
  }

  private draw_ground(draw: CanvasRenderingContext2D): void {
    const pitch = this.scene?.pitch;
    if (!pitch) return this.draw_grid(draw);
    const dark = this.state.dark;
    const { x, y, length, width } = pitch;
    const rect = (x0: number, y0: number, w: number, h: number): [number, number, number, number] => [
      this.x(x0), this.upwards ? this.y(y0 + h) : this.y(y0), this.scale * w, this.scale * h,
    ];
    draw.fillStyle = dark ? "#15291c" : "#cfe3cf";
    draw.fillRect(...rect(x - 4, y - 4, length + 8, width + 8));
    draw.fillStyle = dark ? "#193021" : "#d8ead8";
    const stripe = length / 20;
    for (let i = 0; i < 20; i += 2) draw.fillRect(...rect(x + i * stripe, y, stripe, width));
    draw.strokeStyle = dark ? "rgba(214,232,218,.55)" : "rgba(60,100,70,.6)";
    draw.fillStyle = draw.strokeStyle;
    draw.lineWidth = Math.max(1, 0.12 * this.scale);
    draw.strokeRect(...rect(x, y, length, width));
    const half = x + length / 2;
    const middle = y + width / 2;
    const arc = (cx: number, cy: number, r: number, from: number, to: number) => {
      draw.beginPath();
      draw.arc(this.x(cx), this.y(cy), r * this.scale, from, to);
      draw.stroke();
    };
    const spot = (cx: number) => {
      draw.beginPath();
      draw.arc(this.x(cx), this.y(middle), Math.max(1.5, 0.2 * this.scale), 0, 7);
      draw.fill();
    };
    draw.beginPath();
    draw.moveTo(this.x(half), this.y(y));
    draw.lineTo(this.x(half), this.y(y + width));
    draw.stroke();
    arc(half, middle, 9.15, 0, 7);
    spot(half);
    const turn = Math.acos(5.5 / 9.15);
    for (const side of [0, 1]) {
      const goal = x + side * length;
      const inwards = side ? -1 : 1;
      for (const [depth, across] of [[16.5, 40.32], [5.5, 18.32]])
        draw.strokeRect(...rect(side ? goal - depth : goal, middle - across / 2, depth, across));
      draw.strokeRect(...rect(side ? goal : goal - 2, middle - 3.66, 2, 7.32));
      spot(goal + inwards * 11);
      arc(goal + inwards * 11, middle, 9.15, side ? Math.PI - turn : -turn, side ? Math.PI + turn : turn);
    }
  }

  private draw_grid(draw: CanvasRenderingContext2D): void {
    const step = [0.5, 1, 2, 5, 10, 20, 50, 100].find((s) => s * this.scale > 34) ?? 200;
    draw.strokeStyle = this.state.dark ? "#222933" : "#dde1e6";
    draw.fillStyle = this.state.dark ? "#5f6b78" : "#8a949f";
    draw.font = `10px ${TYPEFACE}`;
    draw.lineWidth = 1;
    draw.beginPath();
    const texts: [string, number, number][] = [];
    for (let x = Math.ceil(-this.origin[0] / this.scale / step) * step; this.x(x) < this.width; x += step) {
      draw.moveTo(this.x(x), 0);
      draw.lineTo(this.x(x), this.height);
      texts.push([`${x} m`, this.x(x) + 3, this.height - 5]);
    }
    const sign = this.upwards ? -1 : 1;
    const edges = [(0 - this.origin[1]) / (sign * this.scale), (this.height - this.origin[1]) / (sign * this.scale)];
    for (let y = Math.ceil(Math.min(...edges) / step) * step; y < Math.max(...edges); y += step) {
      draw.moveTo(0, this.y(y));
      draw.lineTo(this.width, this.y(y));
      texts.push([`${y} m`, 4, this.y(y) - 3]);
    }
    draw.stroke();
    for (const [text, x, y] of texts) draw.fillText(text, x, y);
  }

  private dimmed(id: number): boolean {
    return this.state.selected.size > 0 && !this.state.selected.has(id) && this.state.hover !== id;
  }

  private draw_trails(draw: CanvasRenderingContext2D, motion: Motion, moment: TimeStep): void {
    const now = time_of(moment);
    const before = new Map<number, [number, number, number]>();
    const feet = this.scene?.frame === "image";
    draw.lineCap = "round";
    draw.lineWidth = feet ? 2 : Math.max(1.5, 0.28 * this.scale);
    for (const { chunk: chunk, k } of time_steps_back(motion, moment, this.state.trail_s, TRAIL_STEPS)) {
      const time = chunk.time[k];
      const alpha = 0.7 * (1 - (now - time) / this.state.trail_s);
      for (let row = chunk.begin(k); row < chunk.row_end[k]; ++row) {
        const id = chunk.track[row];
        if (this.state.hidden.has(id) || this.dimmed(id)) continue;
        const box = feet && chunk.box && chunk.has_box(row) ? chunk.box : null;
        const x = this.x(box ? box[0][row] + box[2][row] / 2 : chunk.x[row]);
        const y = this.y(box ? box[1][row] + box[3][row] : chunk.y[row]);
        const last = before.get(id);
        if (last && last[2] - time < 1) {
          draw.strokeStyle = this.colours.css(id, alpha);
          draw.beginPath();
          draw.moveTo(x, y);
          draw.lineTo(last[0], last[1]);
          draw.stroke();
        }
        before.set(id, [x, y, time]);
      }
    }
  }

  private draw_people(moment: TimeStep): void {
    const { chunk: chunk, k } = moment;
    const draw = this.overlay.draw;
    const radius = Math.max(7.5, Math.min(15, 1.25 * this.scale));
    const marks: Mark[] = [];
    draw.textAlign = "center";
    draw.textBaseline = "middle";
    for (let row = chunk.begin(k); row < chunk.row_end[k]; ++row) {
      const id = chunk.track[row];
      if (this.state.hidden.has(id)) continue;
      const [x, y] = [this.x(chunk.x[row]), this.y(chunk.y[row])];
      const measured = chunk.provenance(row) === 0;
      const selected = this.state.selected.has(id) || this.state.hover === id;
      const name = name_of(this.tracks.get(id), id);
      const inside = name.length <= 3 && radius >= 7;
      draw.globalAlpha = this.dimmed(id) ? 0.35 : 1;
      draw.beginPath();
      draw.arc(x, y, radius, 0, 7);
      draw.fillStyle = measured ? this.colours.css(id) : this.state.dark ? "#15291c" : "#d8ead8";
      draw.fill();
      draw.lineWidth = selected ? 3 : 1.5;
      draw.strokeStyle = selected ? (this.state.dark ? "#fff" : "#111") : measured ? "rgba(10,14,18,.55)" : this.colours.css(id);
      draw.stroke();
      if (inside) {
        draw.font = `600 ${Math.round(Math.min(11, radius))}px ${TYPEFACE}`;
        draw.fillStyle = measured && this.colours.is_light(id) ? "#10151a" : "#fff";
        if (!measured && !this.state.dark) draw.fillStyle = "#222";
        draw.fillText(name, x, y + 0.5);
      }
      draw.globalAlpha = 1;
      marks.push({ id, x, y, radius, text: inside ? "" : name, depth: row });
    }
    draw.textAlign = "left";
    this.overlay.labels(marks, this.state.labels);
  }

  private draw_boxes(moment: TimeStep): void {
    const { chunk: chunk, k } = moment;
    const draw = this.overlay.draw;
    const marks: Mark[] = [];
    for (let row = chunk.begin(k); row < chunk.row_end[k]; ++row) {
      const id = chunk.track[row];
      if (this.state.hidden.has(id)) continue;
      const selected = this.state.selected.has(id) || this.state.hover === id;
      const measured = chunk.provenance(row) === 0;
      const alpha = this.dimmed(id) ? 0.35 : 1;
      const name = name_of(this.tracks.get(id), id);
      draw_body(draw, chunk, row, this.scene?.bones ?? [], (x, y) => [this.x(x), this.y(y)], (opacity) => this.colours.css(id, opacity), alpha, selected ? 3.5 : 2);
      draw.strokeStyle = this.colours.css(id, alpha);
      if (!chunk.box || !chunk.has_box(row)) {
        const [x, y] = [this.x(chunk.x[row]), this.y(chunk.y[row])];
        draw.lineWidth = selected ? 3 : 1.75;
        draw.beginPath();
        draw.arc(x, y, 5, 0, 7);
        draw.stroke();
        marks.push({ id, x, y, radius: 5, text: name, depth: row });
        continue;
      }
      const [left, top] = [this.x(chunk.box[0][row] - 0.5), this.y(chunk.box[1][row] - 0.5)];
      const [width, height] = [this.scale * chunk.box[2][row], this.scale * chunk.box[3][row]];
      draw.lineWidth = selected ? 3.5 : 2;
      draw.setLineDash(measured ? [] : [5, 4]);
      draw.beginPath();
      draw.roundRect(left, top, width, height, 3);
      draw.stroke();
      draw.setLineDash([]);
      if (this.state.labels || selected) this.name_box(name, id, left, top, alpha);
      marks.push({ id, x: left + width / 2, y: top + height / 2, radius: Math.min(width, height) / 2, text: "", depth: row });
    }
    this.overlay.labels(marks, this.state.labels);
  }

  private name_box(name: string, id: number, left: number, top: number, alpha: number): void {
    const draw = this.overlay.draw;
    draw.font = `600 11px ${TYPEFACE}`;
    draw.textBaseline = "middle";
    const width = draw.measureText(name).width + 8;
    const up = Math.max(1, top - 16);
    draw.globalAlpha = alpha;
    draw.fillStyle = this.colours.css(id);
    draw.beginPath();
    draw.roundRect(left - 1, up, width, 15, 3);
    draw.fill();
    draw.fillStyle = this.colours.is_light(id) ? "#10151a" : "#fff";
    draw.fillText(name, left + 3, up + 8);
    draw.globalAlpha = 1;
  }
}
