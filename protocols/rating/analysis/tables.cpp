#include "protocols/rating/analysis/tables.hpp"

#include "analysis/exports/column_meanings.hpp"
#include "protocols/rating/analysis/report.hpp"
#include "protocols/rating/study/rating.hpp"

#include <cstddef>
#include <string>

namespace touchtrial::analysis::rating {
namespace {

/// A label of the trial's stimulus; nothing for a catch trial.
DataCell label_of(const TrialOutcome& trial, const std::vector<std::string>& labels, int number) {
  if (!trial.has_stimulus) return std::monostate{};
  return labels[static_cast<std::size_t>(number)];
}

}  // namespace

DataTable ratings_table(const Outcomes& outcomes) {
  DataTable table{{"participant", "session", "trial", "kind", "class", "method", "exemplar",
                   "picture", "scale", "rating", "simulated"},
                  {}};
  const std::vector<study::Scale> scales = study::rating::scales_of(outcomes.design);
  for (const RatedTrials& person : rated_trials(outcomes)) {
    for (const TrialOutcome* trial : person.trials) {
      const std::vector<double> ratings = ratings_of(trial->row.answer);
      for (std::size_t i = 0; i < scales.size(); ++i) {
        table.rows.push_back(
            {person.participant, std::int64_t{trial->row.session}, std::int64_t{trial->row.trial},
             std::string(name_of(trial->role)),
             label_of(*trial, outcomes.classes, trial->stimulus.class_index),
             label_of(*trial, outcomes.methods, trial->stimulus.method),
             trial->has_stimulus ? DataCell(image_of(outcomes, *trial)) : DataCell(),
             trial->picture ? DataCell(outcomes.classes[static_cast<std::size_t>(*trial->picture)])
                            : DataCell(),
             scales[i].id, ratings[i], flag(outcomes.simulated)});
      }
    }
  }
  return table;
}

std::vector<TrialColumn> rating_columns(const Outcomes& outcomes) {
  std::vector<TrialColumn> columns;
  for (const study::Scale& scale : study::rating::scales_of(outcomes.design)) {
    const std::size_t index = columns.size();
    columns.push_back(
        {std::string(kRatingColumn) + scale.id, true, [index](const TrialView& trial) -> DataCell {
           const std::vector<double> ratings = ratings_of(trial.row.answer);
           if (index >= ratings.size()) return std::monostate{};
           return ratings[index];
         }});
  }
  return columns;
}

}  // namespace touchtrial::analysis::rating
