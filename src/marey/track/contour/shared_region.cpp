// Each pixel shows the nearest member that covers it, or the ground. The prior that it shows member k is p_k ∏ (1 − p_j) over all
// nearer j, with p the chance that k covers it: a sigmoid of the distance to its predicted outline, mixed with how often it covers
// the place. The likelihood of the pixel's colour comes from each member's own histograms by height on its body, and for the ground
// from the pixels next to the region; the foreground mask counts as weak evidence, for it runs on halos. Places are found first,
// by trying shifts of one member after the other for the largest likelihood of the whole patch, and with them the order of two
// whose feet are about equally low. The division is then made smooth by mean field in a Potts model (Blake, Kohli & Rother, "Markov
// Random Fields for Vision and Image Processing", 2011, ch. 5), where each pixel's neighbours vote. Cost: cells × members × (tries
// / 4 + rounds).
#include "marey/track/contour/shared_region.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "marey/track/contour/body_mask.h"
#include "marey/track/contour/body_share.h"
#include "marey/track/contour/ground_likelihood.h"
#include "marey/track/contour/neighbour_votes.h"

namespace marey::track::contour {
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
    chances_.resize(members.size());
    likelihoods_.resize(members.size());
    for (std::size_t k = 0; k < members.size(); ++k) {
      members[k].shift = members[k].shifts.front();
      prepare(k);
    }
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
    for (std::size_t k = 0; k < members_.size(); ++k) prepare(k);  // colours where each body was found to be
    decide_order();
  }

  void divide() {
    std::vector<cv::Mat> odds(members_.size() + 1);
    for (cv::Mat& one : odds) one.create(patch_.size(), CV_32FC1);
    for (int y = 0; y < patch_.size().height; ++y) {
      for (int x = 0; x < patch_.size().width; ++x) {
        float left = 1;
        for (const int k : order_) {
          const float chance = chances_[k].at<float>(y, x);
          odds[k].at<float>(y, x) = log_odds(left * chance, likelihoods_[k].at<float>(y, x));
          left *= 1 - chance;
        }
        odds.back().at<float>(y, x) = log_odds(left, ground_.at<float>(y, x));
      }
    }
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
    std::vector<cv::Mat> votes(labels), fractions(labels);
    for (int round = 0; round <= kVotingRounds; ++round) {
      cv::Mat sum = cv::Mat::zeros(odds.front().size(), CV_32FC1), maximum = odds[0].clone();
      for (std::size_t l = 0; l < labels; ++l) {
        fractions[l] = round == 0 ? odds[l].clone() : cv::Mat(odds[l] + kVote * votes[l]);
        cv::max(maximum, fractions[l], maximum);
      }
      for (cv::Mat& fraction : fractions) {
        fraction -= maximum;
        cv::exp(fraction, fraction);
        sum += fraction;
      }
      for (std::size_t l = 0; l < labels; ++l) {
        fractions[l] /= sum;
        if (round < kVotingRounds) votes[l] = neighbours.of(fractions[l]);
      }
    }
    return fractions;
  }

  /// log(prior likelihood^kTempered), with one logarithm.
  static float log_odds(float prior, float likelihood) {
    static_assert(kTempered == 0.5);
    return std::log(prior * std::sqrt(likelihood));
  }

  void inspect_ground() {
    cv::Mat taken = patch_.mask.clone();
    double height = 0;
    for (const RegionMember& member : members_) {
      cv::max(taken, cells_within(member.polygon, patch_), taken);
      height = std::max(height, member.height);
    }
    ground_colours_ = ground_next_to(patch_, taken, height);
    ground_ = marey::track::contour::ground_likelihood(patch_, ground_colours_);
  }

  /// The chance that member k covers each cell, where it is now; and the likelihood of each cell's colour if so.
  void prepare(std::size_t k) {
    const RegionMember& member = members_[k];
    shifted_ = member.polygon;
    for (Vector<2>& corner : shifted_) corner += member.shift;
    const cv::Mat within = cells_within(shifted_, patch_);
    cv::Mat inside, outside, depth, distance;
    within.convertTo(inside, CV_8U, 255);
    outside = 255 - inside;
    cv::distanceTransform(inside, depth, cv::DIST_L2, 3);
    cv::distanceTransform(outside, distance, cv::DIST_L2, 3);
    const double softness = std::max(0.7, kEdgeSoftness * member.height / patch_.step);
    const Vector<2> centre = member.centre + member.shift;
    cv::Mat& chance = chances_[k];
    cv::Mat& likelihood = likelihoods_[k];
    chance.create(patch_.size(), CV_32FC1);
    likelihood.create(patch_.size(), CV_32FC1);
    for (int y = 0; y < chance.rows; ++y) {
      for (int x = 0; x < chance.cols; ++x) {
        const Vector<2> location = (patch_.pixel(Vector<2>(x, y)) - centre) / member.height;
        const auto steps = static_cast<float>((depth.at<float>(y, x) - distance.at<float>(y, x)) / softness);
        const double shape = steps > kFarSteps ? 1 : steps < -kFarSteps ? 0 : 1 / (1 + std::exp(-steps));
        const double typical = member.body->coverage(location);
        chance.at<float>(y, x) =
            std::clamp(static_cast<float>((1 - member.typical) * shape + member.typical * typical), kMinChance, 1 - kMinChance);
        const float mask = patch_.mask.at<float>(y, x);
        likelihood.at<float>(y, x) =
            static_cast<float>(member.body->density(location.y(), patch_.colour.at<cv::Vec3f>(y, x))) * mask_chance_on_body(mask);
      }
    }
  }

  void order_by_feet() {
    order_.clear();
    for (std::size_t k = 0; k < members_.size(); ++k) order_.push_back(static_cast<int>(k));
    std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) { return members_[a].foot > members_[b].foot; });
  }

  /// Of the whole patch, every second cell in each direction, in nats. A cell's likelihood is more than 1e-15, so that a product of
  /// kFactors is far from the smallest number.
  double log_likelihood() const {
    constexpr int kFactors = 16;  // numerical
    double sum = 0, product = 1;
    int factors = 0;
    for (int y = 0; y < patch_.size().height; y += 2) {
      const float* ground = ground_.ptr<float>(y);
      for (int x = 0; x < patch_.size().width; x += 2) {
        float left = 1, all = 0;
        for (const int k : order_) {
          const float chance = chances_[k].at<float>(y, x);
          all += left * chance * likelihoods_[k].at<float>(y, x);
          left *= 1 - chance;
        }
        product *= all + left * ground[x];
        if (++factors < kFactors) continue;
        sum += std::log(product);
        product = 1;
        factors = 0;
      }
    }
    sum += std::log(product);
    double review_item = 0;
    for (const RegionMember& member : members_) {
      review_item += (member.shift - member.shifts.front()).squaredNorm() / std::pow(kShiftAmbiguity * member.height, 2);
    }
    return kTempered * sum - 0.5 * review_item;
  }

  /// One member at four places about where it is, and where else it may be; whether another place is better. Its colours are taken
  /// to stay: they change slowly from head to foot.
  bool try_about(int k, double step, bool elsewhere) {
    RegionMember& member = members_[k];
    const Vector<2> from = member.shift;
    const double whole_cells = std::max(1.0, std::round(step * member.height / patch_.step)) * patch_.step;
    std::vector<Vector<2>> shifts;
    for (const Vector<2>& method : {Vector<2>(1, 0), Vector<2>(-1, 0), Vector<2>(0, 1), Vector<2>(0, -1)}) {
      shifts.push_back(from + whole_cells * method);
    }
    if (elsewhere) shifts.insert(shifts.end(), member.shifts.begin() + 1, member.shifts.end());
    const cv::Mat chance = chances_[k];
    cv::Mat best_chance = chance;
    double best = log_likelihood();
    Vector<2> kept = from;
    for (const Vector<2>& shift : shifts) {
      member.shift = shift;
      chances_[k] = moved(chance, (shift - from) / patch_.step, kMinChance);
      const double value = log_likelihood();
      if (value <= best) continue;
      best = value;
      kept = shift;
      best_chance = chances_[k];
    }
    member.shift = kept;
    chances_[k] = best_chance;
    return kept != from;
  }

  /// By whole cells; what comes in has this value.
  static cv::Mat moved(const cv::Mat& values, const Vector<2>& by, float beyond) {
    const cv::Point shift(static_cast<int>(std::lround(by.x())), static_cast<int>(std::lround(by.y())));
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
  cv::Mat ground_colours_;                      // CV_32FC3
  cv::Mat ground_;                              // likelihood of each cell's colour, if it is ground
  std::vector<cv::Mat> chances_, likelihoods_;  // by member
  std::vector<int> order_;                      // nearest first
  std::vector<Vector<2>> shifted_;
};

}  // namespace

cv::Mat divide_region(const ColourPatch& patch, std::span<RegionMember> members) {
  if (members.empty() || patch.colour.empty()) return {};
  RegionDivision division(patch, members);
  division.find_positions();
  division.divide();
  return division.ground_colours();
}

}  // namespace marey::track::contour
