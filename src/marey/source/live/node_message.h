// What a camera node and the host that solves say to each other (docs/live.md). Little endian, doubles as IEEE 754.
//
//   a frame    "MRYF" session:u64 sequence:i64 taken_ns:i64 width:u32 height:u32 kind:u8, then
//              kind 0: the image, JPEG, to the end
//              kind 1: count:u32, and for each detection centre, covariance xx xy yy, area, box left top width height, score: f64
//              each
//   an answer  "MRYA" session:u64 now_ns:i64 known:u8 width:u32 height:u32 rate_hz:f64 (0: not known), then the names of all
//              cameras, each with a line break behind it
//   controls   "MRYC" session:u64 allowed:u8 waits:u8 count:u8, and for each which:u8 (0 exposure, 1 gain, 2 threshold) least:f64
//              most:f64 now:f64, then why the last that was asked for was refused, a sentence to the end
//
// What a host asks is text: a camera's name (answer), nothing (the rig as text), NAME= (controls), NAME=exposure 2.5 (set it, then
// controls), frames/NAME (from now on each frame of it; that has no answer). No camera's name has a "=" or a "/", so a node that
// knows nothing of controls answers that it has no such camera. Answers come in the order of the questions, frames among them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/detection.h"
#include "marey/core/time.h"
#include "marey/source/live/camera_controls.h"

namespace marey::source::live {

/// One camera's frame in transit: its image or the detections in it.
struct NodeFrame {
  std::uint64_t session = 0;                              ///< of the node's start: another one counts and times again
  std::int64_t sequence = 0;                              ///< of this camera's frames; what a host does not get is missing
  Timestamp taken{};                                      ///< by the node's clock
  cv::Size size;                                          ///< of the image, px; empty if it is not known
  std::optional<std::vector<Detection>> detections = {};  ///< without outlines and groups
  std::span<const std::uint8_t> jpeg = {};                ///< of the message that it was read from; where there are no detections
};

/// What a node says of a camera to who asks for it by its name.
struct NodeAnswer {
  std::uint64_t session = 0;
  Timestamp now{};                   ///< by the node's clock, while it answered
  bool known = false;                ///< whether it has such a camera
  cv::Size size;                     ///< px; empty until its first image came
  std::optional<double> rate_hz;     ///< where it is known
  std::vector<std::string> cameras;  ///< the names of all that it has
};

/// How a camera of a node is set. None of `has` where it has nothing to be set.
struct NodeControls {
  std::uint64_t session = 0;
  bool allowed = false;           ///< whether hosts may set it
  bool waits = false;             ///< the requested values are not set yet
  std::vector<ControlRange> has;  ///< threshold: where the node finds the markers
  std::string refused;            ///< why the last that was asked for was not taken; empty if it was
};

/// About the controls of a node's camera.
struct NodeQuestion {
  struct ControlRequest {
    Control control{};
    double value = 0;
  };
  std::string camera;
  std::optional<ControlRequest> request;
};

std::string text_of(const NodeQuestion& question);
/// Nothing if it asks for something else, or for a value that is not one.
std::optional<NodeQuestion> read_node_question(std::string_view text);

/// What subscribes to a camera's frames, with its name behind it.
inline constexpr std::string_view kFramesOf = "frames/";
/// Whether a message is a frame, and no answer.
bool is_node_frame(std::string_view message);

std::string message_of(const NodeFrame& frame);
std::string message_of(const NodeAnswer& answer);
std::string message_of(const NodeControls& controls);

/// Throw Error, with `name` of the node, for what is no such message.
NodeFrame read_node_frame(std::string_view message, const std::string& name);
NodeAnswer read_node_answer(std::string_view message, const std::string& name);
/// Nothing if it is an answer: the node knows nothing of controls.
std::optional<NodeControls> read_node_controls(std::string_view message, const std::string& name);

}  // namespace marey::source::live
