"""Converts the TensorFlow Lite networks that script/model fetches into ONNX for OpenCV 4.6.

TensorFlow Lite computes on N×H×W×C, ONNX on N×C×H×W: convolutions, pools and resizes are transposed once, in their weights, and the
values only where a layer flattens them. Weights are 16-bit floats in both files (some of MediaPipe's are sparse, too: they are
unpacked); Cast nodes make them 32-bit floats. Opset 11, but Clip has its bounds as attributes: OpenCV 4.6 knows no others, and no
16-bit weights either (marey unpacks them before: detect/network/half_weights.h).

    model_to_onnx.py IN.tflite OUT.onnx NAME...    a NAME for each output, in the file's order; "-" leaves one out
Layers that only outputs behind a "+" need (NAME+) are written last, so that a reader that does not ask for them computes none.
"""

import math
import sys

import numpy as np
import onnx
import tflite
from onnx import TensorProto, helper, numpy_helper

NUMBERS = {tflite.TensorType.FLOAT32: np.float32, tflite.TensorType.FLOAT16: np.float16, tflite.TensorType.INT32: np.int32}
OPERATORS = {code: name for name, code in vars(tflite.BuiltinOperator).items() if isinstance(code, int)}
NONE, RELU, RELU6 = (getattr(tflite.ActivationFunctionType, name) for name in ("NONE", "RELU", "RELU6"))
SAME = tflite.Padding.SAME
TO_NCHW = (0, 3, 1, 2)


def sparse_index(kind, table):
    """The numbers of one compressed dimension."""
    vector = {1: tflite.Int32Vector, 2: tflite.Uint16Vector, 3: tflite.Uint8Vector}[kind]()
    vector.Init(table.Bytes, table.Pos)
    return vector.ValuesAsNumpy().astype(np.int64)


def dense(tensor, values):
    """The values of a sparse tensor at their places (TACO's format, as schema.fbs describes it: dimensions in traversal order, blocks last)."""
    sparsity, shape = tensor.Sparsity(), tensor.ShapeAsNumpy()
    order = sparsity.TraversalOrderAsNumpy()
    blocks = sparsity.BlockMapAsNumpy() if sparsity.BlockMapLength() else []
    rank = len(shape)
    levels = [sparsity.DimMetadata(k) for k in range(sparsity.DimMetadataLength())]
    places = [((), 0)]  # indices so far, position in the level's list
    for level in levels:
        if level.Format() == tflite.DimensionType.DENSE:
            size = level.DenseSize()
            places = [(index + (j,), at * size + j) for index, at in places for j in range(size)]
        else:
            begins = sparse_index(level.ArraySegmentsType(), level.ArraySegments())
            indices = sparse_index(level.ArrayIndicesType(), level.ArrayIndices())
            places = [(index + (int(indices[p]),), p) for index, at in places for p in range(begins[at], begins[at + 1])]
    result = np.zeros(shape, values.dtype)
    for index, at in places:
        place = [0] * rank
        for k in range(rank):
            place[order[k]] = index[k]
        for k in range(rank, len(order)):
            dimension = blocks[order[k] - rank]
            place[dimension] = place[dimension] * levels[k].DenseSize() + index[k]
        result[tuple(place)] = values[at]
    return result


def same_padding(size, kernel, stride, dilation=1):
    """Before and after, so that ceil(size / stride) values come out."""
    whole = max((math.ceil(size / stride) - 1) * stride + (kernel - 1) * dilation + 1 - size, 0)
    return whole // 2, whole - whole // 2


