"""Rewrites PP-OCRv4's text recogniser (PyPI: rapidocr-onnxruntime, Apache-2.0), which script/model --numbers fetches, for OpenCV 4.6: the input is fixed to
1 × 3 × 48 × 96, all that depends on shapes alone is computed once, Clip has its bounds as attributes, and a Gemm is a MatMul and an Add. The outputs are
those of the published file, for each of 12 columns the probabilities of "blank" (class 0) and of every character; the digits are the classes CLASSES.

    numbers_to_onnx.py IN.onnx OUT.onnx
"""

import sys

import numpy as np
import onnx
from onnx import helper, numpy_helper, shape_inference
from onnx.reference import ReferenceEvaluator

SHAPE = (1, 3, 48, 96)  # rows and columns of a crop; 96 columns are 12 steps of the recogniser
CLASSES = [26, 93, 25, 94, 632, 631, 933, 29, 27, 1109]  # of 0 … 9; marey has them too (detect/shirts/shirt_network.cpp)
MAX_BOUND = float(np.finfo(np.float32).max)


def fixed(model):
    """The model with an input of SHAPE, and no other input or stored shape."""
    for size, dimension in zip(SHAPE, model.graph.input[0].type.tensor_type.shape.dim, strict=True):
        dimension.Clear()
        dimension.dim_value = size
    for dimension in model.graph.output[0].type.tensor_type.shape.dim:
        dimension.Clear()
    del model.graph.value_info[:]
    return model


def shapes_of(model):
    """The known sizes of the values that nodes make."""
    inferred = shape_inference.infer_shapes(model, data_prop=True)
    shapes = {v.name: [d.dim_value for d in v.type.tensor_type.shape.dim] for v in [*inferred.graph.value_info, *inferred.graph.output]}
    return {name: shape for name, shape in shapes.items() if shape and all(shape)} | {model.graph.input[0].name: list(SHAPE)}


def folded(model):
    """The model without the nodes whose values do not depend on the image."""
    for _ in range(8):  # a shape that is known makes others known
        shapes = shapes_of(model)
        known = {tensor.name: numpy_helper.to_array(tensor) for tensor in model.graph.initializer}
        kept = []
        for node in model.graph.node:
            if node.op_type == "Shape" and node.input[0] in shapes:
                known[node.output[0]] = np.array(shapes[node.input[0]], np.int64)
            elif all(name in known or not name for name in node.input):
                made = ReferenceEvaluator(helper.make_model(helper.make_graph(
                    [node], "constant", [helper.make_tensor_value_info(n, helper.np_dtype_to_tensor_dtype(known[n].dtype), known[n].shape) for n in node.input if n],
                    [helper.make_empty_tensor_value_info(n) for n in node.output]), opset_imports=model.opset_import)).run(None, {n: known[n] for n in node.input if n})
                known |= dict(zip(node.output, made, strict=True))
            else:
                kept.append(node)
        unchanged = len(kept) == len(model.graph.node)
        needed = {name for node in kept for name in node.input} | {output.name for output in model.graph.output}
        del model.graph.node[:], model.graph.initializer[:]
        model.graph.node.extend(kept)
        model.graph.initializer.extend(numpy_helper.from_array(np.asarray(value), name) for name, value in known.items() if name in needed)
        if unchanged:
            break
    return model


def rewritten(model):
    """The model in the words that OpenCV 4.6 knows."""
    known = {tensor.name: numpy_helper.to_array(tensor) for tensor in model.graph.initializer}
    shapes = shapes_of(model)
    nodes, whole = [], {}
    for node in model.graph.node:
        if node.op_type == "Clip" and len(node.input) > 1:
            bounds = [float(known[name]) if name else None for name in [*node.input[1:], ""][:2]]
            low, high = (-MAX_BOUND if bounds[0] is None else bounds[0]), (MAX_BOUND if bounds[1] is None else bounds[1])
            nodes.append(helper.make_node("Clip", node.input[:1], node.output, node.name, min=low, max=high))
        elif node.op_type == "Gemm":
            attributes = {a.name: helper.get_attribute_value(a) for a in node.attribute}
            if attributes.get("alpha", 1) != 1 or attributes.get("beta", 1) != 1 or attributes.get("transA", 0):
                sys.exit(f"a Gemm of another kind: {attributes}")
            weights = known[node.input[1]].T if attributes.get("transB", 0) else known[node.input[1]]
            names = [node.output[0] + suffix for suffix in ("/weights", "/product")]
            model.graph.initializer.append(numpy_helper.from_array(np.ascontiguousarray(weights), names[0]))
            nodes += [helper.make_node("MatMul", [node.input[0], names[0]], [names[1]]), helper.make_node("Add", [names[1], node.input[2]], node.output)]
        elif node.op_type in ("Add", "Mul") and 2 <= len(shapes.get(node.output[0], ())) <= 3:
            for at, name in enumerate(node.input):
                if name in known and known[name].ndim == 1 and known[name].size > 1:  # along the last dimension
                    node.input[at] = name + "/all"
                    if node.input[at] not in whole:
                        whole[node.input[at]] = numpy_helper.from_array(np.broadcast_to(known[name], shapes[node.output[0]]).copy(), node.input[at])
            nodes.append(node)
        else:
            nodes.append(node)
    model.graph.initializer.extend(whole.values())
    del model.graph.node[:]
    model.graph.node.extend(nodes)
    needed = {name for node in nodes for name in node.input}
    stay = [tensor for tensor in model.graph.initializer if tensor.name in needed]
    del model.graph.initializer[:]
    model.graph.initializer.extend(stay)
    return model


def main(source, target):
    model = onnx.load(source)
    characters = next(entry.value for entry in model.metadata_props if entry.key == "character").split("\n")
    made = rewritten(folded(fixed(model)))
    made.opset_import[0].version = 10  # the last one whose Clip has attributes; no other operator here changed between it and 12
    made = shape_inference.infer_shapes(made)
    if [1 + characters.index(digit) for digit in "0123456789"] != CLASSES:
        sys.exit(f"{source}: is a recogniser with other characters")
    del made.metadata_props[:]
    onnx.checker.check_model(made)
    onnx.save(made, target)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
