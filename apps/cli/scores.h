#pragma once

#include <optional>
#include <string>

#include "marey/evaluate/evaluation.h"

#include "json_value.h"

namespace marey::cli {

/// "83.7 %", or "none".
std::string percent(std::optional<double> fraction);

Json or_null(std::optional<double> value);

/// What `marey evaluate --json` reports for boxes and for places alike.
Json as_json(const evaluate::Evaluation& scores);

}  // namespace marey::cli
