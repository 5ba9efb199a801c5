#include "analysis/planning/felt_study.hpp"

#include "protocols/session/labelled_fields.hpp"
#include "protocols/session/stimulus_source.hpp"

#include <algorithm>

namespace touchtrial::planning {

AnswerModel answer_model_of(const design::StudyKey& key, const engine::Pack& pack,
                            const session::SubjectModel& subject, const FeltStudyOptions& options,
                            const design::Progress& progress) {
  subject.check_labels(key.study);
  const session::StimulusSource source(pack, key.study.rendering);
  const session::LabelledFields fields(key, source);
  const session::FeltKnowledge knowledge = session::learn_by_feeling(
      fields, subject, key.study.rendering.max_force_n, options.seed, options.jobs);
  const session::FeltBank bank(
      fields, key.study, subject,
      {.explorations = options.explorations, .seed = options.seed, .jobs = options.jobs}, progress);
  std::vector<std::string> classes;
  for (const design::StudyClass& one : key.study.classes) classes.push_back(one.label);
  return {knowledge,
          bank,
          std::move(classes),
          {.directions = options.directions, .seed = options.seed, .jobs = options.jobs}};
}

std::vector<design::StimulusIndex> stimuli_of(const design::StudyKey& key) {
  std::vector<design::StimulusIndex> stimuli;
  for (const design::KeyedStimulus& keyed : key.stimuli) stimuli.push_back(keyed.stimulus);
  std::ranges::sort(stimuli);
  return stimuli;
}

std::vector<PictureLayout> layouts_of(const design::Study& study, int participants) {
  std::vector<PictureLayout> layouts;
  for (int number = 1; number <= participants; ++number) {
    PictureLayout layout = design::make_schedule(study, number).layout;
    if (std::ranges::find(layouts, layout) == layouts.end()) layouts.push_back(std::move(layout));
  }
  return layouts;
}

}  // namespace touchtrial::planning
