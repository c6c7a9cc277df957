"""What the wires' own clients receive of a recording with points, a body and a skeleton (tests/support/moving_bodies.h).

    streams_test.py CLIENT PLAYED_BODIES MAREY     CLIENT is one of the functions below; exits 77 (skipped) where it is not installed
"""
import asyncio
import base64
import csv
import json
import math
import os
import pathlib
import re
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import traceback

PLAYED, MAREY = "", ""
HERE = pathlib.Path(__file__).resolve().parent
SECONDS = 30.0


class Skipped(Exception):
    pass


class Player:
    """played_bodies over these wires; `port` is the one that each got."""

    def __init__(self, *wires, seconds=SECONDS):
        self.process = subprocess.Popen([PLAYED, str(seconds), *wires], stdout=subprocess.PIPE, text=True)
        self.port = {}
        for _ in wires:
            name, where = self.process.stdout.readline().split(maxsplit=1)
            self.port[name] = int(re.match(r"[\d.]+:(\d+)", where).group(1))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()


def wait_for(done, seconds=10):
    until = time.monotonic() + seconds
    while not done():
        assert time.monotonic() < until, "nothing came in time"
        time.sleep(0.02)


def near(found, wanted, tolerance=1e-4):
    assert len(found) == len(wanted) and all(abs(a - b) <= tolerance for a, b in zip(found, wanted)), (found, wanted)


def required_rotation(k):
    """Of the racket, column by column."""
    c, s = math.cos(k / 100), math.sin(k / 100)
    return [c, s, 0, -s, c, 0, 0, 0, 1]


def qtm_rt():
    import qtm_rt

    async def talk(port):
        connection = await qtm_rt.connect("127.0.0.1", port=port)
        assert await connection.qtm_version() == b"QTM Version is 2.17 (build 4000)"
        assert await connection.byte_order() == b"Byte order is little endian"
        assert await connection.get_state() == qtm_rt.QRTEvent.EventConnected
        xml = (await connection.get_parameters(parameters=["3d", "6d", "skeleton", "general"])).decode()
        assert "<Name>LASI</Name>" in xml and "<Name>racket</Name>" in xml and 'Name="LeftUpLeg"' in xml, xml
        packets = []
        await connection.stream_frames(components=["3d", "3dnolabels", "6d", "6deuler", "skeleton"], on_packet=packets.append)
        until = time.monotonic() + 10
        while len(packets) < 50 and time.monotonic() < until:
            await asyncio.sleep(0.05)
        await connection.stream_frames_stop()
        for _ in range(5):  # a frame of the stream may still be on its way, and is taken for the answer
            frame = await connection.get_current_frame(components=["3dres"])
            if residuals := frame.get_3d_markers_residual():
                break
        assert len(residuals[1]) == 2
        await connection.take_control("")
        await connection.start()
        await connection.stop()
        connection.disconnect()
        return packets

    with Player("qtm:127.0.0.1:0") as player:
        packets = asyncio.run(talk(player.port["qtm"]))
    assert len(packets) >= 50, len(packets)
    for packet in packets[:50]:
        k = packet.framenumber - 1
        assert packet.timestamp == 10_000 * k
        first, second = packet.get_3d_markers()[1]
        near(first, (k, 0, 1000), 1e-2)
        assert math.isnan(second.x) == (k % 5 == 0)
        other = packet.get_3d_markers_no_label()[1][0]
        near((other.x, other.y, other.z, other.id), (1000, 2000, 3000, 3))
        place, rotation = packet.get_6d()[1][0]
        if k % 7 == 0:
            assert math.isnan(place.x)
        else:
            near(place, (0, k, 1500), 1e-2)
            near(rotation.matrix, required_rotation(k))
            near((packet.get_6d_euler()[1][0][1].a3,), (math.degrees(math.remainder(k / 100, math.tau)),), 1e-2)
        segments = packet.get_skeletons()[1][0]
        near(segments[1][1], (100, 0, -100), 1e-2)
    print(f"qtm-rt: {len(packets)} packets, as they should be")


