// Chosen coordinates of the chosen tracks over time.
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { Colours } from "./colours";
import type { Motion } from "./motion";
import { name_of } from "./scene";
import type { State } from "./state";
import type { Course } from "./wire";

const MOST = 6;
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

export class Plots {
  private place = document.querySelector<HTMLElement>("#plots")!;
  private hint = document.querySelector<HTMLElement>("#plot_hint")!;
  private key = document.querySelector<HTMLElement>("#plot_key")!;
  private buttons = new Map<Coordinate, HTMLButtonElement>();
  private chosen = new Set<Coordinate>(["x", "y", "z"]);
  private plots: uPlot[] = [];
  private courses = new Map<number, Course>();
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
    new ResizeObserver(() => this.update()).observe(this.place);
  }

  /** New data may have come. */
  forget(): void {
    this.courses.clear();
    this.built_for = "";
  }

  async update(): Promise<void> {
    const motion = this.motion();
    const space = motion.scene.frame === "space";
    this.buttons.get("z")!.hidden = !space;
    for (const [coordinate, button] of this.buttons) button.classList.toggle("on", this.chosen.has(coordinate));
    if (!this.visible || this.busy) return;
    const ids = [...this.state.selected].slice(-MOST);
    const coordinates = COORDINATES.filter((c) => this.chosen.has(c) && (c !== "z" || space));
    this.hint.hidden = ids.length > 0;
    const live = motion.scene.kind === "live";
    if (live && performance.now() - this.refreshed > 250) this.forget();
    const wanted = `${ids} ${coordinates} ${this.place.clientWidth} ${this.place.clientHeight} ${this.state.dark} ${motion.last}`;
    if (wanted === this.built_for || this.place.clientWidth === 0) return this.draw();
    this.busy = true;
    this.refreshed = performance.now();
    for (const id of ids) if (!this.courses.has(id)) this.courses.set(id, await motion.course(id));
    this.busy = false;
    this.built_for = wanted;
    this.key.replaceChildren(...ids.map((id) => this.key_of(id)));
    for (const plot of this.plots) plot.destroy();
    this.plots = [];
    if (ids.length === 0) return;
    const height = Math.max(96, Math.floor(this.place.clientHeight / Math.max(1, coordinates.length)) - 4);
    for (const coordinate of coordinates) this.plots.push(this.build(coordinate, ids, height));
    this.draw();
  }

  /** The playhead. */
  draw(): void {
    for (const plot of this.plots) {
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

  /** Tracks of one side or team share a colour: their lines are told apart by lightness. */
  private line_colour(id: number): string {
    const ids = [...this.state.selected].slice(-MOST);
    const same = ids.filter((other) => this.colours.css(other) === this.colours.css(id));
    const [r, g, b] = this.colours.rgb(id).map((v) => Math.round(255 * v));
    const amount = same.length < 2 ? 0 : Math.round((60 * same.indexOf(id)) / (same.length - 1));
    return amount === 0 ? `rgb(${r},${g},${b})` : `color-mix(in oklab, rgb(${r},${g},${b}), ${this.state.dark ? "white" : "black"} ${amount}%)`;
  }

  private build(coordinate: Coordinate, ids: number[], height: number): uPlot {
    const { scene } = this.motion();
    const gap = Math.max(2.5 / Math.max(scene.rate, 0.1), 1e-3);
    const tables = ids.map((id) => {
      const course = this.courses.get(id)!;
      const values = coordinate === "speed" ? speed_of(course, gap) : course[coordinate] ?? [];
      return with_gaps(course, values, gap) as unknown as uPlot.AlignedData;
    });
    const style = getComputedStyle(document.body);
    const css = (name: string) => style.getPropertyValue(name).trim();
    const unit = (scene.frame === "image" ? "px" : "m") + (coordinate === "speed" ? "/s" : "");
    const axis = { stroke: css("--muted"), grid: { stroke: css("--line"), width: 1 }, ticks: { show: false }, font: `10px ${style.fontFamily}` };
    const plot = new uPlot(
      {
        width: this.place.clientWidth, height, legend: { show: false }, padding: [8, 10, 0, 0],
        cursor: { sync: { key: "marey" }, drag: { x: true, y: false }, points: { show: false } },
        scales: { x: { time: false } },
        axes: [
          { ...axis, size: 22, gap: 2, values: (_, ticks) => ticks.map((tick) => `${+tick.toFixed(3)} s`) },
          { ...axis, size: 46, gap: 4, label: `${coordinate} / ${unit}`, labelSize: 16, labelFont: `600 11px ${style.fontFamily}` },
        ],
        series: [{}, ...ids.map((id) => ({ stroke: this.line_colour(id), width: 1.5, spanGaps: false, points: { show: false } }))],
      },
      ids.length > 1 ? uPlot.join(tables) : tables[0],
      this.place,
    );
    const mark = document.createElement("div");
    mark.className = "playhead";
    plot.over.append(mark);
    plot.over.addEventListener("click", (event) => this.seek(plot.posToVal(event.offsetX, "x")));
    return plot;
  }
}
