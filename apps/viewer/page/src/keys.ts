// The keyboard: what each key does, and who has it first.
import type { Editor } from "./edit";
import type { Names } from "./names";
import type { Scene } from "./scene";
import type { State } from "./state";
import type { Timeline } from "./timeline";

/** What the keys of a page reach. */
export interface Keyed {
  state: State;
  scene(): Scene;
  editor: Editor;
  timeline: Timeline;
  names: Names;
  seek(time: number): void;
  go_to(end: "first" | "last"): void;
  step(by: number): void;
  show_tab(tab: string): void;
}

const element = <T extends HTMLElement>(id: string): T => document.querySelector<T>(`#${id}`)!;

export function wire_keys(page: Keyed): void {
  document.addEventListener("keydown", (event) => key(page, event));
  // Who clicks a button with the pointer and then presses space wants to play.
  document.addEventListener("click", (event) => event.detail > 0 && (event.target as Element).closest("button")?.blur());
}

function key(page: Keyed, event: KeyboardEvent): void {
  const { state, seek, step } = page;
  if (page.editor.key(event)) return;
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.target instanceof HTMLInputElement && event.key !== "Escape") return;
  if (event.target instanceof HTMLSelectElement) return;
  if (event.target instanceof HTMLButtonElement && (event.key === " " || event.key === "Enter")) return; // who tabbed there presses it
  if (element<HTMLDialogElement>("keys").open) return;
  const press = (id: string) => element(id).hidden || element(id).click();
  const keys: Record<string, () => void> = {
    " ": () => page.timeline.toggle(),
    ArrowLeft: () => (event.shiftKey ? seek(state.time - 1) : step(-1)),
    ArrowRight: () => (event.shiftKey ? seek(state.time + 1) : step(1)),
    ArrowUp: () => page.timeline.faster(1),
    ArrowDown: () => page.timeline.faster(-1),
    Home: () => page.go_to("first"),
    End: () => page.go_to("last"),
    l: () => press("labels"), t: () => press("trails"), c: () => press("rig"), y: () => press("rays"), d: () => press("theme"), r: () => press("record"),
    "1": () => press("top"), "2": () => press("front"), "3": () => press("side"), "0": () => press("reset"), "?": () => press("help"),
    n: () => page.names.focus(),
    m: () => page.show_tab("list"), p: () => page.show_tab("plot"),
    v: () => element("pictures_tab").hidden || page.show_tab("pictures"),
    a: () => {
      const all = state.selected.size < page.scene().tracks.length;
      state.selected = new Set(all ? page.scene().tracks.map((track) => track.id) : []);
      state.changed();
    },
    Escape: () => press("none"),
  };
  const act = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!act) return;
  event.preventDefault();
  act();
}
