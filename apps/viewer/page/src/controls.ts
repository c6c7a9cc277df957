// What of a live camera is changed from the page: exposure, gain, the detector's threshold, and masks, which are drawn into its
// image. The server says how things are four times a second.
import "./controls.css";
import { MaskEditor, type Mask } from "./masks";
import { make, Slider } from "./slider";
import { put } from "./state";

/** As apps/viewer/live_viewer.cpp says it. */
export interface CameraControl {
  name: string;
  unit: string;
  min: number;
  max: number;
  now: number;
}
export interface Changeable {
  controls?: CameraControl[];
  /** Missing where no markers are searched for. */
  threshold?: number | null;
  masks?: Mask[];
  learning?: boolean;
  refused?: string;
}

const BRIGHTEST = 255;
const HINT = "Drag over a reflection in the image to mask it, or click the corners of its shape: a double click or Enter closes it, Escape leaves it. Click a mask to remove it.";

/** The panel under one camera's image, and the masks in it. */
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
  private masks: MaskEditor;
  open = false;

  constructor(private camera: number, canvas: HTMLCanvasElement, name: string, private say: (line: string) => void, redraw: () => void) {
    this.button.innerHTML = '<svg viewBox="0 0 16 16" aria-hidden="true"><path d="M1 4h7M12 4h3M1 12h3M8 12h7"/><circle cx="10" cy="4" r="2"/><circle cx="6" cy="12" r="2"/></svg>';
    this.button.title = "Exposure, gain, threshold and masks";
    this.button.setAttribute("aria-label", `Adjust ${name}`);
    this.threshold = new Slider("threshold", "", (value) => this.say(`threshold ${camera} ${value}`));
    this.threshold.span(0, BRIGHTEST);
    this.automatic.title = "Let the threshold follow from the image's noise";
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
    this.marker_rows.append(this.threshold.element, masks, make("p", "hint", HINT), this.found);
    this.panel.append(this.marker_rows, this.refused);
    this.panel.hidden = true;
    this.panel.addEventListener("click", (event) => event.stopPropagation());
    this.masks = new MaskEditor(canvas, (word, mask) => say(`${word} ${camera} ${mask.join(" ")}`), redraw);
  }

  show(open: boolean): void {
    this.open = open;
    this.panel.hidden = !open;
    this.button.setAttribute("aria-pressed", `${open}`);
    this.masks.activate(open && !this.marker_rows.hidden);
  }

  take(status: Changeable): void {
    for (const control of status.controls ?? []) {
      let slider = this.sliders.get(control.name);
      if (!slider) {
        slider = new Slider(control.name, control.unit, (value) => this.say(`dial ${this.camera} ${control.name} ${value}`));
        this.sliders.set(control.name, slider);
        this.marker_rows.before(slider.element);
      }
      slider.span(control.min, control.max);
      slider.show(control.now);
    }
    this.marker_rows.hidden = status.threshold === undefined;
    this.threshold.show(status.threshold ?? null);
    this.automatic.classList.toggle("on", status.threshold === null);
    const masks = status.masks ?? [];
    this.masks.take(masks);
    put(this.count, masks.length ? `${masks.length}` : "none");
    this.none.hidden = masks.length === 0;
    this.lit.disabled = status.learning ?? false;
    put(this.lit, status.learning ? "Looking …" : "Mask what is lit");
    put(this.refused, status.refused ?? "");
    this.refused.hidden = !status.refused;
    this.button.classList.toggle("bad", !!status.refused);
  }

  /** How many blobs are in the image that is shown, and how large it is, px. */
  seen(count: number, width: number, height: number): void {
    this.masks.fit(width, height);
    if (this.open) put(this.found, `${count} ${count === 1 ? "marker" : "markers"} found`);
  }

  /** Masks over the image; `scale`: canvas px a px of the camera. */
  draw(draw: CanvasRenderingContext2D, scale: number, ratio: number): void {
    this.masks.draw(draw, scale, ratio);
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
