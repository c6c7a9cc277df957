// What the page says of a scene in words: its head, its legend, and all that is known of it.
import type { CameraStatus } from "./cameras";
import type { Colours } from "./colours";
import type { Latency } from "./latency";
import { Live } from "./live";
import type { Motion } from "./motion";
import { is_computed } from "./scene";
import { put } from "./state";
import { clock } from "./timeline";

/** How a live run is, as apps/viewer/live_viewer.cpp says it. */
export interface Status {
  cameras?: CameraStatus[];
  unsaved?: boolean;
  steps?: { name: string; median: number; p99: number }[];
  superseded?: number;
  notes?: string[];
}

const element = (id: string): HTMLElement => document.querySelector<HTMLElement>(`#${id}`)!;
const many = (count: number, word: string) => `${count} ${word}${count === 1 ? "" : "s"}`;

export class Words {
  status: Status = {};
  private updated = 0;

  constructor(private motion: () => Motion, private colours: Colours, private latency: Latency) {}

  /** The scene is another one. */
  update(): void {
    const { scene } = this.motion();
    const live = scene.kind === "live";
    put(element("list_tab"), { space: "Markers", ground: "People", image: "Tracks" }[scene.frame]);
    const name = scene.job === "wand" ? "Wand calibration" : scene.job === "people" ? "Calibration by people" : live ? "Live" : scene.name.split("/").pop() || "Recording";
    put(element("title"), name);
    document.title = `${name} – Marey`;
    element("record").hidden = !scene.can_record;
    element("pictures_tab").hidden = !live || scene.cameras.length === 0;
    for (const id of ["rig", "rays"]) element(id).hidden = !(scene.frame === "space" && scene.cameras.some((camera) => camera.centre));
    for (const id of ["top", "front", "side"]) element(id).hidden = scene.frame !== "space";
    this.legend();
    this.facts();
    this.about();
  }

  legend(): void {
    element("legend").replaceChildren(
      ...this.colours.legend().map(([text, colour]) => {
        const entry = document.createElement("span");
        const dot = document.createElement("i");
        dot.style.background = colour;
        entry.append(dot, text);
        return entry;
      }),
    );
  }

  /** At most as often as can be read. */
  live_facts(): void {
    if (this.motion().scene.kind === "live" && performance.now() - this.updated > 400) this.facts();
  }

  private facts(): void {
    const motion = this.motion();
    const { scene } = motion;
    const parts: string[] = [];
    const count = motion instanceof Live ? motion.count() : scene.tracks.length;
    if (count) parts.push(many(count, scene.frame === "space" ? "marker" : "track"));
    if (motion instanceof Live) {
      const rate = motion.rate();
      if (rate > 0) parts.push(`${rate.toFixed(0)} Hz`);
      const late = this.latency.of(0.5);
      if (late !== null) parts.push(`${late.toFixed(0)} ms`);
    } else {
      parts.push(clock(motion.last - motion.first), `${+scene.rate.toFixed(2)} Hz`);
      if (!scene.complete) parts.push("reading …");
      if (scene.warnings?.length) parts.push(many(scene.warnings.length, "warning"));
    }
    put(element("facts"), parts.join(" · "));
    this.updated = performance.now();
  }

  about(): void {
    const motion = this.motion();
    const { scene } = motion;
    const ms = (s: number) => `${(1000 * s).toFixed(1)} ms`;
    const rows: [string, string][] = [["Name", scene.name]];
    rows.push(["Holds", { space: "markers in space, m, z up", ground: "places on the ground, m", image: "tracks in an image, px" }[scene.frame]]);
    if (is_computed(scene)) rows.push(["Seen", "these places were computed (joints, say), not seen by cameras"]);
    if (scene.made_by) rows.push(["Made by", scene.made_by]);
    if (scene.kind === "recording") rows.push(["Length", `${clock(motion.last - motion.first)}, ${scene.instants} instants at ${+scene.rate.toFixed(3)} Hz`]);
    if (scene.cameras.length) rows.push(["Cameras", scene.cameras.map((camera) => camera.name).join(", ")]);
    else if (scene.frame === "space" && scene.kind === "recording") rows.push(["Cameras", "this file holds no calibration, so that neither they nor rays can be shown; a take does"]);
    if (scene.bodies.length) rows.push(["Bodies", scene.bodies.map((body) => body.label).join(", ")]);
    for (const step of this.status.steps ?? []) rows.push([step.name, `${ms(step.median)}, 99 % within ${ms(step.p99)}`]);
    if (this.status.superseded !== undefined) rows.push(["Overtaken", many(this.status.superseded, "moment")]);
    const [median, late] = [this.latency.of(0.5), this.latency.of(0.95)];
    if (median !== null && late !== null) rows.push(["Capture to screen", `${median.toFixed(0)} ms, 95 % within ${late.toFixed(0)} ms`]);
    for (const warning of scene.warnings ?? []) rows.push(["Warning", warning]);
    const cell = (kind: "dt" | "dd", text: string) => Object.assign(document.createElement(kind), { textContent: text });
    element("about").replaceChildren(...rows.flatMap(([term, text]) => [cell("dt", term), cell("dd", text)]));
  }
}
