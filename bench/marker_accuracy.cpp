// How well the centre of a rendered disc is found: the detector beside the centroids that others use, and the Cramér-Rao bound.
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include <Eigen/LU>
#include <fmt/core.h>

#include "marey/detect/markers/marker_detector.h"
#include "marey/simulate/markers/discs.h"

namespace {

using namespace marey;

constexpr double kBackground = 12;
constexpr double kLevel = 202;
constexpr double kThreshold = 107;  // of the centroids: half the height

struct Errors {
  double squares = 0;
  int count = 0;
  void add(const Vector<2>& error) { squares += error.squaredNorm(), count += 2; }
  double rms() const { return count > 0 ? std::sqrt(squares / count) : NAN; }
};

/// The centroid of the pixels above a threshold round a place; weighted by what they are above it, or not.
Vector<2> centroid(const cv::Mat& image, const Vector<2>& near, double reach, bool weighted) {
  double sum = 0;
  Vector<2> time_step = Vector<2>::Zero();
  const int r = static_cast<int>(std::ceil(reach));
  const int cx = static_cast<int>(std::lround(near.x())), cy = static_cast<int>(std::lround(near.y()));
  for (int y = cy - r; y <= cy + r; ++y) {
    for (int x = cx - r; x <= cx + r; ++x) {
      const double height = image.at<std::uint8_t>(y, x) - kThreshold;
      if (height <= 0) continue;
      const double weight = weighted ? height : 1;
      sum += weight;
      time_step += weight * Vector<2>(x, y);
    }
  }
  return time_step / sum;
}

struct Row {
  double radius, noise, must, goal;
  double blur = 0.55;
};

void measure(const Row& row, int samples) {
  constexpr int kGrid = 10;
  const int pitch = static_cast<int>(2 * row.radius + 20);
  const int bins = 10;
  std::mt19937_64 random(20240607);
  std::uniform_real_distribution<double> phase(-0.5, 0.5);
  Errors plain, weighted, ours;
  double normalised = 0;
  int missed = 0, extra = 0;
  std::vector<Vector<2>> bias(2 * bins, Vector<2>::Zero());  // sum of errors and count, by the place within the pixel
  detect::markers::MarkerDetector detector;
  for (int image_index = 0; image_index * kGrid * kGrid < samples; ++image_index) {
    cv::Mat clean(pitch * kGrid, pitch * kGrid, CV_32FC1, cv::Scalar(kBackground));
    std::vector<simulate::markers::Disc> discs;
    for (int i = 0; i < kGrid * kGrid; ++i) {
      const Vector<2> centre(i % kGrid * pitch + pitch / 2 + phase(random), i / kGrid * pitch + pitch / 2 + phase(random));
      discs.push_back({centre, row.radius, kLevel, row.blur});
    }
    simulate::markers::draw_discs(clean, discs);
    const cv::Mat image = simulate::markers::expose(clean, row.noise, 1000 + image_index);
    Frame frame;
    frame.index = image_index;
    frame.image = Image(image);
    const auto found = detector.detect(frame, {}).detections;
    extra += static_cast<int>(found.size());
    for (const simulate::markers::Disc& disc : discs) {
      plain.add(centroid(image, disc.centre, row.radius + 4, false) - disc.centre);
      weighted.add(centroid(image, disc.centre, row.radius + 4, true) - disc.centre);
      const Detection* best = nullptr;
      for (const Detection& d : found) {
        if (!best || (d.centre - disc.centre).norm() < (best->centre - disc.centre).norm()) best = &d;
      }
      if (!best || (best->centre - disc.centre).norm() > 1) {
        ++missed;
        continue;
      }
      --extra;
      const Vector<2> error = best->centre - disc.centre;
      ours.add(error);
      normalised += error.dot(best->covariance->inverse() * error);
      for (int axis = 0; axis < 2; ++axis) {
        const double within = disc.centre[axis] - std::floor(disc.centre[axis] + 0.5) + 0.5;
        bias[axis * bins + std::min(bins - 1, static_cast<int>(within * bins))] += Vector<2>(error[axis], 1);
      }
    }
  }
  double worst = 0;
  for (const auto& bin : bias) worst = std::max(worst, std::abs(bin.x() / std::max(1.0, bin.y())));
  const simulate::markers::Disc disc{{0, 0}, row.radius, kLevel, row.blur};
  fmt::print("{:6.1f} {:5.2f} {:5.1f} | {:9.4f} {:9.4f} | {:8.4f} {:8.4f} | {:6.3f} {:6.3f} | {:7.4f} | {:6.2f} | {:4} {:4}\n",
             row.radius, row.blur, row.noise, plain.rms(), weighted.rms(), ours.rms(),
             simulate::markers::disc_centre_bound(disc, kBackground, row.noise), row.must, row.goal, worst,
             normalised / (ours.count / 2.0), missed, extra);
}

}  // namespace

int main(int argc, char** argv) {
  const int samples = argc > 1 ? std::atoi(argv[1]) : 3000;
  fmt::print(
      "{} discs a row; RMS in px per axis; bias: worst mean error over ten places within the pixel; NEES: 2 where the covariance\n"
      "is right; the centroids know where to look and use threshold {}\n\n",
      samples, kThreshold);
  fmt::print("radius  blur noise | unweighted weighted | detector   bound |   must   goal |    bias |   NEES | lost false\n");
  for (const Row& row : {Row{1, 3, 0.050, 0.035}, Row{2, 1, 0.012, 0.008}, Row{2, 3, 0.030, 0.025}, Row{3, 3, 0.020, 0.016}})
    measure(row, samples);
  fmt::print("\nother discs, without a target\n");
  for (const Row& row :
       {Row{0.6, 1, NAN, NAN}, Row{1, 1, NAN, NAN}, Row{5, 3, NAN, NAN}, Row{10, 3, NAN, NAN}, Row{20, 3, NAN, NAN},
        Row{2, 3, NAN, NAN, 1.0}, Row{3, 3, NAN, NAN, 2.0}, Row{2, 8, NAN, NAN}, Row{3, 0, NAN, NAN, 0.3}}) {
    measure(row, samples / 5);
  }
}
