#include "analysis/planning/planned_study.hpp"

#include "analysis/planning/answer_model.hpp"
#include "protocols/simulation/felt_decision.hpp"
#include "study/protocol.hpp"

#include <algorithm>

namespace touchtrial {
namespace {

/// One participant's answers.
planning::CountedPerson answers_of(const PlannedStudy& planned,
                                   const simulation::SubjectModel& subject, int number, int repeats,
                                   const planning::PictureLayout& layout, std::uint64_t seed) {
  std::vector<std::string> shown;
  for (const int picture : layout) shown.push_back(planned.labels[picture]);
  const simulation::Individual individual(subject, seed, number);
  const simulation::MatchedPictures pictures =
      simulation::match_pictures(shown, subject, individual, planned.knowledge);
  const simulation::FeltDecision decision(individual, planned.knowledge);
  const auto classes = planned.labels.size();
  planning::CountedPerson person{0, std::vector<double>(planned.bank.stimuli() * classes, 0.0)};
  RandomStream paths(seed, "planned study: explorations", static_cast<std::uint64_t>(number));
  std::uint64_t nth = 0;
  for (int place = 0; place < planned.bank.stimuli(); ++place) {
    for (int repeat = 0; repeat < repeats; ++repeat) {
      const auto felt = planned.bank.felt(place)[paths.below(planned.bank.explorations())];
      RandomStream random =
          simulation::stream_of_trial(seed, simulation::kAnswerPurpose, number, ++nth);
      const int position = decision.answer(felt, pictures, random).position;
      person.counts[place * classes + layout[position]] += 1.0;
    }
  }
  return person;
}

}  // namespace

planning::FitCounts simulated_counts(const PlannedStudy& planned,
                                     const simulation::SubjectModel& subject, int participants,
                                     int repeats, std::uint64_t seed) {
  planning::FitCounts counts;
  counts.classes = planned.labels;
  for (int m = 0; m < planned.study.key().study.presented_methods(); ++m) {
    counts.methods.push_back(planned.study.key().study.methods[m].label);
  }
  counts.stimuli = planning::stimuli_of(planned.study.key());
  for (int number = 1; number <= participants; ++number) {
    const planning::PictureLayout layout =
        study::make_schedule(planned.study.key().study,
                             planned.study.key().draw_of(number, study::Draws::rehearsal))
            .layout;
    planning::CountedPerson person = answers_of(planned, subject, number, repeats, layout, seed);
    const auto known = std::ranges::find(counts.layouts, layout);
    person.layout = static_cast<int>(known - counts.layouts.begin());
    if (known == counts.layouts.end()) counts.layouts.push_back(layout);
    counts.people.push_back(std::move(person));
    counts.trials += planned.bank.stimuli() * repeats;
  }
  return counts;
}

}  // namespace touchtrial
