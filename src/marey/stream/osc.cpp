// Open Sound Control, for what shows and sounds: TouchDesigner, Max, SuperCollider, scripts. One bundle a frame where it fits.
#include <memory>
#include <utility>

#include <Eigen/Geometry>

#include "marey/stream/osc_message.h"
#include "marey/stream/sender.h"

namespace marey::stream {
namespace {

constexpr std::size_t kMaxBundle = 8192;

class OscProtocol : public UdpProtocol {
 public:
  using UdpProtocol::UdpProtocol;

 protected:
  bool takes_pixels() const override { return true; }
  void send(const Instant& instant, FrameTimes times) override {
    std::vector<std::string> messages;
    messages.push_back(OscMessage("/marey/frame")
                           .i(static_cast<std::int32_t>(instant.index))
                           .d(seconds(instant.time))
                           .h(times.capture)
                           .h(times.solve)
                           .h(times.send)
                           .bytes());
    for (const Sample& sample : instant.samples) {
      const Vector<3>& at = sample.position;
      messages.push_back(OscMessage("/marey/point")
                             .i(number(sample.track))
                             .s(channel_layout().label_of(sample.track))
                             .f(at.x())
                             .f(at.y())
                             .f(at.z())
                             .i(sample.measured() ? 1 : 0)
                             .bytes());
    }
    for (const Body& body : header().bodies) {
      if (const BodyPose* pose = pose_of(instant, body.id)) messages.push_back(message_of(body, *pose));
    }
    put_out(osc_bundles(messages, kMaxBundle));
  }

 private:
  static std::string message_of(const Body& body, const BodyPose& pose) {
    const Vector<3>& at = pose.world_from_body.translation;
    const Eigen::Quaterniond turn(pose.world_from_body.rotation);
    return OscMessage("/marey/body")
        .i(number(body.id))
        .s(body.skeleton.empty() ? body.label : body.skeleton + "/" + body.label)
        .f(at.x())
        .f(at.y())
        .f(at.z())
        .f(turn.x())
        .f(turn.y())
        .f(turn.z())
        .f(turn.w())
        .i(pose.tracked ? 1 : 0)
        .bytes();
  }
};

}  // namespace

StreamProtocol osc_protocol() {
  return {.name = "osc",
          .title = "Open Sound Control over UDP",
          .port = 9000,
          .listens = false,
          .detail = "`/marey/frame` with times, `/marey/point`, `/marey/body`; m (px of images), z up",
          .open = [](const Target& target, const StreamOptions& options) -> std::unique_ptr<ProtocolSink> {
            return std::make_unique<OscProtocol>(target, options);
          }};
}

}  // namespace marey::stream
