// Markers in space: spheres, trails, bodies, the cameras' frusta, a floor of one metre squares. z is up.
import {
  BufferAttribute, BufferGeometry, Color, DynamicDrawUsage, Float32BufferAttribute, Group, HemisphereLight, DirectionalLight,
  InstancedMesh, LineBasicMaterial, LineSegments, Matrix4, MeshLambertMaterial, PerspectiveCamera, Quaternion, Scene as World, SphereGeometry, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { bones_of, certainty } from "./bones";
import type { Colours } from "./colours";
import { time_of, type TimeStep, type Motion } from "./motion";
import { Overlay, type Mark } from "./overlay";
import { name_of, type Scene, type Track } from "./scene";
import { TYPEFACE, type State } from "./state";
import { Sticks } from "./sticks";
import { time_steps_back, type View } from "./view";
import { FILLED, MEASURED, PREDICTED } from "./wire";

const TRAIL_STEPS = 90;
const MAX_TRAIL_SEGMENTS = 60000;
const MARKER_M = 0.017; // radius where the scene is a few metres wide
const BONE_M = 0.009;
const AXIS_M = 0.1; // length of a body's axes

/** Lines whose ends and colours change with every image. */
class Lines {
  readonly object: LineSegments;
  private position: Float32Array;
  private colour: Float32Array;
  private used = 0;
  constructor(private capacity: number) {
    const geometry = new BufferGeometry();
    this.position = new Float32Array(capacity * 6);
    this.colour = new Float32Array(capacity * 8);
    geometry.setAttribute("position", new BufferAttribute(this.position, 3).setUsage(DynamicDrawUsage));
    geometry.setAttribute("color", new BufferAttribute(this.colour, 4).setUsage(DynamicDrawUsage));
    this.object = new LineSegments(geometry, new LineBasicMaterial({ vertexColors: true, transparent: true, depthWrite: false }));
    this.object.frustumCulled = false;
  }
  begin(): void {
    this.used = 0;
  }
  add(x0: number, y0: number, z0: number, x1: number, y1: number, z1: number, rgb: ArrayLike<number>, a0: number, a1: number): void {
    if (this.used === this.capacity) return;
    this.position.set([x0, y0, z0, x1, y1, z1], 6 * this.used);
    this.colour.set([rgb[0], rgb[1], rgb[2], a0, rgb[0], rgb[1], rgb[2], a1], 8 * this.used);
    ++this.used;
  }
  end(): void {
    const { geometry } = this.object;
    geometry.setDrawRange(0, 2 * this.used);
    for (const [name, size] of [["position", 6], ["color", 8]] as const) {
      const attribute = geometry.getAttribute(name) as BufferAttribute;
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, size * this.used);
      attribute.needsUpdate = true;
    }
  }
}

export class SpaceView implements View {
  readonly element = document.createElement("div");
  readonly overlay: Overlay;
  private renderer = new WebGLRenderer({ antialias: true, alpha: false, preserveDrawingBuffer: false });
  private world = new World();
  private camera = new PerspectiveCamera(42, 1, 0.02, 500);
  private controls: OrbitControls;
  private markers: InstancedMesh;
  private trails = new Lines(MAX_TRAIL_SEGMENTS);
  private bones: Sticks;
  private keypoint_bones: [number, number][] = [];
  private rays = new Lines(8000);
  private floor = new Group();
  private rig = new Group();
  private camera_names: { name: string; at: Vector3 }[] = [];
  private tracks = new Map<number, Track>();
  private scene: Scene | null = null;
  private low = new Vector3(-2, -2, 0);
  private high = new Vector3(2, 2, 2);
  private framed = false;
  private capacity = 0;
  private dark: boolean | null = null;
  private scratch = { matrix: new Matrix4(), colour: new Color(), v: new Vector3(), q: new Quaternion() };

