/// \file The servo's health over a study's sessions. Private to analysis.
#pragma once

#include "analysis/collection.hpp"
#include "analysis/report/quality.hpp"

#include <optional>

namespace touchtrial::analysis {

/// \return nothing if no trial was in real time
[[nodiscard]] std::optional<ServoQuality> servo_quality(const Collection& collection);

}  // namespace touchtrial::analysis
