// A wand that is waved before live cameras, or people who walk: each one's image with them in it and the parts of the image in which
// they were, who has seen enough, and together with which; then how good the calibration is, beside the rig as it stands.
import "./wand.css";
import type { Cameras } from "./cameras";
import type { Scene } from "./scene";
import { put } from "./state";
import type { CameraImage } from "./wire";

interface Detected {
  name: string;
  state: string;
  coverage: number;
  views: number;
  covered: boolean;
  parts: number[];
}
interface Fit {
  mean_px: number;
  rms_px: number;
  inliers: number;
  observations: number;
}
interface PeopleReport {
  people: number;
  height_m: number;
  cameras: Record<string, { rms_px: number; coverage: number; deviation: { centre_mm: number; focal: number } }>;
  notes: string[];
}
interface Report {
  all: Fit;
  cameras: Record<string, Fit & { coverage: number; world_error_mm: number }>;
  volume: { median_mm: number; p90_mm: number; three_view: number };
  held_out?: { rms_px: number; length_mean_mm: number; length_rms_mm: number; frames: number };
  grade: string;
  grade_text: string;
  notes: string[];
}
/** As apps/cli/calibration_page.cpp says it. */
interface Waved {
  phase: "waving" | "computing" | "done" | "failed";
  /** Share of an image, views of a pair, and parts of an image. */
  required: number;
  needed: number;
  across: number;
  down: number;
  seconds?: number;
  cameras?: Detected[];
  shared?: { a: number; b: number; views: number; sufficient: boolean }[];
  /** What is to be done yet. */
  missing?: string[];
  report?: Report | PeopleReport;
  rig?: string;
  why?: string;
  /** Asked for on this page, once the rig was found. */
  ground?: null | { phase: "looking" | "set" | "failed"; rms_mm?: number; why?: string; warnings?: string[] };
}

const [MARGIN, GAP, BELOW, NARROWEST] = [16, 14, 118, 160]; // px; of the cards and what stands below their images

/** The words for each kind. */
const WORDS = {
  wand: {
    it: "The wand was",
    invite: "Wave the wand through the whole volume",
    computing: "Put the wand down; this takes some seconds.",
  },
  people: {
    it: "People were",
    invite: "Walk through the whole volume, near and far",
    computing: "The recorded videos are searched for people; this takes some minutes.",
  },
};
export type Kind = keyof typeof WORDS;
export const is_kind = (job?: string): job is Kind => job !== undefined && job in WORDS;

const make = <K extends keyof HTMLElementTagNameMap>(kind: K, name = "", text = ""): HTMLElementTagNameMap[K] => {
  const element = document.createElement(kind);
  element.className = name;
  element.textContent = text;
  return element;
};
const capital = (text: string) => `${text.slice(0, 1).toUpperCase()}${text.slice(1)}`;
const percent = (share: number) => `${(100 * share).toFixed(0)}\u00a0%`;

const row = (kind: "th" | "td", ...texts: string[]) => {
  const line = make("tr");
  line.append(...texts.map((text) => make(kind, "", text)));
  return line;
};

/** What stands under one camera's image, and over it. */
class CameraCard {
  readonly element = make("div", "waved");
  private bar = make("i");
  private words = make("p", "coverage");
  private pairs = make("p", "pairs");
  private seen: Detected | null = null;
  /** Width over height of its images. */
  aspect = 4 / 3;

  constructor(private kind: Kind, private waved: () => Waved) {
    const track = make("div", "coverage_bar");
    track.append(this.bar, make("b"));
    this.element.append(track, this.words, this.pairs);
  }