  constructor(private state: State, private colours: Colours, private redraw: () => void) {
    this.overlay = new Overlay(state, colours);
    this.element.className = "view space";
    this.element.append(this.renderer.domElement, this.overlay.canvas);
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.element);
    this.controls.enableDamping = false;
    this.controls.zoomToCursor = true;
    this.controls.maxPolarAngle = 0.97 * Math.PI;
    this.controls.addEventListener("change", this.redraw);
    this.markers = this.make_markers(128);
    const sun = new DirectionalLight(0xffffff, 1.5);
    sun.position.set(2, -3, 5);
    this.world.add(new HemisphereLight(0xffffff, 0x8a94a0, 2), sun, this.floor, this.rig, this.trails.object, this.rays.object);
    this.bones = new Sticks(this.world);
  }

  take(scene: Scene): void {
    this.scene = scene;
    this.tracks = new Map(scene.tracks.map((track) => [track.id, track]));
    this.keypoint_bones = bones_of(scene);
    if (scene.low && scene.high) {
      this.low.set(...scene.low);
      this.high.set(...scene.high);
    }
    this.dark = null;
    if (!this.framed || scene.complete) {
      if (!this.framed) this.reset();
      this.framed = scene.kind === "live" || scene.low !== undefined;
    }
  }

  resize(width: number, height: number): void {
    this.camera.aspect = width / Math.max(1, height);
    this.camera.updateProjectionMatrix();
    this.renderer.setSize(width, height);
    this.overlay.resize(width, height);
    if (this.moved_by_user === 0) this.reset();
  }
  private moved_by_user = 0;

  reset(): void {
    this.look(new Vector3(0.75, -1, 0.42));
  }
  view_from(side: "top" | "front" | "side"): void {
    this.look(side === "top" ? new Vector3(0, -0.001, 1) : side === "front" ? new Vector3(0, -1, 0.06) : new Vector3(1, 0, 0.06));
  }
  private look(direction: Vector3): void {
    const middle = new Vector3().addVectors(this.low, this.high).multiplyScalar(0.5);
    const size = new Vector3().subVectors(this.high, this.low);
    const radius = Math.max(0.3, 0.5 * size.length());
    const half = Math.atan(Math.tan((this.camera.fov * Math.PI) / 360) * Math.min(1, this.camera.aspect));
    const distance = (0.9 * radius) / Math.sin(half);
    this.camera.position.copy(direction.normalize().multiplyScalar(distance).add(middle));
    this.camera.near = distance / 200;
    this.camera.far = distance * 60;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(middle);
    this.controls.update();
  }

  draw(motion: Motion, moment: TimeStep | null): void {
    if (this.dark !== this.state.dark) this.paint_surroundings();
    this.rig.visible = this.state.cameras;
    const marks = moment ? this.place_markers(moment) : [];
    this.place_trails(motion, moment);
    this.place_bones(moment);
    this.place_rays(moment);
    this.renderer.render(this.world, this.camera);
    this.overlay.clear();
    if (this.state.cameras) this.name_cameras();
    this.overlay.labels(marks, this.state.labels);
  }

  /** How large things are drawn, by how wide the scene is. */
  private room(): number {
    return Math.max(0.5, Math.min(12, new Vector3().subVectors(this.high, this.low).length() / 4));
  }

  private place_markers(moment: TimeStep): Mark[] {
    const { chunk: chunk, k } = moment;
    const end = chunk.row_end[k];
    const begin = chunk.begin(k);
    if (end - begin > this.capacity) this.markers = this.make_markers(2 * (end - begin));
    const { matrix, colour, v } = this.scratch;
    const marks: Mark[] = [];
    const scale = this.room() * MARKER_M;
    const focal = this.overlay.height / 2 / Math.tan((this.camera.fov * Math.PI) / 360);
    let count = 0;
    for (let row = begin; row < end; ++row) {
      const id = chunk.track[row];
      if (this.state.hidden.has(id)) continue;
      const selected = this.state.selected.has(id);
      const radius = scale * (selected || this.state.hover === id ? 1.5 : 1);
      const z = chunk.z ? chunk.z[row] : 0;
      matrix.makeScale(radius, radius, radius).setPosition(chunk.x[row], chunk.y[row], z);
      this.markers.setMatrixAt(count, matrix);
      colour.setRGB(...this.colours.rgb(id), "srgb");
      const how = chunk.provenance(row);
      if (chunk.sigma) colour.lerp(this.background, 1 - certainty(chunk, row));
      if (how === FILLED || how === PREDICTED) colour.lerp(this.background, 0.6); // not seen at this instant
      if (this.state.selected.size > 0 && !selected) colour.lerp(this.background, 0.35);
      this.markers.setColorAt(count++, colour);
      v.set(chunk.x[row], chunk.y[row], z);
      const away = v.distanceTo(this.camera.position);
      v.project(this.camera);
      if (v.z > 1 || Math.abs(v.x) > 1 || Math.abs(v.y) > 1) continue;
      marks.push({
        id, x: ((v.x + 1) / 2) * this.overlay.width, y: ((1 - v.y) / 2) * this.overlay.height,
        radius: (radius * focal) / away + 1, text: name_of(this.tracks.get(id), id), depth: away,
      });
    }
    this.markers.count = count;
    this.markers.instanceMatrix.needsUpdate = true;
    if (this.markers.instanceColor) this.markers.instanceColor.needsUpdate = true;
    return marks;
  }

  private place_trails(motion: Motion, moment: TimeStep | null): void {
    this.trails.begin();
    if (moment && this.state.trail_s > 0) {
      const now = time_of(moment);
      const before = new Map<number, [number, number, number, number]>();
      const chosen = this.state.selected.size > 0;
      for (const { chunk: chunk, k } of time_steps_back(motion, moment, this.state.trail_s, TRAIL_STEPS)) {
        const time = chunk.time[k];
        const alpha = 0.75 * (1 - (now - time) / this.state.trail_s);
        for (let row = chunk.begin(k); row < chunk.row_end[k]; ++row) {
          const id = chunk.track[row];
          if (this.state.hidden.has(id) || (chosen && !this.state.selected.has(id))) continue;
          const z = chunk.z ? chunk.z[row] : 0;
          const last = before.get(id);
          if (last && last[3] - time < 0.25)
            this.trails.add(chunk.x[row], chunk.y[row], z, last[0], last[1], last[2], this.linear(id), alpha, alpha + 0.02);
          before.set(id, [chunk.x[row], chunk.y[row], z, time]);
        }
      }
    }
    this.trails.end();
  }

  private linear(id: number): number[] {
    this.scratch.colour.setRGB(...this.colours.rgb(id), "srgb");
    return [this.scratch.colour.r, this.scratch.colour.g, this.scratch.colour.b];
  }

  /** A segment of a skeleton is a rod from its parent's origin to its own, and to its end; a body by itself is its axes. */
  private place_bones(moment: TimeStep | null): void {
    this.bones.begin(this.camera, this.overlay.height);
    if (moment && this.scene && this.scene.bodies.length > 0) {
      const { chunk: chunk, k } = moment;
      const at = new Map<number, number>();
      for (let p = chunk.pose_begin(k); p < chunk.pose_end[k]; ++p) at.set(chunk.body[p], p);
      const origin = (p: number) => new Vector3(chunk.pose[0][p], chunk.pose[1][p], chunk.pose[2][p]);
      const rotated = (p: number, v: Vector3) =>
        v.applyQuaternion(this.scratch.q.set(chunk.pose[3][p], chunk.pose[4][p], chunk.pose[5][p], chunk.pose[6][p])).add(origin(p));
      const bone = new Color(this.state.dark ? 0xb4bcc8 : 0x4a5563);
      const faint = bone.clone().lerp(this.background, 0.6);
      const axes = [0xff0000, 0x00aa22, 0x2255ff].map((colour) => new Color(colour));
      const radius = this.room() * BONE_M;
      for (const body of this.scene.bodies) {
        const p = at.get(body.id);
        if (p === undefined) continue;
        const colour = chunk.tracked[p] ? bone : faint;
        const parent = body.parent === undefined ? undefined : at.get(body.parent);
        if (parent !== undefined) this.bones.add(origin(parent), origin(p), radius, colour);
        if (body.end) this.bones.add(origin(p), rotated(p, new Vector3(...body.end)), radius, colour);
        if (body.skeleton !== "") continue;
        for (const marker of body.markers) this.bones.add(origin(p), rotated(p, new Vector3(...marker)), 0.3 * radius, colour);
        for (let axis = 0; axis < 3; ++axis)
          this.bones.add(origin(p), rotated(p, new Vector3().setComponent(axis, AXIS_M)), 0.6 * radius, chunk.tracked[p] ? axes[axis] : axes[axis].clone().lerp(this.background, 0.6));
      }
    }
    if (moment) this.place_keypoint_bones(moment);
    this.bones.end();
  }

  /** Between keypoints that are both here: as faint as the less certain of them. */
  private place_keypoint_bones(moment: TimeStep): void {
    if (this.keypoint_bones.length === 0) return;
    const { chunk: chunk, k } = moment;
    const rows = new Map<number, number>();
    for (let row = chunk.begin(k); row < chunk.row_end[k]; ++row) rows.set(chunk.track[row], row);
    const at = (row: number) => new Vector3(chunk.x[row], chunk.y[row], chunk.z ? chunk.z[row] : 0);
    const radius = 0.6 * this.room() * BONE_M;
    for (const [from, to] of this.keypoint_bones) {
      const a = rows.get(from);
      const b = rows.get(to);
      if (a === undefined || b === undefined || this.state.hidden.has(from) || this.state.hidden.has(to)) continue;
      const colour = new Color().setRGB(...this.colours.rgb(from), "srgb");
      colour.lerp(this.background, 1 - Math.min(certainty(chunk, a), certainty(chunk, b)));
      this.bones.add(at(a), at(b), radius, colour);
    }
  }

  /** From each camera that saw a marker to it: of those that are selected, or of all. */
  private place_rays(moment: TimeStep | null): void {
    this.rays.begin();
    if (moment && this.state.rays && moment.chunk.cameras) {
      const { chunk: chunk, k } = moment;
      const centres = (this.scene?.cameras ?? []).map((camera) => camera.centre);
      const chosen = this.state.selected.size > 0;
      for (let row = chunk.begin(k); row < chunk.row_end[k]; ++row) {
        const id = chunk.track[row];
        if (this.state.hidden.has(id) || (chosen && !this.state.selected.has(id)) || chunk.provenance(row) !== MEASURED) continue;
        for (let camera = 0; camera < Math.min(32, centres.length); ++camera) {
          const centre = centres[camera];
          if (!centre || !(chunk.cameras![row] & (1 << camera))) continue;
          this.rays.add(centre[0], centre[1], centre[2], chunk.x[row], chunk.y[row], chunk.z![row], this.linear(id), 0.15, chosen ? 0.8 : 0.4);
        }
      }
    }
    this.rays.end();
  }

  private background = new Color();

  private make_markers(capacity: number): InstancedMesh {
    if (this.markers) {
      this.world.remove(this.markers);
      this.markers.dispose();
    }
    this.capacity = capacity;
    const mesh = new InstancedMesh(new SphereGeometry(1, 16, 12), new MeshLambertMaterial(), capacity);
    mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    mesh.frustumCulled = false;
    mesh.count = 0;
    this.world.add(mesh);
    return mesh;
  }

  private paint_surroundings(): void {
    this.dark = this.state.dark;
    this.background.set(this.dark ? 0x0e1115 : 0xf4f5f7);
    this.world.background = this.background;
    this.floor.clear();
    this.rig.clear();
    this.camera_names = [];
    this.paint_floor();
    for (const camera of this.scene?.cameras ?? []) {
      if (camera.centre && camera.corners?.length === 4) this.paint_camera(camera.name, camera.centre, camera.corners);
    }
  }

  private paint_floor(): void {
    const cameras = (this.scene?.cameras ?? []).flatMap((camera) => (camera.centre ? [camera.centre] : []));
    const reach = (axis: 0 | 1, side: 1 | -1) => {
      const values = [side > 0 ? this.high.getComponent(axis) : this.low.getComponent(axis), ...cameras.map((centre) => centre[axis])];
      const far = side > 0 ? Math.max(...values) : Math.min(...values);
      return Math.max(-60, Math.min(60, side > 0 ? Math.ceil(far + 0.5) : Math.floor(far - 0.5)));
    };
    const [left, right, front, back] = [reach(0, -1), reach(0, 1), reach(1, -1), reach(1, 1)];
    const fine: number[] = [];
    for (let x = left; x <= right; ++x) if (x !== 0) fine.push(x, front, 0, x, back, 0);
    for (let y = front; y <= back; ++y) if (y !== 0) fine.push(left, y, 0, right, y, 0);
    this.floor.add(lines(fine, this.dark ? 0x252c35 : 0xd9dde3));
    const axis = (points: number[], colour: number) => this.floor.add(lines(points, colour));
    axis([left, 0, 0, right, 0, 0], this.dark ? 0x5a3a3c : 0xd9a0a0);
    axis([0, front, 0, 0, back, 0], this.dark ? 0x39533f : 0x9cc7a3);
  }

  private paint_camera(name: string, centre: number[], corners: number[][]): void {
    const size = 0.09 * Math.max(2, Math.min(20, new Vector3().subVectors(this.high, this.low).length()));
    const tip = (corner: number[]) => corner.map((v, axis) => centre[axis] + size * v);
    const points: number[] = [];
    for (let i = 0; i < 4; ++i) points.push(...centre, ...tip(corners[i]), ...tip(corners[i]), ...tip(corners[(i + 1) % 4]));
    this.rig.add(lines(points, this.dark ? 0x62788f : 0x7f95ab));
    this.camera_names.push({ name, at: new Vector3(...(centre as [number, number, number])) });
  }

  private name_cameras(): void {
    const { draw, width, height } = this.overlay;
    draw.font = `10.5px ${TYPEFACE}`;
    draw.textAlign = "center";
    draw.fillStyle = this.state.dark ? "#7d93ab" : "#5d7388";
    for (const { name, at } of this.camera_names) {
      const v = at.clone().project(this.camera);
      if (v.z < 1) draw.fillText(name, ((v.x + 1) / 2) * width, ((1 - v.y) / 2) * height - 9);
    }
    draw.textAlign = "left";
  }
}

function lines(points: number[], colour: number): LineSegments {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(points, 3));
  return new LineSegments(geometry, new LineBasicMaterial({ color: colour }));
}
