"""OpenCap's marker augmenter and a model with its markers, out of PyPI's pose2sim, as marey reads them:

    augmenter_model.py PACKAGE FOLDER    PACKAGE: pose2sim unpacked; FOLDER gets augmenter_lower.onnx, augmenter_upper.onnx, anatomical.osim

The networks are published as loops of TensorFlow's operations. Here they are chains of ONNX's own operator LSTM, with the same weights: inputs less their
mean, divided by their spread, the layers, and a matrix with an offset at the end; "inputs" is T x B x features, "outputs" T x B x coordinates. The model is
Pose2Sim's full body (adapted from Rajagopal et al. 2016) with the markers that the networks give and no others.
"""

import pathlib
import re
import sys

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

GATES = (0, 3, 1, 2)  # Keras stacks input, forget, cell, output; ONNX input, output, forget, cell
WEIGHT = re.compile(r"Func/StatefulPartitionedCall/input/_(\d+):0")


def regated(weights):
    """The gates' blocks along the last dimension in ONNX's order, and transposed: gates first."""
    blocks = np.split(weights, 4, axis=-1)
    return np.concatenate([blocks[gate] for gate in GATES], axis=-1).T


def chain(source, mean, spread):
    """Of each layer its kernel, recurrent kernel and offsets; at the end the matrix and its offsets."""
    known = {tensor.name: numpy_helper.to_array(tensor) for tensor in source.graph.initializer}
    numbered = sorted((int(WEIGHT.fullmatch(name)[1]), value) for name, value in known.items() if WEIGHT.fullmatch(name))
    values = [value for _, value in numbered]
    matrix, offset = (next(value for name, value in known.items() if name.endswith(ending)) for ending in ("Cast/ReadVariableOp:0", "BiasAdd/ReadVariableOp:0"))
    if not values or len(values) % 3 or matrix.shape[1] != offset.size:
        sys.exit("the network has other layers than it had when this was written")
    nodes = [helper.make_node("Sub", ["inputs", "mean"], ["centred"]), helper.make_node("Div", ["centred", "spread"], ["layer_0"])]
    weights = {"mean": mean.astype(np.float32), "spread": spread.astype(np.float32), "matrix": matrix, "offset": offset, "direction": np.array([1], np.int64)}
    for i, (kernel, recurrent, bias) in enumerate(zip(values[::3], values[1::3], values[2::3], strict=True)):
        gates = regated(bias[None]).ravel()
        weights |= {f"W_{i}": regated(kernel)[None], f"R_{i}": regated(recurrent)[None], f"B_{i}": np.concatenate([gates, np.zeros_like(gates)])[None]}
        nodes.append(helper.make_node("LSTM", [f"layer_{i}", f"W_{i}", f"R_{i}", f"B_{i}"], [f"states_{i}"], hidden_size=recurrent.shape[0]))
        nodes.append(helper.make_node("Squeeze", [f"states_{i}", "direction"], [f"layer_{i + 1}"]))
    nodes += [helper.make_node("MatMul", [f"layer_{len(values) // 3}", "matrix"], ["product"]), helper.make_node("Add", ["product", "offset"], ["outputs"])]
    ends = [helper.make_tensor_value_info(name, TensorProto.FLOAT, ["T", "B", size]) for name, size in (("inputs", mean.size), ("outputs", offset.size))]
    tensors = [numpy_helper.from_array(np.ascontiguousarray(value), name) for name, value in weights.items()]
    graph = helper.make_graph(nodes, "augmenter", ends[:1], ends[1:], tensors)
    made = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 13)], ir_version=7)
    onnx.checker.check_model(made)
    return made


def with_markers(model, markers):
    """The model's text with the markers of the networks, "..._study", in its set."""
    chosen = [marker for marker in re.findall(r"<Marker name=.*?</Marker>", markers, re.S) if re.match(r'<Marker name="[^"]*_study"', marker)]
    if len(chosen) != 43:
        sys.exit(f"{len(chosen)} markers of the networks, where 43 are expected")
    newline = "\n"
    return re.sub(r"<MarkerSet\b.*?</MarkerSet>", lambda _: f'<MarkerSet name="markerset">\n<objects>\n{newline.join(chosen)}\n</objects>\n<groups />\n</MarkerSet>', model, count=1, flags=re.S)


def main(package, folder):
    package, folder = pathlib.Path(package, "Pose2Sim"), pathlib.Path(folder)
    for part in ("lower", "upper"):
        source = package / f"MarkerAugmenter/LSTM/v0.3_{part}"
        mean, spread = (np.load(source / f"{name}.npy", allow_pickle=False) for name in ("mean", "std"))
        onnx.save(chain(onnx.load(source / "model.onnx"), mean, spread), folder / f"augmenter_{part}.onnx")
    setup = package / "OpenSim_Setup"
    model = with_markers((setup / "Model_Pose2Sim_simple.osim").read_text(), (setup / "Markers_LSTM.xml").read_text())
    (folder / "anatomical.osim").write_text(model)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
