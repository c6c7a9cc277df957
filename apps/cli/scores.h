#pragma once

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "marey/evaluate/evaluation.h"

namespace marey::cli {

/// "83.7 %", or "none".
std::string percent(std::optional<double> share);

nlohmann::json or_null(std::optional<double> value);

/// What `marey evaluate --json` tells of boxes and of places alike.
nlohmann::json as_json(const evaluate::Evaluation& scores);

}  // namespace marey::cli
