// The server's bytes as arrays, nothing copied. The layout is apps/viewer/wire.h's.

// Where a row comes from.
export const MEASURED = 0;
export const FILLED = 1;
export const PREDICTED = 2;
const HEADER = 40;
const HAS_Z = 1;
const HAS_BOXES = 2;
const HAS_CAMERAS = 4;
const HAS_SIGMA = 8;
const ROW_HAS_BOX = 8;

/** Instants one after the other, in columns. Rows of instant k are those from `begin(k)` to before `row_end[k]`. */
export class TimeChunk {
  readonly time: Float64Array;
  readonly index: Uint32Array;
  readonly row_end: Uint32Array;
  readonly pose_end: Uint32Array;
  readonly track: Int32Array;
  readonly x: Float32Array;
  readonly y: Float32Array;
  readonly z: Float32Array | null;
  readonly box: [Float32Array, Float32Array, Float32Array, Float32Array] | null;
  /** Who saw it, a bit for each of the first 32 cameras. */
  readonly cameras: Uint32Array | null;
  /** Standard deviation of a position, m; NaN where it is not known. */
  readonly sigma: Float32Array | null;
  readonly body: Int32Array;
  /** Position, then a quaternion with its real part last. */
  readonly pose: Float32Array[];
  readonly state: Uint8Array;
  readonly tracked: Uint8Array;
  /** Of each row; keypoint i of a row is at row * keypoints + i. Its confidence is 0 where it is absent, else to 255. */
  readonly keypoints: number;
  readonly keypoint_x: Float32Array;
  readonly keypoint_y: Float32Array;
  readonly confidence: Uint8Array;
  readonly sequence: number;
  readonly sent_ms: number;

  constructor(bytes: ArrayBuffer) {
    const head = new DataView(bytes);
    const flags = head.getUint16(2, true);
    this.sequence = head.getUint32(4, true);
    this.sent_ms = Number(head.getBigUint64(16, true)) / 1e6;
    const n = head.getUint32(24, true);
    const rows = head.getUint32(28, true);
    const poses = head.getUint32(32, true);
    this.keypoints = head.getUint32(36, true);
    let at = HEADER;
    const take = <T>(make: new (bytes: ArrayBuffer, at: number, count: number) => T, count: number, size: number): T => {
      const column = new make(bytes, at, count);
      at += count * size;
      return column;
    };
    this.time = take(Float64Array, n, 8);
    this.index = take(Uint32Array, n, 4);
    this.row_end = take(Uint32Array, n, 4);
    this.pose_end = take(Uint32Array, n, 4);
    this.track = take(Int32Array, rows, 4);
    const floats = () => take(Float32Array, rows, 4);
    this.x = floats();
    this.y = floats();
    this.z = flags & HAS_Z ? floats() : null;
    this.box = flags & HAS_BOXES ? [floats(), floats(), floats(), floats()] : null;
    this.cameras = flags & HAS_CAMERAS ? take(Uint32Array, rows, 4) : null;
    this.sigma = flags & HAS_SIGMA ? floats() : null;
    this.body = take(Int32Array, poses, 4);
    this.pose = Array.from({ length: 7 }, () => take(Float32Array, poses, 4));
    this.keypoint_x = take(Float32Array, rows * this.keypoints, 4);
    this.keypoint_y = take(Float32Array, rows * this.keypoints, 4);
    this.state = take(Uint8Array, rows, 1);
    this.confidence = take(Uint8Array, rows * this.keypoints, 1);
    this.tracked = take(Uint8Array, poses, 1);
  }

  begin(k: number): number {
    return k === 0 ? 0 : this.row_end[k - 1];
  }
  pose_begin(k: number): number {
    return k === 0 ? 0 : this.pose_end[k - 1];
  }
  provenance(row: number): number {
    return this.state[row] & 7;
  }
  has_box(row: number): boolean {
    return (this.state[row] & ROW_HAS_BOX) !== 0;
  }
}

/** One track's course. */
export interface Course {
  time: Float64Array;
  x: Float32Array;
  y: Float32Array;
  z: Float32Array | null;
  state: Uint8Array;
}

export function course_of(bytes: ArrayBuffer): Course {
  const head = new DataView(bytes);
  const has_z = (head.getUint16(2, true) & HAS_Z) !== 0;
  const n = head.getUint32(24, true);
  const floats = (column: number) => new Float32Array(bytes, HEADER + 8 * n + 4 * n * column, n);
  return {
    time: new Float64Array(bytes, HEADER, n),
    x: floats(0),
    y: floats(1),
    z: has_z ? floats(2) : null,
    state: new Uint8Array(bytes, HEADER + n * (has_z ? 20 : 16), n),
  };
}

/** A camera's image and what was found in it, px of the camera. */
export interface CameraImage {
  camera: number;
  frame: number;
  sent_ms: number;
  width: number;
  height: number;
  points: { x: Float32Array; y: Float32Array; track: Int32Array };
  boxes: { left: Float32Array; top: Float32Array; width: Float32Array; height: Float32Array; track: Int32Array };
  jpeg: Blob | null;
}

export function image_of(bytes: ArrayBuffer): CameraImage {
  const head = new DataView(bytes);
  const n = head.getUint32(28, true);
  const b = head.getUint32(32, true);
  let at = HEADER;
  const floats = (count: number) => new Float32Array(bytes, (at += 4 * count) - 4 * count, count);
  const whole = (count: number) => new Int32Array(bytes, (at += 4 * count) - 4 * count, count);
  const points = { x: floats(n), y: floats(n), track: whole(n) };
  const boxes = { left: floats(b), top: floats(b), width: floats(b), height: floats(b), track: whole(b) };
  return {
    camera: head.getUint32(24, true),
    frame: head.getUint32(4, true),
    sent_ms: Number(head.getBigUint64(16, true)) / 1e6,
    width: head.getUint16(36, true),
    height: head.getUint16(38, true),
    points,
    boxes,
    jpeg: at < bytes.byteLength ? new Blob([new Uint8Array(bytes, at)], { type: "image/jpeg" }) : null,
  };
}

export const kind_of = (bytes: ArrayBuffer): number => new DataView(bytes).getUint8(0);
