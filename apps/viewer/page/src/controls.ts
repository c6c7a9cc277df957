// What of a live camera is changed from the page: exposure, gain, the detector's threshold, and masks, which are drawn into its
// picture. The server says how things are four times a second; what the user has in hand is not overwritten by that.
import "./controls.css";
import { put } from "./state";

/** As apps/viewer/live_viewer.cpp says it. */
export interface Dial {
  name: string;
  unit: string;
  least: number;
  most: number;
  now: number;
}
export type Mask = [number, number, number, number]; // x, y, width, height, px of the camera

export interface Changeable {
  dials?: Dial[];
  /** Missing where no markers are looked for. */
  threshold?: number | null;
  masks?: Mask[];
  learning?: boolean;
  refused?: string;
}

const IN_HAND_MS = 900;
const SEND_EVERY_MS = 100;
const LEAST_DRAG = 4; // px of the page; less is a click
const BRIGHTEST = 255;

const make = <K extends keyof HTMLElementTagNameMap>(kind: K, name = "", text = ""): HTMLElementTagNameMap[K] => {
  const element = document.createElement(kind);
  element.className = name;
  element.textContent = text;
  return element;
};

/** A slider with a number beside it. Where it spans decades the slider does too. */
class Slider {
  readonly element = make("div", "dial");
  private range = make("input");
  private number = make("input");
  private touched = 0;
  private typing = false; // what is in the field was not sent yet
  private sent = 0;
  private waiting = 0;
  private least = 0;
  private most = 1;

  constructor(name: string, unit: string, private send: (value: number) => void) {
    const title = name[0].toUpperCase() + name.slice(1);
    this.range.type = "range";
    this.range.min = "0";
    this.range.max = "1000";
    this.range.setAttribute("aria-label", title);
    this.number.type = "number";
    this.number.step = "any";
    this.number.setAttribute("aria-label", unit ? `${title}, ${unit}` : title);
    this.element.dataset.dial = name;
    this.element.append(make("label", "", title), this.range, this.number, make("span", "unit", unit));
    this.range.addEventListener("input", () => this.turned(this.place_to_value(Number(this.range.value) / 1000)));
    this.number.addEventListener("input", () => (this.typing = true));
    this.number.addEventListener("change", () => {
      this.typing = false;
      if (this.number.value !== "") this.turned(Number(this.number.value));
    });
    this.number.addEventListener("blur", () => (this.typing = false));
  }

  span(least: number, most: number): void {
    this.least = least;
    this.most = most;
    this.number.min = `${least}`;
    this.number.max = `${most}`;
  }
  show(value: number | null): void {
    if (performance.now() - this.touched < IN_HAND_MS || this.typing) return;
    this.range.value = `${Math.round(1000 * this.value_to_place(value ?? 0))}`;
    this.number.value = value === null ? "" : `${+value.toPrecision(4)}`;
    this.number.placeholder = value === null ? "auto" : "";
    this.element.classList.toggle("auto", value === null);
  }
  let_go(): void {
    this.touched = 0;
  }

  private get by_decades(): boolean {
    return this.least > 0 && this.most / this.least > 50;
  }
  private place_to_value(place: number): number {
    const value = this.by_decades ? this.least * (this.most / this.least) ** place : this.least + place * (this.most - this.least);
    return Math.min(this.most, Math.max(this.least, Number(value.toPrecision(3))));
  }
  private value_to_place(value: number): number {
    const inside = Math.min(this.most, Math.max(this.least, value));
    if (this.most <= this.least) return 0;
    return this.by_decades ? Math.log(inside / this.least) / Math.log(this.most / this.least) : (inside - this.least) / (this.most - this.least);
  }

  private turned(value: number): void {
    this.touched = performance.now();
    this.element.classList.remove("auto");
    this.range.value = `${Math.round(1000 * this.value_to_place(value))}`;
    this.number.value = `${value}`;
    clearTimeout(this.waiting);
    const early = SEND_EVERY_MS - (performance.now() - this.sent);
    if (early > 0) {
      this.waiting = window.setTimeout(() => this.turned(value), early);
      return;
    }
    this.sent = performance.now();
    this.send(value);
  }
}

