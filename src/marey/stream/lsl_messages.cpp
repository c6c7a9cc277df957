#include "marey/stream/lsl_messages.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <limits>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <pugixml.hpp>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/stream/bytes.h"

namespace marey::stream {
namespace {

constexpr std::size_t kMaxQuery = 1024;
constexpr std::size_t kMaxRequest = 8192;

void append_channel(std::string& xml, std::string_view label, std::string_view marker, std::string_view object,
                    std::string_view type, std::string_view unit) {
  fmt::format_to(std::back_inserter(xml), "<channel><label>{}</label>", xml_escaped(label));
  if (!marker.empty()) fmt::format_to(std::back_inserter(xml), "<marker>{}</marker>", xml_escaped(marker));
  if (!object.empty()) fmt::format_to(std::back_inserter(xml), "<object>{}</object>", xml_escaped(object));
  fmt::format_to(std::back_inserter(xml), "<type>{}</type>", type);
  if (!unit.empty()) fmt::format_to(std::back_inserter(xml), "<unit>{}</unit>", unit);
  xml += "</channel>";
}

std::string shown_body(const Body& body) {
  return body.skeleton.empty() ? body.label : body.skeleton + "/" + body.label;
}

std::string description_xml(const LslLayout& layout) {
  std::string xml = "<desc><channels>";
  const std::string_view unit = layout.metric ? "meters" : "pixels";
  constexpr std::array<std::string_view, 3> kAxes{"X", "Y", "Z"};
  for (const std::string& label : layout.labels) {
    for (std::size_t i = 0; i < layout.axes(); ++i)
      append_channel(xml, fmt::format("{}_{}", label, kAxes[i]), label, {}, fmt::format("Position{}", kAxes[i]), unit);
  }
  for (const Body& body : layout.bodies) {
    const std::string name = shown_body(body);
    for (const std::string_view axis : kAxes)
      append_channel(xml, fmt::format("{}_{}", name, axis), {}, name, fmt::format("Position{}", axis), unit);
    for (const std::string_view part : {"A", "B", "C", "D"})
      append_channel(xml, fmt::format("{}_q{}", name, part), {}, name, fmt::format("Orientation{}", part), "quaternion");
  }
  for (std::size_t slot = 1; slot <= layout.slots; ++slot) {
    const std::string name = fmt::format("slot{}", slot);
    append_channel(xml, name + "_ID", name, {}, "TrackID", {});
    for (std::size_t i = 0; i < layout.axes(); ++i)
      append_channel(xml, fmt::format("{}_{}", name, kAxes[i]), name, {}, fmt::format("Position{}", kAxes[i]), unit);
  }
  return xml +
         "</channels><acquisition><manufacturer>Marey</manufacturer><model>Marey</model></acquisition>"
         "<setup><name>Marey</name></setup></desc>";
}

/// The next line, without its end; nothing if it has none yet.
std::optional<std::string_view> next_line(std::string_view& rest) {
  const std::size_t end = rest.find("\r\n");
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end + 2);
  return line;
}

template <typename T>
std::optional<T> plain_number(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

/// Two words with a blank between.
std::optional<std::pair<std::string_view, std::string_view>> two_words(std::string_view line) {
  const std::size_t blank = line.find(' ');
  if (blank == std::string_view::npos || blank == 0) return std::nullopt;
  return std::pair(line.substr(0, blank), line.substr(blank + 1));
}

/// liblsl's pattern, by which a reader knows that it understands the format.
std::vector<float> test_pattern(std::size_t channels, int offset) {
  std::vector<float> values(channels);
  for (std::size_t k = 0; k < channels; ++k)
    values[k] = (static_cast<float>(k) + static_cast<float>(offset)) * (k % 2 == 0 ? 1.0F : -1.0F);
  return values;
}

}  // namespace

std::string lsl_info_xml(const LslOutlet& outlet, bool full) {
  return fmt::format(
      "<?xml "
      "version=\"1.0\"?>\n<info><name>{}</name><type>MoCap</type><channel_count>{}</channel_count><channel_format>float32</"
      "channel_format>"
      "<source_id>{}</source_id><nominal_srate>{:.15g}</nominal_srate><version>1.100000000000000</version><created_at>{:.6f}</"
      "created_at>"
      "<uid>{}</uid><session_id>default</session_id><hostname>{}</hostname><v4address></v4address><v4data_port>{}</v4data_port>"
      "<v4service_port>{}</v4service_port><v6address></v6address><v6data_port>0</v6data_port><v6service_port>0</v6service_port>{}</"
      "info>\n",
      xml_escaped(outlet.name), outlet.layout.channels(), xml_escaped(outlet.source_id), outlet.rate_hz, outlet.created_at,
      outlet.uid, xml_escaped(outlet.host), outlet.port, outlet.port, full ? description_xml(outlet.layout) : "<desc/>");
}

bool lsl_matches(const std::string& info_xml, std::string_view query) {
  if (query.size() > kMaxQuery || query.find('\0') != std::string_view::npos) return false;
  // One level of brackets is what queries have; thousands would be walked by recursion.
  if (std::count(query.begin(), query.end(), '(') > 32 || std::count(query.begin(), query.end(), '[') > 32) return false;
  pugi::xml_document document;
  if (!document.load_string(info_xml.c_str())) return false;
  if (query.find_first_not_of(" \t") == std::string_view::npos) return true;
  try {
    const pugi::xpath_query path(fmt::format("/info[{}]", query).c_str());
    return !path.evaluate_node_set(document).empty();
  } catch (const pugi::xpath_exception&) {
    return false;
  }
}

std::optional<LslSearch> lsl_search(std::string_view datagram) {
  const auto method = next_line(datagram);
  const auto query = method ? next_line(datagram) : std::nullopt;
  if (!query || *method != "LSL:shortinfo") return std::nullopt;
  // The last line has an end from some.
  const std::string_view last = datagram.substr(0, datagram.find("\r\n"));
  const auto words = two_words(last);
  const auto port = words ? plain_number<std::uint16_t>(words->first) : std::nullopt;
  if (!port || *port == 0 || words->second.size() > 128) return std::nullopt;
  return LslSearch{.query = std::string(*query), .id = std::string(words->second), .port = *port};
}

std::optional<std::string> lsl_time_answer(std::string_view datagram, double came, double answered) {
  const auto method = next_line(datagram);
  if (!method || *method != "LSL:timedata") return std::nullopt;
  const auto words = two_words(datagram.substr(0, datagram.find("\r\n")));
  const auto wave = words ? plain_number<std::int64_t>(words->first) : std::nullopt;
  const auto sent = words ? plain_number<double>(words->second) : std::nullopt;
  if (!wave || !sent) return std::nullopt;
  return fmt::format(" {} {:.16g} {:.16g} {:.16g}", *wave, *sent, came, answered);
}

std::optional<LslRequest> lsl_request(std::string_view bytes) {
  if (bytes.size() > kMaxRequest) throw Error("a request of more than {} bytes", kMaxRequest);
  std::string_view rest = bytes;
  const auto method = next_line(rest);
  if (!method) return std::nullopt;
  LslRequest request;
  if (*method == "LSL:fullinfo") {
    request.kind = LslRequest::Kind::full_info;
  } else if (*method == "LSL:shortinfo") {
    const auto query = next_line(rest);
    if (!query) return std::nullopt;
    request.text = *query;
  } else if (method->starts_with("LSL:streamfeed/")) {
    const auto words = two_words(method->substr(15));
    const auto version = words ? plain_number<int>(words->first) : std::nullopt;
    if (!version) throw Error("asks for a feed without its version and UID");
    const std::size_t end = bytes.find("\r\n\r\n");
    if (end == std::string_view::npos) return std::nullopt;
    request = {.kind = LslRequest::Kind::feed, .text = std::string(words->second), .version = *version, .size = end + 4};
    return request;
  } else {
    throw Error("asks for nothing that an LSL outlet has");
  }
  request.size = bytes.size() - rest.size();
  return request;
}

std::string lsl_feed_head(const LslOutlet& outlet) {
  std::string head = fmt::format(
      "LSL/110 200 OK\r\nUID: {}\r\nByte-Order: 1234\r\nSuppress-Subnormals: 0\r\nData-Protocol-Version: 110\r\n\r\n", outlet.uid);
  for (const int offset : {4, 2}) head += lsl_sample(123456.789, test_pattern(outlet.layout.channels(), offset));
  return head;
}

std::string lsl_sample(double time, const std::vector<float>& channels) {
  LittleBytes bytes;
  bytes.put<std::uint8_t>(std::uint8_t{2}).put<double>(time);
  for (const float value : channels) bytes.put<float>(value);
  return std::move(bytes).str();
}

std::vector<float> lsl_channels(const LslLayout& layout, const ChannelLayout& channel_layout, const ChannelLayout::Scene& scene,
                                const Instant& instant, std::span<const Sample* const> slotted) {
  std::vector<float> channels(layout.channels(), std::numeric_limits<float>::quiet_NaN());
  std::size_t at = 0;
  const std::size_t axes = layout.axes();
  const auto put_position = [&](const Sample* sample, std::size_t channel) {
    for (std::size_t axis = 0; sample != nullptr && axis < axes; ++axis)
      channels[channel + axis] = static_cast<float>(sample->position[static_cast<Eigen::Index>(axis)]);
  };
  for (std::size_t i = 0; i < layout.labels.size(); ++i, at += axes)
    put_position(i < scene.labelled.size() && channel_layout.labels()[i] == layout.labels[i] ? scene.labelled[i] : nullptr, at);
  for (const Body& body : layout.bodies) {
    if (const BodyPose* pose = pose_of(instant, body.id); pose != nullptr && pose->tracked) {
      const Eigen::Quaterniond turn(pose->world_from_body.rotation);
      for (Eigen::Index i = 0; i < 3; ++i)
        channels[at + static_cast<std::size_t>(i)] = static_cast<float>(pose->world_from_body.translation[i]);
      for (const auto& [offset, value] :
           {std::pair(3, turn.w()), std::pair(4, turn.x()), std::pair(5, turn.y()), std::pair(6, turn.z())})
        channels[at + static_cast<std::size_t>(offset)] = static_cast<float>(value);
    }
    at += 7;
  }
  for (std::size_t slot = 0; slot < std::min(layout.slots, slotted.size()); ++slot) {
    const std::size_t channel = at + slot * (1 + axes);
    if (slotted[slot] != nullptr) channels[channel] = static_cast<float>(number(slotted[slot]->track));
    put_position(slotted[slot], channel + 1);
  }
  return channels;
}

}  // namespace marey::stream
