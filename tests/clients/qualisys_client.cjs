// qualisys-rt of npm: version, parameters, ten frames. Usage: node qualisys_client.cjs PORT. The time that it decodes is wrong by its own fault.
const { Api } = require("qualisys-rt");

const api = new Api({ debug: false });
let frames = 0;
api.on("frame", (data) => {
  const markers = data.components["3d"] ?? data.components["3D"];
  if (!markers) { console.error(JSON.stringify(data)); process.exit(1); }
  if (++frames === 10) { console.log(`qualisys-rt: ${frames} frames of ${markers.markerCount ?? markers.markers?.length} markers`); process.exit(0); }
});
api.on("error", (error) => { console.error(error); process.exit(1); });
const ask = async () => {
  await api.connect(Number(process.argv[2]), "127.0.0.1", 1, 19);
  await api.qtmVersion();
  await api.byteOrder();
  await api.getParameters("3D");
  await api.streamFrames({ components: ["3D"] });
};
ask().catch((error) => { console.error(error); process.exit(1); });
setTimeout(() => { console.error("nothing came in time"); process.exit(1); }, 10000);
