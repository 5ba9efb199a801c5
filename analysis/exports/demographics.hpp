/// \file What participants said of themselves, coarse enough to publish. Private to exports.
#pragma once

#include "analysis/exports/dataset.hpp"

#include <map>
#include <optional>
#include <string>

namespace touchtrial::analysis {

struct Demographics {
  std::optional<std::string> age_band;     ///< "20-29"; "under 18", "70 or more"
  std::optional<std::string> sex;          ///< lower case, in the words of the option chosen
  std::optional<double> handedness_score;  ///< -100 to 100
};

/// By session, of those who answered a question "age" (a number), "sex" or "gender", or the
/// handedness inventory. \throws VerificationError if an answer does not open
[[nodiscard]] std::map<int, Demographics> demographics(const DatasetSource& source);

/// \param age  in years
[[nodiscard]] std::string age_band(double age);

/// Laterality quotient over the inventory's four items, each 100 (always right), 50, 0, -50 or
/// -100. Source: Veale (2014), Laterality 19, 164-177. \return nothing if an item was left out
[[nodiscard]] std::optional<double> handedness_score(const std::map<std::string, int>& answers);

/// "right", "left" or "ambidextrous", by Veale's bounds of 60 and -60.
[[nodiscard]] std::string handedness_of(double score);

}  // namespace touchtrial::analysis
