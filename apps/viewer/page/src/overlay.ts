// Text over a view: labels that do not cover each other, and who is under the pointer.
import type { Colours } from "./colours";
import { TYPEFACE, type State } from "./state";

export interface Mark {
  id: number;
  x: number; // css px
  y: number;
  radius: number;
  text: string;
  /** The smaller is labelled first where there is no room for all. */
  depth: number;
}

interface Area {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

const HEIGHT = 15;
const meet = (a: Area, b: Area) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;

/** A grid of areas that are taken, so that hundreds of labels cost little. */
class Taken {
  private cells = new Map<number, Area[]>();
  private each(area: Area, visit: (key: number) => void): void {
    for (let x = Math.floor(area.left / 64); x <= Math.floor(area.right / 64); ++x)
      for (let y = Math.floor(area.top / 64); y <= Math.floor(area.bottom / 64); ++y) visit(x * 4096 + y);
  }
  add(area: Area): void {
    this.each(area, (key) => {
      const cell = this.cells.get(key);
      if (cell) cell.push(area);
      else this.cells.set(key, [area]);
    });
  }
  free(area: Area): boolean {
    let free = true;
    this.each(area, (key) => {
      if (free && this.cells.get(key)?.some((other) => meet(area, other))) free = false;
    });
    return free;
  }
}

export class Overlay {
  readonly canvas = document.createElement("canvas");
  readonly draw: CanvasRenderingContext2D;
  width = 1;
  height = 1;
  private widths = new Map<string, number>();
  private last: Mark[] = [];

  constructor(private state: State, private colours: Colours) {
    this.draw = this.canvas.getContext("2d")!;
  }

  resize(width: number, height: number): void {
    const ratio = Math.min(devicePixelRatio, 2);
    this.width = width;
    this.height = height;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    this.canvas.style.width = `${width}px`;
    this.canvas.style.height = `${height}px`;
    this.draw.setTransform(ratio, 0, 0, ratio, 0, 0);
  }

  clear(): void {
    this.draw.clearRect(0, 0, this.width, this.height);
  }

  /** Labels beside the marks: those that are chosen always, others where there is room. */
  labels(marks: Mark[], every: boolean): void {
    this.last = marks;
    const { state, draw } = this;
    const taken = new Taken();
    for (const m of marks) taken.add({ left: m.x - m.radius, right: m.x + m.radius, top: m.y - m.radius, bottom: m.y + m.radius });
    const chosen = (m: Mark) => state.selected.has(m.id) || state.hover === m.id;
    const order = marks.filter((m) => m.text !== "" && (every || chosen(m))).sort((a, b) => Number(chosen(b)) - Number(chosen(a)) || a.depth - b.depth);
    draw.font = `500 11.5px ${TYPEFACE}`;
    draw.textBaseline = "middle";
    for (const mark of order) {
      const width = this.text_width(mark.text) + 6;
      const area = this.place(mark, width, taken, chosen(mark));
      if (!area) continue;
      taken.add(area);
      this.tag(mark, area, chosen(mark));
    }
  }

  /** The mark at this place, the nearest within reach. */
  hit(x: number, y: number, reach = 14): number | null {
    let best = reach * reach;
    let found: number | null = null;
    for (const mark of this.last) {
      const d = (mark.x - x) ** 2 + (mark.y - y) ** 2 - mark.radius ** 2;
      if (d < best) {
        best = d;
        found = mark.id;
      }
    }
    return found;
  }

  private place(mark: Mark, width: number, taken: Taken, must: boolean): Area | null {
    const gap = mark.radius + 3;
    const at = (x: number, y: number): Area => ({ left: x, top: y, right: x + width, bottom: y + HEIGHT });
    const positions = [
      at(mark.x + gap, mark.y - HEIGHT / 2),
      at(mark.x - gap - width, mark.y - HEIGHT / 2),
      at(mark.x - width / 2, mark.y - gap - HEIGHT),
      at(mark.x - width / 2, mark.y + gap),
    ];
    const inside = (a: Area) => a.left >= 2 && a.top >= 2 && a.right <= this.width - 2 && a.bottom <= this.height - 2;
    return positions.find((area) => inside(area) && taken.free(area)) ?? (must ? positions[0] : null);
  }

  private tag(mark: Mark, area: Area, chosen: boolean): void {
    const { draw, state } = this;
    const middle = (area.top + area.bottom) / 2 + 0.5;
    if (chosen) {
      draw.fillStyle = this.colours.css(mark.id);
      draw.beginPath();
      draw.roundRect(area.left, area.top, area.right - area.left, HEIGHT, 3);
      draw.fill();
      draw.fillStyle = this.colours.is_light(mark.id) ? "#14181d" : "#fff";
    } else {
      draw.lineWidth = 3;
      draw.lineJoin = "round";
      draw.strokeStyle = state.dark ? "rgba(14,17,21,.75)" : "rgba(255,255,255,.85)";
      draw.strokeText(mark.text, area.left + 3, middle);
      draw.fillStyle = state.dark ? "#c9d1da" : "#3a444f";
    }
    draw.fillText(mark.text, area.left + 3, middle);
  }

  private text_width(text: string): number {
    let width = this.widths.get(text);
    if (width === undefined) {
      width = this.draw.measureText(text).width;
      if (this.widths.size > 5000) this.widths.clear();
      this.widths.set(text, width);
    }
    return width;
  }
}