class Converter:
    def __init__(self, content):
        self.model = tflite.Model.GetRootAsModel(content, 0)
        self.graph = self.model.Subgraphs(0)
        self.nodes, self.weights = [], []
        self.names = {}      # of a tensor of TensorFlow Lite's that a node here makes
        self.flat = set()    # those whose values lie as TensorFlow Lite has them
        self.constants = {}  # arrays, by tensor
        for i in range(self.graph.TensorsLength()):
            tensor = self.graph.Tensors(i)
            buffer = self.model.Buffers(tensor.Buffer())
            if not buffer.DataLength():
                continue
            values = buffer.DataAsNumpy().view(NUMBERS[tensor.Type()])
            self.constants[i] = dense(tensor, values) if tensor.Sparsity() else values.reshape(tensor.ShapeAsNumpy() if tensor.ShapeLength() else ())

    def shape(self, tensor):
        return [int(n) for n in self.graph.Tensors(tensor).ShapeAsNumpy()]

    def add(self, operator, inputs, output, **attributes):
        self.nodes.append(helper.make_node(operator, inputs, [output], name=f"{operator}_{len(self.nodes)}", **attributes))

    def constant(self, values):
        """The name of an input that holds these; floats as 16 bits where that loses nothing."""
        name = f"c{len(self.weights)}"
        values = np.ascontiguousarray(values)
        small = values.astype(np.float16) if values.dtype in (np.float16, np.float32) and values.ndim else None
        if small is None or not np.array_equal(small.astype(np.float32), values.astype(np.float32)):
            self.weights.append(numpy_helper.from_array(values, name))
            return name
        self.weights.append(numpy_helper.from_array(small, name))
        self.add("Cast", [name], name + "f", to=TensorProto.FLOAT)
        return name + "f"

    def activated(self, activation, output):
        """What a layer should call its result; `activate` makes `output` of it."""
        return output if activation == NONE else output + "raw"

    def activate(self, activation, output):
        if activation == RELU:
            self.add("Relu", [output + "raw"], output)
        elif activation == RELU6:
            self.nodes.append(helper.make_node("Clip", [output + "raw"], [output], min=0.0, max=6.0))
        elif activation != NONE:
            raise SystemExit(f"model_to_onnx.py: activation {activation} is not known here")

    def padding(self, options, shape, kernel, strides, dilations=(1, 1)):
        if options.Padding() != SAME:
            return [0] * 4
        sides = [same_padding(shape[1 + k], kernel[k], strides[k], dilations[k]) for k in range(2)]
        return [sides[0][0], sides[1][0], sides[0][1], sides[1][1]]

    def convolution(self, operator, inputs, output, table):
        by_channel = operator == "DEPTHWISE_CONV_2D"
        options = (tflite.DepthwiseConv2DOptions if by_channel else tflite.Conv2DOptions)()
        options.Init(table.Bytes, table.Pos)
        shape = self.shape(inputs[0])
        weights = self.constants[inputs[1]].transpose((3, 0, 1, 2) if by_channel else TO_NCHW)
        kernel, strides = [int(n) for n in weights.shape[2:]], [options.StrideH(), options.StrideW()]
        dilations = [options.DilationHFactor(), options.DilationWFactor()]
        result = self.activated(options.FusedActivationFunction(), output)
        self.add("Conv", [self.names[inputs[0]], self.constant(weights), self.constant(self.constants[inputs[2]])], result,
                 kernel_shape=kernel, strides=strides, dilations=dilations, group=shape[3] if by_channel else 1,
                 pads=self.padding(options, shape, kernel, strides, dilations))
        self.activate(options.FusedActivationFunction(), output)

    def pool(self, inputs, output, table):
        options = tflite.Pool2DOptions()
        options.Init(table.Bytes, table.Pos)
        kernel, strides = [options.FilterHeight(), options.FilterWidth()], [options.StrideH(), options.StrideW()]
        self.add("MaxPool", [self.names[inputs[0]]], output, kernel_shape=kernel, strides=strides,
                 pads=self.padding(options, self.shape(inputs[0]), kernel, strides))

    def sum(self, inputs, output, table):
        options = tflite.AddOptions()
        options.Init(table.Bytes, table.Pos)
        terms = []
        for tensor in inputs:
            values = self.constants.get(tensor)
            if values is None:
                terms.append(self.names[tensor])
            else:
                terms.append(self.constant(values.transpose(TO_NCHW) if values.ndim == 4 else values))
        self.add("Add", terms, self.activated(options.FusedActivationFunction(), output))
        self.activate(options.FusedActivationFunction(), output)

    def pad(self, inputs, output):
        amounts = self.constants[inputs[1]].reshape(-1, 2)[list(TO_NCHW)]
        self.add("Pad", [self.names[inputs[0]], self.constant(amounts.T.reshape(-1).astype(np.int64)), self.constant(np.float32(0))],
                 output, mode="constant")

    def resize(self, inputs, output, made, table):
        options = tflite.ResizeBilinearOptions()
        options.Init(table.Bytes, table.Pos)
        mode = "align_corners" if options.AlignCorners() else "half_pixel" if options.HalfPixelCenters() else "asymmetric"
        shape, wanted = self.shape(inputs[0]), self.shape(made)
        scales = np.array([1, 1, wanted[1] / shape[1], wanted[2] / shape[2]], np.float32)
        self.weights.append(numpy_helper.from_array(scales, output + "scales"))
        self.weights.append(numpy_helper.from_array(np.zeros(0, np.float32), output + "roi"))
        self.add("Resize", [self.names[inputs[0]], output + "roi", output + "scales"], output, mode="linear",
                 coordinate_transformation_mode=mode)

    def reshape(self, inputs, output, made):
        values = self.names[inputs[0]]
        if len(self.shape(inputs[0])) == 4 and inputs[0] not in self.flat:
            self.add("Transpose", [values], output + "nhwc", perm=[0, 2, 3, 1])
            values = output + "nhwc"
        self.add("Reshape", [values, self.constant(np.array(self.shape(made), np.int64))], output)
        self.flat.add(made)

    def concatenation(self, inputs, output, made, table):
        options = tflite.ConcatenationOptions()
        options.Init(table.Bytes, table.Pos)
        axis = options.Axis()
        if inputs[0] in self.flat:
            self.flat.add(made)
        elif len(self.shape(made)) == 4:
            axis = TO_NCHW.index(axis % 4)
        self.add("Concat", [self.names[tensor] for tensor in inputs], output, axis=axis)

    def operator(self, operator):
        code = self.model.OperatorCodes(operator.OpcodeIndex())
        name = OPERATORS[max(code.BuiltinCode(), code.DeprecatedBuiltinCode())]
        inputs, made, table = [operator.Inputs(k) for k in range(operator.InputsLength())], operator.Outputs(0), operator.BuiltinOptions()
        output = f"t{made}"
        if name in ("DEQUANTIZE", "DENSIFY"):  # of weights: done when they are loaded
            self.constants[made] = self.constants[inputs[0]]
            return
        self.names[made] = output
        if name in ("CONV_2D", "DEPTHWISE_CONV_2D"):
            self.convolution(name, inputs, output, table)
        elif name == "MAX_POOL_2D":
            self.pool(inputs, output, table)
        elif name == "ADD":
            self.sum(inputs, output, table)
        elif name == "PAD":
            self.pad(inputs, output)
        elif name == "RESIZE_BILINEAR":
            self.resize(inputs, output, made, table)
        elif name == "DEPTH_TO_SPACE":
            options = tflite.DepthToSpaceOptions()
            options.Init(table.Bytes, table.Pos)
            self.add("DepthToSpace", [self.names[inputs[0]]], output, blocksize=options.BlockSize(), mode="DCR")
        elif name == "LOGISTIC":
            self.add("Sigmoid", [self.names[inputs[0]]], output)
        elif name == "RESHAPE":
            self.reshape(inputs, output, made)
        elif name == "CONCATENATION":
            self.concatenation(inputs, output, made, table)
        else:
            raise SystemExit(f"model_to_onnx.py: the layer {name} is not known here")

    def needed(self, names):
        """The nodes that these values are made by, as indices."""
        wanted, found = set(names), set()
        for i in range(len(self.nodes) - 1, -1, -1):
            if wanted.intersection(self.nodes[i].output):
                found.add(i)
                wanted.update(self.nodes[i].input)
        return found

    def onnx(self, names):
        """The network with its outputs called so."""
        taken = self.graph.Inputs(0)
        self.names[taken] = "image"
        for k in range(self.graph.OperatorsLength()):
            self.operator(self.graph.Operators(k))
        outputs, first = [], []
        for k, name in enumerate(names):
            if name == "-":
                continue
            tensor = self.graph.Outputs(k)
            shape = self.shape(tensor)
            if len(shape) == 4 and tensor not in self.flat:
                shape = [shape[i] for i in TO_NCHW]
            wanted = name.rstrip("+")
            self.add("Identity", [self.names[tensor]], wanted)
            outputs.append(helper.make_tensor_value_info(wanted, TensorProto.FLOAT, shape))
            if wanted == name:
                first.append(name)
        early, all_needed = self.needed(first), self.needed([value.name for value in outputs])
        nodes = [self.nodes[i] for i in sorted(early)] + [self.nodes[i] for i in sorted(all_needed - early)]
        used = {name for node in nodes for name in node.input}
        height, width, colours = self.shape(taken)[1:]
        graph = helper.make_graph(nodes, "network", [helper.make_tensor_value_info("image", TensorProto.FLOAT, [1, colours, height, width])],
                                  outputs, [weights for weights in self.weights if weights.name in used])
        return helper.make_model(graph, opset_imports=[helper.make_opsetid("", 11)], ir_version=7, producer_name="marey script/model")


def main(arguments):
    if len(arguments) < 3:
        raise SystemExit(__doc__)
    source, target, *names = arguments
    with open(source, "rb") as file:
        converter = Converter(file.read())
    if len(names) != converter.graph.OutputsLength():
        raise SystemExit(f"model_to_onnx.py: {source} has {converter.graph.OutputsLength()} outputs, and {len(names)} names are given")
    onnx.save(converter.onnx(names), target)


if __name__ == "__main__":
    main(sys.argv[1:])
