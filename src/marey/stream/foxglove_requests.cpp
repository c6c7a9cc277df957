#include "marey/stream/foxglove_requests.h"

#include <nlohmann/json.hpp>

#include "marey/core/error.h"
#include "marey/format/mcap/foxglove_messages.h"
#include "marey/stream/bytes.h"

namespace marey::stream {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxAtOnce = 256;
constexpr int kMaxNesting = 16;

/// The parser goes down by recursion of its own stack, but what it builds is taken apart by ours.
bool is_nested_beyond(std::string_view text, int maximum) {
  int depth = 0, deepest = 0;
  for (const char c : text) {
    if (c == '[' || c == '{') deepest = std::max(deepest, ++depth);
    if (c == ']' || c == '}') --depth;
  }
  return deepest > maximum;
}

template <typename T>
std::optional<T> whole_in(const json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_number_unsigned()) return std::nullopt;
  const auto value = found->template get<std::uint64_t>();
  return value <= std::numeric_limits<T>::max() ? std::optional(static_cast<T>(value)) : std::nullopt;
}

}  // namespace

std::string base64(std::string_view bytes) {
  constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kLetters[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::optional<FoxgloveRequest> foxglove_request(std::string_view text) {
  if (is_nested_beyond(text, kMaxNesting)) throw Error("a message that is nested too deep");
  const json message = json::parse(text, nullptr, false);
  if (!message.is_object()) throw Error("a message that is not JSON object");
  const auto op = message.find("op");
  if (op == message.end() || !op->is_string()) throw Error("a message without its op");
  FoxgloveRequest request;
  if (*op == "subscribe") {
    const auto required = message.find("subscriptions");
    if (required == message.end() || !required->is_array()) throw Error("a subscription of nothing");
    if (required->size() > kMaxAtOnce) throw Error("{} subscriptions at once", required->size());
    for (const json& each : *required) {
      if (!each.is_object()) throw Error("a subscription that is not an object");
      const auto id = whole_in<std::uint32_t>(each, "id");
      const auto channel = whole_in<std::uint64_t>(each, "channelId");
      if (!id || !channel) throw Error("a subscription without its numbers");
      request.subscribe.push_back({*id, *channel});
    }
    return request;
  }
  if (*op == "unsubscribe") {
    const auto required = message.find("subscriptionIds");
    if (required == message.end() || !required->is_array() || required->size() > kMaxAtOnce)
      throw Error("an unsubscription of nothing");
    for (const json& each : *required) {
      if (each.is_number_unsigned() && each.get<std::uint64_t>() <= 0xffffffffu)
        request.unsubscribe.push_back(each.get<std::uint32_t>());
    }
    return request;
  }
  return std::nullopt;
}

std::string foxglove_server_info(std::string_view name, std::string_view session) {
  return json{{"op", "serverInfo"}, {"name", name}, {"capabilities", json::array()}, {"sessionId", session}}.dump(
      -1, ' ', false, json::error_handler_t::replace);
}

std::string foxglove_advertisement() {
  json channels = json::array();
  for (std::size_t i = 0; i < format::mcap::topics().size(); ++i) {
    const format::mcap::Topic& topic = format::mcap::topics()[i];
    channels.push_back({{"id", i + 1},
                        {"topic", topic.name},
                        {"encoding", topic.encoding},
                        {"schemaName", topic.schema_name},
                        {"schemaEncoding", topic.schema_encoding},
                        {"schema", topic.encoding == "protobuf" ? base64(topic.schema) : topic.schema}});
  }
  return json{{"op", "advertise"}, {"channels", channels}}.dump();
}

std::string foxglove_status(int level, std::string_view message_text) {
  return json{{"op", "status"}, {"level", level}, {"message", message_text}}.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string foxglove_data_head(std::uint32_t subscription, std::uint64_t time_ns) {
  LittleBytes bytes;
  bytes.put<std::uint8_t>(std::uint8_t{1}).put<std::uint32_t>(subscription).put<std::uint64_t>(time_ns);
  return std::move(bytes).str();
}

}  // namespace marey::stream
