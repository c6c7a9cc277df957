// The page: fetches the scene, keeps the socket, wires the parts together. It draws when something has changed, once an image of
// the screen at most, from the newest state only; what is not in sight costs nothing.
import "./style.css";
import { Cameras } from "./cameras";
import { Colours } from "./colours";
import { Editor } from "./edit";
import { wire_keys } from "./keys";
import { Latency } from "./latency";
import { Live } from "./live";
import { time_of, type TimeStep, type Motion } from "./motion";
import { Names } from "./names";
import { wire_picking } from "./picking";
import { PlaneView } from "./plane_view";
import { Plots } from "./plots";
import { Recorded } from "./recorded";
import { is_computed, type Scene } from "./scene";
import { Socket } from "./socket";
import { put, State } from "./state";
import { Table } from "./table";
import { Timeline } from "./timeline";
import type { View } from "./view";
import { view_of } from "./views";
import { Wand, is_kind } from "./wand";
import { kind_of, image_of, TimeChunk, type CameraImage } from "./wire";
import { Words, type Status } from "./status_text";

const element = <T extends HTMLElement>(id: string): T => document.querySelector<T>(`#${id}`)!;
const TRAILS = [0, 0.5, 1, 2, 5, 10];

class Page {
  private state = new State();
  private colours = new Colours();
  private motion: Motion;
  private view: View;
  private current_step: TimeStep | null = null;
  private socket: Socket;
  private timeline: Timeline;
  private table: Table;
  private plots: Plots;
  private cameras: Cameras;
  private words: Words;
  private editor: Editor;
  private names: Names;
  private wand: Wand | null = null;
  private noted = "";
  private tab = "list";
  private wanted = false;
  private before = 0;
  private recording = false;
  private recording_into = "";
  private latency = new Latency();
  private latest: TimeChunk | null = null;
  private image_requested = { frame: -1, at: 0 };

  constructor(scene: Scene) {
    const { state } = this;
    const redraw = () => this.draw_soon();
    this.motion = scene.kind === "live" ? new Live(scene) : new Recorded(scene);
    this.motion.on_change = redraw;
    this.view = view_of(scene, state, this.colours, redraw);
    this.socket = new Socket(
      { opened: () => this.opened(), text: (line) => this.text(line), bytes: (data) => this.bytes(data), lost: () => this.editor.lost(), server_message: (message_text) => this.said(message_text) },
      scene.kind === "live",
    );
    element("view").append(this.view.element);
    state.trail_s = scene.frame === "space" ? 1 : 2;
    this.timeline = new Timeline(state, () => this.motion, (by) => this.step(by));
    this.table = new Table(state, this.colours);
    this.plots = new Plots(state, this.colours, () => this.motion, (time) => this.seek(time));
    this.cameras = new Cameras(state, this.colours, (line) => this.say(line), (decoded) => this.latency.drawn(decoded.sent_ms));
    this.names = new Names(element("stage"), state, (line) => this.say(line));
    this.words = new Words(() => this.motion, this.colours, this.latency);
    this.editor = new Editor(state, () => this.motion, { send: (line) => this.say(line), seek: (time) => this.seek(time), show_tab: (tab) => this.show_tab(tab) });
    if (is_kind(scene.job)) this.wand = new Wand(scene.job, this.cameras, (line) => this.say(line));
    state.on_change(redraw);
    state.on_change(() => this.plots.update());
    state.on_hover = redraw;
    this.wire_buttons();
    wire_picking(this.view, state);
    this.take(scene);
    if (scene.kind === "recording") state.time = this.motion.first;
    const narrow = matchMedia("(max-width: 800px)").matches;
    this.show_tab(scene.kind === "live" && scene.cameras.length > 0 && scene.frame !== "image" && !narrow ? "pictures" : "list");
    new ResizeObserver(() => this.resize()).observe(element("stage"));
    wire_keys({
      state,
      scene: () => this.motion.scene,
      editor: this.editor,
      timeline: this.timeline,
      names: this.names,
      seek: (time) => this.seek(time),
      go_to: (end) => this.seek(this.motion[end]),
      step: (by) => this.step(by),
      show_tab: (tab) => this.show_tab(tab),
    });
    document.addEventListener("visibilitychange", () => this.visible());
    this.socket.connect();
  }

