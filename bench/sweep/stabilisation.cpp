// How well images of a shaking camera are brought to its rest: simulated videos of a crowd whose camera's motion is known,
// registered by marey's standing scene, and beside it by two naive peers: Lucas & Kanade from each image to the next with
// OpenCV's estimateAffinePartial2D, added up; and OpenCV's findTransformECC (Euclidean, images of half the size) against the
// first image. Prints the distance in px between where 25 places of the rest are put and where they are, less its mean over the
// video (a rest that lies elsewhere is not an error of registration), and what each costs an image of one core's time.
//
//   steady SHAKE_PX SEED IMAGES [SHAKE_PX SEED IMAGES …]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/core.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "marey/simulate/people/people_video.h"
#include "marey/source/stabilise/stabiliser.h"

namespace marey {
namespace {

using source::stabilise::PinholeView;
using source::stabilise::ReferenceScene;

struct SweepVideo {
  std::vector<Frame> frames;
  std::vector<Matrix<3>> truth;  // pixels at rest to pixels of the frame
};

SweepVideo video_of(double shake_px, std::uint64_t seed, int images) {
  simulate::people::PeopleVideoOptions options;
  options.size = {1280, 720};
  options.height_px = 90;
  options.frames = images;
  options.shake_px = shake_px;
  const simulate::people::PeopleVideo video(simulate::people::PeopleSituation::crowd, seed, options);
  const PinholeView view{video.camera().focal, Vector<2>(options.size.width - 1, options.size.height - 1) / 2};
  SweepVideo result;
  for (int i = 0; i < video.frames(); ++i) {
    Frame frame;
    frame.index = i;
    frame.time = timestamp_from_seconds(i / options.rate_hz);
    frame.image = video.render(i).image;
    result.frames.push_back(std::move(frame));
    result.truth.push_back(moved_from_rest({video.turn(i), 0}, view));
  }
  return result;
}

/// From pixels of its reference to those of each image; nothing if the method gave up.
using Registered = std::vector<std::optional<Matrix<3>>>;

Matrix<3> matrix_of(const cv::Mat& affine) {
  Matrix<3> result = Matrix<3>::Identity();
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 3; ++column)
      result(row, column) = affine.depth() == CV_32F ? affine.at<float>(row, column) : affine.at<double>(row, column);
  }
  return result;
}

Registered by_scene(const SweepVideo& video) {
  std::vector<Image> samples;
  const std::size_t step = std::max<std::size_t>(1, std::min<std::size_t>(300, video.frames.size()) / 30);
  for (std::size_t i = 0; i < video.frames.size() && samples.size() < 30; i += step) samples.push_back(video.frames[i].image);
  ReferenceScene scene(video.frames.front().image.size(), std::nullopt);
  Registered found;
  if (!scene.learn(samples)) return Registered(video.frames.size());
  for (const Frame& frame : video.frames) {
    const auto motion = scene.find(frame.image);
    found.push_back(motion ? std::optional(moved_from_rest(*motion, scene.view())) : std::nullopt);
  }
  return found;
}

Registered by_adding_up(const SweepVideo& video) {
  Registered found{Matrix<3>::Identity().eval()};
  for (std::size_t i = 1; i < video.frames.size(); ++i) {
    const cv::Mat& before = video.frames[i - 1].image.luma();
    std::vector<cv::Point2f> from, to, a, b;
    std::vector<unsigned char> status;
    std::vector<float> error;
    cv::goodFeaturesToTrack(before, from, 240, 0.01, 10);
    if (from.size() >= 4) cv::calcOpticalFlowPyrLK(before, video.frames[i].image.luma(), from, to, status, error);
    for (std::size_t k = 0; k < status.size(); ++k) {
      if (status[k] != 0) a.push_back(from[k]), b.push_back(to[k]);
    }
    const cv::Mat step = a.size() >= 4 ? cv::estimateAffinePartial2D(a, b) : cv::Mat();
    found.emplace_back(step.empty() ? *found.back() : matrix_of(step) * *found.back());
  }
  return found;
}

