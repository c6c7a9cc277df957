// What the server says of a scene once, as apps/viewer/scene.cpp writes it.

export type Vector = [number, number, number];

export interface Track {
  id: number;
  label: string;
  team: string;
  colour?: [number, number, number];
  /** Of a recording: instants it is in, those in which it was seen, and the first and last time (s). */
  rows?: number;
  measured?: number;
  first?: number;
  last?: number;
  /** Instants from its first to its last. */
  within?: number;
  /** Grows with every edit that changes it. */
  version?: number;
}

export interface Camera {
  name: string;
  size?: [number, number];
  centre?: Vector;
  /** Directions of its image's corners, from the top left one clockwise. */
  corners?: Vector[];
}

export interface Body {
  id: number;
  label: string;
  skeleton: string;
  parent?: number;
  end?: Vector;
  markers: Vector[];
}

export interface Pitch {
  length: number;
  width: number;
  x: number;
  y: number;
}

export interface Scene {
  kind: "recording" | "live";
  name: string;
  frame: "space" | "ground" | "image";
  rate: number;
  made_by: string;
  cameras: Camera[];
  bodies: Body[];
  tracks: Track[];
  /** Of tracks in an image that have body keypoints: their names, and the bones between them. */
  keypoints?: string[];
  bones?: [number, number][];
  /** Of keypoints in space: the bones between points of these names. */
  named_bones?: [string, string][];
  /** Of tracks in an image: whose, and its size (px). */
  camera?: number;
  size?: [number, number];
  pitch?: Pitch | null;
  y_down?: boolean;
  low?: Vector;
  high?: Vector;
  // of a recording
  video?: boolean;
  instants?: number;
  last?: number;
  complete?: boolean;
  warnings?: string[];
  /** First time (s), instants, rows, version: its bytes are others where that has grown. */
  chunks?: [number, number, number, number][];
  /** The page may change the take. */
  can_edit?: boolean;
  // of a live run
  can_record?: boolean;
  can_change?: boolean;
  rig_file?: string;
  job?: string;
}

/** Of joints and other places that were computed: cameras saw none of them. */
export function is_computed(scene: Scene): boolean {
  return scene.kind === "recording" && scene.tracks.length > 0 && scene.tracks.every((track) => !track.measured);
}

export function name_of(track: Track | undefined, id: number): string {
  return track && track.label !== "" ? track.label : `${id}`;
}