  // -- what comes

  private opened(): void {
    this.visible();
    this.cameras.ask(true);
    this.ping();
    if (this.motion.scene.can_edit) this.fetch_scene();
    this.editor.found();
  }

  private say(line: string): boolean {
    return this.socket.send(line);
  }

  private text(line: string): void {
    const blank = line.indexOf(" ");
    const word = blank < 0 ? line : line.slice(0, blank);
    const rest = blank < 0 ? "" : line.slice(blank + 1);
    if (word === "scene") this.fetch_scene();
    else if (word === "status") this.take_status(JSON.parse(rest) as Status);
    else if (word === "recording") this.take_recording(rest);
    else if (word === "said") this.said(rest);
    else if (word === "wand") this.wand?.take(rest);
    else if (word === "ended") this.said("The run has ended.");
    else if (word === "pong") this.latency.pong(rest);
    else this.editor.hear(word, rest);
  }

  private bytes(data: ArrayBuffer): void {
    const kind = kind_of(data);
    if (kind === 2 && this.motion instanceof Live) {
      this.latest = new TimeChunk(data);
      this.motion.add(this.latest);
    } else if (kind === 3) {
      const decoded = image_of(data);
      const { scene } = this.motion;
      if (scene.kind === "live") this.cameras.shown_image(decoded);
      if (scene.kind === "recording" || (scene.frame === "image" && decoded.camera === (scene.camera ?? 0))) this.take_video_image(decoded);
    }
  }

  private fetching = false;
  private stale = false;
  private async fetch_scene(): Promise<void> {
    this.stale = true;
    if (this.fetching) return;
    this.fetching = true;
    while (this.stale) {
      this.stale = false;
      try {
        this.take((await (await fetch("scene")).json()) as Scene);
      } catch {
        break; // the server has gone, which the socket tells
      }
    }
    this.fetching = false;
  }

  private take(scene: Scene): void {
    if (scene.kind !== this.motion.scene.kind || scene.frame !== this.motion.scene.frame) return location.reload();
    const fresh = this.motion.last === 0;
    if (this.motion instanceof Live) this.motion.take(scene);
    else (this.motion as Recorded).take(scene);
    if (fresh && scene.kind === "recording") this.state.time = Math.max(this.state.time, this.motion.first);
    this.colours.take(scene);
    const stands = this.wand?.frame(scene) ?? false;
    this.view.take(scene);
    if (stands) this.view.reset();
    const live = this.motion instanceof Live ? this.motion : null;
    const whole = Math.max(1, scene.instants ?? 1);
    const computed = is_computed(scene);
    this.table.say_what_counts(computed);
    this.table.take(scene, this.motion, (track) => {
      if (live) return live.seen(track.id);
      if (computed) return (track.rows ?? 0) / whole;
      if (scene.frame === "space") return (track.measured ?? 0) / whole;
      // Of a person who comes and goes: while the track lasts.
      return (track.measured ?? 0) / Math.max(1, track.within ?? 1);
    });
    this.cameras.take(scene);
    this.names.take(scene);
    this.plots.update();
    this.editor.take(scene);
    this.words.update();
    this.draw_soon();
  }

  private take_status(status: Status): void {
    this.words.status = status;
    this.cameras.status(status.cameras ?? [], status.unsaved ?? false);
    this.note(status.notes ?? []);
    this.words.about();
    if (this.motion instanceof Live && this.tab === "list") {
      const live = this.motion;
      this.table.take(live.scene, live, (track) => live.seen(track.id));
    }
  }

  private take_recording(rest: string): void {
    this.recording = rest.startsWith("on");
    this.recording_into = rest.slice(3);
    const button = element("record");
    button.setAttribute("aria-pressed", `${this.recording}`);
    button.querySelector("span")!.textContent = this.recording ? "Recording" : "Record";
    button.title = this.recording ? `into ${this.recording_into}; R ends it` : "Record (R)";
  }

