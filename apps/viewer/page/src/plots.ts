// Chosen coordinates of the chosen tracks over time.
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { Colours } from "./colours";
import { range_between, times_of } from "./frames";
import type { Motion } from "./motion";
import { name_of } from "./scene";
import type { State } from "./state";
import { FILLED, PREDICTED, type Course } from "./wire";

const MAXIMUM = 6;
const COORDINATES = ["x", "y", "z", "speed"] as const;
type Coordinate = (typeof COORDINATES)[number];

/** Central differences; none over a gap. */
function speed_of(course: Course, gap: number): (number | null)[] {
  const { time, x, y, z } = course;
  return Array.from(time, (_, i) => {
    const [a, b] = [Math.max(0, i - 1), Math.min(time.length - 1, i + 1)];
    const step = time[b] - time[a];
    if (step <= 0 || step > 2 * gap) return null;
    return Math.hypot(x[b] - x[a], y[b] - y[a], z ? z[b] - z[a] : 0) / step;
  });
}

/** A null within each gap, so that no line crosses it. */
function with_gaps(course: Course, values: ArrayLike<number | null>, gap: number): [number[], (number | null)[]] {
  const time: number[] = [];
  const out: (number | null)[] = [];
  for (let i = 0; i < course.time.length; ++i) {
    if (i > 0 && course.time[i] - course.time[i - 1] > gap) {
      time.push((course.time[i] + course.time[i - 1]) / 2);
      out.push(null);
    }
    time.push(course.time[i]);
    out.push(values[i]);
  }
  return [time, out];
}

/** What was not seen there: filled, predicted. */
const unmeasured = (course: Course, i: number): boolean => (course.state[i] & 7) === FILLED || (course.state[i] & 7) === PREDICTED;

/** The values that were seen, and where some were not those: up to the ones beside them, so that the line continues. */
function by_observed(course: Course, values: ArrayLike<number | null>): ArrayLike<number | null>[] {
  const n = course.time.length;
  const missed = Array.from({ length: n }, (_, i) => unmeasured(course, i));
  if (!missed.includes(true)) return [values];
  const adjacent = (i: number) => missed[i] || (i > 0 && missed[i - 1]) || (i + 1 < n && missed[i + 1]);
  return [missed.map((gone, i) => (gone ? null : values[i])), missed.map((_, i) => (adjacent(i) ? values[i] : null))];
}

export class Plots {
  private container = document.querySelector<HTMLElement>("#plots")!;
  private hint = document.querySelector<HTMLElement>("#plot_hint")!;
  private key = document.querySelector<HTMLElement>("#plot_key")!;
  private buttons = new Map<Coordinate, HTMLButtonElement>();
  private chosen = new Set<Coordinate>(["x", "y", "z"]);
  private plots: uPlot[] = [];
  private courses = new Map<number, { course: Course; version: string }>();
  private built_for = "";
  private busy = false;
  private refreshed = 0;
  visible = false;

  constructor(private state: State, private colours: Colours, private motion: () => Motion, private seek: (time: number) => void) {
    const bar = document.querySelector("#coordinates")!;
    for (const coordinate of COORDINATES) {
      const button = document.createElement("button");
      button.textContent = coordinate;
      button.className = "chip";
      button.addEventListener("click", () => {
        if (!this.chosen.delete(coordinate)) this.chosen.add(coordinate);
        this.update();
      });
      this.buttons.set(coordinate, button);
      bar.append(button);
    }
    new ResizeObserver(() => this.update()).observe(this.container);
  }

  private forget(): void {
    this.courses.clear();
    this.built_for = "";
  }

  async update(): Promise<void> {
    const motion = this.motion();
    const space = motion.scene.frame === "space";
    this.buttons.get("z")!.hidden = !space;
    for (const [coordinate, button] of this.buttons) button.classList.toggle("on", this.chosen.has(coordinate));
    if (!this.visible || this.busy) return;
    const ids = [...this.state.selected].slice(-MAXIMUM);
    const coordinates = COORDINATES.filter((c) => this.chosen.has(c) && (c !== "z" || space));
    this.hint.hidden = ids.length > 0;
    const live = motion.scene.kind === "live";
    if (live && performance.now() - this.refreshed > 250) this.forget();
    const versions = new Map(motion.scene.tracks.map((track) => [track.id, `${track.rows}.${track.version}`]));
    const required = `${ids.map((id) => `${id}:${versions.get(id)}`)} ${coordinates} ${this.container.clientWidth} ${this.container.clientHeight} ${this.state.dark} ${motion.last}`;
    if (required === this.built_for || this.container.clientWidth === 0) return this.draw();
    this.busy = true;
    this.refreshed = performance.now();
    for (const id of ids) {
      const version = versions.get(id) ?? "";
      if (this.courses.get(id)?.version !== version) this.courses.set(id, { course: await motion.course(id), version });
    }
    this.busy = false;
    this.built_for = required;
    this.key.replaceChildren(...ids.map((id) => this.key_of(id)));
    const zoom = this.zoom();
    for (const plot of this.plots) plot.destroy();
    this.plots = [];
    if (ids.length === 0) return;
    const height = Math.max(96, Math.floor(this.container.clientHeight / Math.max(1, coordinates.length)) - 4);
    for (const coordinate of coordinates) this.plots.push(this.build(coordinate, ids, height));
    if (zoom && !live) for (const plot of this.plots) plot.setScale("x", zoom);
    this.draw();
    this.update(); // the selection or the recording may have changed in the meantime
  }

