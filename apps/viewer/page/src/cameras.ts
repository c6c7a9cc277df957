// The cameras of a live run: each one's image with what was found in it drawn over it, its state, rate and losses. Only images
// that are in sight are asked for, as wide as they are shown.
import type { Colours } from "./colours";
import { Controls, SaveBar, type Changeable } from "./controls";
import { Coverage } from "./coverage";
import { bones_of } from "./bones";
import type { Scene } from "./scene";
import type { State } from "./state";
import type { CameraImage } from "./wire";

export interface CameraStatus extends Changeable {
  state: string;
  rate: number | null;
  frames: number;
  dropped: number;
}

/** Draws over a camera's image: the canvas' size and its px a px of the page. */
export type Adorn = (draw: CanvasRenderingContext2D, wide: number, tall: number, ratio: number, shown_image: CameraImage) => void;

class Tile {
  readonly element = document.createElement("figure");
  readonly canvas = document.createElement("canvas");
  private title = document.createElement("figcaption");
  private state = document.createElement("b");
  private facts = document.createElement("span");
  visible = false;
  shown: { shown_image: CameraImage; image: ImageBitmap | null } | null = null;
  private decoding = false;
  private next: CameraImage | null = null;
  private controls: Controls | null = null;
  private over: Adorn | null = null;
  private covered = new Coverage();

  /** Between keypoints, by their tracks' ids. */
  bones: [number, number][] = [];

  constructor(readonly number: number, private name: string, private size: [number, number] | undefined, private colours: Colours, private drawn: (shown_image: CameraImage) => void) {
    this.element.className = "camera";
    const label = document.createElement("em");
    label.textContent = name;
    this.title.append(this.state, label, this.facts);
    this.element.append(this.canvas, this.title);
    this.element.tabIndex = 0;
    this.element.addEventListener("click", () => this.element.classList.toggle("large"));
  }

  /** From now on it can be changed. */
  let_change(say: (line: string) => void): void {
    if (this.controls) return;
    const controls = new Controls(this.number, this.canvas, this.name, say, () => this.draw());
    this.controls = controls;
    this.title.append(controls.button);
    this.element.append(controls.panel);
    controls.button.addEventListener("click", (event) => {
      event.stopPropagation();
      controls.show(!controls.open);
    });
  }

  adorn(below: HTMLElement, over: Adorn): void {
    this.element.append(below);
    this.over = over;
  }

  show_state(state: string): void {
    this.state.className = state;
    this.state.title = state;
  }

  status(status: CameraStatus | undefined): void {
    this.show_state(status?.state ?? "connecting");
    if (!status) return;
    this.controls?.take(status);
    const parts = [status.state === "live" || status.state === "back" ? `${(status.rate ?? 0).toFixed(0)} Hz` : status.state];
    if (status.dropped > 0) parts.push(`${status.dropped} lost`);
    if (this.covered.share > 0 && !this.over) parts.push(`${Math.round(100 * this.covered.share)} % covered`);
    this.facts.textContent = parts.join(" · ");
  }

  /** Of images that come faster than they are decoded the newest counts. */
  async take(shown_image: CameraImage): Promise<void> {
    this.next = shown_image;
    if (this.decoding) return;
    this.decoding = true;
    while (this.next) {
      const now: CameraImage = this.next;
      this.next = null;
      const image = now.jpeg ? await createImageBitmap(now.jpeg).catch(() => null) : null;
      this.shown?.image?.close();
      this.shown = { shown_image: now, image };
      requestAnimationFrame(() => {
        this.draw();
        this.drawn(now);
      });
    }
    this.decoding = false;
  }

  private draw_bones(draw: CanvasRenderingContext2D, shown_image: CameraImage, scale: number): void {
    if (this.bones.length === 0) return;
    const { x, y, track } = shown_image.points;
    const at = new Map<number, number>();
    track.forEach((id, i) => at.set(id, i));
    for (const [from, to] of this.bones) {
      const a = at.get(from);
      const b = at.get(to);
      if (a === undefined || b === undefined) continue;
      draw.strokeStyle = this.colours.css(from, 0.8);
      draw.beginPath();
      draw.moveTo(scale * (x[a] + 0.5), scale * (y[a] + 0.5));
      draw.lineTo(scale * (x[b] + 0.5), scale * (y[b] + 0.5));
      draw.stroke();
    }
  }

