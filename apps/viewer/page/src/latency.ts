// How old what is shown is: from the instant that the server names to the image on the screen. The server's clock is known by the
// shortest of the round trips so far.

const KEPT = 330;

export class Latency {
  private pings = new Map<number, number>();
  private count = 0;
  private offset: { ms: number; trip: number } | null = null;
  private ms: number[] = [];

  /** What is to be said to the server, and after how long (ms) again. */
  ping(): [string, number] {
    this.pings.set(++this.count, performance.now());
    return [`ping ${this.count}`, this.count < 8 ? 150 : 4000];
  }

  pong(answer: string): void {
    const [count, ns] = answer.split(" ");
    const sent = this.pings.get(Number(count));
    this.pings.delete(Number(count));
    if (sent === undefined) return;
    const now = performance.now();
    const trip = now - sent;
    if (this.offset && trip > this.offset.trip * 1.02) return;
    this.offset = { ms: Number(BigInt(ns) / 1000n) / 1000 - (sent + now) / 2, trip };
  }

  /** Something of this instant (ms of the server's clock) is on the screen now. */
  drawn(sent_ms: number): void {
    if (!this.offset || document.hidden) return;
    this.ms.push(performance.now() + this.offset.ms - sent_ms);
    if (this.ms.length > KEPT) this.ms.splice(0, 30);
    if (this.ms.length % 30 === 0) document.body.dataset.latency = `${this.of(0.95)?.toFixed(1)}`;
  }

  /** ms within which that share was drawn; null where too little is known. */
  of(share: number): number | null {
    if (this.ms.length < 10) return null;
    const sorted = [...this.ms].sort((a, b) => a - b);
    return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
  }
}
