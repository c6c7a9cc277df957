#include "marey/detect/blobs/response_mixture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "marey/filter/random_stream.h"
#include "marey/geometry/median.h"

namespace marey::detect::blobs {
namespace {

// Standard deviations of a normal distribution in its median absolute deviation: by definition.
constexpr float kDeviation = 1.4826F;

constexpr double kSecondFraction = 0.25;  // of the frames, in which another thing must be seen at a point to belong to the scene
constexpr float kOutlying = 4;            // standard deviations from the median, from which on it is another thing
constexpr double kShadowFraction = 0.05;  // of a point's time, in which a person's shadow may lie on it
constexpr float kShadowLevel = 0.65F;     // what a shadow leaves of luma, more or less
constexpr float kShadowChroma = 0.8F;     // of chroma's distance from grey
constexpr float kShadowDeviation = 0.12F;
constexpr double kUnknownFraction = 0.1;     // of the foreground, that looks like nothing seen before
constexpr std::size_t kMinResponses = 200;   // responses that a foreground can be learned from
constexpr std::size_t kMaxResponses = 6000;  // of those that are given; numerical: more only cost time
constexpr int kRounds = 12;

struct Middle {
  Response median, sigma;
};

Middle middle_of(std::span<const Response> detected, const Response& noise, std::vector<float>& values) {
  Middle middle;
  for (int i = 0; i < kResponses; ++i) {
    values.clear();
    for (const Response& one : detected) values.push_back(one[i]);
    middle.median[i] = geometry::median(values);
    for (float& value : values) value = std::abs(value - middle.median[i]);
    middle.sigma[i] = std::max(noise[i], kDeviation * geometry::median(values));
  }
  return middle;
}

float squares(const Response& response, const Response& mean, const Response& sigma) {
  float sum = 0;
  for (int i = 0; i < kResponses; ++i) sum += std::pow((response[i] - mean[i]) / sigma[i], 2.0F);
  return sum;
}

/// The same place in a person's shadow.
ResponseKind shadow_on(const Middle& lit) {
  Response mean, sigma;
  for (int i = 0; i < kResponses; ++i) {
    const float grey = i == 1 || i == 2 ? 128.0F : 0.0F;
    mean[i] = grey + (i == 0 || i == 3 ? kShadowLevel : kShadowChroma) * (lit.median[i] - grey);
    sigma[i] = 1.5F * lit.sigma[i] + (i == 0 ? kShadowDeviation * lit.median[0] : i >= 3 ? 2.0F : 1.0F);
  }
  return ResponseKind::of(kShadowFraction, mean, sigma);
}

ResponseKind unknown(double weight) {
  return ResponseKind::of(weight, {110, 128, 128, 0, 0, 0}, {65, 20, 20, 18, 5, 5});
}

/// Beginnings far from each other, chosen with probabilities by squared distance (k-means++: Arthur, Vassilvitskii 2007).
std::vector<Response> beginnings(const std::vector<Response>& points, int count, std::uint64_t seed) {
  filter::RandomStream random(seed);
  std::vector<Response> centres{points[static_cast<std::size_t>(random.uniform() * static_cast<double>(points.size()))]};
  std::vector<double> distance(points.size(), std::numeric_limits<double>::max());
  while (std::ssize(centres) < count) {
    double all = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      distance[i] = std::min(distance[i], static_cast<double>(squares(points[i], centres.back(), Response::all(1))));
      all += distance[i];
    }
    double left = random.uniform() * all;
    std::size_t chosen = 0;
    while (chosen + 1 < points.size() && (left -= distance[chosen]) > 0) ++chosen;
    centres.push_back(points[chosen]);
  }
  return centres;
}

std::size_t nearest_of(const std::vector<Response>& centres, const Response& point) {
  std::size_t nearest = 0;
  float minimum = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < centres.size(); ++i) {
    const float away = squares(point, centres[i], Response::all(1));
    if (away < minimum) minimum = away, nearest = i;
  }
  return nearest;
}

struct Cluster {
  std::array<double, kResponses> sum{}, squared{};
  double count = 0;

  void add(const Response& point) {
    for (int i = 0; i < kResponses; ++i) {
      const auto at = static_cast<std::size_t>(i);
      sum[at] += point[i];
      squared[at] += static_cast<double>(point[i]) * point[i];
    }
    ++count;
  }
  Response mean() const {
    Response result;
    for (int i = 0; i < kResponses; ++i) result[i] = static_cast<float>(sum[static_cast<std::size_t>(i)] / count);
    return result;
  }
  Response sigma() const {
    Response result;
    for (int i = 0; i < kResponses; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double mean = sum[at] / count;
      result[i] = static_cast<float>(std::sqrt(std::max(9.0, squared[at] / count - mean * mean)));
    }
    return result;
  }
};

