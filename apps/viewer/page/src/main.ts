// The page: fetches the scene, keeps the socket, wires the parts together. It draws when something has changed, once a picture of
// the screen at most, from the newest state only; what is not in sight costs nothing.
import "./style.css";
import { Cameras, type CameraStatus } from "./cameras";
import { Colours } from "./colours";
import { Live } from "./live";
import { time_of, type Moment, type Motion } from "./motion";
import { PlaneView } from "./plane_view";
import { Plots } from "./plots";
import { Recorded } from "./recorded";
import type { Scene } from "./scene";
import { SpaceView } from "./space_view";
import { put, State } from "./state";
import { Table } from "./table";
import { clock, Timeline } from "./timeline";
import type { View } from "./view";
import { kind_of, picture_of, Stretch, type Picture } from "./wire";

const element = <T extends HTMLElement>(id: string): T => document.querySelector<T>(`#${id}`)!;
const TRAILS = [0, 0.5, 1, 2, 5, 10];

interface Status {
  cameras?: CameraStatus[];
  steps?: { name: string; median: number; p99: number }[];
  overtaken?: number;
  notes?: string[];
}

class Page {
  private state = new State();
  private colours = new Colours();
  private motion: Motion;
  private view: View;
  private moment: Moment | null = null;
  private socket: WebSocket | null = null;
  private timeline: Timeline;
  private table: Table;
  private plots: Plots;
  private cameras: Cameras;
  private tab = "list";
  private wanted = false;
  private before = 0;
  private status: Status = {};
  private recording = false;
  private recording_into = "";
  private pings = new Map<number, number>();
  private ping_count = 0;
  private clock_offset: { ms: number; trip: number } | null = null;
  /** ms from the capture to the picture on the screen, the last few. */
  private latencies: number[] = [];
  private latest: Stretch | null = null;
  private film_asked = { frame: -1, at: 0 };

  constructor(scene: Scene) {
    const { state } = this;
    const redraw = () => this.draw_soon();
    this.motion = scene.kind === "live" ? new Live(scene) : new Recorded(scene);
    this.motion.on_change = redraw;
    this.view = scene.frame === "space" ? new SpaceView(state, this.colours, redraw) : new PlaneView(state, this.colours, redraw);
    element("view").append(this.view.element);
    state.trail_s = scene.frame === "space" ? 1 : 2;
    this.timeline = new Timeline(state, () => this.motion, (by) => this.step(by));
    this.table = new Table(state, this.colours);
    this.plots = new Plots(state, this.colours, () => this.motion, (time) => this.seek(time));
    this.cameras = new Cameras(state, this.colours, (line) => this.say(line), (picture) => this.note_latency(picture.sent_ms));
    state.on_change(redraw);
    state.on_change(() => this.plots.update());
    state.on_hover = redraw;
    this.wire_buttons();
    this.wire_picking();
    this.take(scene);
    if (scene.kind === "recording") state.time = this.motion.first;
    const narrow = matchMedia("(max-width: 800px)").matches;
    this.show_tab(scene.kind === "live" && scene.cameras.length > 0 && !narrow ? "pictures" : "list");
    new ResizeObserver(() => this.resize()).observe(element("stage"));
    document.addEventListener("keydown", (event) => this.key(event));
    document.addEventListener("visibilitychange", () => this.visible());
    this.connect();
  }

  // -- what comes

