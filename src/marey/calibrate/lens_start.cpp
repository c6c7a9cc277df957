#include "marey/calibrate/lens_start.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/ranges.h>

#include "marey/calibrate/board/board_pose.h"
#include "marey/core/error.h"
#include "marey/geometry/median.h"

namespace marey::calibrate {
namespace {

constexpr std::size_t kViewsTried = 12;                          // spread over all: a guess needs no more
constexpr double kMinWidth = 20, kMaxWidth = 0.2, kStep = 1.15;  // focal length in image widths

/// Median over the views of how far corners are from where this lens and the view's best pose would put them.
std::optional<double> misfit(const board::Board& board, std::span<const LensView> views, const geometry::Lens& lens) {
  std::vector<double> misfits;
  const std::size_t stride = std::max<std::size_t>(1, views.size() / kViewsTried);
  for (std::size_t i = 0; i < views.size(); i += stride) {
    const auto pose = board::board_pose(board, views[i].board, lens);
    const auto rms = pose ? board::board_rms(board, views[i].board, lens, *pose) : std::nullopt;
    misfits.push_back(rms.value_or(1e6));
  }
  const auto middle = geometry::median(misfits);
  return middle < 1e6 ? std::optional(middle) : std::nullopt;
}

}  // namespace

geometry::Lens plain_lens(const std::string& model, double focal, const Vector<2>& principal) {
  auto lens = geometry::lens_named(model);
  if (!lens) throw Error("lens model \"{}\" is not known; choose one of {}", model, fmt::join(geometry::lens_names(), ", "));
  std::visit(
      [&](auto& one) {
        one.focal = {focal, focal};
        one.principal = principal;
      },
      *lens);
  return *lens;
}

std::optional<geometry::Lens> first_lens(const board::Board& board, cv::Size size, std::span<const LensView> views,
                                         const std::string& model) {
  const Vector<2> middle((size.width - 1) / 2.0, (size.height - 1) / 2.0);
  std::optional<geometry::Lens> best;
  double minimum = 0;
  for (double widths = kMaxWidth; widths < kMinWidth; widths *= kStep) {
    const geometry::Lens lens = plain_lens(model, widths * std::max(size.width, size.height), middle);
    const auto off = misfit(board, views, lens);
    if (off && (!best || *off < minimum)) best = lens, minimum = *off;
  }
  return best;
}

}  // namespace marey::calibrate
