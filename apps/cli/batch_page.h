#pragma once

#include <string>

#include "batch_reduce.h"

namespace marey::cli {

/// A page of a whole plan, by draw::Page: the gaps and why; of `measure` every person's totals and how they went from
/// recording to recording; of the rest how much each recording has; and the whole table.
std::string season_page(const Season& season, const std::string& title, std::size_t planned);

}  // namespace marey::cli
