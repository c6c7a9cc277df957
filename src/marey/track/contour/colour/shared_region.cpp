// Each pixel shows the nearest member that covers it, or the ground. The prior that it shows member k is p_k ∏ (1 − p_j) over all
// nearer j, with p the chance that k covers it: a sigmoid of the distance to its predicted outline, mixed with how often it covers
// the place. The likelihood of the pixel's colour comes from each member's own histograms by height on its body, and for the ground
// from the pixels next to the region; the foreground mask counts as weak evidence, for it runs on halos. Places are found first,
// by trying shifts of one member after the other for the largest likelihood of the whole patch, and with them the order of two
// whose feet are about equally low. The division is then made smooth by mean field in a Potts model (Blake, Kohli & Rother, "Markov
// Random Fields for Vision and Image Processing", 2011, ch. 5), where each pixel's neighbours vote. Cost: cells × members × (tries
// / 4 + rounds).
#include "marey/track/contour/colour/shared_region.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include <opencv2/imgproc.hpp>
#include <tbb/parallel_for.h>

#include "marey/track/contour/colour/body_mask.h"
#include "marey/track/contour/colour/body_share.h"
#include "marey/track/contour/colour/ground_likelihood.h"
#include "marey/track/contour/colour/neighbour_votes.h"

namespace marey::track::contour::colour {
namespace {

constexpr double kEdgeSoftness = 0.03;  // heights, of a predicted outline
constexpr float kFarSteps = 12;         // of that softness, beyond which the edge's sigmoid is 0 or 1 to 1e-5; numerical
constexpr float kMinChance = 0.004F;    // that a member covers a pixel, or does not
constexpr double kTempered = 0.5;       // exponent of likelihoods: neighbouring pixels err alike
constexpr float kVote = 8;              // of all neighbours together, in log-odds
constexpr int kVotingRounds = 5;
constexpr double kLargeStep = 0.1, kMiddleStep = 0.05, kSmallStep = 0.02;  // heights, of the search for a place
constexpr int kSteps = 3;                                                  // of each size, at most
constexpr double kShiftAmbiguity = 0.12;                                   // heights, standard deviation of a predicted place
constexpr double kFootAmbiguity = 0.03;                                    // heights by which feet are misjudged
constexpr double kUndecided = 0.1;                                         // heights between feet, below which colours have a say

class RegionDivision {
 public:
  RegionDivision(const ColourPatch& patch, std::span<RegionMember> members) : patch_(patch), members_(members) {
    inspect_ground();
    find_bins();
    chances_.resize(members.size());
    likelihoods_.resize(members.size());
    prepared_.resize(members.size());
    for (RegionMember& member : members) member.shift = member.shifts.front();
    prepare_all();
    order_by_feet();
  }

  void find_positions() {
    for (const double step : {kLargeStep, kMiddleStep, kSmallStep}) {
      for (int round = 0; round < kSteps; ++round) {
        bool moved = false;
        for (const int k : order_) moved = try_about(k, step, step == kLargeStep && round == 0) || moved;
        if (!moved) break;
      }
    }
    prepare_all();  // colours where each body that was moved was found to be
    decide_order();
  }

  void divide() {
    std::vector<cv::Mat> odds(members_.size() + 1);
    for (cv::Mat& one : odds) one.create(patch_.size(), CV_32FC1);
    cv::Mat left(patch_.size(), CV_32FC1, cv::Scalar(1));
    for (const int k : order_) {
      find_log_odds(left.mul(chances_[k]), likelihoods_[k], odds[k]);
      left = left.mul(1 - chances_[k]);
    }
    find_log_odds(left, ground_, odds.back());
    for (std::size_t k = 0; k < members_.size(); ++k) add_network(members_[k], odds[k]);
    const NeighbourVotes neighbours(patch_, ground_colours_);
    hand_out(by_votes(odds, neighbours));
  }

  const cv::Mat& ground_colours() const { return ground_colours_; }

 private:
  /// A network's mask of a member is one more likelihood of its cells.
  static void add_network(const RegionMember& member, cv::Mat& odds) {
    if (member.network.empty()) return;
    for (int y = 0; y < odds.rows; ++y) {
      const float* chance = member.network.ptr<float>(y);
      float* sum = odds.ptr<float>(y);
      for (int x = 0; x < odds.cols; ++x) sum[x] += static_cast<float>(kTempered) * evidence_of(chance[x]);
    }
  }

