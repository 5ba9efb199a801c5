/// \file A fit in words and in JSON. Format: docs/data-dictionary.md, "Fit".
#pragma once

#include "analysis/planning/subject_fit.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace touchtrial::planning {

/// The keys of a subject file that differ from draw to draw of a fit; its JSON has them by draw.
inline constexpr std::array<std::string_view, 3> kDrawnKeys{"feature_noise", "lapse", "bias"};

/// What a fit was made from.
struct FitOrigin {
  std::string study;
  std::string subject;     ///< file of the subject model that the search started from
  bool simulated = false;  ///< the answers are those of simulated participants
  bool pilot = false;
  bool interim = false;
  int explorations = 0;
  int directions = 0;
  std::uint64_t seed = 0;
  std::string answers_on{};  ///< analysis::device_words of the answers; empty: real participants
  std::string felt_on{};     ///< analysis::device_words of the subject that feels
};

/// Tables for a terminal; ends with a line feed.
[[nodiscard]] std::string fit_text(const SubjectFit& fit, const FitOrigin& origin);
[[nodiscard]] std::string fit_text(const AccuracyFit& fit, const FitOrigin& origin);

/// One indented JSON object; ends with a line feed. Missing values are null.
[[nodiscard]] std::string fit_json(const SubjectFit& fit, const FitOrigin& origin);
[[nodiscard]] std::string fit_json(const AccuracyFit& fit, const FitOrigin& origin);

}  // namespace touchtrial::planning
