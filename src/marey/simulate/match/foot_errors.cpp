#include "marey/simulate/match/foot_errors.h"

#include <cmath>

namespace marey::simulate::match {

FootErrors::FootErrors(double sigma, std::uint64_t seed) : sigma_(sigma), random_(seed) {
  slow_.fill(Vector<2>::Zero());
  quick_.fill(Vector<2>::Zero());
  renew(slow_, 0, sigma * std::sqrt(kSlowFraction));
  renew(quick_, 0, sigma * std::sqrt(1 - kSlowFraction));
}

void FootErrors::advance(double dt) {
  renew(slow_, std::exp(-dt / kSlow_s), sigma_ * std::sqrt(kSlowFraction));
  renew(quick_, std::exp(-dt / kQuick_s), sigma_ * std::sqrt(1 - kSlowFraction));
}

double FootErrors::covariance(double sigma, double lag) {
  return sigma * sigma * (kSlowFraction * std::exp(-lag / kSlow_s) + (1 - kSlowFraction) * std::exp(-lag / kQuick_s));
}

/// `kept`: the share of the old error that stays; `sigma` is the standard deviation before and after.
void FootErrors::renew(Errors& errors, double kept, double sigma) {
  const double fresh = sigma * std::sqrt(1 - kept * kept);
  for (Vector<2>& error : errors) {
    const double x = random_.gaussian(), y = random_.gaussian();
    error = kept * error + fresh * Vector<2>(x, y);
  }
}

}  // namespace marey::simulate::match
