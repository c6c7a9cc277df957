// Bones as rods: one round mesh, drawn once for all of them, each as thick as it is in the room but never thinner than can be seen.
// Lines would be one pixel wide: browsers draw no wider ones.
import { Color, CylinderGeometry, DynamicDrawUsage, InstancedMesh, Matrix4, MeshLambertMaterial, Quaternion, Vector3, type PerspectiveCamera, type Scene as World } from "three";

const SIDES = 10;
const MIN_PX = 1.3; // of a rod's radius on the screen
const UP = new Vector3(0, 1, 0);

export class Sticks {
  private mesh: InstancedMesh | null = null;
  private capacity = 0;
  private used = 0;
  private px_m = 0; // at a distance of 1 m
  private eye = new Vector3();
  private along = new Vector3();
  private middle = new Vector3();
  private turn = new Quaternion();
  private size = new Vector3();
  private matrix = new Matrix4();

  constructor(private world: World) {
    this.reserve(64);
  }

  /** `height`: of the view, px. */
  begin(camera: PerspectiveCamera, height: number): void {
    this.used = 0;
    this.eye.copy(camera.position);
    this.px_m = (2 * Math.tan((camera.fov * Math.PI) / 360)) / Math.max(1, height);
  }

  /** From `a` to `b`, `radius` m. */
  add(a: Vector3, b: Vector3, radius: number, colour: Color): void {
    this.along.subVectors(b, a);
    const length = this.along.length();
    if (!(length > 1e-6)) return;
    if (this.used === this.capacity) this.reserve(2 * this.capacity);
    this.middle.addVectors(a, b).multiplyScalar(0.5);
    const wide = Math.max(radius, MIN_PX * this.px_m * this.middle.distanceTo(this.eye));
    this.turn.setFromUnitVectors(UP, this.along.multiplyScalar(1 / length));
    this.matrix.compose(this.middle, this.turn, this.size.set(wide, length, wide));
    this.mesh!.setMatrixAt(this.used, this.matrix);
    this.mesh!.setColorAt(this.used++, colour);
  }

  end(): void {
    const mesh = this.mesh!;
    mesh.count = this.used;
    mesh.instanceMatrix.needsUpdate = true;
    if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
  }

  private reserve(capacity: number): void {
    const before = this.mesh;
    const mesh = new InstancedMesh(new CylinderGeometry(1, 1, 1, SIDES, 1), new MeshLambertMaterial(), capacity);
    mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    mesh.frustumCulled = false;
    if (before) {
      (mesh.instanceMatrix.array as Float32Array).set(before.instanceMatrix.array);
      mesh.setColorAt(0, new Color());
      if (before.instanceColor) (mesh.instanceColor!.array as Float32Array).set(before.instanceColor.array);
      this.world.remove(before);
      before.geometry.dispose();
      before.dispose();
    }
    this.mesh = mesh;
    this.capacity = capacity;
    this.world.add(mesh);
  }
}