  private async take_video_image(decoded: CameraImage): Promise<void> {
    this.image_requested.at = 0;
    if (!decoded.jpeg || !(this.view instanceof PlaneView)) return;
    const image = await createImageBitmap(decoded.jpeg);
    this.view.video_image?.image.close();
    this.view.video_image = { image, frame: decoded.frame };
    const { scene } = this.motion;
    if (!scene.size) {
      scene.size = [decoded.width, decoded.height];
      this.view.take(scene);
    }
    this.draw_soon();
  }

  // -- what is shown

  private draw_soon(): void {
    if (this.wanted) return;
    this.wanted = true;
    requestAnimationFrame((now) => this.draw(now));
  }

  private draw(now: number): void {
    this.wanted = false;
    const { state, motion } = this;
    const passed = Math.min(0.25, (now - this.before) / 1000);
    this.before = now;
    if (this.colours.dark !== state.dark) {
      this.colours.dark = state.dark;
      document.documentElement.classList.toggle("light", !state.dark);
      this.table.draw();
      this.words.legend();
    }
    if (motion.scene.kind === "live") {
      if (state.stays_at_end) state.time = motion.last;
      else if (state.time < motion.first) state.time = motion.first;
    } else if (state.playing) {
      this.play_on(passed);
      this.draw_soon();
    }
    const current_step = motion.at(state.time);
    if (current_step) this.current_step = current_step;
    this.request_video_image();
    this.view.draw(motion, this.shown_moment());
    if (this.latest) {
      this.latency.drawn(this.latest.sent_ms);
      this.latest = null;
    }
    this.timeline.draw();
    this.plots.draw();
    if (this.plots.visible && motion.scene.kind === "live") this.plots.update();
    this.editor.draw();
    this.show_buttons();
    // For tests: attributes that no rule of the style looks at.
    document.body.dataset.time = state.time.toFixed(4);
    document.body.dataset.rows = `${current_step ? current_step.chunk.row_end[current_step.k] - current_step.chunk.begin(current_step.k) : ""}`;
  }

  private play_on(passed: number): void {
    const { state, motion } = this;
    if (!motion.at(state.time)) return; // it is not here yet: wait for it
    state.time += passed * state.speed;
    if (state.time < motion.last) return;
    state.time = motion.last;
    if ((motion.scene.complete ?? true)) state.playing = false;
  }

  /** With a video behind it, what was tracked in the frame that is shown. */
  private shown_moment(): TimeStep | null {
    const video_image = this.view instanceof PlaneView ? this.view.video_image : null;
    if (!video_image || !this.current_step) return this.current_step;
    const near = this.motion.at(this.state.time + (video_image.frame - this.current_step.chunk.index[this.current_step.k]) / Math.max(0.1, this.motion.scene.rate));
    return near && Math.abs(near.chunk.index[near.k] - video_image.frame) < 2 ? near : this.current_step;
  }

  private request_video_image(): void {
    const { current_step, view } = this;
    if (!this.motion.scene.video || !current_step || !(view instanceof PlaneView)) return;
    const frame = current_step.chunk.index[current_step.k];
    const now = performance.now();
    const waiting = this.image_requested.at > 0 && now - this.image_requested.at < 1000;
    if (frame === this.image_requested.frame || waiting) return;
    this.image_requested = { frame, at: now };
    this.say(`video ${frame} ${Math.max(320, Math.min(1920, 160 * Math.ceil(view.pixels_wide / 160)))}`);
  }

  private show_buttons(): void {
    const { state } = this;
    put(element("theme"), state.dark ? "☾" : "☀");
    element("labels").classList.toggle("on", state.labels);
    element("rig").classList.toggle("on", state.cameras);
    element("rays").classList.toggle("on", state.rays);
    const trails = element("trails");
    trails.classList.toggle("on", state.trail_s > 0);
    put(trails, state.trail_s > 0 ? `Trails ${state.trail_s} s` : "Trails");
    this.words.live_facts();
  }

