#include "marey/format/mcap/foxglove_schemas.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

#include "marey/format/mcap/protobuf.h"

namespace marey::format::mcap {
namespace {

// A message a line: "Name: type field number, …"; "*" before a type: repeated; types with a capital letter are messages, those with
// "#" enumerations.
constexpr std::string_view kGoogle = R"(
Timestamp: int64 seconds 1, int32 nanos 2
Duration: int64 seconds 1, int32 nanos 2
)";
constexpr std::string_view kFoxglove = R"(
Vector3: double x 1, double y 2, double z 3
Point3: double x 1, double y 2, double z 3
Quaternion: double x 1, double y 2, double z 3, double w 4
Pose: Vector3 position 1, Quaternion orientation 2
Color: double r 1, double g 2, double b 3, double a 4
KeyValuePair: string key 1, string value 2
PackedElementField: string name 1, fixed32 offset 2, #NumericType type 3
PointCloud: .Timestamp timestamp 1, string frame_id 2, Pose pose 3, fixed32 point_stride 4, *PackedElementField fields 5, bytes data 6
FrameTransform: .Timestamp timestamp 1, string parent_frame_id 2, string child_frame_id 3, Vector3 translation 4, Quaternion rotation 5
FrameTransforms: *FrameTransform transforms 1
SceneEntityDeletion: .Timestamp timestamp 1, #Type type 2, string id 3
ArrowPrimitive: Pose pose 1, double shaft_length 2, double shaft_diameter 3, double head_length 4, double head_diameter 5, Color color 6
CubePrimitive: Pose pose 1, Vector3 size 2, Color color 3
SpherePrimitive: Pose pose 1, Vector3 size 2, Color color 3
CylinderPrimitive: Pose pose 1, Vector3 size 2, double bottom_scale 3, double top_scale 4, Color color 5
LinePrimitive: #Type type 1, Pose pose 2, double thickness 3, bool scale_invariant 4, *Point3 points 5, Color color 6, *Color colors 7, *fixed32 indices 8
TriangleListPrimitive: Pose pose 1, *Point3 points 2, Color color 3, *Color colors 4, *fixed32 indices 5
TextPrimitive: Pose pose 1, bool billboard 2, double font_size 3, bool scale_invariant 4, Color color 5, string text 6
ModelPrimitive: Pose pose 1, Vector3 scale 2, Color color 3, bool override_color 4, string url 5, string media_type 6, bytes data 7
SceneEntity: .Timestamp timestamp 1, string frame_id 2, string id 3, .Duration lifetime 4, bool frame_locked 5, *KeyValuePair metadata 6, *ArrowPrimitive arrows 7, *CubePrimitive cubes 8, *SpherePrimitive spheres 9, *CylinderPrimitive cylinders 10, *LinePrimitive lines 11, *TriangleListPrimitive triangles 12, *TextPrimitive texts 13, *ModelPrimitive models 14
SceneUpdate: *SceneEntityDeletion deletions 1, *SceneEntity entities 2
)";
constexpr std::string_view kEnumerations = R"(
PackedElementField: NumericType UNKNOWN UINT8 INT8 UINT16 INT16 UINT32 INT32 FLOAT32 FLOAT64
SceneEntityDeletion: Type MATCHING_ID ALL
LinePrimitive: Type LINE_STRIP LINE_LOOP LINE_LIST
)";

std::vector<std::string_view> parts_of(std::string_view text, char between) {
  std::vector<std::string_view> parts;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(between), text.size());
    std::string_view part = text.substr(0, end);
    while (part.starts_with(' ')) part.remove_prefix(1);
    if (!part.empty()) parts.push_back(part);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parts;
}

/// FieldDescriptorProto.Type.
std::uint64_t scalar_type(std::string_view name) {
  if (name == "double") return 1;
  if (name == "int64") return 3;
  if (name == "int32") return 5;
  if (name == "fixed32") return 7;
  if (name == "bool") return 8;
  if (name == "string") return 9;
  return 12;  // bytes
}

ProtobufWriter field_of(std::string_view text, std::string_view message) {
  const auto words = parts_of(text, ' ');
  std::string_view type = words[0];
  const bool repeated = type.starts_with('*');
  if (repeated) type.remove_prefix(1);
  std::uint64_t field_number = 0;
  std::from_chars(words[2].data(), words[2].data() + words[2].size(), field_number);
  ProtobufWriter field;
  field.bytes(1, words[1]).varint(3, field_number).varint(4, repeated ? 3 : 1);
  if (type.starts_with('#')) {
    field.varint(5, 14).bytes(6, std::string(".foxglove.").append(message).append(".").append(type.substr(1)));
  } else if (type.starts_with('.')) {
    field.varint(5, 11).bytes(6, std::string(".google.protobuf").append(type));
  } else if (type[0] >= 'A' && type[0] <= 'Z') {
    field.varint(5, 11).bytes(6, std::string(".foxglove.").append(type));
  } else {
    field.varint(5, scalar_type(type));
  }
  return field;
}

/// EnumDescriptorProto: values count from 0.
ProtobufWriter enumeration_of(std::string_view text) {
  const auto words = parts_of(text, ' ');
  ProtobufWriter enumeration;
  enumeration.bytes(1, words[0]);
  for (std::size_t i = 1; i < words.size(); ++i) enumeration.message(2, ProtobufWriter().bytes(1, words[i]).varint(2, i - 1));
  return enumeration;
}

/// DescriptorProto.
ProtobufWriter message_of(std::string_view line) {
  const std::size_t colon = line.find(':');
  const std::string_view name = line.substr(0, colon);
  ProtobufWriter message;
  message.bytes(1, name);
  for (const std::string_view field : parts_of(line.substr(colon + 1), ',')) message.message(2, field_of(field, name));
  for (const std::string_view enumeration : parts_of(kEnumerations, '\n')) {
    if (enumeration.substr(0, enumeration.find(':')) == name)
      message.message(4, enumeration_of(enumeration.substr(enumeration.find(':') + 1)));
  }
  return message;
}

/// FileDescriptorProto.
ProtobufWriter file_of(std::string_view name, std::string_view package, std::string_view depends_on, std::string_view messages) {
  ProtobufWriter file;
  file.bytes(1, name).bytes(2, package);
  if (!depends_on.empty()) file.bytes(3, depends_on);
  for (const std::string_view line : parts_of(messages, '\n')) file.message(4, message_of(line));
  return file.bytes(12, "proto3");
}

}  // namespace

const std::string& foxglove_descriptors() {
  static const std::string set =
      ProtobufWriter()
          .message(1, file_of("google/protobuf/times.proto", "google.protobuf", {}, kGoogle))
          .message(1, file_of("foxglove/marey.proto", "foxglove", "google/protobuf/times.proto", kFoxglove))
          .str();
  return set;
}

}  // namespace marey::format::mcap