std::vector<Cluster> clusters_of(const std::vector<Response>& points, const std::vector<Response>& centres) {
  std::vector<Cluster> clusters(centres.size());
  for (const Response& point : points) clusters[nearest_of(centres, point)].add(point);
  return clusters;
}

}  // namespace

ResponseKind ResponseKind::of(double weight, const Response& mean, const Response& sigma) {
  ResponseKind kind;
  kind.mean = mean;
  double log_scale = std::log(weight) - 0.5 * kResponses * std::log(2 * std::numbers::pi);
  for (int i = 0; i < kResponses; ++i) {
    kind.precision[i] = 1 / (sigma[i] * sigma[i]);
    log_scale -= std::log(sigma[i]);
  }
  kind.log_scale = static_cast<float>(log_scale);
  return kind;
}

float ResponseKind::log_density(const Response& response) const {
  float sum = 0;
  for (int i = 0; i < kResponses; ++i) {
    const float off = response[i] - mean[i];
    sum += off * off * precision[i];
  }
  return log_scale - 0.5F * sum;
}

float log_density(std::span<const ResponseKind> mixture, const Response& response) {
  float maximum = -std::numeric_limits<float>::max(), sum = 0;
  for (const ResponseKind& kind : mixture) {
    const float one = kind.log_density(response);
    if (one > maximum) {
      sum = sum * std::exp(maximum - one) + 1;
      maximum = one;
    } else if (one > maximum - 15) {
      sum += std::exp(one - maximum);
    }
  }
  return maximum + std::log(sum);
}

std::vector<ResponseKind> learn_foreground(std::span<const Response> responses, int kinds, std::uint64_t seed) {
  if (responses.size() < kMinResponses) return {unknown(1)};
  std::vector<Response> points;
  const std::size_t every = (responses.size() + kMaxResponses - 1) / kMaxResponses;
  for (std::size_t i = 0; i < responses.size(); i += every) points.push_back(responses[i]);
  std::vector<Response> centres = beginnings(points, kinds, seed);
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<Cluster> clusters = clusters_of(points, centres);
    for (std::size_t i = 0; i < centres.size(); ++i) {
      if (clusters[i].count > 0) centres[i] = clusters[i].mean();
    }
  }
  std::vector<ResponseKind> mixture{unknown(kUnknownFraction)};
  for (const Cluster& cluster : clusters_of(points, centres)) {
    if (cluster.count < 5) continue;
    const double fraction = cluster.count / static_cast<double>(points.size());
    mixture.push_back(ResponseKind::of((1 - kUnknownFraction) * fraction, cluster.mean(), cluster.sigma()));
  }
  return mixture;
}

PointBackground::PointBackground(std::span<const Response> detected, const Response& noise) {
  std::vector<float> values;
  const Middle typical = middle_of(detected, noise, values);
  std::vector<Response> others;
  for (const Response& one : detected) {
    if (squares(one, typical.median, typical.sigma) > kResponses * kOutlying * kOutlying) others.push_back(one);
  }
  const double second = static_cast<double>(others.size()) / static_cast<double>(detected.size());
  const bool two = second >= kSecondFraction;
  const double lit = 1 - kShadowFraction;
  kinds_[count_++] = ResponseKind::of(two ? lit * (1 - second) : lit, typical.median, typical.sigma);
  kinds_[count_++] = shadow_on(typical);
  if (!two) return;
  const Middle other = middle_of(others, noise, values);
  kinds_[count_++] = ResponseKind::of(lit * second, other.median, other.sigma);
}

float PointBackground::distance(const Response& response) const {
  float minimum = std::numeric_limits<float>::max();
  for (std::size_t k = 0; k < count_; ++k) {
    float sum = 0;
    for (int i = 0; i < kResponses; ++i) sum += std::pow(response[i] - kinds_[k].mean[i], 2.0F) * kinds_[k].precision[i];
    minimum = std::min(minimum, sum);
  }
  return std::sqrt(minimum / kResponses);
}

Response response_noise(std::span<const cv::Mat> detected) {
  constexpr int kEvery = 7;  // of the points, numerical, time against precision: enough for a median
  Response noise;
  std::array<std::vector<float>, kResponses> deviations;
  std::vector<Response> of_point;
  std::vector<float> values;
  const cv::Size size = detected.front().size();
  for (int at = 0; at < size.area(); at += kEvery) {
    of_point.clear();
    for (const cv::Mat& grid : detected) of_point.push_back(grid.at<Response>(at / size.width, at % size.width));
    const Middle middle = middle_of(of_point, Response::all(0), values);
    for (int i = 0; i < kResponses; ++i) deviations[static_cast<std::size_t>(i)].push_back(middle.sigma[i]);
  }
  for (int i = 0; i < kResponses; ++i) {
    noise[i] = std::max(i < 3 ? 1.0F : 0.5F, geometry::median(deviations[static_cast<std::size_t>(i)]));
  }
  return noise;
}

}  // namespace marey::detect::blobs
