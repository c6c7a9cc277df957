#pragma once

namespace marey::track::contour {

/// How the cells' labels are found from what each says: each asks its neighbours (mean field), or all at once by graph cuts
/// (graph_cut.h).
enum class Labelling { votes, cuts };

}  // namespace marey::track::contour
