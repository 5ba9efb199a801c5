// Meanings of the members of results.json.
#include "protocols/identification/analysis/measures.hpp"

namespace touchtrial::analysis::identification {

std::vector<ListedObject> listed_objects() {
  const MethodReport method;
  const MethodPair pair;
  const choices::AnswersByPlace places;
  ConfidenceReport confidence;
  confidence.ratings = {RatedAccuracy{}};
  StudyReport report;
  report.methods = {method, method};
  const ListedMembers trials{{"n", "trials, those without a response included"},
                             {"correct", "right answers"},
                             {"p", "their share"}};
  const ListedMembers people{
      {"participants", "who have a share of their own"},
      {"mean", "of participants' own shares"},
      {"interval", "Student's t, 95 %; null with fewer than two participants"}};
  const ListedMembers comparison{{"participants", "with trials by both methods"},
                                 {"difference", "mean of participants' differences in accuracy"},
                                 {"interval", "Student's t, 95 %"},
                                 {"bootstrap", "expanded percentiles over participants, 95 %"},
                                 {"p", "sign flips, two-sided"},
                                 {"db", "10 log10 of the ratio of the means"},
                                 {"statistic", "Student's t, as in `primary`"}};
  const ListedMembers computation{{"method", "how these are computed"},
                                  {"references", "keys of `references`"}};
  return {
      listed_object(
          "methods[].overall", overall_measures(),
          joined_members(
              {trials,
               {{"mean", "of participants' own accuracies: the main result"},
                {"interval", "Student's t, 95 %; null with fewer than two participants"},
                {"sd", "of these accuracies"},
                {"bootstrap", "expanded percentiles of the mean over whole participants, 95 %"}},
               computation,
               {{"spread", "of participants' own probabilities of a right answer; null: not known"},
                {"spread.estimate", "standard deviation"},
                {"spread.interval", "95 %"}}})),
      listed_object(
          "methods[].accuracy[]", accuracy_measures(report, method),
          joined_members(
              {{{"class", "label"}},
               trials,
               {{"wilson",
                 "95 %, as if trials were independent, like the next two; null without a trial"},
                {"clopper_pearson", "95 %"},
                {"jeffreys", "95 %"},
                {"mean", "of participants' own accuracies"},
                {"interval", "Student's t, 95 %"}}})),
      listed_object(
          "methods[].per_participant[]", participant_measures(report),
          joined_members(
              {{{"participant", "id"}},
               trials,
               {{"best_matching",
                 "under the one-to-one exchange of labels that fits the answers best"},
                {"best_matching.n", "trials"},
                {"best_matching.correct", "right answers then"},
                {"best_matching.p", "their share"},
                {"best_matching.answer_of", "the answer that the exchange gives each class"},
                {"consistency_bits", "raw information transfer; not to be quoted as a main result"},
                {"swap_p", "of the exchange of labels"},
                {"swap_p_adjusted", "over all participants and methods"}}})),
      listed_object("methods[].chance", chance_measures(),
                    {{"correct", "right answers"},
                     {"trials", "of so many"},
                     {"expected", "right answers by chance"},
                     {"p",
                      "that at least one participant can: one-sided, over the orders that the "
                      "study's rule could have produced; 1e-280: this or any smaller value"},
                     {"exact", "whether over all of these orders"},
                     {"deals", "orders drawn, if not"},
                     {"method", "how p is computed"},
                     {"references", "keys of `references`"}}),
      listed_object(
          "methods[].best_matching", matching_measures(report.classes),
          {{"n", "trials"},
           {"correct",
            "right answers under the one-to-one exchange of labels that fits the answers best"},
           {"p", "their share"},
           {"answer_of", "the answer that the exchange gives each class"}}),
      listed_object(
          "methods[].breakdowns.exemplar[], .trial[], .order_group[]",
          breakdown_measures(BreakdownKind::exemplar),
          joined_members(
              {{{"group",
                 "what the trials have in common; a breakdown is there if it has two groups"}},
               trials,
               {{"wilson", "95 %, as if trials were independent"}}})),
      listed_object("methods[].breakdowns.visit[], .group[]",
                    breakdown_measures(BreakdownKind::visit),
                    joined_members({{{"group", "the visit, or the participants' group"}},
                                    trials,
                                    {{"wilson", "95 %, as if trials were independent"}},
                                    people})),
      listed_object(
          "methods[].robustness[]", subset_measures(),
          joined_members(
              {{{"trials",
                 "`counted`: the main result; `answered`, `valid`, `with_excluded_sessions`"},
                {"n", "trials"},
                {"correct", "right answers"},
                {"p", "their share"}},
               people})),
      listed_object("methods[].confidence.ratings[]", rating_measures(confidence),
                    joined_members({{{"rating", "the confidence, from 1"},
                                     {"n", "answers with this confidence"},
                                     {"correct", "right answers"},
                                     {"p", "their share"}},
                                    people})),
      listed_object("methods[].confidence.type_2_area", mean_measures(),
                    {{"participants", "with an area; those `without` one beside it"},
                     {"mean", "of their areas"},
                     {"interval", "Student's t, 95 %"}}),
      listed_object(
          "pairs[]", pair_measures(report),
          joined_members(
              {{{"first", "method"}, {"second", "method; differences are first minus second"}},
               comparison,
               {{"p_holm", "over all pairs; null with fewer than three methods"},
                {"odds_ratio",
                 "`estimate`, `interval` over participants (null if they are fewer than six), "
                 "`interval_of_trials` as if trials were independent"},
                {"mcnemar_mid_p", "one pair per participant"},
                {"classes", "by class, see below"}}})),
      listed_object("pairs[].classes[]", class_measures(report, pair),
                    joined_members({{{"class", "label"},
                                     {"first", "`n`, `correct` and `p` of the first method"},
                                     {"second", "the same of the second"}},
                                    comparison,
                                    {{"mcnemar_mid_p", "one pair per participant"}}})),
      listed_object("places.places[]", place_measures(places),
                    {{"named", "answers at this place; places are in the order of the screen"},
                     {"participants", "who answered"},
                     {"mean", "of participants' shares of answers here, less 1/K"},
                     {"interval", "Student's t, 95 %"},
                     {"p", "of t, or of sign flips if all are alike"}}),
      listed_object(
          "prevalence", prevalence_measures(),
          joined_members(
              {{{"estimate",
                 "share of people who would pass their own test: a lower bound of those who can"},
                {"interval", "highest posterior density, 95 %"},
                {"passed", "people who passed"},
                {"participants", "of so many"},
                {"level", "mean level that their tests attain by chance"}},
               computation}))};
}

}  // namespace touchtrial::analysis::identification