def motioncapture():
    """The C++ SDK of Qualisys, and the NatNet of libmotioncapture."""
    import motioncapture

    with Player("qtm:127.0.0.1:22223") as _:
        connection = motioncapture.connect("qualisys", {"hostname": "127.0.0.1", "port": "22222"})
        found = bodies_of(connection)
    print("motioncapture, Qualisys:", *found)
    with Player("natnet") as _:
        connection = motioncapture.connect("optitrack", {"hostname": "127.0.0.1", "interface_ip": "127.0.0.1"})
        found = bodies_of(connection)
    print("motioncapture, OptiTrack:", *found)


def bodies_of(connection):
    for _ in range(30):
        connection.waitForNextFrame()
        if "racket" in connection.rigidBodies:
            return list(connection.rigidBodies)
    raise AssertionError("no body called racket")


def natnet():
    import natnet

    for wire, multicast in (("natnet", True), ("natnet-unicast", False)):
        frames, definitions = [], []
        with Player(wire):
            client = natnet.NatNetClient(use_multicast=multicast)
            client.on_data_frame_received_event.handlers.append(frames.append)
            client.on_data_description_received_event.handlers.append(definitions.append)
            with client:
                client.request_modeldef()
                until = time.monotonic() + 10
                while (len(frames) < 30 or not definitions) and time.monotonic() < until:
                    client.update_sync()
                    time.sleep(0.005)
        assert len(frames) >= 30 and definitions, (wire, len(frames), len(definitions))
        assert [body.name for body in definitions[0].rigid_bodies] == ["racket"]
        for frame in frames:
            k = frame.prefix.frame_number
            body = frame.rigid_bodies[0]
            near(body.pos, (0, 1.5, -k / 1000))
            near(body.rot, (0, math.sin(k / 200), 0, math.cos(k / 200)))
            near(frame.marker_sets[0].marker_pos_list[0], (k / 1000, 1, 0))
            near(frame.labeled_markers[-1].pos, (1, 3, -2))
            assert len(frame.skeletons[0].rigid_bodies) == 2
        print(f"natnet, {wire}: {len(frames)} frames")


def natnetsdk():
    import natnetsdk
    from natnetsdk.NatNetClient import NatNetClient

    del natnetsdk
    seen, stamps = [], []
    with Player("natnet-unicast"):
        client = NatNetClient()
        client.set_client_address("127.0.0.1")
        client.set_server_address("127.0.0.1")
        client.set_use_multicast(False)
        client.set_print_level(0)
        client.rigid_body_listener = lambda number, place, turn: seen.append((number, place, turn))
        client.new_frame_listener = stamps.append
        assert client.run()
        wait_for(lambda: len(seen) >= 30)
    assert {number for number, _, _ in seen} == {1, 1 << 16 | 1, 1 << 16 | 2}, seen  # the body, and the skeleton's bones
    for number, place, _ in seen:
        assert number != 1 or abs(place[1] - 1.5) < 1e-6, place
    assert stamps
    print(f"natnetsdk: {len(seen)} poses")


def osc_messages(wire, enough):
    from pythonosc.dispatcher import Dispatcher
    from pythonosc.osc_server import ThreadingOSCUDPServer

    heard, dispatcher = [], Dispatcher()
    dispatcher.set_default_handler(lambda address, *values: heard.append((address, values)))
    server = ThreadingOSCUDPServer(("127.0.0.1", 0), dispatcher)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    with Player(f"{wire}:127.0.0.1:{server.server_address[1]}"):
        wait_for(lambda: len(heard) >= enough)
    server.shutdown()
    return heard


def python_osc():
    heard = osc_messages("osc", 200)
    kinds = {address for address, _ in heard}
    assert kinds == {"/marey/frame", "/marey/point", "/marey/body"}, kinds
    frame = next(values for address, values in heard if address == "/marey/frame")
    assert frame[2] <= frame[3] <= frame[4] <= time.monotonic_ns(), frame
    points = [values for address, values in heard if address == "/marey/point" and values[1] == "RASI"]
    near(points[0][2:5], (0, 0.25, 1))
    print(f"python-osc: {len(heard)} messages")
    heard = osc_messages("vmc", 200)
    bones = [values for address, values in heard if address == "/VMC/Ext/Bone/Pos"]
    assert {bone[0] for bone in bones} == {"Hips", "LeftUpperLeg"}, bones
    leg = next(bone for bone in bones if bone[0] == "LeftUpperLeg")
    near(leg[1:], (0.1, -0.1, 0, 0, -math.sin(0.1), 0, math.cos(0.1)))
    hips = next(bone for bone in bones if bone[0] == "Hips")
    near(hips[1:4], (1, 1, 1))
    trackers = [values for address, values in heard if address == "/VMC/Ext/Tra/Pos"]
    assert trackers and trackers[0][0] == "racket" and abs(trackers[0][2] - 1.5) < 1e-6
    assert ("/VMC/Ext/OK", (1, 3, 0, 1)) in heard
    print(f"python-osc, VMC: {len(heard)} messages")