  /// Mean field: every cell's chances, given its neighbours'.
  static std::vector<cv::Mat> by_votes(const std::vector<cv::Mat>& odds, const NeighbourVotes& neighbours) {
    const std::size_t labels = odds.size();
    const int cells = static_cast<int>(odds.front().total());
    std::vector<cv::Mat> votes(labels), fractions(labels);
    for (cv::Mat& one : fractions) one.create(odds.front().size(), CV_32FC1);
    cv::Mat maximum(odds.front().size(), CV_32FC1), sum(odds.front().size(), CV_32FC1);
    float *most = maximum.ptr<float>(), *all = sum.ptr<float>();
    for (int round = 0; round <= kVotingRounds; ++round) {
      odds.front().copyTo(maximum);
      for (std::size_t l = 0; l < labels; ++l) {
        auto* value = fractions[l].ptr<float>();
        const float *own = odds[l].ptr<float>(), *vote = round > 0 ? votes[l].ptr<float>() : nullptr;
        for (int i = 0; i < cells; ++i) {
          value[i] = vote != nullptr ? own[i] + kVote * vote[i] : own[i];
          most[i] = std::max(most[i], value[i]);
        }
      }
      sum.setTo(0);
      for (cv::Mat& fraction : fractions) {
        auto* value = fraction.ptr<float>();
        for (int i = 0; i < cells; ++i) value[i] -= most[i];
        cv::exp(fraction, fraction);
        for (int i = 0; i < cells; ++i) all[i] += value[i];
      }
      tbb::parallel_for(std::size_t{0}, labels, [&](std::size_t l) {
        auto* value = fractions[l].ptr<float>();
        for (int i = 0; i < cells; ++i) value[i] /= all[i];
        if (round < kVotingRounds) votes[l] = neighbours.of(fractions[l]);
      });
    }
    return fractions;
  }

  /// log(prior likelihood^kTempered), with one logarithm.
  static void find_log_odds(const cv::Mat& prior, const cv::Mat& likelihood, cv::Mat& odds) {
    static_assert(kTempered == 0.5);
    cv::sqrt(likelihood, odds);
    cv::multiply(odds, prior, odds);
    cv::log(odds, odds);
  }

  void inspect_ground() {
    cv::Mat taken = patch_.mask.clone();
    double height = 0;
    for (const RegionMember& member : members_) {
      cv::max(taken, cells_within(member.polygon, patch_), taken);
      height = std::max(height, member.height);
    }
    ground_colours_ = ground_next_to(patch_, taken, height);
    ground_ = marey::track::contour::colour::ground_likelihood(patch_, ground_colours_);
  }

  void find_bins() {
    bins_.create(patch_.size(), CV_16UC1);
    for (int y = 0; y < bins_.rows; ++y) {
      const auto* colour = patch_.colour.ptr<cv::Vec3f>(y);
      auto* bin = bins_.ptr<std::uint16_t>(y);
      for (int x = 0; x < bins_.cols; ++x) bin[x] = static_cast<std::uint16_t>(BodyModel::bin_of(colour[x]));
    }
  }

  void prepare_all() {
    tbb::parallel_for(std::size_t{0}, members_.size(), [&](std::size_t k) { prepare(k); });
  }

  /// How deep inside a polygon each cell is, in cells; outside of it, less than 0: CV_32FC1.
  cv::Mat depth_in(std::span<const Vector<2>> polygon) const {
    const cv::Mat within = cells_within(polygon, patch_);
    cv::Mat inside, outside, depth, distance;
    within.convertTo(inside, CV_8U, 255);
    outside = 255 - inside;
    cv::distanceTransform(inside, depth, cv::DIST_L2, 3);
    cv::distanceTransform(outside, distance, cv::DIST_L2, 3);
    return depth - distance;
  }

