// The edits of a take as a list: which count, where they branch, what a fill is expected to be off. A click goes to that state.
import type { Edit, History } from "./edits";

const MAX_GAPS = 300; // that are listed of one fill

const made = <K extends keyof HTMLElementTagNameMap>(kind: K, name: string, text = ""): HTMLElementTagNameMap[K] =>
  Object.assign(document.createElement(kind), { className: name, textContent: text });

export class HistoryList {
  private list = document.querySelector<HTMLElement>("#edits")!;

  constructor(private go: (id: number) => void, private show: (frame: number) => void) {}

  draw(history: History): void {
    const rows = [this.row(0, "as it was recorded", history.head === 0, true, "")];
    let before = 0;
    for (const edit of history.edits) {
      const parent = edit.parent ?? 0;
      const branch = parent === before ? "" : parent === 0 ? "a branch from the recording" : `a branch from ${parent}`;
      const row = this.row(edit.id, edit.description, history.head === edit.id, edit.active, branch);
      if (edit.gaps?.length) row.append(this.gaps(edit));
      rows.push(row);
      before = edit.id;
    }
    this.list.replaceChildren(...rows);
    this.show_head();
  }

  /** Of the list the state that counts, where it is in sight at all. */
  show_head(): void {
    this.list.querySelector(".head")?.scrollIntoView({ block: "nearest" });
  }

  private row(id: number, words: string, head: boolean, counts: boolean, branch: string): HTMLElement {
    const row = made("li", `edit${head ? " head" : ""}${counts ? "" : " undone"}`);
    row.dataset.id = `${id}`;
    const button = made("button", "go");
    button.title = head ? "This is what is shown" : id === 0 ? "Show it as it was recorded" : `Let the edits up to this one count`;
    button.setAttribute("aria-current", `${head}`);
    const text = made("span", "words", words);
    if (branch) text.append(made("em", "", branch));
    button.append(made("span", "number", id === 0 ? "" : `${id}`), text);
    button.addEventListener("click", () => head || this.go(id));
    row.append(button);
    return row;
  }

  private gaps(edit: Edit): HTMLElement {
    const gaps = edit.gaps!;
    const part = made("details", "gaps");
    part.append(made("summary", "", gaps.length === 1 ? "the gap" : `the ${gaps.length} gaps`));
    for (const gap of gaps.slice(0, MAX_GAPS)) {
      const line = made("button", "gap");
      line.title = "Show its beginning";
      line.append(made("span", "", gap.track), made("span", "", gap.first === gap.last ? `${gap.first}` : `${gap.first} – ${gap.last}`));
      line.append(made("span", "", gap.method), made("b", "", `${gap.expected_mm.toFixed(1)} mm`));
      line.addEventListener("click", () => this.show(gap.first));
      part.append(line);
    }
    if (gaps.length > MAX_GAPS) part.append(made("span", "gap", `and ${gaps.length - MAX_GAPS} more`));
    return part;
  }
}
