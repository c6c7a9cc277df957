// What answers to doubts would change: each is tried on the take as it is, and what then has another name is counted. A doubt
// whose answers all leave the take as it is, or cannot be applied to it, need not be asked.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/core/recording.h"
#include "marey/pipeline/identify/review.h"

namespace marey::pipeline::identify {

/// s of person-time that have another name, or none, after `answer` than before it; nothing if the take does not take that
/// answer. `doubt.edit` is of `history`.
std::optional<double> effect_of_answer(const ReviewItem& review_item, const std::string& answer, const Recording& recording,
                                       const take::EditHistory& history, const std::vector<SquadMember>& squads, TrackId initiated);

/// Those of which some answer changes something: `changes_s` is reported of each. First of all those whose probability times that
/// is the greatest: the expected gain of a review.
std::vector<ReviewItem> ambiguities_that_matter(std::vector<ReviewItem> review_items, const Recording& recording,
                                                const take::EditHistory& history, const std::vector<SquadMember>& squads,
                                                TrackId initiated);

}  // namespace marey::pipeline::identify