  private connect(): void {
    const socket = new WebSocket(`ws://${location.host}/socket`);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.socket = socket;
      this.said("");
      this.visible();
      this.cameras.ask(true);
      this.ping();
    };
    socket.onmessage = (event) => (typeof event.data === "string" ? this.text(event.data) : this.bytes(event.data as ArrayBuffer));
    socket.onclose = () => {
      if (this.socket === socket) this.said("The program that showed this has ended.");
      this.socket = null;
      setTimeout(() => this.connect(), 2000);
    };
  }

  private say(line: string): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(line);
  }

  private text(line: string): void {
    const blank = line.indexOf(" ");
    const word = blank < 0 ? line : line.slice(0, blank);
    const rest = blank < 0 ? "" : line.slice(blank + 1);
    if (word === "scene") this.fetch_scene();
    else if (word === "status") this.take_status(JSON.parse(rest) as Status);
    else if (word === "recording") this.take_recording(rest);
    else if (word === "said") this.said(rest);
    else if (word === "ended") this.said("The run has ended.");
    else if (word === "pong") this.pong(rest);
  }

  private bytes(data: ArrayBuffer): void {
    const kind = kind_of(data);
    if (kind === 2 && this.motion instanceof Live) {
      this.latest = new Stretch(data);
      this.motion.add(this.latest);
    } else if (kind === 3) {
      const picture = picture_of(data);
      if (this.motion.scene.kind === "live") this.cameras.picture(picture);
      else this.take_film(picture);
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
    this.view.take(scene);
    const live = this.motion instanceof Live ? this.motion : null;
    const whole = Math.max(1, scene.instants ?? 1);
    this.table.take(scene, (track) => {
      if (live) return live.seen(track.id);
      if (scene.frame === "space") return (track.measured ?? 0) / whole;
      // Of somebody who comes and goes: while the track lasts.
      return (track.measured ?? 0) / Math.max(1, track.within ?? 1);
    });
    this.cameras.take(scene);
    this.plots.forget();
    this.plots.update();
    this.tell(scene);
    this.draw_soon();
  }

  private take_status(status: Status): void {
    this.status = status;
    this.cameras.status(status.cameras ?? []);
    if (status.notes?.length) this.said(status.notes.join(" "));
    this.about(this.motion.scene);
    if (this.motion instanceof Live && this.tab === "list") {
      const live = this.motion;
      this.table.take(live.scene, (track) => live.seen(track.id));
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

  private async take_film(picture: Picture): Promise<void> {
    this.film_asked.at = 0;
    if (!picture.jpeg || !(this.view instanceof PlaneView)) return;
    const image = await createImageBitmap(picture.jpeg);
    this.view.film?.image.close();
    this.view.film = { image, frame: picture.frame };
    const { scene } = this.motion;
    if (!scene.size) {
      scene.size = [picture.width, picture.height];
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
    if (motion.scene.kind === "live") {
      if (state.following) state.time = motion.last;
      else if (state.time < motion.first) state.time = motion.first;
    } else if (state.playing) {
      this.play_on(passed);
      this.draw_soon();
    }
    const moment = motion.at(state.time);
    if (moment) this.moment = moment;
    this.ask_for_film();
    this.view.draw(motion, this.shown_moment());
    if (this.latest) {
      this.note_latency(this.latest.sent_ms);
      this.latest = null;
    }
    this.timeline.draw();
    this.plots.draw();
    if (this.plots.visible && motion.scene.kind === "live") this.plots.update();
    this.show_buttons();
    // For tests: attributes that no rule of the style looks at.
    document.body.dataset.time = state.time.toFixed(4);
    document.body.dataset.rows = `${moment ? moment.stretch.row_end[moment.k] - moment.stretch.begin(moment.k) : ""}`;
  }

  private play_on(passed: number): void {
    const { state, motion } = this;
    if (!motion.at(state.time)) return; // it is not here yet: wait for it
    state.time += passed * state.speed;
    if (state.time < motion.last) return;
    state.time = motion.last;
    if ((motion.scene.complete ?? true)) state.playing = false;
  }

  /** With a film behind it, what was tracked in the frame that is shown. */
  private shown_moment(): Moment | null {
    const film = this.view instanceof PlaneView ? this.view.film : null;
    if (!film || !this.moment) return this.moment;
    const { scene } = this.motion;
    const near = this.motion.at(this.state.time + (film.frame - this.moment.stretch.index[this.moment.k]) / Math.max(0.1, scene.rate));
    return near && Math.abs(near.stretch.index[near.k] - film.frame) < 2 ? near : this.moment;
  }

  private ask_for_film(): void {
    const { moment, view } = this;
    if (!this.motion.scene.film || !moment || !(view instanceof PlaneView)) return;
    const frame = moment.stretch.index[moment.k];
    const now = performance.now();
    const waiting = this.film_asked.at > 0 && now - this.film_asked.at < 1000;
    if (frame === this.film_asked.frame || waiting) return;
    this.film_asked = { frame, at: now };
    this.say(`film ${frame} ${Math.max(320, Math.min(1920, 160 * Math.ceil(view.pixels_wide / 160)))}`);
  }

  private tell(scene: Scene): void {
    const words = { space: "Markers", ground: "People", image: "Tracks" }[scene.frame];
    element("list_tab").textContent = words;
    const name = scene.name.split("/").pop() || "Live";
    element("title").textContent = scene.kind === "live" ? "Live" : name;
    document.title = `${scene.kind === "live" ? "Live" : name} – Marey`;
    element("record").hidden = !scene.can_record;
    element("pictures_tab").hidden = scene.kind !== "live" || scene.cameras.length === 0;
    element("rig").hidden = !(scene.frame === "space" && scene.cameras.some((camera) => camera.centre));
    for (const id of ["top", "front", "side"]) element(id).hidden = scene.frame !== "space";
    element("legend").replaceChildren(
      ...this.colours.legend().map(([text, colour]) => {
        const entry = document.createElement("span");
        const dot = document.createElement("i");
        dot.style.background = colour;
        entry.append(dot, text);
        return entry;
      }),
    );
    this.facts();
    this.about(scene);
  }

  private facts(): void {
    const { scene } = this.motion;
    const parts: string[] = [];
    const word = { space: "marker", ground: "track", image: "track" }[scene.frame];
    if (scene.tracks.length) parts.push(`${scene.tracks.length} ${word}${scene.tracks.length === 1 ? "" : "s"}`);
    if (this.motion instanceof Live) {
      const rate = this.motion.rate();
      if (rate > 0) parts.push(`${rate.toFixed(0)} Hz`);
      const latency = this.latency(0.5);
      if (latency !== null) parts.push(`${latency.toFixed(0)} ms`);
    } else {
      parts.push(clock(this.motion.last - this.motion.first), `${+scene.rate.toFixed(2)} Hz`);
      if (!scene.complete) parts.push("reading …");
      if (scene.warnings?.length) parts.push(`${scene.warnings.length} warning${scene.warnings.length === 1 ? "" : "s"}`);
    }
    put(element("facts"), parts.join(" · "));
    this.facts_told = performance.now();
  }
  private facts_told = 0;

  private about(scene: Scene): void {
    const rows: [string, string][] = [["Name", scene.name]];
    const frames = { space: "markers in space, m, z up", ground: "places on the ground, m", image: "tracks in a picture, px" };
    rows.push(["Holds", frames[scene.frame]]);
    if (scene.made_by) rows.push(["Made by", scene.made_by]);
    if (scene.kind === "recording") {
      rows.push(["Length", `${clock(this.motion.last - this.motion.first)}, ${scene.instants} instants at ${+scene.rate.toFixed(3)} Hz`]);
    }
    if (scene.cameras.length) rows.push(["Cameras", scene.cameras.map((camera) => camera.name).join(", ")]);
    if (scene.bodies.length) rows.push(["Bodies", scene.bodies.map((body) => body.label).join(", ")]);
    const ms = (s: number) => `${(1000 * s).toFixed(1)} ms`;
    for (const step of this.status.steps ?? []) rows.push([step.name, `${ms(step.median)}, 99 % within ${ms(step.p99)}`]);
    if (this.status.overtaken !== undefined) rows.push(["Overtaken", `${this.status.overtaken} moments`]);
    const [median, late] = [this.latency(0.5), this.latency(0.95)];
    if (median !== null && late !== null) rows.push(["Capture to screen", `${median.toFixed(0)} ms, 95 % within ${late.toFixed(0)} ms`]);
    for (const warning of scene.warnings ?? []) rows.push(["Warning", warning]);
    element("about").replaceChildren(
      ...rows.flatMap(([term, text]) => {
        const dt = document.createElement("dt");
        const dd = document.createElement("dd");
        dt.textContent = term;
        dd.textContent = text;
        return [dt, dd];
      }),
    );
  }

  private show_buttons(): void {
    const { state } = this;
    document.documentElement.classList.toggle("light", !state.dark);
    put(element("theme"), state.dark ? "☾" : "☀");
    element("labels").classList.toggle("on", state.labels);
    element("rig").classList.toggle("on", state.cameras);
    const trails = element("trails");
    trails.classList.toggle("on", state.trail_s > 0);
    put(trails, state.trail_s > 0 ? `Trails ${state.trail_s} s` : "Trails");
    if (this.motion.scene.kind === "live" && performance.now() - this.facts_told > 400) this.facts();
  }

  private said(text: string): void {
    const place = element("said");
    place.textContent = text;
    place.hidden = text === "";
  }

  // -- latency

  private ping(): void {
    if (this.motion.scene.kind === "live") {
      this.pings.set(++this.ping_count, performance.now());
      this.say(`ping ${this.ping_count}`);
      setTimeout(() => this.socket && this.ping(), this.ping_count < 8 ? 150 : 4000);
    }
  }

  /** The server's clock by the shortest of the round trips. */
  private pong(rest: string): void {
    const [count, ns] = rest.split(" ");
    const sent = this.pings.get(Number(count));
    this.pings.delete(Number(count));
    if (sent === undefined) return;
    const now = performance.now();
    const trip = now - sent;
    if (this.clock_offset && trip > this.clock_offset.trip * 1.02) return;
    this.clock_offset = { ms: Number(BigInt(ns) / 1000n) / 1000 - (sent + now) / 2, trip };
  }

  private note_latency(sent_ms: number): void {
    if (!this.clock_offset || document.hidden) return;
    this.latencies.push(performance.now() + this.clock_offset.ms - sent_ms);
    if (this.latencies.length > 330) this.latencies.splice(0, 30);
    if (this.latencies.length % 30 === 0) document.body.dataset.latency = `${this.latency(0.95)?.toFixed(1)}`;
  }

  private latency(share: number): number | null {
    if (this.latencies.length < 10) return null;
    const sorted = [...this.latencies].sort((a, b) => a - b);
    return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
  }

  // -- what the user does

  private visible(): void {
    this.say(document.hidden ? "sleep" : "wake");
    if (!document.hidden) this.cameras.ask(true);
  }

  private seek(time: number): void {
    this.state.time = Math.max(this.motion.first, Math.min(this.motion.last, time));
    this.state.following = false;
    this.state.changed();
  }

  private step(by: number): void {
    this.state.playing = false;
    this.state.following = false;
    const moment = this.motion.at(this.state.time);
    const next = moment && this.motion.beside(moment, by > 0 ? 1 : -1);
    if (next) this.seek(time_of(next));
    else this.state.changed();
  }

  private show_tab(tab: string): void {
    this.tab = tab;
    for (const each of document.querySelectorAll<HTMLElement>("#panel section")) each.classList.toggle("on", each.dataset.tab === tab);
    for (const each of document.querySelectorAll<HTMLElement>("#tabs button")) each.setAttribute("aria-selected", `${each.dataset.tab === tab}`);
    document.body.classList.toggle("pictures", tab === "pictures");
    this.plots.visible = tab === "plot";
    this.plots.update();
    this.table.draw();
    this.about(this.motion.scene);
  }

  private resize(): void {
    const stage = element("stage");
    this.view.resize(stage.clientWidth, stage.clientHeight);
    this.draw_soon();
  }

  private wire_buttons(): void {
    const { state } = this;
    const click = (id: string, act: () => void) => element(id).addEventListener("click", act);
    const toggle = (id: string, change: () => void) => click(id, () => (change(), state.changed()));
    toggle("labels", () => (state.labels = !state.labels));
    toggle("rig", () => (state.cameras = !state.cameras));
    toggle("theme", () => (state.dark = !state.dark));
    toggle("trails", () => (state.trail_s = TRAILS[(TRAILS.indexOf(state.trail_s) + 1) % TRAILS.length]));
    click("reset", () => this.view.reset());
    for (const side of ["top", "front", "side"] as const) click(side, () => this.view.look_from?.(side));
    click("help", () => element<HTMLDialogElement>("keys").showModal());
    click("record", () => this.say(`record ${this.recording ? "off" : "on"}`));
    for (const tab of document.querySelectorAll<HTMLElement>("#tabs button")) tab.addEventListener("click", () => this.show_tab(tab.dataset.tab!));
  }

  /** A click that was no drag selects what is under it. */
  private wire_picking(): void {
    const { view, state } = this;
    let pressed: [number, number] | null = null;
    const place = (event: PointerEvent): [number, number] => {
      const rect = view.element.getBoundingClientRect();
      return [event.clientX - rect.left, event.clientY - rect.top];
    };
    view.element.addEventListener("pointerdown", (event) => (pressed = place(event)), { capture: true });
    view.element.addEventListener("pointerup", (event) => {
      const now = place(event);
      if (!pressed || Math.hypot(now[0] - pressed[0], now[1] - pressed[1]) > 5) return;
      const found = view.overlay.hit(...now, event.pointerType === "touch" ? 22 : 12);
      if (found !== null) state.toggle_selected(found);
    });
    view.element.addEventListener("pointermove", (event) => {
      if (event.buttons) return;
      const found = view.overlay.hit(...place(event), 10);
      view.element.classList.toggle("over_mark", found !== null);
      if (found === state.hover) return;
      state.hover = found;
      state.changed_hover();
    });
  }

  private key(event: KeyboardEvent): void {
    const { state } = this;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target instanceof HTMLInputElement && event.key !== "Escape") return;
    if (element<HTMLDialogElement>("keys").open) return;
    const press = (id: string) => element(id).hidden || element(id).click();
    const keys: Record<string, () => void> = {
      " ": () => this.timeline.toggle(),
      ArrowLeft: () => (event.shiftKey ? this.seek(state.time - 1) : this.step(-1)),
      ArrowRight: () => (event.shiftKey ? this.seek(state.time + 1) : this.step(1)),
      ArrowUp: () => this.timeline.faster(1),
      ArrowDown: () => this.timeline.faster(-1),
      Home: () => this.seek(this.motion.first),
      End: () => this.seek(this.motion.last),
      l: () => press("labels"), t: () => press("trails"), c: () => press("rig"), d: () => press("theme"), r: () => press("record"),
      "1": () => press("top"), "2": () => press("front"), "3": () => press("side"), "0": () => press("reset"), "?": () => press("help"),
      m: () => this.show_tab("list"), p: () => this.show_tab("plot"),
      v: () => element("pictures_tab").hidden || this.show_tab("pictures"),
      a: () => {
        const all = state.selected.size < this.motion.scene.tracks.length;
        state.selected = new Set(all ? this.motion.scene.tracks.map((track) => track.id) : []);
        state.changed();
      },
      Escape: () => press("none"),
    };
    const act = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act) return;
    event.preventDefault();
    act();
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
  const place = element("said");
  place.hidden = false;
  place.textContent = `Nothing to show: ${error instanceof Error ? error.message : String(error)}`;
});
