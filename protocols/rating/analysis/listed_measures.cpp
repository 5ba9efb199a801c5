// Meanings of the members of results.json.
#include "protocols/rating/analysis/measures.hpp"

namespace touchtrial::analysis::rating {

std::vector<ListedObject> listed_objects() {
  const RatingReport report;
  const ScaleReport scale;
  const ListedMembers mean_of_items{{"items", "items that the mean is over"},
                                    {"participants", "who rated all of them"},
                                    {"mean", "of participants' means over the items"},
                                    {"interval", "Student's t, 95 %, cut to the scale"},
                                    {"sd", "between participants"}};
  return {
      listed_object("scales[].items[]", item_measures(report),
                    {{"class", "label of the texture"},
                     {"method", "label"},
                     {"participants", "who rated the item"},
                     {"mean", "of participants' means of their repeats"},
                     {"interval", "Student's t, 95 %, cut to the scale"},
                     {"sd", "between participants"}}),
      listed_object("scales[].methods[]", group_measures("method", report.methods),
                    joined_members({{{"method", "label"}}, mean_of_items})),
      listed_object("scales[].classes[]", group_measures("class", report.classes),
                    joined_members({{{"class", "label"}}, mean_of_items})),
      listed_object(
          "scales[].differences[]", difference_measures(report),
          {{"first", "method"},
           {"second", "method; differences are first minus second"},
           {"classes", "textures that both methods have"},
           {"participants", "who rated all of these by both"},
           {"difference", "mean of participants' differences"},
           {"interval", "Student's t, 95 %"},
           {"sd", "between participants"},
           {"p", "sign flips, two-sided"},
           {"p_holm", "the same, adjusted over all pairs"},
           {"t", "Student's t; null if all differences are the same"},
           {"t_p", "of t, two-sided"},
           {"t_p_holm", "the same, adjusted over all pairs"},
           {"d_z",
            "`estimate`, `interval` by noncentral t, `jackknife` with `estimate` and `interval`"}}),
      listed_object("scales[].use.participants[]", use_measures(report, scale),
                    {{"participant", "id"},
                     {"n", "scored answers"},
                     {"at_low", "of these at the low end of the scale"},
                     {"at_high", "at the high end"},
                     {"mean", "of the answers"},
                     {"sd", "of the answers"},
                     {"distinct", "different values"},
                     {"narrow", "whether the SD is below 5 % of the scale's length"},
                     {"scatter", "SD of means of items without the means of participant and item"},
                     {"retest", "own ICC(1,1) of the repeats"}}),
      listed_object("scales[].catch.per_participant[]", catch_measures(report),
                    {{"participant", "id"},
                     {"catch", "mean rating of catch trials"},
                     {"scored", "mean rating of the others"}})};
}

}  // namespace touchtrial::analysis::rating
