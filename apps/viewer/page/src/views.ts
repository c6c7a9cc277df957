import { BlindView } from "./blind_view";
import type { Colours } from "./colours";
import { PlaneView } from "./plane_view";
import type { Scene } from "./scene";
import { SpaceView } from "./space_view";
import type { State } from "./state";
import type { View } from "./view";

/** How a scene is inspected. */
export function view_of(scene: Scene, state: State, colours: Colours, redraw: () => void): View {
  if (scene.frame !== "space") return new PlaneView(state, colours, redraw);
  try {
    return new SpaceView(state, colours, redraw);
  } catch {
    return new BlindView(state, colours); // three throws where there is no WebGL
  }
}