  /// The chance that member k covers each cell, where it is now; and the likelihood of each cell's colour if so.
  void prepare(std::size_t k) {
    const RegionMember& member = members_[k];
    if (prepared_[k] == member.shift) return;
    prepared_[k] = member.shift;
    std::vector<Vector<2>> shifted = member.polygon;
    for (Vector<2>& corner : shifted) corner += member.shift;
    const cv::Mat depth = depth_in(shifted);
    const auto softness = static_cast<float>(std::max(0.7, kEdgeSoftness * member.height / patch_.step));
    const auto typical = static_cast<float>(member.typical);
    const Vector<2> centre = member.centre + member.shift;
    cv::Mat& chance = chances_[k];
    cv::Mat& likelihood = likelihoods_[k];
    chance.create(patch_.size(), CV_32FC1);
    likelihood.create(patch_.size(), CV_32FC1);
    const auto location = [&](int x, int y) { return Vector<2>((patch_.pixel(Vector<2>(x, y)) - centre) / member.height); };
    std::vector<BodyModel::CoveragePosition> columns;
    for (int x = 0; x < chance.cols; ++x) columns.push_back(BodyModel::column_at(location(x, 0).x()));
    const BodyModel::CoveragePosition* const column = columns.data();
    for (int y = 0; y < chance.rows; ++y) {
      const double down = location(0, y).y();
      const BodyModel::CoveragePosition row = BodyModel::row_at(down);
      const BodyModel::Bands bands = member.body->bands_at(down);
      const float *deep = depth.ptr<float>(y), *mask = patch_.mask.ptr<float>(y);
      const auto* bin = bins_.ptr<std::uint16_t>(y);
      float *covers = chance.ptr<float>(y), *goes_with = likelihood.ptr<float>(y);
      for (int x = 0; x < chance.cols; ++x) covers[x] = std::clamp(-deep[x] / softness, -kFarSteps, kFarSteps);
      cv::exp(chance.row(y), chance.row(y));
      for (int x = 0; x < chance.cols; ++x) {
        const float shape = 1 / (1 + covers[x]), known = member.body->coverage(column[x], row);
        covers[x] = std::clamp((1 - typical) * shape + typical * known, kMinChance, 1 - kMinChance);
        goes_with[x] = BodyModel::density(bands, bin[x]) * mask_chance_on_body(mask[x]);
      }
    }
  }

  void order_by_feet() {
    order_.clear();
    for (std::size_t k = 0; k < members_.size(); ++k) order_.push_back(static_cast<int>(k));
    std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) { return members_[a].foot > members_[b].foot; });
  }

  /// Of the whole patch, every second cell in each direction, in nats.
  double log_likelihood() const { return log_likelihood_if(-1, Vector<2>::Zero()); }

  /// The same with member k moved to another shift, its colours staying; −1: none. A cell's likelihood is more than 1e-15, so that
  /// a product of kFactors is far from the smallest number.
  double log_likelihood_if(int k, const Vector<2>& shift) const {
    constexpr int kFactors = 16;  // numerical
    const cv::Point by = k < 0 ? cv::Point(0, 0) : whole_cells(shift - members_[k].shift);
    const int width = (patch_.size().width + 1) / 2;
    std::vector<float> rows(2 * static_cast<std::size_t>(width));
    float *left = rows.data(), *all = left + width;
    double sum = 0, product = 1;
    int factors = 0;
    for (int y = 0; y < patch_.size().height; y += 2) {
      std::fill(left, left + width, 1.0F);
      std::fill(all, all + width, 0.0F);
      for (const int j : order_) add_member(j, y, j == k ? by : cv::Point(0, 0), left, all);
      const float* ground = ground_.ptr<float>(y);
      for (int i = 0; i < width; ++i) {
        product *= all[i] + left[i] * ground[2 * i];
        if (++factors < kFactors) continue;
        sum += std::log(product);
        product = 1;
        factors = 0;
      }
    }
    sum += std::log(product);
    double penalty = 0;
    for (int j = 0; j < std::ssize(members_); ++j) {
      const Vector<2> off = (j == k ? shift : members_[j].shift) - members_[j].shifts.front();
      penalty += off.squaredNorm() / std::pow(kShiftAmbiguity * members_[j].height, 2);
    }
    return kTempered * sum - 0.5 * penalty;
  }

  /// What a member adds to the likelihood of every second cell of a row, moved by whole cells, and what it leaves to those behind.
  void add_member(int j, int y, const cv::Point& by, float* left, float* all) const {
    const int width = patch_.size().width, from = y - by.y;
    const float* likelihood = likelihoods_[j].ptr<float>(y);
    const float* chance = from >= 0 && from < patch_.size().height ? chances_[j].ptr<float>(from) : nullptr;
    // Cells `begin` to `end` of the row, of every second one, come from within the patch.
    const int count = (width + 1) / 2, begin = chance != nullptr ? std::clamp((by.x + 1) / 2, 0, count) : count,
              end = chance != nullptr ? std::clamp((by.x + width + 1) / 2, begin, count) : count;
    const auto add = [&](int i, float own) {
      all[i] += left[i] * own * likelihood[2 * i];
      left[i] *= 1 - own;
    };
    for (int i = 0; i < begin; ++i) add(i, kMinChance);
    for (int i = begin; i < end; ++i) add(i, chance[2 * i - by.x]);
    for (int i = end; i < count; ++i) add(i, kMinChance);
  }

