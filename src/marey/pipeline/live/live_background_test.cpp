// Background models that saw nothing ahead, on videos of people before a scene that does not keep still.
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "marey/detect/background/background.h"
#include "marey/simulate/people/restless_video.h"

namespace marey::pipeline::live {
namespace {

using detect::background::AdaptiveOptions;
using detect::background::BackgroundOptions;
using detect::background::make_background;
using detect::background::Mog2Options;

double f_of(const marey::simulate::people::Unrest& unrest, const BackgroundOptions& options) {
  marey::simulate::people::RestlessVideoOptions required;
  required.frames = 75;
  required.unrest = unrest;
  const marey::simulate::people::RestlessVideo video(1, required);
  const auto model = make_background(options);
  double hit = 0, marked = 0, people = 0;
  for (int i = 0; i < video.frames(); ++i) {
    const marey::simulate::people::RestlessFrame shown = video.render(i);
    Frame frame;
    frame.index = i;
    frame.time = timestamp_from_seconds(i / video.rate_hz());
    frame.image = shown.image;
    const Foreground detected = model->apply(frame, {});
    const cv::Mat& mask = detected.covered.empty() ? detected.mask : detected.covered;
    hit += cv::countNonZero(mask & shown.people);
    marked += cv::countNonZero(mask);
    people += cv::countNonZero(shown.people);
  }
  return 2 * hit / (marked + people);
}

TEST(LiveBackground, ACameraThatShakesCostsLittleFromTheFirstFrameOn) {
  const double still = f_of({}, AdaptiveOptions{}), shaken = f_of({.jitter_px = 3}, AdaptiveOptions{});
  EXPECT_GT(still, 0.78);
  EXPECT_GT(shaken, still - 0.04);
  EXPECT_GT(shaken, f_of({.jitter_px = 3}, Mog2Options{}) + 0.1);
}

TEST(LiveBackground, CloudsShadowsAreTheSceneInAnotherLight) {
  const double ours = f_of({.clouds = 0.4}, AdaptiveOptions{});
  EXPECT_GT(ours, 0.72);
  EXPECT_GT(ours, f_of({.clouds = 0.4}, Mog2Options{}) + 0.1);
}

}  // namespace
}  // namespace marey::pipeline::live
