// Meanings of the members of results.json.
#include "protocols/threshold/analysis/measures.hpp"

namespace touchtrial::analysis::threshold {

std::vector<ListedObject> listed_objects(const ThresholdReport& report) {
  const ListedMembers censored{
      {"interval", "likelihood ratio, 95 %; Student's t if every value is known"},
      {"lack", "why there is none: `few known`, `most censored`, `all alike`"},
      {"sd", "between participants, dB"},
      {"median", "dB"},
      {"median_within", "bounds of the median, dB; null: open"}};
  const ListedMembers weber{{"weber.fraction", "for instance a Weber fraction"},
                            {"weber.low", "end of its 95 % interval"},
                            {"weber.high", "the other end"}};
  const ListedMembers right_answers{
      {"n", "answers"},
      {"right", "of these"},
      {"share", "of right answers"},
      {"interval", "Clopper and Pearson, 95 %"},
      {"p", "exact probability of at least as many right answers by guessing"}};
  const ListedMembers test{{"interval", "Student's t, 95 %"},
                           {"participants", "participants who have a value"},
                           {"p", "two-sided"},
                           {"test", "`t`, or `sign flips` if all are alike; null without p"}};
  return {
      listed_object(
          "tracks[]", track_measures(report),
          joined_members(
              {{{"participant", "id"},
                {"track", "from 1"},
                {"standard", "in words"},
                {"trials", "that the procedure chose"},
                {"right", "right answers in these"},
                {"catch", "catch trials"},
                {"catch.n", "answered"},
                {"catch.right", "right answers"},
                {"estimate", "the threshold"},
                {"estimate.threshold", "dB; null: there is none"},
                {"estimate.low", "end of the 95 % interval, dB; null: open"},
                {"estimate.high", "the other end"},
                {"estimate.censored",
                 "why there is no threshold: `below`, `above`, `undetermined`"},
                {"in_mean",
                 "bounds between which the group's mean takes the threshold, dB; null: open"},
                {"reversals",
                 "mean of the last reversals of a staircase; null for other procedures"},
                {"reversals.threshold", "dB; null: there is none"},
                {"reversals.low", "null: it has no interval"},
                {"reversals.high", "null likewise"},
                {"reversals.censored",
                 "why there is no threshold: `below`, `above`, `undetermined`"},
                {"weber", "the threshold as a familiar quantity; null: there is none"}},
               weber,
               {{"goodness_of_fit", "null: not tested"},
                {"goodness_of_fit.deviance", "of the answers from the fitted observer"},
                {"goodness_of_fit.p", "share of the observer's own data sets that deviate as much"},
                {"goodness_of_fit.draws", "number of these data sets"},
                {"learning_db",
                 "change of the threshold over the track; null if its standard error is too "
                 "large"}}})),
      listed_object(
          "standards[]", standard_measures(report),
          joined_members(
              {{{"standard", "in words"},
                {"class", "label of its texture"},
                {"value", "value of the standard; 0 in detection"},
                {"highest_level", "dB"},
                {"tracks", "of all participants"},
                {"n", "participants who contribute to the mean"},
                {"no_share", "participants whose tracks leave both ends open; not in `n`"},
                {"known", "participants whose tracks have numbers"},
                {"below", "participants below the lowest level"},
                {"above", "participants above the highest level"},
                {"undetermined", "all other participants"},
                {"mean", "of the threshold over participants, dB; null: none"}},
               censored,
               {{"weber", "the mean as a familiar quantity; null: there is none"}},
               weber})),
      listed_object(
          "differences[]", difference_measures(report),
          joined_members(
              {{{"first", "standard, in words"},
                {"second", "standard; differences are first minus second"},
                {"difference", "mean over participants, dB; null: none"}},
               censored,
               {{"participants", "with thresholds at both, known or bounded"},
                {"known", "of these with both known"},
                {"p", "two-sided"},
                {"p_holm", "adjusted over all pairs"},
                {"statistic",
                 "Student's t, as in `primary`; null unless every difference is known"}}})),
      listed_object("control, catch", right_measures(false), right_answers),
      listed_object("control.participants[], catch.participants[]", right_measures(true),
                    joined_members({{{"participant", "id"}},
                                    right_answers,
                                    {{"p_holm", "adjusted over participants"}}})),
      listed_object(
          "control.without_hearers[]", censored_measures("mean"),
          joined_members(
              {{{"mean",
                 "without people who hear, beside `standard` and `participants`, dB; null: none"}},
               censored})),
      listed_object(
          "intervals[]", choice_measures(),
          joined_members({{{"choice", "the answer"},
                           {"named", "how often it was given"},
                           {"targets", "how often it was right"},
                           {"difference", "share given minus share right, mean over participants"}},
                          test})),
      listed_object(
          "sequence.after_right, .after_wrong", repetition_measures(),
          joined_members(
              {{{"n", "answers after another"},
                {"repeats", "of these the same as the one before"},
                {"share", "of repeats"},
                {"expected", "share by chance, from how often each participant gave each answer"},
                {"difference", "mean over participants of share minus expected"}},
               test})),
      listed_object(
          "learning", test_measures("change_db"),
          joined_members(
              {{{"change_db", "change of the threshold over a track, mean over participants"}},
               test})),
      listed_object("same_different.levels[]", level_measures(report),
                    {{"participant", "id; null: all together"},
                     {"standard", "in words"},
                     {"level", "dB"},
                     {"different", "trials with two kinds"},
                     {"different.n", "trials"},
                     {"different.said_different", "answered \"different\""},
                     {"same", "trials with one kind, at this level"},
                     {"same.n", "trials"},
                     {"same.said_different", "false alarms"},
                     {"same_at_all_levels", "trials with one kind, at all levels of the standard"},
                     {"same_at_all_levels.n", "trials"},
                     {"same_at_all_levels.said_different", "false alarms"},
                     {"d_prime_differencing", "d' by the differencing model"},
                     {"d_prime_independent", "d' by independent observations"}}),
      listed_object("same_different.groups[]", group_measures(report),
                    {{"standard", "in words"},
                     {"level", "dB"},
                     {"participants", "whose answers are pooled"},
                     {"differencing", "d' by the differencing model"},
                     {"differencing.d_prime", "of all answers pooled"},
                     {"differencing.interval", "bootstrap over participants, 95 %"},
                     {"independent", "d' by independent observations"},
                     {"independent.d_prime", "of all answers pooled"},
                     {"independent.interval", "bootstrap over participants, 95 %"}})};
}

}  // namespace touchtrial::analysis::threshold