/** The panel under one camera's picture, and the masks in it. */
export class Controls {
  readonly button = make("button", "adjust");
  readonly panel = make("div", "controls");
  private sliders = new Map<string, Slider>();
  private threshold: Slider;
  private automatic = make("button", "chip", "Auto");
  private marker_rows = make("div", "markers");
  private found = make("span", "found");
  private lit = make("button", "chip", "Mask what is lit");
  private none = make("button", "chip", "Remove all");
  private count = make("span", "count");
  private refused = make("p", "refused");
  private masks: Mask[] = [];
  private drag: { x: number; y: number; to_x: number; to_y: number } | null = null;
  private begun: [number, number] = [0, 0]; // of the drag, px of the page
  private dragged = false;
  private size: [number, number] = [0, 0];
  open = false;

  constructor(private camera: number, private canvas: HTMLCanvasElement, name: string, private say: (line: string) => void, private redraw: () => void) {
    this.button.innerHTML = '<svg viewBox="0 0 16 16" aria-hidden="true"><path d="M1 4h7M12 4h3M1 12h3M8 12h7"/><circle cx="10" cy="4" r="2"/><circle cx="6" cy="12" r="2"/></svg>';
    this.button.title = "Exposure, gain, threshold and masks";
    this.button.setAttribute("aria-label", `Adjust ${name}`);
    this.threshold = new Slider("threshold", "", (value) => this.say(`threshold ${camera} ${value}`));
    this.threshold.span(0, BRIGHTEST);
    this.automatic.title = "Let the threshold follow from the picture's noise";
    this.threshold.element.append(this.automatic);
    this.automatic.addEventListener("click", () => {
      this.threshold.let_go();
      say(`threshold ${camera} auto`);
    });
    this.lit.title = "Masks what stands out and does not move in the next second; markers that move stay";
    this.lit.addEventListener("click", () => say(`lit ${camera}`));
    this.none.addEventListener("click", () => say(`unmask ${camera} all`));
    const masks = make("div", "dial masks");
    masks.append(make("label", "", "Masks"), this.count, this.lit, this.none);
    this.marker_rows.append(this.threshold.element, masks, make("p", "hint", "Drag over a reflection in the picture to mask it; click a mask to remove it."), this.found);
    this.panel.append(this.marker_rows, this.refused);
    this.panel.hidden = true;
    this.panel.addEventListener("click", (event) => event.stopPropagation());
    this.wire_drawing();
  }

  show(open: boolean): void {
    this.open = open;
    this.panel.hidden = !open;
    this.button.setAttribute("aria-pressed", `${open}`);
    this.canvas.classList.toggle("draws", open && !this.marker_rows.hidden);
    this.redraw();
  }

  take(status: Changeable): void {
    for (const dial of status.dials ?? []) {
      let slider = this.sliders.get(dial.name);
      if (!slider) {
        slider = new Slider(dial.name, dial.unit, (value) => this.say(`dial ${this.camera} ${dial.name} ${value}`));
        this.sliders.set(dial.name, slider);
        this.marker_rows.before(slider.element);
      }
      slider.span(dial.least, dial.most);
      slider.show(dial.now);
    }
    this.marker_rows.hidden = status.threshold === undefined;
    this.threshold.show(status.threshold ?? null);
    this.automatic.classList.toggle("on", status.threshold === null);
    const masks = status.masks ?? [];
    if (JSON.stringify(masks) !== JSON.stringify(this.masks)) {
      this.masks = masks;
      this.redraw();
    }
    put(this.count, masks.length ? `${masks.length}` : "none");
    this.none.hidden = masks.length === 0;
    this.lit.disabled = status.learning ?? false;
    put(this.lit, status.learning ? "Looking …" : "Mask what is lit");
    put(this.refused, status.refused ?? "");
    this.refused.hidden = !status.refused;
    this.button.classList.toggle("bad", !!status.refused);
  }

  /** How many blobs are in the picture that is shown, and how large it is, px. */
  seen(count: number, width: number, height: number): void {
    this.size = [width, height];
    if (this.open) put(this.found, `${count} ${count === 1 ? "marker" : "markers"} found`);
  }

  /** Masks over the picture; `scale`: canvas px a px of the camera. */
  draw(draw: CanvasRenderingContext2D, scale: number, ratio: number): void {
    draw.lineWidth = 1.25 * ratio;
    for (const mask of this.masks) this.draw_mask(draw, mask, scale, ratio);
    const drawn = this.drawn();
    if (drawn) this.draw_mask(draw, drawn, scale, ratio);
  }