  take(index: number, seen: Detected): void {
    this.seen = seen;
    const { required: required, needed, shared, cameras } = this.waved();
    // The bar is full at the wanted share.
    this.bar.style.width = `${Math.min(100, (100 * seen.coverage) / required)}%`;
    this.element.classList.toggle("enough", seen.covered);
    const gives = seen.state === "live" || seen.state === "back";
    if (!gives) put(this.words, `The camera is ${seen.state}`);
    else put(this.words, seen.covered ? `Enough: ${percent(seen.coverage)} of its picture` : `${percent(seen.coverage)} of its picture; ${percent(required)} wanted`);
    const chips = (shared ?? [])
      .filter((pair) => pair.a === index || pair.b === index)
      .map((pair) => {
        const other = cameras?.[pair.a === index ? pair.b : pair.a]?.name ?? "";
        const chip = make("span", pair.sufficient ? "pair enough" : "pair", pair.sufficient ? `✓ ${other}` : `${other} ${pair.views}/${needed}`);
        chip.title = `${WORDS[this.kind].it} seen ${pair.views} times together with ${other}; ${needed} tell how they stand to each other`;
        return chip;
      });
    this.pairs.replaceChildren("Together with ", ...chips);
    this.pairs.hidden = chips.length === 0;
  }

  draw(draw: CanvasRenderingContext2D, wide: number, tall: number, ratio: number, picture: CameraImage): void {
    if (picture.width > 0) this.aspect = picture.width / picture.height;
    const { across, down } = this.waved();
    const [w, h] = [wide / across, tall / down];
    draw.fillStyle = "#55b97a4d";
    for (const part of this.seen?.parts ?? []) draw.fillRect((part % across) * w, Math.floor(part / across) * h, w, h);
    draw.strokeStyle = "#ffffff1f";
    draw.lineWidth = ratio;
    draw.beginPath();
    for (let i = 1; i < across; ++i) draw.rect(i * w, 0, 0, tall);
    for (let i = 1; i < down; ++i) draw.rect(0, i * h, wide, 0);
    draw.stroke();
    if (this.kind === "wand") this.draw_wand(draw, wide / (picture.width || wide), ratio, picture);
    else this.draw_people(draw, wide / (picture.width || wide), ratio, picture);
  }

  private draw_people(draw: CanvasRenderingContext2D, scale: number, ratio: number, { points }: CameraImage): void {
    draw.fillStyle = "#ffd166";
    for (const i of points.track.keys()) {
      if (points.track[i] <= 0) continue;
      draw.beginPath();
      draw.arc(scale * (points.x[i] + 0.5), scale * (points.y[i] + 0.5), 3 * ratio, 0, 7);
      draw.fill();
    }
  }

  private draw_wand(draw: CanvasRenderingContext2D, scale: number, ratio: number, { points }: CameraImage): void {
    const marks = [...points.track.keys()].filter((i) => points.track[i] > 0).sort((a, b) => points.track[a] - points.track[b]);
    if (marks.length === 0) return;
    draw.strokeStyle = "#ffd166";
    draw.lineWidth = 2.5 * ratio;
    draw.beginPath();
    for (const i of marks) draw.lineTo(scale * (points.x[i] + 0.5), scale * (points.y[i] + 0.5));
    draw.stroke();
    draw.fillStyle = "#ffd166";
    for (const i of marks) {
      draw.beginPath();
      draw.arc(scale * (points.x[i] + 0.5), scale * (points.y[i] + 0.5), 4.5 * ratio, 0, 7);
      draw.fill();
    }
  }
}

export class Wand {
  private main = make("main");
  private head = make("div", "wand_head");
  private title = make("h1");
  private detail = make("p");
  private enough = make("button", "", "That will do");
  private missing = make("ul", "missing");
  private result = make("div", "result");
  private floor = make("div", "floor");
  private set_ground = make("button", "chip", "Set the ground");
  private floor_words = make("p");
  private grid = document.querySelector<HTMLElement>("#cameras")!;
  private arranged = "";
  private cards: CameraCard[] = [];
  private waved: Waved = { phase: "waving", required: 0.3, needed: 200, across: 10, down: 8 };

