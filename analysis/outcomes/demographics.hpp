/// \file Demographics from participants' answers, in bands, so that tables never show single ages.
#pragma once

#include "record/study_store.hpp"
#include "study/study_key.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// One participant's answers.
struct Demographics {
  std::optional<std::string> age_band;     ///< for example "20-29", "under 18" or "70 or more"
  std::optional<std::string> sex;          ///< the text of the chosen option, in lower case
  std::optional<double> handedness_score;  ///< -100 to 100
};

/// "right", "left" or "ambidextrous", with the bounds of 60 and -60 of Veale (2014).
[[nodiscard]] std::string handedness_of(double score);

struct QuestionAnswer;

/// Demographics by session. They come from answers to questions with the id "age" (a number), "sex"
/// or "gender", and from the handedness inventory. Texts are never read, because they may name
/// people.
/// \param study  has the options of its questions
[[nodiscard]] std::map<int, Demographics> demographics_of(
    const std::vector<QuestionAnswer>& answers, const study::Study& study);

/// The minimum number of people in a band that is shown. Fewer could be identified.
inline constexpr int kMinOfBand = 5;

/// People in one band.
struct Band {
  std::string name;
  int people = 0;
};

/// The distribution of a group of people over one characteristic.
struct Characteristic {
  std::string name;         ///< "age", "sex", "handedness"
  std::vector<Band> bands;  ///< each of kMinOfBand people or more; empty: nothing can be shown
  /// People in smaller bands and people who did not answer, together: 0, or at least kMinOfBand.
  /// The smallest band is merged into them if they are too few.
  int others = 0;
};

/// Removes bands of fewer than kMinOfBand people. Also removes the smallest band while the
/// remainder is too small, because it could be computed from the total.
/// \param others  people in no band
/// \return the people in no band now
[[nodiscard]] int keep_large_bands(std::vector<Band>& bands, int others);

/// The characteristics of a group, without those that nobody answered.
/// \param people  one entry for each person, empty if the person gave no answers
[[nodiscard]] std::vector<Characteristic> in_bands(const std::vector<Demographics>& people);

}  // namespace touchtrial::analysis
