// Masks over a camera's image: rectangles that are dragged, polygons whose corners are clicked. A click on a mask removes it.

/** x, y, width, height of a rectangle; x, y of each corner of a polygon, six numbers or more. Px of the camera. */
export type Mask = number[];

type Location = [number, number];

const MIN_DRAG = 4; // px of the page; less is a click
const CLOSE_BY = 9; // px of the page to the first corner: a click there closes the polygon
const MAX_CORNERS = 64; // that the server takes

function outline(mask: Mask, scale: number): Path2D {
  const path = new Path2D();
  if (mask.length === 4) path.rect(mask[0] * scale, mask[1] * scale, mask[2] * scale, mask[3] * scale);
  else for (let i = 0; i < mask.length; i += 2) path.lineTo((mask[i] + 0.5) * scale, (mask[i + 1] + 0.5) * scale); // a pixel's middle
  if (mask.length !== 4) path.closePath();
  return path;
}

export class MaskEditor {
  private masks: Mask[] = [];
  private drag: { from: Location; to: Location; begun: Location; far: boolean } | null = null; // `begun`: px of the page
  private corners: { px: Location; at: Location }[] = []; // of a polygon that is not closed; `at`: px of the page, in the canvas
  private pointer: Location | null = null;
  private active = false;
  private size: [number, number] = [0, 0];

  /** `say`: "mask" or "unmask", and which. */
  constructor(private canvas: HTMLCanvasElement, private send: (word: "mask" | "unmask", mask: Mask) => void, private redraw: () => void) {
    canvas.addEventListener("click", (event) => this.active && event.stopPropagation());
    canvas.addEventListener("dblclick", () => this.close());
    canvas.addEventListener("pointerdown", (event) => this.pressed(event));
    canvas.addEventListener("pointermove", (event) => this.moved(event));
    canvas.addEventListener("pointerup", (event) => this.released(event));
    canvas.addEventListener("pointercancel", () => (this.drag = null));
    document.addEventListener("keydown", (event) => this.key(event), { capture: true });
  }

  /** Whether masks are drawn now. */
  activate(active: boolean): void {
    this.active = active;
    this.canvas.classList.toggle("draws", active);
    if (!active) this.corners = [];
    this.redraw();
  }

  /** As the server has them. */
  take(masks: Mask[]): void {
    if (JSON.stringify(masks) === JSON.stringify(this.masks)) return;
    this.masks = masks;
    this.redraw();
  }

  /** Of the image that is shown, px. */
  fit(width: number, height: number): void {
    this.size = [width, height];
  }

  /** `scale`: canvas px a px of the camera. */
  draw(draw: CanvasRenderingContext2D, scale: number, ratio: number): void {
    draw.lineWidth = 1.25 * ratio;
    const dragged = this.dragged();
    for (const mask of dragged ? [...this.masks, dragged] : this.masks) this.draw_mask(draw, mask, scale, ratio);
    this.draw_corners(draw, scale, ratio);
  }

  private draw_mask(draw: CanvasRenderingContext2D, mask: Mask, scale: number, ratio: number): void {
    const path = outline(mask, scale);
    draw.save();
    draw.fillStyle = "#e0ab4a40";
    draw.strokeStyle = "#e0ab4a";
    draw.fill(path, "evenodd");
    draw.stroke(path);
    draw.clip(path, "evenodd");
    draw.beginPath();
    const { width, height } = draw.canvas;
    for (let d = -height; d < width; d += 6 * ratio) {
      draw.moveTo(d, height);
      draw.lineTo(d + height, 0);
    }
    draw.globalAlpha = 0.5;
    draw.stroke();
    draw.restore();
  }

  private draw_corners(draw: CanvasRenderingContext2D, scale: number, ratio: number): void {
    if (this.corners.length === 0) return;
    draw.strokeStyle = draw.fillStyle = "#e0ab4a";
    draw.beginPath();
    for (const { px } of this.corners) draw.lineTo((px[0] + 0.5) * scale, (px[1] + 0.5) * scale);
    if (this.pointer) draw.lineTo(this.pointer[0] * scale, this.pointer[1] * scale);
    draw.stroke();
    for (const [i, { px }] of this.corners.entries()) {
      draw.beginPath();
      draw.arc((px[0] + 0.5) * scale, (px[1] + 0.5) * scale, (i === 0 ? 4.5 : 3) * ratio, 0, 7);
      if (i === 0) draw.stroke();
      else draw.fill();
    }
  }