  /// One member at four places about where it is, and where else it may be; whether another place is better. Its colours are taken
  /// to stay: they change slowly from head to foot.
  bool try_about(int k, double step, bool elsewhere) {
    RegionMember& member = members_[k];
    const Vector<2> from = member.shift;
    const double length = std::max(1.0, std::round(step * member.height / patch_.step)) * patch_.step;
    std::vector<Vector<2>> shifts{from};
    for (const Vector<2>& direction : {Vector<2>(1, 0), Vector<2>(-1, 0), Vector<2>(0, 1), Vector<2>(0, -1)}) {
      shifts.push_back(from + length * direction);
    }
    if (elsewhere) shifts.insert(shifts.end(), member.shifts.begin() + 1, member.shifts.end());
    std::vector<double> values(shifts.size());
    tbb::parallel_for(std::size_t{0}, shifts.size(), [&](std::size_t i) { values[i] = log_likelihood_if(k, shifts[i]); });
    const auto best = std::max_element(values.begin(), values.end()) - values.begin();  // the first of several
    if (best == 0) return false;
    chances_[k] = moved(chances_[k], whole_cells(shifts[best] - from), kMinChance);
    member.shift = shifts[best];
    return true;
  }

  cv::Point whole_cells(const Vector<2>& pixels) const {
    return {static_cast<int>(std::lround(pixels.x() / patch_.step)), static_cast<int>(std::lround(pixels.y() / patch_.step))};
  }

  /// By whole cells; what comes in has this value.
  static cv::Mat moved(const cv::Mat& values, const cv::Point& shift, float beyond) {
    cv::Mat result(values.size(), CV_32FC1, cv::Scalar(beyond));
    const cv::Rect all({0, 0}, values.size()), to = (all + shift) & all;
    if (!to.empty()) values(to - shift).copyTo(result(to));
    return result;
  }

  /// Two whose feet are about equally low are tried vice versa.
  void decide_order() {
    for (std::size_t i = 0; i + 1 < order_.size(); ++i) {
      const RegionMember& front = members_[order_[i]];
      const RegionMember& back = members_[order_[i + 1]];
      const double apart = (front.foot - back.foot) / (0.5 * (front.height + back.height));
      if (apart > kUndecided) continue;
      const double as_it_is = log_likelihood() + apart / kFootAmbiguity;
      std::swap(order_[i], order_[i + 1]);
      if (log_likelihood() <= as_it_is) std::swap(order_[i], order_[i + 1]);
    }
  }

  void hand_out(const std::vector<cv::Mat>& fractions) {
    cv::Mat nearer = cv::Mat::zeros(patch_.size(), CV_32FC1);
    std::vector<int> before;
    for (const int k : order_) {
      RegionMember& member = members_[k];
      member.detected = fractions[k];
      member.whole = fractions[k].clone();
      double hidden = 0, detected = 0;
      for (int y = 0; y < nearer.rows; ++y) {
        for (int x = 0; x < nearer.cols; ++x) {
          const float part = chances_[k].at<float>(y, x) > 0.5F ? nearer.at<float>(y, x) : 0;
          member.whole.at<float>(y, x) = std::min(1.0F, member.whole.at<float>(y, x) + part);
          hidden += part;
          detected += fractions[k].at<float>(y, x);
        }
      }
      member.visible = detected + hidden > 0 ? detected / (detected + hidden) : 0;
      member.behind.clear();
      for (const int j : before) {
        const cv::Mat both = members_[j].detected.mul(chances_[k]);
        if (cv::sum(both)[0] > 0.02 * (detected + hidden)) member.behind.push_back(j);
      }
      before.push_back(k);
      nearer += fractions[k];
    }
  }

  const ColourPatch& patch_;
  std::span<RegionMember> members_;
  cv::Mat ground_colours_;                          // CV_32FC3
  cv::Mat ground_;                                  // likelihood of each cell's colour, if it is ground
  std::vector<cv::Mat> chances_, likelihoods_;      // by member
  std::vector<std::optional<Vector<2>>> prepared_;  // the shift that these are of
  cv::Mat bins_;                                    // CV_16UC1: of each cell's colour, in a body's histograms
  std::vector<int> order_;                          // nearest first
};

}  // namespace

cv::Mat divide_region(const ColourPatch& patch, std::span<RegionMember> members) {
  if (members.empty() || patch.colour.empty()) return {};
  RegionDivision division(patch, members);
  division.find_positions();
  division.divide();
  return division.ground_colours();
}

}  // namespace marey::track::contour::colour
