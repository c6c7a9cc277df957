// What the user has chosen, shared by all parts of the page. The one who changes it calls `changed`.

export type Speed = number;
export const SPEEDS: Speed[] = [0.05, 0.1, 0.25, 0.5, 1, 2, 4, 8, 16];

/** Sets a text where it is another one: what stays costs no layout. */
export function put(place: Element, text: string): void {
  if (place.textContent !== text) place.textContent = text;
}

/** The page's typeface, for canvases. */
export const TYPEFACE = 'Inter, system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "Liberation Sans", sans-serif';

/** Frames by their indices, both ends included. */
export interface Range {
  first: number;
  last: number;
  /** The end that no person set: it is the recording's. */
  open?: "first" | "last";
}

export class State {
  time = 0;
  playing = false;
  /** Live: the newest is shown. */
  stays_at_end = true;
  speed: Speed = 1;
  labels = true;
  trail_s = 1;
  cameras = true;
  rays = false;
  dark = true;
  selected = new Set<number>();
  hidden = new Set<number>();
  hover: number | null = null;
  /** What is marked on the strip and in the plots, to be edited. */
  range: Range | null = null;
  private listeners: (() => void)[] = [];

  constructor() {
    const kept = JSON.parse(localStorage.getItem("marey") ?? "{}") as Partial<State>;
    this.dark = kept.dark ?? !matchMedia("(prefers-color-scheme: light)").matches;
    this.labels = kept.labels ?? true;
    this.cameras = kept.cameras ?? true;
  }
  on_change(listener: () => void): void {
    this.listeners.push(listener);
  }
  changed(): void {
    localStorage.setItem("marey", JSON.stringify({ dark: this.dark, labels: this.labels, cameras: this.cameras }));
    for (const listener of this.listeners) listener();
  }
  /** Only who is under the pointer: the table does not make its rows again for that. */
  on_hover = () => {};
  changed_hover(): void {
    this.on_hover();
  }
  toggle_selected(id: number): void {
    if (!this.selected.delete(id)) this.selected.add(id);
    this.changed();
  }
}
