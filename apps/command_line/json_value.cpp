#include "json_value.h"

#include <algorithm>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace marey::cli {

struct JsonWriter {
  nlohmann::json operator()(const Json::Array& values) const {
    nlohmann::json list = nlohmann::json::array();
    for (const Json& value : values) list.push_back(written(value));
    return list;
  }
  nlohmann::json operator()(const Json::Object& members) const {
    nlohmann::json object = nlohmann::json::object();
    for (const auto& [name, value] : members) object[name] = written(value);
    return object;
  }
  template <typename T>
  nlohmann::json operator()(const T& value) const {
    return value;
  }

  static nlohmann::json written(const Json& json) { return std::visit(JsonWriter{}, json.value_); }
};

Json::Json(std::initializer_list<Json> list) {
  const auto is_member = [](const Json& json) {
    const auto* pair = std::get_if<Array>(&json.value_);
    return pair != nullptr && pair->size() == 2 && std::holds_alternative<std::string>(pair->front().value_);
  };
  if (!std::all_of(list.begin(), list.end(), is_member)) {
    value_ = Array(list);
    return;
  }
  Object members;
  for (const Json& json : list) {
    const auto& pair = std::get<Array>(json.value_);
    members.emplace(std::get<std::string>(pair[0].value_), pair[1]);
  }
  value_ = std::move(members);
}

Json Json::object() {
  Json json;
  json.value_ = Object();
  return json;
}

Json& Json::operator[](const std::string& name) {
  if (std::holds_alternative<std::nullptr_t>(value_)) value_ = Object();
  return std::get<Object>(value_)[name];
}

void Json::push_back(Json value) {
  if (std::holds_alternative<std::nullptr_t>(value_)) value_ = Array();
  std::get<Array>(value_).push_back(std::move(value));
}

bool Json::empty() const {
  if (const auto* values = std::get_if<Array>(&value_)) return values->empty();
  if (const auto* members = std::get_if<Object>(&value_)) return members->empty();
  return std::holds_alternative<std::nullptr_t>(value_);
}

void print(const Json& json) {
  fmt::print("{}\n", JsonWriter::written(json).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

std::string compact(const Json& json) {
  return JsonWriter::written(json).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace marey::cli