  /** The stretch of time that the user looks at; nothing if it is all of it. */
  private zoom(): { min: number; max: number } | null {
    const plot = this.plots[0];
    const times = plot?.data[0];
    const { min, max } = plot?.scales.x ?? {};
    if (!times?.length || min === undefined || min === null || max === undefined || max === null) return null;
    return min > times[0] || max < times[times.length - 1] ? { min, max } : null;
  }

  /** The playhead, and the range that is marked. */
  draw(): void {
    const { range } = this.state;
    const marked = range && this.plots.length ? times_of(this.motion(), range) : null;
    for (const plot of this.plots) {
      const band = plot.root.querySelector<HTMLElement>(".marked")!;
      band.hidden = !marked;
      if (marked) {
        const [from, to] = marked.map((time) => Math.max(-4, Math.min(plot.over.clientWidth + 4, plot.valToPos(time, "x"))));
        band.style.left = `${from}px`;
        band.style.width = `${Math.max(2, to - from)}px`;
      }
      const mark = plot.root.querySelector<HTMLElement>(".playhead")!;
      const x = plot.valToPos(this.state.time, "x");
      mark.style.transform = `translateX(${x}px)`;
      mark.hidden = !(x >= 0 && x <= plot.over.clientWidth);
    }
  }

  private key_of(id: number): HTMLElement {
    const entry = document.createElement("span");
    const swatch = document.createElement("i");
    swatch.style.background = this.line_colour(id);
    entry.append(swatch, name_of(this.motion().scene.tracks.find((track) => track.id === id), id));
    return entry;
  }

  /** Tracks of one side or team share a colour: their lines are distinguished by lightness. */
  private line_colour(id: number): string {
    const ids = [...this.state.selected].slice(-MAXIMUM);
    const same = ids.filter((other) => this.colours.css(other) === this.colours.css(id));
    const [r, g, b] = this.colours.rgb(id).map((v) => Math.round(255 * v));
    const amount = same.length < 2 ? 0 : Math.round((60 * same.indexOf(id)) / (same.length - 1));
    return amount === 0 ? `rgb(${r},${g},${b})` : `color-mix(in oklab, rgb(${r},${g},${b}), ${this.state.dark ? "white" : "black"} ${amount}%)`;
  }

  private build(coordinate: Coordinate, ids: number[], height: number): uPlot {
    const { scene } = this.motion();
    const gap = Math.max(2.5 / Math.max(scene.rate, 0.1), 1e-3);
    const tables: uPlot.AlignedData[] = [];
    const lines: uPlot.Series[] = [];
    for (const id of ids) {
      const { course } = this.courses.get(id)!;
      const values = coordinate === "speed" ? speed_of(course, gap) : course[coordinate] ?? [];
      by_observed(course, values).forEach((part, which) => {
        tables.push(with_gaps(course, part, gap) as unknown as uPlot.AlignedData);
        lines.push({ stroke: this.line_colour(id), width: 1.5, dash: which ? [3, 3] : undefined, spanGaps: false, points: { show: false } });
      });
    }
    const style = getComputedStyle(document.body);
    const css = (name: string) => style.getPropertyValue(name).trim();
    const unit = (scene.frame === "image" ? "px" : "m") + (coordinate === "speed" ? "/s" : "");
    const axis = { stroke: css("--muted"), grid: { stroke: css("--line"), width: 1 }, ticks: { show: false }, font: `10px ${style.fontFamily}` };
    const plot = new uPlot(
      {
        width: this.container.clientWidth, height, legend: { show: false }, padding: [8, 10, 0, 0],
        cursor: { sync: { key: "marey" }, drag: { x: true, y: false }, points: { show: false } },
        scales: { x: { time: false } },
        hooks: { draw: [() => this.draw()] }, // places on its scale are known by then
        axes: [
          { ...axis, size: 22, gap: 2, values: (_, ticks) => ticks.map((tick) => `${+tick.toFixed(3)} s`) },
          { ...axis, size: 46, gap: 4, label: `${coordinate} / ${unit}`, labelSize: 16, labelFont: `600 11px ${style.fontFamily}` },
        ],
        series: [{}, ...lines],
      },
      tables.length > 1 ? uPlot.join(tables) : tables[0],
      this.container,
    );
    for (const name of ["marked", "playhead"]) plot.over.append(Object.assign(document.createElement("div"), { className: name }));
    plot.over.addEventListener("click", (event) => event.shiftKey || this.seek(plot.posToVal(event.offsetX, "x")));
    plot.over.addEventListener("mousedown", (event) => this.mark(plot, event), { capture: true });
    return plot;
  }

  /** With Shift, where a take is edited, dragging marks a range of frames. */
  private mark(plot: uPlot, event: MouseEvent): void {
    const motion = this.motion();
    if (!event.shiftKey || event.button !== 0 || !motion.scene.can_edit) return;
    event.stopImmediatePropagation();
    event.preventDefault();
    const time_at = (x: number) => {
      const rect = plot.over.getBoundingClientRect();
      return plot.posToVal(Math.max(0, Math.min(rect.width, x - rect.left)), "x");
    };
    const from = time_at(event.clientX);
    const drag = (moved: MouseEvent) => {
      this.state.range = range_between(motion, from, time_at(moved.clientX));
      this.state.changed();
    };
    drag(event);
    document.addEventListener("mousemove", drag);
    document.addEventListener("mouseup", () => document.removeEventListener("mousemove", drag), { once: true });
  }
}