  draw(): void {
    if (!this.shown) return;
    const { shown_image: shown_image, image } = this.shown;
    const width = shown_image.width || image?.width || (this.size?.[0] ?? 640);
    const height = shown_image.height || image?.height || (this.size?.[1] ?? 480);
    this.canvas.style.aspectRatio = `${width} / ${height}`;
    const ratio = Math.min(devicePixelRatio, 2);
    const wide = Math.max(16, Math.round(this.canvas.clientWidth * ratio));
    const tall = Math.round((wide * height) / width);
    if (this.canvas.width !== wide || this.canvas.height !== tall) {
      this.canvas.width = wide;
      this.canvas.height = tall;
    }
    const draw = this.canvas.getContext("2d")!;
    const scale = wide / width;
    if (image) draw.drawImage(image, 0, 0, wide, tall);
    else {
      draw.fillStyle = "#0b0e12";
      draw.fillRect(0, 0, wide, tall);
    }
    this.covered.add(shown_image.points.x, shown_image.points.y, width, height);
    if (this.over) this.over(draw, wide, tall, ratio, { ...shown_image, width, height });
    else if (this.element.classList.contains("large")) this.covered.draw(draw, wide, tall);
    draw.lineWidth = 1.25 * ratio;
    const { points, boxes } = shown_image;
    this.draw_bones(draw, shown_image, scale);
    for (let i = 0; i < points.x.length; ++i) {
      draw.strokeStyle = points.track[i] ? this.colours.css(points.track[i]) : "#ff5d5d";
      draw.beginPath();
      draw.arc(scale * (points.x[i] + 0.5), scale * (points.y[i] + 0.5), 3.2 * ratio, 0, 7);
      draw.stroke();
    }
    this.controls?.seen(points.x.length, width, height);
    this.controls?.draw(draw, scale, ratio);
    for (let i = 0; i < boxes.left.length; ++i) {
      draw.strokeStyle = this.colours.css(boxes.track[i]);
      draw.strokeRect(scale * boxes.left[i], scale * boxes.top[i], scale * boxes.width[i], scale * boxes.height[i]);
    }
  }
}

export class Cameras {
  private grid = document.querySelector<HTMLElement>("#cameras")!;
  private tiles: Tile[] = [];
  private watched = "";
  private scene: Scene | null = null;
  private save_bar = new SaveBar(this.grid.parentElement!, (line) => this.say(line));
  /** A camera whose image is shown elsewhere, and how wide there, px of the screen. */
  also: { camera: number; width: number } | null = null;
  private watcher: IntersectionObserver;

  constructor(private chosen: State, private colours: Colours, private say: (line: string) => void, private drawn: (shown_image: CameraImage) => void) {
    this.watcher = new IntersectionObserver((entries) => {
      for (const entry of entries) {
        const tile = this.tiles.find((each) => each.element === entry.target);
        if (tile) tile.visible = entry.isIntersecting;
      }
      this.ask();
    });
    new ResizeObserver(() => this.ask()).observe(this.grid);
    void this.chosen;
  }

  take(scene: Scene): void {
    this.scene = scene;
    const bones = bones_of(scene);
    for (const tile of this.tiles) tile.bones = bones;
    if (this.tiles.length === scene.cameras.length && scene.cameras.length > 0) return;
    this.watcher.disconnect();
    this.tiles = scene.cameras.map((camera, i) => new Tile(i, camera.name, camera.size, this.colours, this.drawn));
    this.grid.replaceChildren(...this.tiles.map((tile) => tile.element));
    for (const tile of this.tiles) {
      tile.bones = bones;
      if (scene.can_change) tile.let_change(this.say);
      this.watcher.observe(tile.element);
    }
  }

  /** What stands below a camera's image, and is drawn over it. False where there is no such camera. */
  adorn(camera: number, below: HTMLElement, over: Adorn): boolean {
    this.tiles[camera]?.adorn(below, over);
    return camera in this.tiles;
  }

  state(camera: number, state: string): void {
    this.tiles[camera]?.show_state(state);
  }

  shown_image(shown_image: CameraImage): void {
    this.tiles[shown_image.camera]?.take(shown_image);
  }
  status(cameras: CameraStatus[], unsaved: boolean): void {
    this.save_bar.take(this.scene?.can_change ?? false, this.scene?.rig_file, unsaved);
    this.tiles.forEach((tile, i) => tile.status(cameras[i]));
  }

  /** Says again what is watched, as after a new connection. */
  ask(anew = false): void {
    const ratio = Math.min(devicePixelRatio, 2);
    const step = (width: number) => Math.min(4096, Math.max(64, 32 * Math.ceil((width * ratio) / 32)));
    const widths = new Map<number, number>();
    for (const tile of this.tiles) if (tile.visible) widths.set(tile.number, step(tile.canvas.clientWidth));
    if (this.also) widths.set(this.also.camera, Math.max(step(this.also.width / ratio), widths.get(this.also.camera) ?? 0));
    const parts = document.hidden ? [] : [...widths].map(([camera, width]) => `${camera} ${width}`);
    const line = `watch ${parts.join(" ")}`;
    if (line === this.watched && !anew) return;
    this.watched = line;
    this.say(line);
  }
}
