// The table of tracks: which there are, how much of each was seen, what is chosen and hidden. Only rows in sight exist.
import type { Colours } from "./colours";
import { Live } from "./live";
import type { Motion } from "./motion";
import { name_of, type Scene, type Track } from "./scene";
import { put, type State } from "./state";

const ROW = 30; // px

interface Entry {
  track: Track;
  name: string;
  measured: number | null; // share
  gone: boolean; // of a live run
}

interface Row {
  element: HTMLElement;
  swatch: HTMLElement;
  name: HTMLButtonElement;
  bar: HTMLElement;
  percent: HTMLElement;
  eye: HTMLButtonElement;
}

export class Table {
  private list = document.querySelector<HTMLElement>("#tracks")!;
  private filter = document.querySelector<HTMLInputElement>("#filter")!;
  private count = document.querySelector<HTMLElement>("#count")!;
  private entries: Entry[] = [];
  private shown: Entry[] = [];
  private body = document.createElement("div");
  private rows = new Map<number, Row>(); // those in sight, by track
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

  /** Of what was computed, not seen, the share of instants that have it counts. */
  say_what_counts(computed: boolean): void {
    const head = document.querySelector<HTMLElement>("#by_seen")!;
    put(head, computed ? "Present %" : "Seen %");
    head.title = computed ? "Share of the instants that have it: these places were computed, not seen by cameras" : "Share of the instants at which cameras saw it";
  }

  /** Of a live run those who are gone are omitted after a while, but for who is selected or has a name. */
  take(scene: Scene, motion: Motion, measured: (track: Track) => number | null): void {
    const live = motion instanceof Live ? motion : null;
    const kept = ({ id, label }: Track) => !live || live.is_listed(id) || label !== "" || this.state.selected.has(id);
    this.entries = scene.tracks.filter(kept).map((track) => ({ track, name: name_of(track, track.id), measured: measured(track), gone: live !== null && !live.is_there(track.id) }));
    this.sift();
  }

  private sift(): void {
    const filter_text = this.filter.value.trim().toLowerCase();
    this.shown = this.entries.filter((entry) => filter_text === "" || `${entry.name} ${entry.track.team}`.toLowerCase().includes(filter_text));
    const by_name = (a: Entry, b: Entry) => a.track.team.localeCompare(b.track.team) || a.name.localeCompare(b.name, undefined, { numeric: true });
    const by_choice = this.by === "name" ? by_name : (a: Entry, b: Entry) => (a.measured ?? 0) - (b.measured ?? 0) || by_name(a, b);
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
    this.place(this.shown.slice(first, last), first);
  }

  /** A row stays the same element while its track is in sight: a press that began on it ends on it, however often the list is drawn in the meantime. */
  private place(entries: Entry[], first: number): void {
    const filter_text = new Set(entries.map((entry) => entry.track.id));
    for (const [id, row] of this.rows) {
      if (filter_text.has(id)) continue;
      row.element.remove();
      this.rows.delete(id);
    }
    entries.forEach((entry, i) => {
      const { id } = entry.track;
      const row = this.rows.get(id) ?? this.row(id);
      this.rows.set(id, row);
      this.fill(row, entry, first + i);
      if (this.body.children[i] !== row.element) this.body.insertBefore(row.element, this.body.children[i] ?? null);
    });
  }

  private fill(row: Row, entry: Entry, place: number): void {
    const { id } = entry.track;
    const { selected, hidden } = this.state;
    row.element.style.top = `${place * ROW}px`;
    row.element.classList.toggle("selected", selected.has(id));
    row.element.classList.toggle("hidden", hidden.has(id));
    row.element.classList.toggle("gone", entry.gone);
    row.swatch.style.background = this.colours.css(id);
    if (row.name.textContent !== entry.name) row.name.textContent = entry.name;
    row.name.title = entry.track.team ? `${entry.name}, ${entry.track.team}` : entry.name;
    row.name.setAttribute("aria-pressed", `${selected.has(id)}`);
    row.bar.hidden = entry.measured === null;
    row.bar.style.width = `${(100 * (entry.measured ?? 0)).toFixed(1)}%`;
    row.percent.textContent = entry.measured === null ? "" : entry.measured > 0.9995 ? "100" : (100 * entry.measured).toFixed(1);
    row.eye.title = hidden.has(id) ? "Show" : "Hide";
    row.eye.setAttribute("aria-label", `${row.eye.title} ${entry.name}`);
  }

  private row(id: number): Row {
    const element = document.createElement("div");
    element.className = "row";
    element.dataset.id = `${id}`;
    const swatch = document.createElement("span");
    swatch.className = "swatch";
    const name = document.createElement("button");
    name.className = "name";
    name.addEventListener("click", () => this.state.toggle_selected(id));
    element.addEventListener("mouseenter", () => {
      this.state.hover = id;
      element.classList.add("hover");
      this.state.changed_hover();
    });
    element.addEventListener("mouseleave", () => {
      this.state.hover = null;
      element.classList.remove("hover");
      this.state.changed_hover();
    });
    const fraction_cell = document.createElement("span");
    fraction_cell.className = "share";
    const bar = document.createElement("i");
    fraction_cell.append(bar);
    const percent = document.createElement("span");
    percent.className = "percent";
    const eye = document.createElement("button");
    eye.className = "eye";
    eye.addEventListener("click", () => {
      if (!this.state.hidden.delete(id)) this.state.hidden.add(id);
      this.state.changed();
    });
    element.append(swatch, name, fraction_cell, percent, eye);
    return { element, swatch, name, bar, percent, eye };
  }
}
