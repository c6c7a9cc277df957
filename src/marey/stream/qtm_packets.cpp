#include "marey/stream/qtm_packets.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include <Eigen/Geometry>

#include "marey/core/error.h"
#include "marey/stream/bytes.h"

namespace marey::stream {
namespace {

constexpr float kLost = std::numeric_limits<float>::quiet_NaN();  // every bit that the protocol asks for is set
constexpr float kMm = 1000;

void put_vector(LittleBytes& bytes, const Vector<3>& value) {
  for (int i = 0; i < 3; ++i) bytes.put<float>(static_cast<float>(value[i]));
}

void put_lost(LittleBytes& bytes, int count) {
  for (int i = 0; i < count; ++i) bytes.put<float>(kLost);
}

float residual_mm(const std::optional<double>& residual_m) {
  return residual_m ? static_cast<float>(*residual_m) * kMm : kLost;
}

/// All marker and body components begin so; nothing is dropped or out of sync that is reported here.
void put_count(LittleBytes& bytes, std::size_t count) {
  bytes.put<std::uint32_t>(static_cast<std::uint32_t>(count)).put<std::uint16_t>(0).put<std::uint16_t>(0);
}

void put_points(LittleBytes& bytes, const ChannelLayout::Scene& scene, bool with_residual) {
  put_count(bytes, scene.labelled.size());
  for (const Sample* sample : scene.labelled) {
    if (sample == nullptr) {
      put_lost(bytes, with_residual ? 4 : 3);
      continue;
    }
    put_vector(bytes, kMm * sample->position);
    if (with_residual) bytes.put<float>(residual_mm(sample->residual_m));
  }
}

void put_other_points(LittleBytes& bytes, const ChannelLayout::Scene& scene, bool with_residual) {
  put_count(bytes, scene.others.size());
  for (const Sample* sample : scene.others) {
    put_vector(bytes, kMm * sample->position);
    bytes.put<std::uint32_t>(static_cast<std::uint32_t>(number(sample->track)));
    if (with_residual) bytes.put<float>(residual_mm(sample->residual_m));
  }
}

void put_bodies(LittleBytes& bytes, const ChannelLayout& channel_layout, const Instant& instant, bool euler, bool with_residual) {
  put_count(bytes, channel_layout.bodies().size());
  for (const Body& body : channel_layout.bodies()) {
    const BodyPose* pose = pose_of(instant, body.id);
    if (pose == nullptr || !pose->tracked) {
      put_lost(bytes, (euler ? 6 : 12) + (with_residual ? 1 : 0));
      continue;
    }
    put_vector(bytes, kMm * pose->world_from_body.translation);
    if (euler) {
      put_vector(bytes, qtm_euler_degrees(pose->world_from_body.rotation));
    } else {  // column by column, as the matrix lies in memory
      for (int i = 0; i < 9; ++i) bytes.put<float>(static_cast<float>(pose->world_from_body.rotation.data()[i]));
    }
    if (with_residual) bytes.put<float>(residual_mm(pose->residual_m));
  }
}

void put_skeletons(LittleBytes& bytes, const ChannelLayout& channel_layout, const Instant& instant, bool global) {
  bytes.put<std::uint32_t>(static_cast<std::uint32_t>(channel_layout.skeletons().size()));
  for (const Skeleton& skeleton : channel_layout.skeletons()) {
    bytes.put<std::uint32_t>(static_cast<std::uint32_t>(skeleton.segments.size()));
    for (const Body& segment : skeleton.segments) {
      bytes.put<std::int32_t>(number(segment.id));
      const BodyPose* pose = pose_of(instant, segment.id);
      const BodyPose* parent = segment.parent && !global ? pose_of(instant, *segment.parent) : nullptr;
      if (pose == nullptr || (segment.parent && !global && parent == nullptr)) {
        put_lost(bytes, 7);
        continue;
      }
      const Rigid3 local = parent == nullptr ? pose->world_from_body : in_parent(*parent, *pose);
      put_vector(bytes, kMm * local.translation);
      const Eigen::Quaterniond turn(local.rotation);
      for (int i = 0; i < 4; ++i) bytes.put<float>(static_cast<float>(turn.coeffs()[i]));  // x y z w
    }
  }
}

struct Named {
  std::string_view name;
  std::optional<QtmComponent> component;  // nothing if this program never has any
};
constexpr std::array<Named, 24> kComponents{{{"3d", QtmComponent::points},
                                             {"3dres", QtmComponent::points_residual},
                                             {"3dnolabels", QtmComponent::points_no_labels},
                                             {"3dnolabelsres", QtmComponent::points_no_labels_residual},
                                             {"6d", QtmComponent::bodies},
                                             {"6dres", QtmComponent::bodies_residual},
                                             {"6deuler", QtmComponent::bodies_euler},
                                             {"6deulerres", QtmComponent::bodies_euler_residual},
                                             {"skeleton", QtmComponent::skeletons},
                                             {"skeleton:global", QtmComponent::skeletons},
                                             {"skeleton:local", QtmComponent::skeletons},
                                             {"2d", {}},
                                             {"2dlin", {}},
                                             {"analog", {}},
                                             {"analogsingle", {}},
                                             {"force", {}},
                                             {"forcesingle", {}},
                                             {"image", {}},
                                             {"gazevector", {}},
                                             {"eyetracker", {}},
                                             {"timecode", {}},
                                             {"trigger", {}},
                                             {"digital", {}},
                                             {"externaltimebase", {}}}};

template <typename T>
std::optional<T> whole_of(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// "udp:6734", "udp:192.168.0.9:6734".
bool take_udp(std::string_view word, QtmStreamRequest& request) {
  word.remove_prefix(4);
  if (const std::size_t colon = word.find(':'); colon != std::string_view::npos) {
    request.udp_host = word.substr(0, colon);
    word.remove_prefix(colon + 1);
  }
  request.udp_port = whole_of<std::uint16_t>(word);
  return request.udp_port && *request.udp_port > 0;
}

/// "allframes", "frequency:100", "frequencydivisor:2".
bool take_rate(std::string_view word, QtmStreamRequest& request) {
  if (word == "allframes") return true;
  const auto number_behind = [&](std::string_view name) -> std::optional<std::int64_t> {
    return word.starts_with(name) ? whole_of<std::int64_t>(word.substr(name.size())) : std::nullopt;
  };
  const auto maximum = std::int64_t{1'000'000};
  if (const auto divisor = number_behind("frequencydivisor:"); divisor && *divisor > 0 && *divisor <= maximum) {
    request.divisor = *divisor;
    return true;
  }
  if (const auto frequency = number_behind("frequency:"); frequency && *frequency > 0 && *frequency <= maximum) {
    request.frequency = static_cast<double>(*frequency);
    return true;
  }
  return false;
}

}  // namespace

std::string qtm_packet(QtmPacket kind, std::string_view body) {
  LittleBytes bytes;
  bytes.put<std::uint32_t>(static_cast<std::uint32_t>(8 + body.size()))
      .put<std::uint32_t>(static_cast<std::uint32_t>(kind))
      .raw(body);
  return std::move(bytes).str();
}

std::string qtm_text_packet(QtmPacket kind, std::string_view text) {
  return qtm_packet(kind, std::string(text) + '\0');
}

std::string qtm_event_packet(QtmEvent event) {
  return qtm_packet(QtmPacket::event, std::string(1, static_cast<char>(event)));
}

Vector<3> qtm_euler_degrees(const Matrix<3>& rotation) {
  const double pitch = std::asin(std::clamp(rotation(0, 2), -1.0, 1.0));
  const double roll = std::atan2(-rotation(1, 2), rotation(2, 2)), yaw = std::atan2(-rotation(0, 1), rotation(0, 0));
  return Vector<3>(roll, pitch, yaw) * (180 / std::numbers::pi);
}

std::string qtm_data_packet(const ChannelLayout& channel_layout, const ChannelLayout::Scene& scene, const Instant& instant,
                            const QtmComponents& components) {
  LittleBytes bytes;
  bytes.put<std::uint32_t>(0).put<std::uint32_t>(static_cast<std::uint32_t>(QtmPacket::data));
  bytes.put<std::int64_t>(instant.time.time_since_epoch().count() / 1000);
  bytes.put<std::uint32_t>(static_cast<std::uint32_t>(instant.index + 1));
  bytes.put<std::uint32_t>(static_cast<std::uint32_t>(components.required.size()));
  for (const QtmComponent component : components.required) {
    const std::size_t begin = bytes.size();
    bytes.put<std::uint32_t>(0).put<std::uint32_t>(static_cast<std::uint32_t>(component));
    switch (component) {
      case QtmComponent::points:
      case QtmComponent::points_residual:
        put_points(bytes, scene, component == QtmComponent::points_residual);
        break;
      case QtmComponent::points_no_labels:
      case QtmComponent::points_no_labels_residual:
        put_other_points(bytes, scene, component == QtmComponent::points_no_labels_residual);
        break;
      case QtmComponent::bodies:
      case QtmComponent::bodies_residual:
        put_bodies(bytes, channel_layout, instant, false, component == QtmComponent::bodies_residual);
        break;
      case QtmComponent::bodies_euler:
      case QtmComponent::bodies_euler_residual:
        put_bodies(bytes, channel_layout, instant, true, component == QtmComponent::bodies_euler_residual);
        break;
      case QtmComponent::skeletons:
        put_skeletons(bytes, channel_layout, instant, components.global_skeletons);
        break;
    }
    bytes.set<std::uint32_t>(begin, static_cast<std::uint32_t>(bytes.size() - begin));
  }
  bytes.set<std::uint32_t>(0, static_cast<std::uint32_t>(bytes.size()));
  return std::move(bytes).str();
}

std::optional<QtmReceived> qtm_received(std::string_view bytes) {
  const auto size = number_at<std::uint32_t>(bytes, 0);
  if (!size) return std::nullopt;
  if (*size < 8 || *size > kQtmMaxBytes) throw Error("a packet of {} bytes; 8 to {} are taken", *size, kQtmMaxBytes);
  if (bytes.size() < *size) return std::nullopt;
  return QtmReceived{.type = *number_at<std::uint32_t>(bytes, 4), .body = bytes.substr(8, *size - 8), .size = *size};
}

std::vector<std::string> qtm_words(std::string_view command) {
  std::vector<std::string> words(1);
  for (const char c : command) {
    if (c == '\0' || std::isspace(static_cast<unsigned char>(c)) != 0) {
      if (!words.back().empty()) words.emplace_back();
    } else {
      words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

std::optional<QtmComponents> qtm_components(const std::vector<std::string>& words, std::size_t first) {
  QtmComponents components;
  for (const std::string& word : std::span(words).subspan(std::min(first, words.size()))) {
    const auto known = std::find_if(kComponents.begin(), kComponents.end(), [&](const Named& each) { return each.name == word; });
    const bool analog = word.starts_with("analog:") || word.starts_with("analogsingle:");  // with channels
    if (known == kComponents.end() && !analog) return std::nullopt;
    if (word == "skeleton:global") components.global_skeletons = true;
    if (analog || !known->component) continue;
    if (std::find(components.required.begin(), components.required.end(), *known->component) == components.required.end())
      components.required.push_back(*known->component);
  }
  return components;
}

std::optional<QtmStreamRequest> qtm_stream_request(const std::vector<std::string>& words) {
  QtmStreamRequest request;
  if (words.size() >= 2 && words[1] == "stop") {
    request.stop = true;
    return request;
  }
  if (words.size() < 3 || !take_rate(words[1], request)) return std::nullopt;
  std::size_t next = 2;
  if (words[next].starts_with("udp:")) {
    if (!take_udp(words[next], request)) return std::nullopt;
    ++next;
  }
  const auto components = qtm_components(words, next);
  if (!components || next >= words.size()) return std::nullopt;
  request.components = *components;
  return request;
}

}  // namespace marey::stream