Registered by_ecc(const SweepVideo& video) {
  const auto half = [](const Frame& frame) {
    cv::Mat small;
    cv::resize(frame.image.luma(), small, {}, 0.5, 0.5, cv::INTER_AREA);
    return small;
  };
  const cv::Mat first = half(video.frames.front());
  cv::Mat by = cv::Mat::eye(2, 3, CV_32F);
  Registered found;
  Matrix<3> doubled = Matrix<3>::Identity();
  doubled << 2, 0, 0.5, 0, 2, 0.5, 0, 0, 1;
  for (const Frame& frame : video.frames) {
    try {
      cv::findTransformECC(first, half(frame), by, cv::MOTION_EUCLIDEAN,
                           {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 30, 1e-4}, cv::noArray(), 5);
      found.emplace_back(doubled * matrix_of(by) * doubled.inverse());
    } catch (const cv::Exception&) {
      found.emplace_back(std::nullopt);
      by = cv::Mat::eye(2, 3, CV_32F);
    }
  }
  return found;
}

struct Errors {
  double median = 0, majority_of = 0, largest = 0;
  int lost = 0;
};

Errors errors_of(const SweepVideo& video, const Registered& found) {
  const cv::Size size = video.frames.front().image.size();
  std::vector<double> all;
  Errors errors;
  for (int location = 0; location < 25; ++location) {
    const Vector<2> at(size.width * (0.1 + 0.2 * (location % 5)), size.height * (0.1 + 0.2 * (location / 5)));
    std::vector<Vector<2>> off;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (!found[i]) continue;
      const Matrix<3> left = video.truth[i].inverse() * *found[i];
      off.push_back((left * at.homogeneous()).hnormalized() - at);
    }
    Vector<2> mean = Vector<2>::Zero();
    for (const Vector<2>& each : off) mean += each / static_cast<double>(off.size());
    for (const Vector<2>& each : off) all.push_back((each - mean).norm());
  }
  for (const auto& each : found) errors.lost += each ? 0 : 1;
  if (all.empty()) return errors;
  std::sort(all.begin(), all.end());
  errors.median = all[all.size() / 2], errors.majority_of = all[all.size() * 95 / 100], errors.largest = all.back();
  return errors;
}

void print_row(const SweepVideo& video, const std::string& name, const std::function<Registered(const SweepVideo&)>& method) {
  const std::clock_t begin = std::clock();  // of the processor, so that a busy machine does not matter
  const Registered found = method(video);
  const double ms = 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  const Errors errors = errors_of(video, found);
  fmt::print("  {:28} median {:6.3f}  95 % {:7.3f}  largest {:7.3f} px   lost {:3}   {:6.1f} ms an image\n", name, errors.median,
             errors.majority_of, errors.largest, errors.lost, ms / static_cast<double>(video.frames.size()));
}

/// The whole of it, for its cost alone: found, and brought to the rest.
Registered stabilised(const SweepVideo& video) {
  source::stabilise::Stabiliser steadier(ReferenceScene(video.frames.front().image.size(), std::nullopt),
                                         std::make_shared<source::stabilise::StabilisationLog>());
  for (const Frame& frame : video.frames) steadier.stabilised(frame);
  return Registered(video.frames.size());
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  using namespace marey;
  if (argc < 4) return 2;
  cv::setNumThreads(1);
  for (int i = 1; i + 2 < argc; i += 3) {
    const SweepVideo video =
        video_of(std::strtod(argv[i], nullptr), std::strtoull(argv[i + 1], nullptr, 10), std::atoi(argv[i + 2]));
    fmt::print("shake {} px, seed {}, {} images\n", argv[i], argv[i + 1], video.frames.size());
    print_row(video, "standing scene", by_scene);
    print_row(video, "image to image, added up", by_adding_up);
    print_row(video, "ECC against the first", by_ecc);
    print_row(video, "(standing scene and warp)", stabilised);
    std::fflush(stdout);
  }
  return 0;
}
