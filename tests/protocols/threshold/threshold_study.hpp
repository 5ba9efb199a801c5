/// \file Tiny studies of thresholds.
#pragma once

#include "protocols/session/tiny_study.hpp"

#include <string>

namespace touchtrial {

inline constexpr const char* kTinyTrials =
    R"({"explore_limit_s": 6, "validity": {"exploring_s": 1, "contact_s": 1, "path_mm": 20}})";

/// \param section  members of "threshold"
inline TinyStudyOptions threshold_options(const std::string& section) {
  return {.protocol = "threshold", .section = "{" + section + "}", .trials = kTinyTrials};
}

inline const std::string kTinyDetection =
    R"("task": "detection", "interval_s": 0.5, "trials": 8, "levels": {"from": -40, "to": 0, "step": 4})";

}  // namespace touchtrial
