#pragma once

#include <span>

#include <opencv2/core.hpp>

#include "marey/track/contour/neighbour_votes.h"

namespace marey::track::contour {

/// The label of every cell (CV_8UC1, an index of `costs`) whose energy is low: the sum of each cell's cost for its label (CV_32FC1,
/// all of one size, finite), plus `smoothness` times the weight between neighbours whose labels differ. Alpha expansion: exact for
/// two labels, within a factor of two of the least energy for more. At most 255 labels. Cost: one maximum flow for each label and
/// round.
cv::Mat cut_labels(std::span<const cv::Mat> costs, const NeighbourVotes& neighbours, float smoothness);

/// That sum for given labels.
double label_energy(std::span<const cv::Mat> costs, const NeighbourVotes& neighbours, float smoothness, const cv::Mat& labels);

}  // namespace marey::track::contour
