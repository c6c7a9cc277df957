// In place of markers in space where the browser draws nothing in space: it says so. List, plots and images work all the same.
import type { Colours } from "./colours";
import { Overlay } from "./overlay";
import type { State } from "./state";
import type { View } from "./view";

export class BlindView implements View {
  readonly element = document.createElement("div");
  readonly overlay: Overlay;

  constructor(state: State, colours: Colours) {
    this.overlay = new Overlay(state, colours);
    this.element.className = "view blind";
    const hint = document.createElement("p");
    hint.className = "hint";
    hint.textContent =
      "This browser draws nothing in space, for it has no WebGL: switch hardware acceleration on in its settings, or take another browser. The list and the plots work all the same.";
    this.element.append(hint);
  }
  take(): void {}
  resize(width: number, height: number): void {
    this.overlay.resize(width, height);
  }
  draw(): void {}
  reset(): void {}
}
