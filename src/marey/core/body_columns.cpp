#include <algorithm>
#include <array>
#include <cassert>

#include "marey/core/error.h"
#include "marey/core/recording.h"

namespace marey {

BodyPose BodyColumns::pose(std::size_t row) const {
  BodyPose pose{.body = body_,
                .world_from_body = poses_[row],
                .covariance = {},
                .residual_m = {},
                .tracked = static_cast<bool>(tracked_[row])};
  if (covariance_.known(row)) {
    const double* value = covariance_.values(row);
    Matrix<6> covariance;
    for (int i = 0; i < 6; ++i) {
      for (int k = i; k < 6; ++k) covariance(i, k) = covariance(k, i) = *value++;
    }
    pose.covariance = covariance;
  }
  if (residual_m_.known(row)) pose.residual_m = *residual_m_.values(row);
  if (other_.known(row)) pose.other = {geometry::rigid_from_rows(other_.values(row)), other_.values(row)[12]};
  return pose;
}

std::optional<std::size_t> BodyColumns::row_at(std::int32_t instant) const {
  const auto found = std::lower_bound(at_.begin(), at_.end(), instant);
  if (found == at_.end() || *found != instant) return std::nullopt;
  return static_cast<std::size_t>(found - at_.begin());
}

void BodyColumns::add(std::int32_t instant, const BodyPose& pose) {
  if (!at_.empty() && at_.back() >= instant) throw Error("body {} has two poses at one instant", number(body_));
  const std::size_t row = at_.size();
  at_.push_back(instant);
  poses_.push_back(pose.world_from_body);
  tracked_.push_back(pose.tracked);
  if (pose.covariance) {
    std::array<double, 21> upper{};
    std::size_t count = 0;
    for (int i = 0; i < 6; ++i) {
      for (int k = i; k < 6; ++k) upper[count++] = (*pose.covariance)(i, k);
    }
    covariance_.set(row, upper);
  }
  if (pose.residual_m) residual_m_.set(row, {&*pose.residual_m, 1});
  if (pose.other) {
    std::array<double, 13> numbers{};
    std::ranges::copy(geometry::rows_of(pose.other->world_from_body), numbers.begin());
    numbers[12] = pose.other->probability;
    other_.set(row, numbers);
  }
}

void BodyColumns::append(const BodyColumns& other, std::int32_t offset) {
  for (std::size_t row = 0; row < other.size(); ++row) add(other.at_[row] + offset, other.pose(row));
}

void BodyColumns::set_at(std::vector<std::int32_t> instants) {
  assert(instants.size() == at_.size() && std::is_sorted(instants.begin(), instants.end()));
  at_ = std::move(instants);
}

}  // namespace marey