  private draw_mask(draw: CanvasRenderingContext2D, [x, y, width, height]: Mask, scale: number, ratio: number): void {
    const [left, top, wide, tall] = [x * scale, y * scale, width * scale, height * scale];
    draw.save();
    draw.beginPath();
    draw.rect(left, top, wide, tall);
    draw.fillStyle = "#e0ab4a40";
    draw.strokeStyle = "#e0ab4a";
    draw.fill();
    draw.stroke();
    draw.clip();
    draw.beginPath();
    for (let d = -tall; d < wide; d += 6 * ratio) {
      draw.moveTo(left + d, top + tall);
      draw.lineTo(left + d + tall, top);
    }
    draw.globalAlpha = 0.5;
    draw.stroke();
    draw.restore();
  }

  private drawn(): Mask | null {
    if (!this.drag || !this.dragged) return null;
    const { x, y, to_x, to_y } = this.drag;
    const mask: Mask = [Math.floor(Math.min(x, to_x)), Math.floor(Math.min(y, to_y)), Math.ceil(Math.abs(x - to_x)), Math.ceil(Math.abs(y - to_y))];
    return mask[2] > 1 && mask[3] > 1 ? mask : null;
  }

  /** A place on the canvas in px of the camera. */
  private place(event: PointerEvent): [number, number] {
    const rect = this.canvas.getBoundingClientRect();
    const inside = (at: number, low: number, size: number, most: number) => Math.max(0, Math.min(most, ((at - low) / size) * most));
    return [inside(event.clientX, rect.left, rect.width, this.size[0]), inside(event.clientY, rect.top, rect.height, this.size[1])];
  }

  private wire_drawing(): void {
    const { canvas } = this;
    canvas.addEventListener("click", (event) => this.open && event.stopPropagation());
    canvas.addEventListener("pointerdown", (event) => {
      if (!this.open || this.marker_rows.hidden || !this.size[0]) return;
      event.preventDefault();
      canvas.setPointerCapture(event.pointerId);
      const [x, y] = this.place(event);
      this.drag = { x, y, to_x: x, to_y: y };
      this.begun = [event.clientX, event.clientY];
      this.dragged = false;
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!this.drag) return;
      this.dragged ||= Math.hypot(event.clientX - this.begun[0], event.clientY - this.begun[1]) >= LEAST_DRAG;
      [this.drag.to_x, this.drag.to_y] = this.place(event);
      this.redraw();
    });
    canvas.addEventListener("pointercancel", () => (this.drag = null));
    canvas.addEventListener("pointerup", () => {
      if (!this.drag) return;
      const { x, y } = this.drag;
      const mask = this.drawn();
      this.drag = null;
      if (mask) {
        this.masks = [...this.masks, mask]; // as it will be said in a moment
        this.say(`mask ${this.camera} ${mask.join(" ")}`);
      } else {
        const hit = this.masks.find(([left, top, width, height]) => x >= left && x < left + width && y >= top && y < top + height);
        if (hit) this.say(`unmask ${this.camera} ${hit.join(" ")}`);
      }
      this.redraw();
    });
  }
}

/** Over the cameras: whether what was changed is in the rig file. */
export class SaveBar {
  private bar = make("div", "save_bar");
  private button = make("button", "chip on");
  private words = make("span");
  private rig = "";
  private changed = false;

  constructor(place: Element, say: (line: string) => void) {
    this.bar.append(this.words, this.button);
    this.bar.hidden = true;
    this.button.id = "save_rig";
    this.button.addEventListener("click", () => say("save"));
    place.prepend(this.bar);
  }

  take(can_change: boolean, rig_file: string | undefined, unsaved: boolean): void {
    this.rig = rig_file?.split("/").pop() ?? "";
    this.changed ||= unsaved;
    this.bar.hidden = !can_change || !this.changed;
    this.button.hidden = !this.rig || !unsaved;
    put(this.button, `Save to ${this.rig}`);
    if (!this.rig) put(this.words, "These changes end with the run: it has no rig file to keep them in.");
    else put(this.words, unsaved ? "Changed, and not saved yet" : `All changes are in ${this.rig}`);
    this.bar.classList.toggle("unsaved", unsaved);
  }
}
