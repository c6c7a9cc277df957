// The table of tracks: which there are, how much of each was seen, what is chosen and hidden. Only rows in sight exist.
import type { Colours } from "./colours";
import { Live } from "./live";
import type { Motion } from "./motion";
import { name_of, type Scene, type Track } from "./scene";
import type { State } from "./state";

const ROW = 30; // px

interface Entry {
  track: Track;
  name: string;
  seen: number | null; // share
  gone: boolean; // of a live run
}

export class Table {
  private list = document.querySelector<HTMLElement>("#tracks")!;
  private filter = document.querySelector<HTMLInputElement>("#filter")!;
  private count = document.querySelector<HTMLElement>("#count")!;
  private entries: Entry[] = [];
  private shown: Entry[] = [];
  private body = document.createElement("div");
  private by: "name" | "seen" = "name";

  constructor(private state: State, private colours: Colours) {
    this.body.className = "rows";
    this.list.append(this.body);
    this.list.addEventListener("scroll", () => this.draw());
    this.filter.addEventListener("input", () => this.sift());
    document.querySelector("#none")!.addEventListener("click", () => {
      state.selected.clear();
      state.hidden.clear();
      state.changed();
    });
    for (const by of ["name", "seen"] as const) {
      document.querySelector(`#by_${by}`)!.addEventListener("click", () => {
        this.by = by;
        this.sift();
      });
    }
    state.on_change(() => this.draw());
    new ResizeObserver(() => this.draw()).observe(this.list);
  }

  /** Of a live run those who are gone are left out after a while, but for who is selected or has a name. */
  take(scene: Scene, motion: Motion, seen: (track: Track) => number | null): void {
    const live = motion instanceof Live ? motion : null;
    const kept = ({ id, label }: Track) => !live || live.is_listed(id) || label !== "" || this.state.selected.has(id);
    this.entries = scene.tracks.filter(kept).map((track) => ({ track, name: name_of(track, track.id), seen: seen(track), gone: live !== null && !live.is_there(track.id) }));
    this.sift();
  }

  private sift(): void {
    const wanted = this.filter.value.trim().toLowerCase();
    this.shown = this.entries.filter((entry) => wanted === "" || `${entry.name} ${entry.track.team}`.toLowerCase().includes(wanted));
    const by_name = (a: Entry, b: Entry) => a.track.team.localeCompare(b.track.team) || a.name.localeCompare(b.name, undefined, { numeric: true });
    const by_choice = this.by === "name" ? by_name : (a: Entry, b: Entry) => (a.seen ?? 0) - (b.seen ?? 0) || by_name(a, b);
    this.shown.sort((a, b) => Number(a.gone) - Number(b.gone) || by_choice(a, b));
    document.querySelector("#by_name")!.classList.toggle("on", this.by === "name");
    document.querySelector("#by_seen")!.classList.toggle("on", this.by === "seen");
    this.draw();
  }

  draw(): void {
    const { selected, hidden } = this.state;
    const there = (entries: Entry[]) => entries.filter((entry) => !entry.gone).length;
    const parts = [`${there(this.shown)}${this.shown.length < this.entries.length ? ` of ${there(this.entries)}` : ""}`];
    if (selected.size) parts.push(`${selected.size} selected`);
    if (hidden.size) parts.push(`${hidden.size} hidden`);
    this.count.textContent = parts.join(" · ");
    if (this.list.clientHeight === 0) return;
    this.body.style.height = `${this.shown.length * ROW}px`;
    const first = Math.max(0, Math.floor(this.list.scrollTop / ROW) - 4);
    const last = Math.min(this.shown.length, first + Math.ceil(this.list.clientHeight / ROW) + 8);
    this.body.replaceChildren(...this.shown.slice(first, last).map((entry, i) => this.row(entry, first + i)));
  }

  private row(entry: Entry, place: number): HTMLElement {
    const { id } = entry.track;
    const { selected, hidden } = this.state;
    const row = document.createElement("div");
    row.className = "row";
    row.style.top = `${place * ROW}px`;
    row.dataset.id = `${id}`;
    row.classList.toggle("selected", selected.has(id));
    row.classList.toggle("hidden", hidden.has(id));
    row.classList.toggle("gone", entry.gone);
    const swatch = document.createElement("span");
    swatch.className = "swatch";
    swatch.style.background = this.colours.css(id);
    const name = document.createElement("button");
    name.className = "name";
    name.textContent = entry.name;
    name.title = entry.track.team ? `${entry.name}, ${entry.track.team}` : entry.name;
    name.setAttribute("aria-pressed", `${selected.has(id)}`);
    name.addEventListener("click", () => this.state.toggle_selected(id));
    row.addEventListener("mouseenter", () => {
      this.state.hover = id;
      row.classList.add("hover");
      this.state.changed_hover();
    });
    row.addEventListener("mouseleave", () => {
      this.state.hover = null;
      this.state.changed_hover();
    });
    const share = document.createElement("span");
    share.className = "share";
    if (entry.seen !== null) {
      const bar = document.createElement("i");
      bar.style.width = `${(100 * entry.seen).toFixed(1)}%`;
      share.append(bar);
    }
    const percent = document.createElement("span");
    percent.className = "percent";
    percent.textContent = entry.seen === null ? "" : entry.seen > 0.9995 ? "100" : (100 * entry.seen).toFixed(1);
    const eye = document.createElement("button");
    eye.className = "eye";
    eye.title = hidden.has(id) ? "Show" : "Hide";
    eye.setAttribute("aria-label", `${eye.title} ${entry.name}`);
    eye.addEventListener("click", () => {
      if (!hidden.delete(id)) hidden.add(id);
      this.state.changed();
    });
    row.append(swatch, name, share, percent, eye);
    return row;
  }
}