  constructor(private kind: Kind, private cameras: Cameras, say: (line: string) => void) {
    this.main.id = "wand";
    document.body.classList.add("wand");
    const words = make("div", "words");
    words.append(this.title, this.detail, this.missing);
    this.enough.id = "enough";
    this.enough.title = "Calibrate by what was seen so far";
    this.enough.addEventListener("click", () => say("enough"));
    this.head.append(words, this.enough);
    this.set_ground.id = "set_ground";
    this.set_ground.title = "Origin and axes by the L-frame that lies on the floor now";
    this.set_ground.addEventListener("click", () => {
      this.set_ground.disabled = true;
      say("ground");
    });
    this.floor.append(make("h2", "", "The floor"), this.floor_words, this.set_ground);
    this.floor.classList.toggle("absent", this.kind !== "wand");
    this.main.append(this.head, this.result, this.floor, this.grid);
    document.querySelector("#panel")!.before(this.main);
    new ResizeObserver(() => this.arrange()).observe(this.grid);
    this.tell();
  }

  /** Of a rig that is calibrated: what of space is shown. Whether it is one. */
  frame(scene: Scene): boolean {
    const centres = scene.cameras.flatMap((camera) => (camera.centre ? [camera.centre] : []));
    if (centres.length < scene.cameras.length) return false;
    const of = (axis: number) => centres.map((centre) => centre[axis]);
    scene.low = [Math.min(...of(0)), Math.min(...of(1)), Math.min(...of(2))];
    scene.high = [Math.max(...of(0)), Math.max(...of(1)), Math.max(...of(2))];
    return true;
  }

  /** As many columns as make the images largest while all of them are in sight. */
  private arrange(): void {
    const count = this.waved.cameras?.length ?? 0;
    const [width, height] = [this.grid.clientWidth - 2 * MARGIN, this.grid.clientHeight - 2 * MARGIN];
    if (count === 0 || width <= 0) return;
    const aspects = this.cards.map((card) => card.aspect);
    const narrowest = aspects.length > 0 ? Math.min(...aspects) : 4 / 3; // the tallest decides how wide all can be
    let best = [1, 0];
    for (let columns = 1; columns <= count; ++columns) {
      const row = height / Math.ceil(count / columns) - GAP - BELOW;
      const wide = Math.min((width + GAP) / columns - GAP, row * narrowest);
      if (wide > best[1]) best = [columns, wide];
    }
    const wide = Math.max(best[1], Math.min(NARROWEST, width));
    const columns = Math.max(1, Math.min(best[0], Math.floor((width + GAP) / (wide + GAP))));
    this.grid.style.gridTemplateColumns = `repeat(${columns}, ${Math.floor(wide)}px)`;
  }

  take(json: string): void {
    this.waved = JSON.parse(json) as Waved;
    const { cameras } = this.waved;
    cameras?.forEach((seen, i) => {
      this.card(i)?.take(i, seen);
      this.cameras.state(i, seen.state);
    });
    const shapes = cameras ? this.cards.map((card) => card.aspect.toFixed(2)).join() : "";
    if (shapes !== this.arranged) {
      this.arranged = shapes;
      this.arrange();
    }
    this.tell();
  }

  private card(index: number): CameraCard | null {
    if (this.cards[index]) return this.cards[index];
    const card = new CameraCard(this.kind, () => this.waved);
    if (!this.cameras.adorn(index, card.element, (...all) => card.draw(...all))) return null;
    return (this.cards[index] = card);
  }

