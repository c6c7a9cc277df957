#include "marey/format/take/body_definition.h"

#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "marey/core/error.h"
#include "marey/format/nesting.h"

namespace marey::format::take {
namespace {

using BodyJson = nlohmann::json;

BodyJson numbers_of(const Vector<3>& vector) {
  return BodyJson::array({vector.x(), vector.y(), vector.z()});
}

Vector<3> vector_of(const BodyJson& json) {
  if (!json.is_array() || json.size() != 3) throw Error("three numbers are due");
  Vector<3> vector;
  for (int i = 0; i < 3; ++i) {
    if (!json[static_cast<std::size_t>(i)].is_number()) throw Error("three numbers are due");
    vector[i] = json[static_cast<std::size_t>(i)].get<double>();
  }
  if (!vector.allFinite()) throw Error("a number is infinite");
  return vector;
}

std::string text_of(const BodyJson& json) {
  if (!json.is_string()) throw Error("a text is due");
  return json.get<std::string>();
}

void read_definition(const BodyJson& json, Body& body) {
  if (!json.is_object()) throw Error("no object");
  if (json.contains("skeleton")) body.skeleton = text_of(json["skeleton"]);
  if (json.contains("parent")) {
    if (!json["parent"].is_number_unsigned()) throw Error("a parent's number is due");
    const auto parent = json["parent"].get<std::uint64_t>();
    if (parent == 0 || parent >= static_cast<std::uint64_t>(number(body.id))) throw Error("parents come before their children");
    body.parent = BodyId{static_cast<int>(parent)};
  }
  if (json.contains("offset")) body.offset = vector_of(json["offset"]);
  if (json.contains("end")) body.end = vector_of(json["end"]);
  if (!json.contains("markers")) return;
  if (!json["markers"].is_array()) throw Error("a list of markers is due");
  for (const BodyJson& marker : json["markers"]) {
    if (!marker.is_object() || !marker.contains("label") || !marker.contains("position"))
      throw Error("a marker lacks what it needs");
    body.markers.push_back({text_of(marker["label"]), vector_of(marker["position"])});
  }
}

}  // namespace

std::string body_definition(const Body& body) {
  BodyJson json = BodyJson::object();
  if (!body.skeleton.empty()) json["skeleton"] = body.skeleton;
  if (body.parent) json["parent"] = number(*body.parent);
  if (!body.offset.isZero(0)) json["offset"] = numbers_of(body.offset);
  if (body.end) json["end"] = numbers_of(*body.end);
  for (const BodyMarker& marker : body.markers)
    json["markers"].push_back({{"label", marker.label}, {"position", numbers_of(marker.position)}});
  return json.dump(-1, ' ', false, BodyJson::error_handler_t::replace);
}

void read_body_definition(std::string_view text, const std::string& where, Body& body) {
  check_nesting(text, Notation::json, where);
  const BodyJson json = BodyJson::parse(text, nullptr, false);
  try {
    if (json.is_discarded()) throw Error("no JSON");
    read_definition(json, body);
  } catch (const Error& error) {
    throw Error("{}: is damaged (a body's definition: {}); restore it from a copy", where, error.what());
  }
}

}  // namespace marey::format::take