def pylsl():
    import pylsl

    with Player("lsl"):
        found = pylsl.resolve_byprop("type", "MoCap", timeout=10)
        assert found, "no outlet of type MoCap was found"
        inlet = pylsl.StreamInlet(found[0])
        info = inlet.info(timeout=10)
        assert (info.name(), info.channel_count(), info.nominal_srate()) == ("Marey", 3 * 2 + 3 * 7, 100.0)
        channel, labels = info.desc().child("channels").child("channel"), []
        while not channel.empty():
            labels.append(channel.child_value("label"))
            channel = channel.next_sibling()
        assert labels[:6] == [f"{name}_{axis}" for name in ("LASI", "RASI") for axis in "XYZ"] and labels[9] == "racket_qA", labels
        samples = [inlet.pull_sample(timeout=10) for _ in range(50)]
        assert abs(inlet.time_correction(timeout=10)) < 0.05
    for values, stamp in samples:
        assert abs(pylsl.local_clock() - stamp) < 20
        k = round(1000 * values[0])
        near(values[0:3], (k / 1000, 0, 1))
        assert math.isnan(values[3]) == (k % 5 == 0)
    steps = [b[1] - a[1] for a, b in zip(samples, samples[1:])]
    assert abs(sum(steps) / len(steps) - 0.01) < 1e-3, steps
    print(f"pylsl: {len(samples)} samples of {len(labels)} channels")


def unlabelled():
    """Live markers without labels: LSL sends them by slot, and the script for Qualisys clients in docs/streams.md prints them."""
    import pylsl
    import qtm_rt  # noqa: F401: the script imports it

    streams = ["--stream", "lsl", "--stream", "qtm"]
    live = subprocess.Popen([MAREY, "live", "sim://room?cameras=4&rate=30&markers=8&blobs", "--max-markers", "12", "--duration", "30", *streams],
                            stderr=subprocess.PIPE, text=True)
    try:
        said = [live.stderr.readline() for _ in range(3)]
        assert any("12 slots, each with a track's ID" in line for line in said), said
        found = pylsl.resolve_byprop("type", "MoCap", timeout=10)
        assert found, "no outlet of type MoCap was found"
        inlet = pylsl.StreamInlet(found[0])
        info = inlet.info(timeout=10)
        channel = info.desc().child("channels").child("channel")
        assert (info.channel_count(), channel.child_value("label"), channel.child_value("type")) == (12 * 4, "slot1_ID", "TrackID")
        tracks = set()
        for _ in range(60):
            values = inlet.pull_sample(timeout=10)[0]
            slots = [values[i:i + 4] for i in range(0, len(values), 4)]
            tracks |= {slot[0] for slot in slots if not math.isnan(slot[0])}
            assert all(math.isnan(slot[0]) == math.isnan(slot[3]) for slot in slots), slots
        assert len(tracks) >= 4, tracks
        script = re.search(r"```python\n(import asyncio, qtm_rt.*?)```", (HERE.parents[1] / "docs/streams.md").read_text(), re.S)[1]
        told = subprocess.run([sys.executable, "-c", script.replace("sleep(5)", "sleep(1)")], capture_output=True, text=True, timeout=60)
        assert "RT3DMarkerPositionNoLabel" in told.stdout and "Error" not in told.stderr, (told.stdout[-500:], told.stderr[-2000:])
    finally:
        live.kill()
        live.communicate()
    print(f"unlabelled: {len(tracks)} tracks in 12 slots")


