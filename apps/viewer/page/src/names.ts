// Names that the user gives to tracks of a live run: pick one, type, Enter.
import "./names.css";
import { name_of, type Scene } from "./scene";
import type { State } from "./state";

const LONGEST = 64; // bytes, as apps/viewer/page_command.h has it

export class Names {
  private form = document.createElement("form");
  private title = document.createElement("label");
  private field = document.createElement("input");
  private full = document.createElement("span");
  private scene: Scene | null = null;
  private shown: number | null = null;

  constructor(place: Element, private state: State, private say: (line: string) => void) {
    this.form.id = "naming";
    this.form.hidden = true;
    this.field.id = "name_field";
    this.field.maxLength = LONGEST;
    this.field.addEventListener("input", () => this.limit());
    this.field.placeholder = "its name";
    this.field.autocomplete = "off";
    this.field.spellcheck = false;
    this.title.htmlFor = "name_field";
    const give = document.createElement("button");
    give.className = "chip on";
    give.textContent = "Name it";
    this.full.textContent = `${LONGEST} letters at most`;
    this.full.hidden = true;
    this.form.append(this.title, this.field, give, this.full);
    this.form.addEventListener("submit", (event) => {
      event.preventDefault();
      this.give();
    });
    place.append(this.form);
    state.on_change(() => this.update());
  }

  take(scene: Scene): void {
    this.scene = scene;
    this.update();
  }
  focus(): void {
    if (!this.form.hidden) this.field.select();
  }

  private update(): void {
    const { scene, state } = this;
    const one = scene?.kind === "live" && scene.can_change && state.selected.size === 1 ? [...state.selected][0] : null;
    this.form.hidden = one === null;
    if (one === null || !scene) {
      this.shown = null;
      return;
    }
    const track = scene.tracks.find((each) => each.id === one);
    this.title.textContent = `${scene.frame === "space" ? "Marker" : "Track"} ${name_of(track, one)}`;
    if (this.shown === one) return;
    this.shown = one;
    this.field.value = track?.label ?? "";
    this.limit();
  }

  /** A name is no longer than the server takes. */
  private limit(): void {
    const bytes = (text: string) => new TextEncoder().encode(text).length;
    const letters = [...this.field.value];
    while (bytes(letters.join("")) > LONGEST) letters.pop();
    if (letters.join("") !== this.field.value) this.field.value = letters.join("");
    this.full.hidden = bytes(this.field.value) < LONGEST;
  }

  private give(): void {
    if (this.shown === null) return;
    this.say(`name ${this.shown} ${this.field.value.trim()}`);
    this.field.blur();
  }
}