  private dragged(): Mask | null {
    if (!this.drag?.far) return null;
    const [[x, y], [to_x, to_y]] = [this.drag.from, this.drag.to];
    const mask = [Math.floor(Math.min(x, to_x)), Math.floor(Math.min(y, to_y)), Math.ceil(Math.abs(x - to_x)), Math.ceil(Math.abs(y - to_y))];
    return mask[2] > 1 && mask[3] > 1 ? mask : null;
  }

  /** A place on the canvas in px of the camera. */
  private location_of(event: PointerEvent): Location {
    const rect = this.canvas.getBoundingClientRect();
    const inside = (at: number, low: number, size: number, most: number) => Math.max(0, Math.min(most, ((at - low) / size) * most));
    return [inside(event.clientX, rect.left, rect.width, this.size[0]), inside(event.clientY, rect.top, rect.height, this.size[1])];
  }

  private pressed(event: PointerEvent): void {
    if (!this.active || !this.size[0] || event.button !== 0) return;
    event.preventDefault();
    (document.activeElement as HTMLElement | null)?.blur(); // of a number's field: Enter and Escape are for the mask now
    this.canvas.setPointerCapture(event.pointerId);
    const from = this.location_of(event);
    this.drag = { from, to: from, begun: [event.clientX, event.clientY], far: false };
  }

  private moved(event: PointerEvent): void {
    this.pointer = this.active ? this.location_of(event) : null;
    if (this.drag) {
      const { begun } = this.drag;
      // While corners are set there is no dragging.
      this.drag.far ||= this.corners.length === 0 && Math.hypot(event.clientX - begun[0], event.clientY - begun[1]) >= MIN_DRAG;
      this.drag.to = this.location_of(event);
    }
    if (this.drag || this.corners.length) this.redraw();
  }

  private released(event: PointerEvent): void {
    if (!this.drag) return;
    const { from, far } = this.drag;
    const mask = this.dragged();
    this.drag = null;
    if (mask) this.add(mask);
    else if (!far) this.clicked(from, event);
    this.redraw();
  }

  private clicked([x, y]: Location, event: PointerEvent): void {
    const rect = this.canvas.getBoundingClientRect();
    const at: Location = [event.clientX - rect.left, event.clientY - rect.top];
    const near = (corner: { at: Location } | undefined, reach: number) => !!corner && Math.hypot(corner.at[0] - at[0], corner.at[1] - at[1]) < reach;
    if (this.corners.length === 0) {
      const draw = this.canvas.getContext("2d")!;
      draw.save();
      draw.resetTransform();
      const hit = this.masks.find((mask) => draw.isPointInPath(outline(mask, 1), x, y, "evenodd"));
      draw.restore();
      if (hit) return this.send("unmask", hit);
    } else if (this.corners.length >= 3 && near(this.corners[0], CLOSE_BY)) {
      return this.close();
    } else if (near(this.corners[this.corners.length - 1], MIN_DRAG)) {
      return; // the second of a double click
    }
    const last = (value: number, size: number) => Math.min(size - 1, Math.floor(value));
    this.corners.push({ px: [last(x, this.size[0]), last(y, this.size[1])], at });
    if (this.corners.length === MAX_CORNERS) this.close();
  }

  /** The polygon, where it has three corners. */
  private close(): void {
    if (!this.active || this.corners.length < 3) return;
    const mask = this.corners.flatMap(({ px }) => px);
    this.corners = [];
    this.add(mask);
    this.redraw();
  }

  private add(mask: Mask): void {
    this.masks = [...this.masks, mask]; // as it will be said in a moment
    this.send("mask", mask);
  }

  /** Before the page's keys: Enter closes a polygon, Escape leaves it. */
  private key(event: KeyboardEvent): void {
    if (this.corners.length === 0 || (event.key !== "Enter" && event.key !== "Escape")) return;
    if (event.target instanceof HTMLInputElement) return;
    event.preventDefault();
    event.stopPropagation();
    if (event.key === "Enter") this.close();
    else this.corners = [];
    this.redraw();
  }
}
