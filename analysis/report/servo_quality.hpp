/// \file The servo's health over a study's sessions. Private to analysis.
#pragma once

#include "analysis/report/quality.hpp"

#include <set>

namespace touchtrial {

/// \return nothing if no trial was in real time
[[nodiscard]] std::optional<ServoQuality> servo_quality(const StudyStore& store,
                                                        const std::set<int>& withdrawn);

/// Whether the study's sessions were seen on a screen; a database never holds both kinds.
[[nodiscard]] bool is_visual(const StudyStore& store);

}  // namespace touchtrial
