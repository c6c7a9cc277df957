// The panel in which a take is edited: a range of frames, what to do, what that means in words, undo and redo.
import "./edit.css";
import { command, KINDS, missing, message_text, shell, type History, type Kind, type ControlRequest } from "./edits";
import { frame_at, time_of_frame } from "./frames";
import { HistoryList } from "./history_list";
import type { Motion } from "./motion";
import type { Scene } from "./scene";
import { put, type Range, type State } from "./state";

const element = <T extends HTMLElement>(id: string): T => document.querySelector<T>(`#${id}`)!;
const field = (id: string): HTMLInputElement => element<HTMLInputElement>(id);
const capital = (text: string): string => `${text[0].toUpperCase()}${text.slice(1)}`;
const MAX_BYTES = 4000; // that the server takes of one message
const KEYS: Record<string, Kind> = { n: "rename", w: "swap", s: "split", j: "join", Delete: "delete", f: "fill", b: "filter" };

/** What the rest of the page does for it. */
interface Around {
  /** False where no person is there to receive it. */
  send(line: string): boolean;
  seek(time: number): void;
  show_tab(tab: string): void;
}

export class Editor {
  private allowed = false;
  private kind: Kind | null = null;
  private reversed = false;
  private history: History = { edits: [], head: 0, newest: 0 };
  private list: HistoryList;
  /** What was asked for and not answered yet. */
  private pending: "edit" | "undo" | "redo" | "go" | null = null;
  private fetching: Promise<void> = Promise.resolve();

  constructor(private state: State, private motion: () => Motion, private around: Around) {
    this.list = new HistoryList((id) => this.ask("go", ` ${id}`), (frame) => around.seek(time_of_frame(motion(), frame)));
    const click = (id: string, act: () => void) => element(id).addEventListener("click", act);
    for (const kind of KINDS) click(`do_${kind}`, () => this.choose(kind));
    click("mark_in", () => this.mark("first"));
    click("mark_out", () => this.mark("last"));
    click("mark_none", () => this.set_range(null));
    click("undo", () => this.ask("undo"));
    click("redo", () => this.ask("redo"));
    click("other_way", () => {
      this.reversed = !this.reversed;
      this.tell();
    });
    for (const id of ["range_first", "range_last"]) field(id).addEventListener("change", () => this.take_range());
    element("act").addEventListener("input", () => this.tell());
    element("act").addEventListener("submit", (event) => {
      event.preventDefault();
      this.act();
    });
    state.on_change(() => this.tell());
  }

  // -- what comes

  take(scene: Scene): void {
    this.allowed = scene.can_edit ?? false;
    document.body.classList.toggle("editing", this.allowed);
    if (!this.allowed || !scene.complete) return;
    const there = new Set(scene.tracks.map((track) => track.id));
    const gone = [...this.state.selected].filter((id) => !there.has(id));
    for (const id of gone) this.state.selected.delete(id);
    if (gone.length) this.state.changed();
    this.tell();
  }

  /** The server is there, perhaps again: what it said in the meantime was missed. */
  found(): void {
    if (this.allowed) this.refresh();
  }

  /** True where the line was for it. */
  hear(word: string, rest: string): boolean {
    if (word === "edits") this.refresh();
    else if (word === "done") this.refresh().then(() => this.answered(""));
    else if (word === "refused") this.refresh().then(() => this.answered(rest || "that cannot be done"));
    else return false;
    return true;
  }

  /** Its panel is in sight now. */
  opened(): void {
    this.list.show_head();
  }

  /** The server has gone. */
  lost(): void {
    this.pending = null;
    this.tell();
  }

  private refresh(): Promise<void> {
    const fetched = this.fetching.then(async () => {
      try {
        this.history = (await (await fetch("edits")).json()) as History;
      } catch {
        return; // the server has gone, which the socket tells
      }
      this.list.draw(this.history);
      this.tell();
    });
    this.fetching = fetched;
    return fetched;
  }

