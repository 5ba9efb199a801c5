/// \file A fit as text and as JSON. Format: docs/data-dictionary.md, "Fit".
#pragma once

#include "analysis/planning/subject_fit.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace touchtrial::planning {

/// The subject-file keys that differ between draws of a fit; the JSON lists them for each draw.
inline constexpr std::array<std::string_view, 3> kDrawnKeys{"feature_noise", "lapse", "bias"};

/// The inputs of a fit.
struct FitOrigin {
  std::string study;
  std::string subject;     ///< file of the subject model that the search started from
  bool simulated = false;  ///< whether the participants were simulated
  bool pilot = false;
  bool interim = false;
  int explorations = 0;
  int directions = 0;
  std::uint64_t seed = 0;
  std::string answers_on{};  ///< device of simulated participants (analysis::device_words); empty
                             ///< for real ones
  std::string felt_on{};     ///< device of the explorations (analysis::device_words)
};

/// Tables for a terminal; ends with a line feed.
[[nodiscard]] std::string fit_text(const SubjectFit& fit, const FitOrigin& origin);
[[nodiscard]] std::string fit_text(const AccuracyFit& fit, const FitOrigin& origin);

/// One indented JSON object; ends with a line feed. Missing values are null.
[[nodiscard]] std::string fit_json(const SubjectFit& fit, const FitOrigin& origin);
[[nodiscard]] std::string fit_json(const AccuracyFit& fit, const FitOrigin& origin);

}  // namespace touchtrial::planning
