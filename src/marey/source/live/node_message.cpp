#include "marey/source/live/node_message.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/rig.h"
#include "marey/files/limits.h"
#include "marey/files/text_safety.h"

namespace marey::source::live {
namespace {

static_assert(std::endian::native == std::endian::little, "messages of nodes are written as they lie in memory");

constexpr std::string_view kFrameMark = "MRYF", kAnswerMark = "MRYA", kControlsMark = "MRYC";
constexpr std::array kNodeControls{Control::exposure, Control::gain, Control::threshold};
constexpr std::size_t kMaxRefusal = 1000;  // bytes
constexpr std::size_t kNumbersOfDetection = 11;
constexpr std::size_t kMaxNames = 1000;
constexpr int kMaxNodeSide = 1 << 20;                                                                   // px
constexpr double kMaxNumber = 1e9;                                                                      // of px, px², Hz
constexpr std::int64_t kMostNodeFrames = std::int64_t{1} << 40, kMostNodeTime = std::int64_t{1} << 60;  // ns: 36 years

enum class NodeKind : std::uint8_t { jpeg, detections };

template <typename T>
void put(std::string& to, T value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Takes a message apart from its front.
class NodeReader {
 public:
  NodeReader(std::string_view rest, const std::string& name) : rest_(rest), name_(name) {}

  void mark(std::string_view mark) {
    if (!rest_.starts_with(mark)) refuse("it is not a node of Marey, or one of another version");
    rest_.remove_prefix(mark.size());
  }

  template <typename T>
  T next() {
    if (rest_.size() < sizeof(T)) refuse("the message breaks off");
    T value;
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return value;
  }

  double number() {
    const auto value = next<double>();
    if (!(std::abs(value) <= kMaxNumber)) refuse("a number is not one, or out of all bounds");
    return value;
  }

  Timestamp time() {
    const auto ns = next<std::int64_t>();
    if (ns < -kMostNodeTime || ns > kMostNodeTime) refuse("a time is out of all bounds");
    return Timestamp(Duration(ns));
  }

  cv::Size size() {
    const auto width = next<std::uint32_t>(), height = next<std::uint32_t>();
    if (width > kMaxNodeSide || height > kMaxNodeSide) refuse("its images are too large");
    return {static_cast<int>(width), static_cast<int>(height)};
  }

  std::string_view rest() const { return rest_; }

  [[noreturn]] void refuse(const char* why) const { throw Error("{}: {}", name_, why); }

 private:
  std::string_view rest_;
  const std::string& name_;
};

void put_detection(std::string& to, const Detection& found) {
  const Matrix<2> covariance = found.covariance.value_or(Matrix<2>::Zero());  // in a message zeros stand for unknown
  for (const double value : {found.centre.x(), found.centre.y(), covariance(0, 0), covariance(0, 1), covariance(1, 1), found.area,
                             found.box.left, found.box.top, found.box.width, found.box.height, found.score})
    put(to, value);
}

Detection next_detection(NodeReader& message) {
  Detection found;
  for (int axis = 0; axis < 2; ++axis) found.centre[axis] = message.number();
  Matrix<2> covariance;
  covariance(0, 0) = message.number();
  covariance(0, 1) = covariance(1, 0) = message.number();
  covariance(1, 1) = message.number();
  if (!(covariance(0, 0) >= 0 && covariance.determinant() >= 0)) message.refuse("a covariance is not one");
  if (covariance.trace() > 0) found.covariance = covariance;
  found.area = message.number();
  for (double* side : {&found.box.left, &found.box.top, &found.box.width, &found.box.height}) *side = message.number();
  found.score = message.number();
  if (!(found.score >= 0 && found.score <= 1)) message.refuse("a score is not within 0 and 1");
  return found;
}

}  // namespace

std::string message_of(const NodeFrame& frame) {
  std::string message(kFrameMark);
  put(message, frame.session);
  put(message, frame.sequence);
  put(message, static_cast<std::int64_t>(frame.taken.time_since_epoch().count()));
  put(message, static_cast<std::uint32_t>(frame.size.width));
  put(message, static_cast<std::uint32_t>(frame.size.height));
  put(message, frame.detections ? NodeKind::detections : NodeKind::jpeg);
  if (frame.detections) {
    put(message, static_cast<std::uint32_t>(frame.detections->size()));
    for (const Detection& found : *frame.detections) put_detection(message, found);
  } else {
    message.append(reinterpret_cast<const char*>(frame.jpeg.data()), frame.jpeg.size());
  }
  return message;
}

std::string message_of(const NodeAnswer& answer) {
  std::string message(kAnswerMark);
  put(message, answer.session);
  put(message, static_cast<std::int64_t>(answer.now.time_since_epoch().count()));
  put(message, static_cast<std::uint8_t>(answer.known));
  put(message, static_cast<std::uint32_t>(answer.size.width));
  put(message, static_cast<std::uint32_t>(answer.size.height));
  put(message, answer.rate_hz.value_or(0));
  for (const std::string& camera : answer.cameras) message += camera + '\n';
  return message;
}

bool is_node_frame(std::string_view message) {
  return message.starts_with(kFrameMark);
}

NodeFrame read_node_frame(std::string_view message, const std::string& name) {
  NodeReader reader(message, name);
  reader.mark(kFrameMark);
  NodeFrame frame;
  frame.session = reader.next<std::uint64_t>();
  frame.sequence = reader.next<std::int64_t>();
  if (frame.sequence < 0 || frame.sequence > kMostNodeFrames) reader.refuse("a frame's number is out of all bounds");
  frame.taken = reader.time();
  frame.size = reader.size();
  const auto kind = reader.next<NodeKind>();
  if (kind == NodeKind::jpeg) {
    frame.jpeg = {reinterpret_cast<const std::uint8_t*>(reader.rest().data()), reader.rest().size()};
    return frame;
  }
  if (kind != NodeKind::detections) reader.refuse("a frame is neither an image nor detections");
  const std::size_t count = reader.next<std::uint32_t>();
  if (count > Limits::in_force().observations) reader.refuse("too many detections in a frame (the limit observations)");
  if (reader.rest().size() != count * kNumbersOfDetection * sizeof(double)) reader.refuse("the message breaks off");
  frame.detections.emplace().reserve(count);
  for (std::size_t i = 0; i < count; ++i) frame.detections->push_back(next_detection(reader));
  return frame;
}

NodeAnswer read_node_answer(std::string_view message, const std::string& name) {
  NodeReader reader(message, name);
  reader.mark(kAnswerMark);
  NodeAnswer answer;
  answer.session = reader.next<std::uint64_t>();
  answer.now = reader.time();
  answer.known = reader.next<std::uint8_t>() != 0;
  answer.size = reader.size();
  const double rate_hz = reader.number();
  if (rate_hz > 0) answer.rate_hz = rate_hz;
  for (std::string_view rest = reader.rest(); !rest.empty();) {
    const std::size_t end = rest.find('\n');
    const std::string_view camera = rest.substr(0, end);
    if (end == std::string_view::npos || answer.cameras.size() == kMaxNames || camera.size() > Limits::in_force().label_bytes ||
        std::any_of(camera.begin(), camera.end(), unfit_for_camera_name))
      reader.refuse("its list of cameras is not one");
    answer.cameras.emplace_back(camera);
    rest.remove_prefix(end + 1);
  }
  return answer;
}

std::string message_of(const NodeControls& controls) {
  std::string message(kControlsMark);
  put(message, controls.session);
  put(message, static_cast<std::uint8_t>(controls.allowed));
  put(message, static_cast<std::uint8_t>(controls.waits));
  put(message, static_cast<std::uint8_t>(controls.has.size()));
  for (const ControlRange& range : controls.has) {
    put(message, static_cast<std::uint8_t>(range.control));
    for (const double value : {range.minimum, range.maximum, range.now}) put(message, value);
  }
  return message + controls.refused.substr(0, kMaxRefusal);
}

std::optional<NodeControls> read_node_controls(std::string_view message, const std::string& name) {
  if (message.starts_with(kAnswerMark)) return std::nullopt;
  NodeReader reader(message, name);
  reader.mark(kControlsMark);
  NodeControls controls;
  controls.session = reader.next<std::uint64_t>();
  controls.allowed = reader.next<std::uint8_t>() != 0;
  controls.waits = reader.next<std::uint8_t>() != 0;
  const std::size_t count = reader.next<std::uint8_t>();
  if (count > kNodeControls.size()) reader.refuse("a camera has more controls than there are");
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t which = reader.next<std::uint8_t>();
    if (which >= kNodeControls.size()) reader.refuse("a control is not one that is known");
    ControlRange& range = controls.has.emplace_back();
    range.control = kNodeControls[which];
    for (double* value : {&range.minimum, &range.maximum, &range.now}) *value = reader.number();
    if (range.minimum > range.maximum) reader.refuse("a control's bounds are not any");
  }
  if (reader.rest().size() > kMaxRefusal) reader.refuse("a sentence is too long");
  controls.refused = plain_text(reader.rest());
  return controls;
}

std::string text_of(const NodeQuestion& question) {
  if (!question.request) return question.camera + "=";
  return fmt::format("{}={} {}", question.camera, to_string(question.request->control), question.request->value);
}

std::optional<NodeQuestion> read_node_question(std::string_view text) {
  const std::size_t sign = text.find('=');
  if (sign == std::string_view::npos || sign == 0) return std::nullopt;
  NodeQuestion question{.camera = std::string(text.substr(0, sign)), .request = {}};
  const std::string_view request = text.substr(sign + 1);
  if (request.empty()) return question;
  const std::size_t blank = std::min(request.find(' '), request.size());
  const auto control = std::find_if(kNodeControls.begin(), kNodeControls.end(),
                                    [&](Control each) { return to_string(each) == request.substr(0, blank); });
  const std::string_view digits = request.substr(std::min(blank + 1, request.size()));
  double value = 0;
  const auto [end, failed] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (control == kNodeControls.end() || failed != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  if (!(value >= 0 && value <= kMaxNumber)) return std::nullopt;
  question.request = {*control, value};
  return question;
}

}  // namespace marey::source::live