  private answered(refused: string): void {
    const pending = this.pending;
    this.pending = null;
    const head = this.history.edits.find((edit) => edit.id === this.history.head);
    const now = head ? `as after ${head.id}: ${head.description}` : "as it was recorded";
    if (refused) this.said(`Not done. ${capital(refused)}${/[.?!]$/.test(refused) ? "" : "."}`, false);
    else this.said(pending === "edit" && head ? `Done: ${head.description}.` : `Now ${now}.`, true);
    if (!refused) this.kind = null;
    this.tell();
  }

  private said(text: string, good: boolean): void {
    const message = element("edit_said");
    message.textContent = text;
    message.hidden = text === "";
    message.classList.toggle("refused", !good);
  }

  // -- what is shown

  private get frame(): number {
    return frame_at(this.motion(), this.state.time);
  }

  private get what(): string {
    return { space: "markers", ground: "people", image: "tracks" }[this.motion().scene.frame];
  }

  private request(kind: Kind): ControlRequest {
    const { scene } = this.motion();
    const by_id = new Map(scene.tracks.map((track) => [track.id, track]));
    const tracks = [...this.state.selected].flatMap((id) => by_id.get(id) ?? []);
    if (this.reversed && kind === "join") tracks.reverse();
    const named = kind === "rename" || kind === "split";
    return {
      kind, tracks, all: scene.tracks, range: this.state.range, frame: this.frame,
      name: named ? field("new_name").value : "", method: field("fill_method").value,
      longest: field("fill_longest").value, within: field("fill_within").value, cutoff: field("cutoff").value,
    };
  }

  /** Every image: only what the time changes. */
  draw(): void {
    if (!this.allowed) return;
    const frame = `frame ${this.frame}`;
    if (element("frame_now").textContent === frame) return;
    put(element("frame_now"), frame);
    if (this.kind === "split") this.tell();
  }

  private tell(): void {
    if (!this.allowed) return;
    const { range, selected } = this.state;
    const { kind, history } = this;
    for (const end of ["first", "last"] as const)
      if (document.activeElement !== element(`range_${end}`)) field(`range_${end}`).value = range && range.open !== end ? `${range[end]}` : "";
    element<HTMLButtonElement>("mark_none").disabled = !range;
    for (const each of KINDS) {
      const button = element(`do_${each}`);
      button.classList.toggle("on", kind === each);
      button.classList.toggle("dim", missing({ ...this.request(each), name: "x" }) !== "");
      button.setAttribute("aria-pressed", `${kind === each}`);
    }
    element("edit_hint").hidden = kind !== null || !element("edit_said").hidden;
    put(element("edit_hint"), `${selected.size ? "" : `Select ${this.what} in the view or in the list. `}Mark frames with In and Out, where it is not for all of them, and choose what to do. Nothing recorded is ever changed: all of it can be undone.`);
    element("act").hidden = kind === null;
    if (kind) this.tell_act(kind);
    element<HTMLButtonElement>("undo").disabled = history.head === 0 || this.pending !== null;
    element<HTMLButtonElement>("redo").disabled = !history.edits.some((edit) => (edit.parent ?? 0) === history.head) || this.pending !== null;
    put(element("edits_count"), history.edits.length ? `${history.edits.length}` : "");
  }

  private tell_act(kind: Kind): void {
    const request = this.request(kind);
    const lacks = missing(request);
    put(element("act_words"), lacks || message_text(request, this.what));
    element("act_words").classList.toggle("lacks", lacks !== "");
    put(element("act_command"), lacks ? "" : `marey edit ${shell(this.motion().scene.name)} ${shell(command(request))}`);
    element("act_command").hidden = lacks !== "";
    for (const part of document.querySelectorAll<HTMLElement>("#act [data-of]")) part.hidden = !part.dataset.of!.split(" ").includes(kind);
    field("new_name").placeholder = kind === "split" ? "its name, where it is to have one" : "its new name";
    const button = element<HTMLButtonElement>("act_do");
    put(button.firstElementChild!, this.pending ? "…" : capital(kind));
    button.disabled = lacks !== "" || this.pending !== null || !this.motion().scene.complete;
  }

  // -- what the user does

  private mark(end: "first" | "last"): void {
    const { frame } = this;
    const range = { ...(this.state.range ?? { first: frame, last: frame }) };
    range[end] = frame;
    if (range.open === end) delete range.open;
    if (range.first > range.last) range[end === "first" ? "last" : "first"] = frame;
    this.set_range(range);
  }

