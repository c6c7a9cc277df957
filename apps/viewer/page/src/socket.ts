// The page's socket to the program that shows it: opened again when it was lost, with a sentence where it cannot be had.
const AGAIN_MS = 2000;

export interface Received {
  opened(): void;
  text(line: string): void;
  bytes(data: ArrayBuffer): void;
  lost(): void;
  server_message(message_text: string): void;
}

export class Socket {
  private socket: WebSocket | null = null;
  private ever = false;

  constructor(private received: Received, private live: boolean) {}

  connect(): void {
    if (typeof WebSocket === "undefined") {
      this.received.lost();
      this.received.server_message(`This browser has no WebSockets${this.without("take a current one")}`);
      return;
    }
    const socket = new WebSocket(`ws://${location.host}/socket`);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.socket = socket;
      this.ever = true;
      this.received.server_message("");
      this.received.opened();
    };
    socket.onmessage = ({ data }) => (typeof data === "string" ? this.received.text(data) : this.received.bytes(data as ArrayBuffer));
    socket.onclose = () => {
      if (this.socket === socket) this.received.server_message("The program that showed this has ended.");
      else if (!this.ever) this.received.server_message(`The program cannot be heard: a proxy or an extension may let no WebSocket through${this.without("open the page without it")}`);
      this.socket = null;
      this.received.lost();
      setTimeout(() => this.connect(), AGAIN_MS);
    };
  }

  get open(): boolean {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  /** False where no person is there to receive it. */
  send(line: string): boolean {
    if (!this.socket || !this.open) return false;
    this.socket.send(line);
    return true;
  }

  private without(remedy: string): string {
    return this.live ? `, by which a live run comes: ${remedy}.` : `; the recording is shown, but neither its video nor edits: ${remedy} for those.`;
  }
}
