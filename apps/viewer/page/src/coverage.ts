// Where in a camera's image something was found so far: a lens is known only where it was.
const COLUMNS = 16;
const ROWS = 12;

export class Coverage {
  private cells = new Set<number>();

  add(x: ArrayLike<number>, y: ArrayLike<number>, width: number, height: number): void {
    for (let i = 0; i < x.length; ++i) {
      const column = Math.floor((COLUMNS * (x[i] + 0.5)) / width);
      const row = Math.floor((ROWS * (y[i] + 0.5)) / height);
      if (column >= 0 && column < COLUMNS && row >= 0 && row < ROWS) this.cells.add(row * COLUMNS + column);
    }
  }

  /** Of the image. */
  get share(): number {
    return this.cells.size / (COLUMNS * ROWS);
  }

  draw(draw: CanvasRenderingContext2D, wide: number, tall: number): void {
    draw.fillStyle = "rgba(91, 168, 230, 0.18)";
    for (const cell of this.cells) {
      const row = Math.floor(cell / COLUMNS);
      draw.fillRect(((cell - row * COLUMNS) * wide) / COLUMNS, (row * tall) / ROWS, wide / COLUMNS, tall / ROWS);
    }
  }
}