  private set_range(range: Range | null): void {
    this.state.range = range;
    this.state.changed();
  }

  /** As it was typed. */
  private take_range(): void {
    const [first, last] = ["range_first", "range_last"].map((id) => Math.round(Number(field(id).value || NaN)));
    const motion = this.motion();
    const [begin, end] = [frame_at(motion, motion.first), frame_at(motion, motion.last)];
    const typed = ["range_first", "range_last"].map((id) => field(id).value.trim());
    if (typed.some((text) => text !== "" && !/^\d+$/.test(text))) return this.refuse_range("A frame is a whole number.");
    if (Number.isNaN(first) && Number.isNaN(last)) return this.set_range(null);
    const ends = [Number.isNaN(first) ? begin : first, Number.isNaN(last) ? end : last];
    if (ends.some((value) => value < begin || value > end)) return this.refuse_range(`Frames are from ${begin} to ${end}.`);
    if (ends[0] > ends[1]) return this.refuse_range(`Frame ${ends[0]} is after frame ${ends[1]}.`);
    this.said("", true);
    const open = Number.isNaN(last) ? "last" : Number.isNaN(first) ? "first" : undefined;
    this.set_range({ first: ends[0], last: ends[1], open });
  }

  /** The range stays as it was, and is shown again. */
  private refuse_range(why: string): void {
    const { range } = this.state;
    for (const end of ["first", "last"] as const) field(`range_${end}`).value = range && range.open !== end ? `${range[end]}` : "";
    this.said(`Range not set. ${why}`, false);
    this.tell();
  }

  private choose(kind: Kind | null): void {
    this.kind = this.kind === kind ? null : kind;
    this.reversed = false;
    this.said("", true);
    field("new_name").value = "";
    this.tell();
    if (this.kind && document.querySelector<HTMLElement>("#edit")!.offsetParent === null) this.around.show_tab("edits");
    if (this.kind === "rename" && this.state.selected.size === 1) field("new_name").focus();
  }

  private act(): void {
    if (!this.kind) return;
    const request = this.request(this.kind);
    if (missing(request) === "") this.ask("edit", ` ${command(request)}`);
  }

  private ask(word: "edit" | "undo" | "redo" | "go", rest = ""): void {
    if (!this.allowed || this.pending) return;
    const line = `${word} ${this.history.head} ${this.history.newest}${rest}`;
    if (new TextEncoder().encode(line).length > MAX_BYTES) return this.said("Not done. This many names are more than the page can send; write it as marey edit on the command line.", false);
    if (!this.around.send(line)) return this.said("Not done. The program that shows this does not answer.", false);
    this.pending = word;
    (document.activeElement as HTMLElement | null)?.blur?.();
    this.tell();
  }

  /** True where the key was for it. */
  key(event: KeyboardEvent): boolean {
    if (!this.allowed || event.altKey || document.querySelector("dialog[open]")) return false;
    const typing = event.target instanceof HTMLInputElement || event.target instanceof HTMLSelectElement;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const act = event.ctrlKey || event.metaKey ? this.with_control(key, event.shiftKey) : this.plain(key);
    if (!act || (typing && key !== "Escape")) return false;
    if (event.target instanceof HTMLButtonElement && key === "Enter") return false; // who tabbed there presses it
    event.preventDefault();
    act();
    return true;
  }

  private with_control(key: string, shift: boolean): (() => void) | null {
    if (key === "z") return () => this.ask(shift ? "redo" : "undo");
    return key === "y" ? () => this.ask("redo") : null;
  }

  private plain(key: string): (() => void) | null {
    if (key in KEYS) return () => this.choose(KEYS[key]);
    if (key === "i") return () => this.mark("first");
    if (key === "o") return () => this.mark("last");
    if (key === "u") return () => this.set_range(null);
    if (key === "e") return () => this.around.show_tab("edits");
    if (key === "Enter" && this.kind) return () => this.act();
    if (key !== "Escape" || !this.kind) return null;
    return () => {
      (document.activeElement as HTMLElement | null)?.blur?.();
      this.choose(null);
    };
  }
}
