#include "marey/stream/json_text.h"

#include <iterator>

#include <fmt/format.h>

#include "marey/files/text_safety.h"

namespace marey::stream {
namespace {

std::string_view frame_word(const FrameOfReference& frame) {
  switch (frame.kind) {
    case FrameOfReference::Kind::image:
      return "image";
    case FrameOfReference::Kind::ground:
      return "ground";
    case FrameOfReference::Kind::user_ground:
      return "user_ground";
    case FrameOfReference::Kind::space:
      break;
  }
  return "space";
}

void append_point(std::string& text, const RecordingHeader& header, const ChannelLayout& channel_layout, const Sample& sample) {
  auto out = std::back_inserter(text);
  fmt::format_to(out, R"({{"id":{})", number(sample.track));
  if (const std::string_view label = channel_layout.label_of(sample.track); !label.empty())
    fmt::format_to(out, R"(,"label":{})", json_quoted(label));
  fmt::format_to(out, R"(,"x":{:.6f},"y":{:.6f})", sample.position.x(), sample.position.y());
  if (header.frame.dimensions() == 3) fmt::format_to(out, R"(,"z":{:.6f})", sample.position.z());
  if (sample.residual_m) fmt::format_to(out, R"(,"residual":{:.6f})", *sample.residual_m);
  if (sample.box) {
    fmt::format_to(out, R"(,"box":[{:.2f},{:.2f},{:.2f},{:.2f}])", sample.box->left, sample.box->top, sample.box->width,
                   sample.box->height);
  }
  fmt::format_to(out, R"(,"state":"{}"}})", to_string(sample.provenance));
}

void append_body(std::string& text, const Body& body, const BodyPose& pose) {
  const Eigen::Quaterniond turn(pose.world_from_body.rotation);
  const Vector<3>& at = pose.world_from_body.translation;
  auto out = std::back_inserter(text);
  fmt::format_to(out, R"({{"id":{},"label":{})", number(body.id), json_quoted(body.label));
  if (!body.skeleton.empty()) fmt::format_to(out, R"(,"skeleton":{})", json_quoted(body.skeleton));
  fmt::format_to(out, R"(,"position":[{:.6f},{:.6f},{:.6f}],"rotation":[{:.7f},{:.7f},{:.7f},{:.7f}],"tracked":{})", at.x(), at.y(),
                 at.z(), turn.x(), turn.y(), turn.z(), turn.w(), pose.tracked);
  if (pose.residual_m) fmt::format_to(out, R"(,"residual":{:.6f})", *pose.residual_m);
  if (pose.other) {
    const Eigen::Quaterniond turned(pose.other->world_from_body.rotation);
    const Vector<3>& there = pose.other->world_from_body.translation;
    fmt::format_to(
        out, R"(,"other":{{"position":[{:.6f},{:.6f},{:.6f}],"rotation":[{:.7f},{:.7f},{:.7f},{:.7f}],"probability":{:.3f}}})",
        there.x(), there.y(), there.z(), turned.x(), turned.y(), turned.z(), turned.w(), pose.other->probability);
  }
  text += '}';
}

}  // namespace

std::string json_quoted(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : plain_text(text)) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

std::string json_header(const RecordingHeader& header, const ChannelLayout& channel_layout) {
  std::string text =
      fmt::format(R"({{"type":"header","version":1,"name":{},"frame":"{}","unit":"{}","rate_hz":{:.6g})", json_quoted(header.name),
                  frame_word(header.frame), header.frame.metric() ? "m" : "px", header.rate_hz);
  if (header.frame.metric()) text += R"(,"up":"z")";
  text += R"(,"labels":[)";
  for (const std::string& label : channel_layout.labels()) text += (text.ends_with('[') ? "" : ",") + json_quoted(label);
  text += R"(],"bodies":[)";
  for (const Body& body : header.bodies) {
    if (!text.ends_with('[')) text += ',';
    text += fmt::format(R"({{"id":{},"label":{})", number(body.id), json_quoted(body.label));
    if (!body.skeleton.empty()) text += fmt::format(R"(,"skeleton":{})", json_quoted(body.skeleton));
    if (body.parent) text += fmt::format(R"(,"parent":{})", number(*body.parent));
    text += '}';
  }
  return text + "]}";
}

std::string json_frame(const RecordingHeader& header, const ChannelLayout& channel_layout, const Instant& instant,
                       const FrameTimes& times) {
  std::string text;
  text.reserve(160 + 96 * instant.samples.size() + 192 * instant.bodies.size());
  fmt::format_to(std::back_inserter(text),
                 R"({{"type":"frame","frame":{},"time":{:.6f},"capture_ns":{},"solve_ns":{},"send_ns":{},"points":[)",
                 instant.index, seconds(instant.time), times.capture, times.solve, times.send);
  bool first = true;
  for (const Sample& sample : instant.samples) {
    if (!first) text += ',';
    first = false;
    append_point(text, header, channel_layout, sample);
  }
  text += ']';
  if (!header.bodies.empty()) {
    text += R"(,"bodies":[)";
    first = true;
    for (const Body& body : header.bodies) {
      const BodyPose* pose = pose_of(instant, body.id);
      if (pose == nullptr) continue;
      if (!first) text += ',';
      first = false;
      append_body(text, body, *pose);
    }
    text += ']';
  }
  return text + '}';
}

}  // namespace marey::stream
