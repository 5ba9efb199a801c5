#include "analysis/planning/fit_evidence.hpp"

#include "core/errors.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::planning {
namespace {

int find_or_add_layout(std::vector<PictureLayout>& layouts, const PictureLayout& layout) {
  const auto found = std::ranges::find(layouts, layout);
  const auto place = static_cast<int>(found - layouts.begin());
  if (found == layouts.end()) layouts.push_back(layout);
  return place;
}

std::size_t place_of_stimulus(const std::vector<study::StimulusIndex>& stimuli,
                              const study::StimulusIndex& stimulus) {
  const auto found = std::ranges::lower_bound(stimuli, stimulus);
  if (found == stimuli.end() || *found != stimulus) {
    throw StudyError("the database presents a stimulus that its study does not have");
  }
  return static_cast<std::size_t>(found - stimuli.begin());
}

Confusions empty_confusions(const FitCounts& counts) {
  const auto classes = counts.classes.size();
  return {counts.methods.size(),
          std::vector<std::vector<double>>(classes, std::vector<double>(classes, 0.0))};
}

}  // namespace

FitCounts count_answers(const analysis::Outcomes& outcomes,
                        const std::map<int, study::Schedule>& schedules,
                        const std::vector<study::StimulusIndex>& stimuli) {
  FitCounts counts;
  counts.classes = outcomes.classes;
  counts.methods = outcomes.methods;
  counts.stimuli = stimuli;
  std::map<int, std::size_t> person_of_session;
  const std::size_t cells = stimuli.size() * counts.classes.size();
  for (const analysis::TrialOutcome& trial : outcomes.trials) {
    if (!trial.counted || trial.role != study::Role::scored) continue;
    if (!trial.response) {
      ++counts.no_response;
      continue;
    }
    const int session = trial.row.session;
    const auto [entry, is_new] = person_of_session.emplace(session, counts.people.size());
    if (is_new) {
      const int layout = find_or_add_layout(counts.layouts, schedules.at(session).layout);
      counts.people.push_back({layout, std::vector<double>(cells, 0.0)});
    }
    const std::size_t row = place_of_stimulus(stimuli, trial.stimulus) * counts.classes.size();
    counts.people[entry->second].counts[row + static_cast<std::size_t>(*trial.response)] += 1.0;
    ++counts.trials;
  }
  if (counts.trials == 0) {
    throw StudyError(
        "no counted trial has an answer, so there is nothing to fit; collect sessions that count, "
        "or check the exclusions");
  }
  return counts;
}

double presentations(const std::vector<double>& cells, std::size_t row, std::size_t classes) {
  double sum = 0.0;
  for (std::size_t c = 0; c < classes; ++c) sum += cells[row + c];
  return sum;
}

Cells counts_by_layout(const FitCounts& counts, std::span<const CountedPerson> people) {
  const std::size_t cells = counts.stimuli.size() * counts.classes.size();
  Cells sums(counts.layouts.size(), std::vector<double>(cells, 0.0));
  for (const CountedPerson& person : people) {
    for (std::size_t i = 0; i < cells; ++i) sums[person.layout][i] += person.counts[i];
  }
  return sums;
}

Confusions observed_confusions(const FitCounts& counts, std::span<const CountedPerson> people) {
  Confusions table = empty_confusions(counts);
  const std::size_t classes = counts.classes.size();
  for (const CountedPerson& person : people) {
    for (std::size_t i = 0; i < person.counts.size(); ++i) {
      const study::StimulusIndex& stimulus = counts.stimuli[i / classes];
      table[stimulus.method][stimulus.class_index][i % classes] += person.counts[i];
    }
  }
  return table;
}

Confusions expected_confusions(const FitCounts& counts, const AnswerTable& table) {
  Confusions expected = empty_confusions(counts);
  const std::size_t classes = counts.classes.size();
  for (const CountedPerson& person : counts.people) {
    for (std::size_t place = 0; place < counts.stimuli.size(); ++place) {
      const double presented = presentations(person.counts, place * classes, classes);
      const study::StimulusIndex& stimulus = counts.stimuli[place];
      const auto answers = table.answers(person.layout, static_cast<int>(place));
      for (std::size_t c = 0; c < classes; ++c) {
        expected[stimulus.method][stimulus.class_index][c] += presented * answers[c];
      }
    }
  }
  return expected;
}

double g_squared(const Confusions& observed, const Confusions& expected) {
  constexpr double kMinExpected = 1e-12;
  double sum = 0.0;
  for (std::size_t m = 0; m < observed.size(); ++m) {
    for (std::size_t c = 0; c < observed[m].size(); ++c) {
      for (std::size_t a = 0; a < observed[m][c].size(); ++a) {
        const double count = observed[m][c][a];
        if (count > 0.0) sum += count * std::log(count / std::max(expected[m][c][a], kMinExpected));
      }
    }
  }
  return std::max(0.0, 2.0 * sum);
}

double clamped_probability(double probability) noexcept {
  return std::clamp(probability, kMinProbability, 1.0);
}

Cells cells_of(const AnswerTable& table, const FitCounts& counts) {
  Cells cells(counts.layouts.size());
  for (std::size_t layout = 0; layout < cells.size(); ++layout) {
    for (int stimulus = 0; stimulus < table.stimuli(); ++stimulus) {
      const auto answers = table.answers(static_cast<int>(layout), stimulus);
      cells[layout].insert(cells[layout].end(), answers.begin(), answers.end());
    }
  }
  return cells;
}

Cells zeros(std::size_t layouts, const AnswerTable& table) {
  const auto cells = static_cast<std::size_t>(table.stimuli()) * table.classes();
  return {layouts, std::vector<double>(cells, 0.0)};
}

CountsEvidence::CountsEvidence(const FitCounts& counts, std::span<const CountedPerson> people)
    : counts_(counts), sums_(counts_by_layout(counts, people)) {}

double CountsEvidence::log_likelihood(const AnswerTable& table, Cells* slopes) const {
  const auto classes = static_cast<std::size_t>(table.classes());
  if (slopes != nullptr) *slopes = zeros(sums_.size(), table);
  double sum = 0.0;
  for (std::size_t layout = 0; layout < sums_.size(); ++layout) {
    for (std::size_t cell = 0; cell < sums_[layout].size(); ++cell) {
      const double count = sums_[layout][cell];
      if (count == 0.0) continue;
      const auto answers =
          table.answers(static_cast<int>(layout), static_cast<int>(cell / classes));
      const double probability = clamped_probability(answers[cell % classes]);
      sum += count * std::log(probability);
      if (slopes != nullptr) (*slopes)[layout][cell] = count / probability;
    }
  }
  return sum;
}

}  // namespace touchtrial::planning
