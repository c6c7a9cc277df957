// What is under the pointer in a view: it is named, and a click selects it.
import type { State } from "./state";
import type { View } from "./view";

/** A click that was no drag selects what is under it. */
export function wire_picking(view: View, state: State): void {
  let pressed: [number, number] | null = null;
  const location_of = (event: PointerEvent): [number, number] => {
    const rect = view.element.getBoundingClientRect();
    return [event.clientX - rect.left, event.clientY - rect.top];
  };
  view.element.addEventListener("pointerdown", (event) => (pressed = location_of(event)), { capture: true });
  view.element.addEventListener("pointerup", (event) => {
    const now = location_of(event);
    if (!pressed || Math.hypot(now[0] - pressed[0], now[1] - pressed[1]) > 5) return;
    const found = view.overlay.hit(...now, event.pointerType === "touch" ? 22 : 12);
    if (found !== null) state.toggle_selected(found);
  });
  view.element.addEventListener("pointermove", (event) => {
    if (event.buttons) return;
    const found = view.overlay.hit(...location_of(event), 10);
    view.element.classList.toggle("over_mark", found !== null);
    if (found === state.hover) return;
    state.hover = found;
    state.changed_hover();
  });
}