  private tell(): void {
    const { phase, cameras, seconds, report, rig, why, missing } = this.waved;
    const words = WORDS[this.kind];
    this.missing.hidden = phase !== "waving" || !missing?.length;
    if (!this.missing.hidden && this.missing.textContent !== missing!.map(capital).join("")) this.missing.replaceChildren(...missing!.map((line) => make("li", "", capital(line))));
    const ready = cameras?.filter((camera) => camera.covered).length ?? 0;
    document.body.classList.toggle("wand_done", phase === "done");
    document.body.dataset.wand = phase;
    this.enough.hidden = phase !== "waving" || !cameras;
    this.head.classList.toggle("bad", phase === "failed");
    if (phase === "waving") {
      put(this.title, words.invite);
      put(this.detail, cameras ? `${ready} of ${cameras.length} cameras have seen enough · ${(seconds ?? 0).toFixed(0)} s` : "Waiting for the cameras …");
    } else if (phase === "computing") {
      put(this.title, "Enough. Calibrating …");
      put(this.detail, words.computing);
    } else if (phase === "failed") {
      put(this.title, "No rig results from it");
      put(this.detail, why ?? "");
    } else if (report) {
      put(this.title, "Calibrated");
      put(this.detail, `The rig was written to ${rig ?? ""}`);
      this.result.replaceChildren(...("grade" in report ? this.judged(report) : this.told(report)));
      this.tell_floor();
    }
  }

  private tell_floor(): void {
    const { ground } = this.waved;
    const observing = ground?.phase === "looking";
    this.set_ground.disabled = observing;
    put(this.set_ground, ground?.phase === "set" ? "Set it again" : "Set the ground");
    this.floor.dataset.phase = ground?.phase ?? "";
    if (!ground) put(this.floor_words, "Lay the L-frame down, step back, and set the ground: its first marker becomes the origin, z is up.");
    else if (observing) put(this.floor_words, "Looking at the L-frame for three seconds …");
    else if (ground.phase === "set") put(this.floor_words, [`The ground is set; the L-frame fits to ${(ground.rms_mm ?? 0).toFixed(2)} mm. The rig file has it.`, ...(ground.warnings ?? [])].join(" "));
    else put(this.floor_words, `Not set: ${ground.why ?? ""}`);
  }

  /** Of people there is no part that was held out, but each camera's own deviation. */
  private told(report: PeopleReport): HTMLElement[] {
    const table = make("table", "each");
    table.append(row("th", "Camera", "Error", "Place", "Focal length", "Coverage"));
    for (const [name, { rms_px, deviation, coverage }] of Object.entries(report.cameras))
      table.append(row("td", name, `${rms_px.toFixed(1)} px`, `± ${(deviation.centre_mm / 10).toFixed(1)} cm`, `± ${(100 * deviation.focal).toFixed(1)}\u00a0%`, percent(coverage)));
    const facts = make("ul");
    facts.append(make("li", "", `${report.people === 1 ? "One person was" : `${report.people} people were`} seen by two cameras or more; height ${report.height_m.toFixed(2)} m; the floor is z = 0`));
    for (const note of report.notes) facts.append(make("li", "", capital(note.replaceAll("`", ""))));
    return [table, facts, make("p", "hint", "Close this page to end.")];
  }

  private judged(report: Report): HTMLElement[] {
    const grade = make("p", `grade ${report.grade}`);
    grade.append(make("strong", "", report.grade), make("span", "", report.grade_text));
    const table = make("table");
    table.append(row("th", "Camera", "Error", "In space", "Coverage"));
    for (const [name, camera] of Object.entries(report.cameras))
      table.append(row("td", name, `${camera.mean_px.toFixed(2)} px`, `${camera.world_error_mm.toFixed(2)} mm`, percent(camera.coverage)));
    table.append(row("td", "All", `${report.all.mean_px.toFixed(2)} px`, "", ""));
    const facts = make("ul");
    const { held_out: held, volume } = report;
    if (held) facts.append(make("li", "", `Judged on ${held.frames} places of the wand that took no part: its length is off by ${held.length_rms_mm.toFixed(2)} mm`));
    facts.append(make("li", "", `A marker's place is known to ${volume.median_mm.toFixed(2)} mm, in the worst tenth of the volume to ${volume.p90_mm.toFixed(2)} mm`));
    for (const note of report.notes) facts.append(make("li", "", capital(note.replaceAll("`", ""))));
    return [grade, table, facts, make("p", "hint", "Close this page to end.")];
  }
}
