// Foxglove's own client of its WebSocket: reads the channels and ten point clouds. Usage: node foxglove_client.cjs PORT
const { FoxgloveClient } = require("@foxglove/ws-protocol");
const { WebSocket } = require("ws");

const client = new FoxgloveClient({ ws: new WebSocket(`ws://127.0.0.1:${process.argv[2]}`, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]) });
let clouds = 0;
client.on("error", (error) => { console.error(error); process.exit(1); });
client.on("advertise", (channels) => {
  const points = channels.find((channel) => channel.topic === "/marey/points");
  if (points.schemaName !== "foxglove.PointCloud" || points.encoding !== "protobuf") process.exit(1);
  client.subscribe(points.id);
});
client.on("message", ({ timestamp, data }) => {
  if (timestamp === 0n || data.byteLength < 48) process.exit(1);
  if (++clouds === 10) { console.log(`@foxglove/ws-protocol: ${clouds} point clouds`); process.exit(0); }
});
setTimeout(() => { console.error("nothing came in time"); process.exit(1); }, 10000);