class FoxgloveClient:
    """As little of RFC 6455 as it takes."""

    def __init__(self, port, protocol):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=10)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall((f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                             f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: {protocol}\r\n\r\n").encode())
        self.file = self.socket.makefile("rb")
        self.head = b""
        while not self.head.endswith(b"\r\n\r\n"):
            byte = self.file.read(1)
            if not byte:
                break
            self.head += byte

    def send(self, message):
        text, mask = json.dumps(message).encode(), os.urandom(4)
        head = bytes([0x81, 0x80 | len(text)]) if len(text) < 126 else b"\x81\xfe" + struct.pack(">H", len(text))
        self.socket.sendall(head + mask + bytes(b ^ mask[i % 4] for i, b in enumerate(text)))

    def receive(self):
        first, size = self.file.read(2)
        if size == 126:
            size = struct.unpack(">H", self.file.read(2))[0]
        elif size == 127:
            size = struct.unpack(">Q", self.file.read(8))[0]
        return first & 15, self.file.read(size)


def foxglove_schemas():
    """The published schemas' own classes read what goes over the WebSocket, and the descriptors that are sent along."""
    from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
    from foxglove_schemas_protobuf.PointCloud_pb2 import PointCloud
    from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
    from google.protobuf import descriptor_pb2

    with Player("foxglove:127.0.0.1:0") as player:
        assert FoxgloveClient(player.port["foxglove"], "chat").head.startswith(b"HTTP/1.1 400 ")
        for protocol in ("foxglove.sdk.v1", "foxglove.websocket.v1"):
            client = FoxgloveClient(player.port["foxglove"], protocol)
            assert f"Sec-WebSocket-Protocol: {protocol}\r\n".encode() in client.head, client.head
        assert json.loads(client.receive()[1])["op"] == "serverInfo"
        channels = {channel["topic"]: channel for channel in json.loads(client.receive()[1])["channels"]}
        compare_descriptors(base64.b64decode(channels["/marey/points"]["schema"]), descriptor_pb2, (PointCloud, FrameTransforms, SceneUpdate))
        client.send({"op": "subscribe", "subscriptions": [{"id": 10 + c["id"], "channelId": c["id"]} for c in channels.values()]})
        messages = {}
        while len(messages) < 4:
            opcode, payload = client.receive()
            assert opcode == 2
            _, subscription, _ = struct.unpack_from("<BIQ", payload)
            messages[subscription - 10] = payload[13:]
    topic = {name: messages[channel["id"]] for name, channel in channels.items()}
    times = json.loads(topic["/marey/times"])
    assert times["capture_ns"] <= times["solve_ns"] <= times["send_ns"]
    k = times["frame"]
    cloud = PointCloud.FromString(topic["/marey/points"])
    assert [field.name for field in cloud.fields] == ["x", "y", "z", "id"] and cloud.point_stride == 16
    x, y, z, number = struct.unpack_from("<fffI", cloud.data)
    near((y, z, number), (0, 1, 1))
    transforms = FrameTransforms.FromString(topic["/tf"]).transforms
    assert [t.child_frame_id for t in transforms] == ["racket", "dancer/Hips", "dancer/LeftUpLeg"]
    entity = SceneUpdate.FromString(topic["/marey/scene"]).entities[0]
    assert entity.texts[0].text == "LASI" and len(entity.lines[0].points) == 2 and len(entity.spheres) >= 2
    print(f"Foxglove's schemas read frame {k}: {len(transforms)} transforms, {len(entity.spheres)} spheres")


def compare_descriptors(serialised, descriptor_pb2, classes):
    """Every field that is published is in what is sent, with its number and type; of all messages that it refers to."""
    ours = {}
    for file in descriptor_pb2.FileDescriptorSet.FromString(serialised).file:
        for message in file.message_type:
            ours[f"{file.package}.{message.name}"] = {f.name: (f.number, f.type, f.label, f.type_name) for f in message.field}
    waiting, seen = [c.DESCRIPTOR for c in classes], set()
    while waiting:
        descriptor = waiting.pop()
        if descriptor.full_name in seen:
            continue
        seen.add(descriptor.full_name)
        published = descriptor_pb2.DescriptorProto()
        descriptor.CopyToProto(published)
        wanted = {f.name: (f.number, f.type, f.label, f.type_name) for f in published.field}
        assert ours.get(descriptor.full_name) == wanted, (descriptor.full_name, ours.get(descriptor.full_name), wanted)
        waiting += [f.message_type for f in descriptor.fields if f.message_type is not None]
    print(f"descriptors: {len(seen)} messages as they are published")


def node():
    """@foxglove/ws-protocol and qualisys-rt of npm, where node is there and script/setup found npm."""
    modules = HERE.parent.parent / ".node" / "node_modules"
    if not (modules / "@foxglove/ws-protocol").is_dir():
        raise Skipped(f"{modules} is not there; script/setup --tests makes it where npm is installed")
    with Player("foxglove:127.0.0.1:0", "qtm:127.0.0.1:0") as player:
        for script, wire in (("foxglove_client.cjs", "foxglove"), ("qualisys_client.cjs", "qtm")):
            done = subprocess.run(["node", HERE / script, str(player.port[wire])], capture_output=True, text=True, timeout=30,
                                  env={**os.environ, "NODE_PATH": str(modules)})
            assert done.returncode == 0, (script, done.stdout, done.stderr)
            print(done.stdout.strip())


def mcap():
    from mcap.reader import make_reader
    from mcap_protobuf.decoder import DecoderFactory

    with tempfile.TemporaryDirectory() as folder:
        points, path = pathlib.Path(folder, "walk.csv"), pathlib.Path(folder, "walk.mcap")
        with open(points, "w", newline="") as file:
            rows = csv.writer(file)
            rows.writerow("frame time id label x y z state cameras residual_mm".split())
            for k in range(200):
                rows.writerow([k, f"{k / 100:.9f}", 1, "LASI", k / 1000, 0, 1, "measured", "0 1", 0.5])
        subprocess.run([MAREY, "convert", points, path, "-q"], check=True)
        with open(path, "rb") as file:
            reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
            summary = reader.get_summary()
            assert summary.statistics.message_count == 600, summary.statistics  # points, scene, times
            clouds = [(message.log_time, decoded) for _, _, message, decoded in reader.iter_decoded_messages(topics=["/marey/points"])]
            names = [decoded.entities[0].texts[0].text for _, _, _, decoded in reader.iter_decoded_messages(topics=["/marey/scene"])]
    assert [time for time, _ in clouds] == [10_000_000 * k for k in range(200)]
    near(struct.unpack_from("<fff", clouds[100][1].data), (0.1, 0, 1))
    assert names == ["LASI"] * 200
    print(f"mcap: {len(clouds)} point clouds")


def json_lines():
    """By a script, as in docs/streams.md; and `marey play` from the beginning to the end."""
    with tempfile.TemporaryDirectory() as folder:
        points = pathlib.Path(folder, "walk.csv")
        points.write_text("frame,id,x,y,z\n" + "".join(f"{k},1,{k / 1000},0,1\n" for k in range(150)))
        process = subprocess.Popen([MAREY, "play", points, "--recorded-rate", "100", "--stream", "json:127.0.0.1:0", "--json"], text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        port = int(process.stderr.readline().rsplit(":", 1)[1])
        with socket.create_connection(("127.0.0.1", port)) as client:
            lines = [json.loads(line) for line in client.makefile()]
        told = json.loads(process.communicate(timeout=20)[0])
    assert lines[0]["type"] == "header" and lines[0]["rate_hz"] > 0
    frames = [line for line in lines if line["type"] == "frame"]
    numbers = [frame["frame"] for frame in frames]
    assert numbers == sorted(set(numbers)) and numbers[-1] == 149, numbers
    assert told["instants"] + told["skipped"] == 150 and told["streams"][0]["sent"] == len(frames), told
    for frame in frames:
        assert frame["capture_ns"] <= frame["solve_ns"] <= frame["send_ns"]
        near((frame["points"][0]["x"], frame["points"][0]["z"]), (frame["frame"] / 1000, 1))
    print(f"JSON lines: {len(frames)} frames")


def main(client):
    try:
        globals()[client]()
    except (ImportError, Skipped) as missing:
        print(f"skipped: {missing}; script/setup --tests installs it")
        return 77
    except Exception:
        traceback.print_exc()
        return 1
    return 0


if __name__ == "__main__":
    PLAYED, MAREY = sys.argv[2:4]
    code = main(sys.argv[1])
    sys.stdout.flush()
    os._exit(code)  # natnetsdk leaves threads behind that wait for ever