  /** A line each, for as long as the server says so; another message that came since stays. */
  private note(notes: string[]): void {
    const text = notes.map((line) => line.slice(0, 1).toUpperCase() + line.slice(1)).join("\n");
    if (text !== "" || element("said").textContent === this.noted) this.said(text);
    this.noted = text;
  }

  private said(text: string): void {
    const message = element("said");
    message.textContent = text;
    message.hidden = text === "";
  }

  private ping(): void {
    if (this.motion.scene.kind !== "live" || !this.socket.open) return;
    const [line, again_ms] = this.latency.ping();
    this.say(line);
    setTimeout(() => this.ping(), again_ms);
  }

  // -- what the user does

  private visible(): void {
    this.say(document.hidden ? "sleep" : "wake");
    if (!document.hidden) this.cameras.ask(true);
  }

  private seek(time: number): void {
    this.state.time = Math.max(this.motion.first, Math.min(this.motion.last, time));
    this.state.stays_at_end = false;
    this.state.changed();
  }

  private step(by: number): void {
    this.state.playing = false;
    this.state.stays_at_end = false;
    const current_step = this.motion.at(this.state.time);
    const next = current_step && this.motion.neighbour(current_step, by > 0 ? 1 : -1);
    if (next) this.seek(time_of(next));
    else this.state.changed();
  }

  private show_tab(tab: string): void {
    this.tab = tab;
    document.body.dataset.tab = tab;
    for (const each of document.querySelectorAll<HTMLElement>("#panel section")) each.classList.toggle("on", each.dataset.tab === tab);
    for (const each of document.querySelectorAll<HTMLElement>("#tabs button")) each.setAttribute("aria-selected", `${each.dataset.tab === tab}`);
    document.body.classList.toggle("pictures", tab === "pictures");
    this.plots.visible = tab === "plot";
    this.plots.update();
    this.table.draw();
    if (tab === "edits") this.editor.opened();
    this.words.about();
  }

  private resize(): void {
    const stage = element("stage");
    this.view.resize(stage.clientWidth, stage.clientHeight);
    const { scene } = this.motion;
    if (scene.kind === "live" && scene.frame === "image") {
      this.cameras.also = { camera: scene.camera ?? 0, width: (this.view as PlaneView).pixels_wide };
      this.cameras.ask();
    }
    this.draw_soon();
  }

  private wire_buttons(): void {
    const { state } = this;
    const click = (id: string, act: () => void) => element(id).addEventListener("click", act);
    const toggle = (id: string, change: () => void) => click(id, () => (change(), state.changed()));
    toggle("labels", () => (state.labels = !state.labels));
    toggle("rig", () => (state.cameras = !state.cameras));
    toggle("rays", () => (state.rays = !state.rays));
    toggle("theme", () => (state.dark = !state.dark));
    toggle("trails", () => (state.trail_s = TRAILS[(TRAILS.indexOf(state.trail_s) + 1) % TRAILS.length]));
    click("reset", () => this.view.reset());
    for (const side of ["top", "front", "side"] as const) click(side, () => this.view.view_from?.(side));
    click("help", () => element<HTMLDialogElement>("keys").showModal());
    click("record", () => this.say(`record ${this.recording ? "off" : "on"}`));
    for (const tab of document.querySelectorAll<HTMLElement>("#tabs button")) tab.addEventListener("click", () => this.show_tab(tab.dataset.tab!));
  }
}

async function begin(): Promise<void> {
  // The token has become a cookie; it has no business in the address bar, the history or a screenshot.
  history.replaceState(null, "", "/");
  const answer = await fetch("scene");
  if (!answer.ok) throw new Error(await answer.text());
  new Page((await answer.json()) as Scene);
}

begin().catch((error: unknown) => {
  const message = element("said");
  message.hidden = false;
  message.textContent = `Nothing to show: ${error instanceof Error ? error.message : String(error)}`;
});
