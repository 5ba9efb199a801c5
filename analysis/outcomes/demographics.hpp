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

  /// Replaces the values that a later session has.
  void update(const Demographics& later);
};

/// "right", "left" or "ambidextrous", by Veale's (2014) bounds of 60 and -60.
[[nodiscard]] std::string handedness_of(double score);

struct QuestionAnswer;

/// Demographics by session. They come from answers to questions with the id "age" (a number), "sex"
/// or "gender", and from the handedness inventory. Texts are never read, because they may name
/// people.
/// \param study  defines the options of its questions
[[nodiscard]] std::map<int, Demographics> demographics_of(
    const std::vector<QuestionAnswer>& answers, const study::Study& study);

/// The minimum number of people in a shown band. Fewer could be identified.
inline constexpr int kMinBandPeople = 5;

/// People in one band.
struct Band {
  std::string name;
  int people = 0;
};

/// The distribution of a group of people over one characteristic.
struct Characteristic {
  std::string name;         ///< "age", "sex", "handedness"
  std::vector<Band> bands;  ///< each of kMinBandPeople people or more; empty: nothing can be shown
  /// People in smaller bands plus those who did not answer: 0, or at least kMinBandPeople. If they
  /// are too few, the smallest shown band is added.
  int others = 0;
};

/// Removes bands of fewer than kMinBandPeople people. Also removes the smallest band while the
/// others are too few, because their number follows from the total.
/// \param others  people who are in no band
/// \return people who are now in no band
[[nodiscard]] int remove_small_bands(std::vector<Band>& bands, int others);

/// The characteristics of a group, without characteristics that nobody stated.
/// \param people  one entry per person, empty if the person gave no answers
[[nodiscard]] std::vector<Characteristic> banded_characteristics(
    const std::vector<Demographics>& people);

}  // namespace touchtrial::analysis
