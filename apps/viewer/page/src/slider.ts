// A dial of a camera: a slider with a number beside it. What the user has in hand is not overwritten by what the server says.

const IN_HAND_MS = 900;
const SEND_EVERY_MS = 100;

export const make = <K extends keyof HTMLElementTagNameMap>(kind: K, name = "", text = ""): HTMLElementTagNameMap[K] => {
  const element = document.createElement(kind);
  element.className = name;
  element.textContent = text;
  return element;
};

/** Where it spans decades the slider does too. */
export class Slider {
  readonly element = make("div", "dial");
  private range = make("input");
  private number = make("input");
  private touched = 0;
  private typing = false; // what is in the field was not sent yet
  private sent = 0;
  private waiting = 0;
  private least = 0;
  private most = 1;

  constructor(name: string, unit: string, private send: (value: number) => void) {
    const title = name[0].toUpperCase() + name.slice(1);
    this.range.type = "range";
    this.range.min = "0";
    this.range.max = "1000";
    this.range.setAttribute("aria-label", title);
    this.number.type = "number";
    this.number.step = "any";
    this.number.setAttribute("aria-label", unit ? `${title}, ${unit}` : title);
    this.element.dataset.dial = name;
    this.element.append(make("label", "", title), this.range, this.number, make("span", "unit", unit));
    this.range.addEventListener("input", () => this.turned(this.place_to_value(Number(this.range.value) / 1000)));
    this.number.addEventListener("input", () => (this.typing = true));
    this.number.addEventListener("change", () => {
      this.typing = false;
      if (this.number.value !== "") this.turned(Number(this.number.value));
    });
    this.number.addEventListener("blur", () => (this.typing = false));
  }

  span(least: number, most: number): void {
    this.least = least;
    this.most = most;
    this.number.min = `${least}`;
    this.number.max = `${most}`;
  }
  show(value: number | null): void {
    if (performance.now() - this.touched < IN_HAND_MS || this.typing) return;
    this.range.value = `${Math.round(1000 * this.value_to_place(value ?? 0))}`;
    this.number.value = value === null ? "" : `${+value.toPrecision(4)}`;
    this.number.placeholder = value === null ? "auto" : "";
    this.element.classList.toggle("auto", value === null);
  }
  let_go(): void {
    this.touched = 0;
  }

  private get by_decades(): boolean {
    return this.least > 0 && this.most / this.least > 50;
  }
  private place_to_value(place: number): number {
    const value = this.by_decades ? this.least * (this.most / this.least) ** place : this.least + place * (this.most - this.least);
    return Math.min(this.most, Math.max(this.least, Number(value.toPrecision(3))));
  }
  private value_to_place(value: number): number {
    const inside = Math.min(this.most, Math.max(this.least, value));
    if (this.most <= this.least) return 0;
    return this.by_decades ? Math.log(inside / this.least) / Math.log(this.most / this.least) : (inside - this.least) / (this.most - this.least);
  }

  private turned(value: number): void {
    this.touched = performance.now();
    this.element.classList.remove("auto");
    this.range.value = `${Math.round(1000 * this.value_to_place(value))}`;
    this.number.value = `${value}`;
    clearTimeout(this.waiting);
    const early = SEND_EVERY_MS - (performance.now() - this.sent);
    if (early > 0) {
      this.waiting = window.setTimeout(() => this.turned(value), early);
      return;
    }
    this.sent = performance.now();
    this.send(value);
  }
}
