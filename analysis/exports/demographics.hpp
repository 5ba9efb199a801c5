/// \file Participants' answers about themselves, in categories coarse enough to publish. Private to
/// exports.
#pragma once

#include "analysis/exports/dataset.hpp"

#include <map>
#include <optional>
#include <string>

namespace touchtrial::analysis {

struct Demographics {
  std::optional<std::string> age_band;     ///< for example "20-29", "under 18" or "70 or more"
  std::optional<std::string> sex;          ///< the text of the chosen option, in lower case
  std::optional<double> handedness_score;  ///< -100 to 100
};

/// Demographics by session. They come from answers to questions with the id "age" (a number), "sex"
/// or "gender", and from the handedness inventory. Empty before unblinding.
/// \throws VerificationError if an answer does not open
[[nodiscard]] std::map<int, Demographics> demographics(const DatasetSource& source);

/// \param age  in years
[[nodiscard]] std::string age_band(double age);

/// The laterality quotient: the mean over the inventory's four items, each 100 (always right), 50,
/// 0, -50 or -100. Source: Veale (2014), Laterality 19, 164-177.
/// \return nothing if an item has no answer
[[nodiscard]] std::optional<double> handedness_score(const std::map<std::string, int>& answers);

/// "right", "left" or "ambidextrous", with Veale's bounds of 60 and -60.
[[nodiscard]] std::string handedness_of(double score);

}  // namespace touchtrial::analysis
