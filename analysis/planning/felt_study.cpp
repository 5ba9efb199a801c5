#include "analysis/planning/felt_study.hpp"

#include "protocols/session/labelled_fields.hpp"
#include "protocols/session/stimulus_source.hpp"

#include <algorithm>

namespace touchtrial {

AnswerModel answer_model_of(const StudyKey& key, const Pack& pack, const SubjectModel& subject,
                            const FeltStudyOptions& options, const Progress& progress) {
  subject.check_labels(key.study);
  const StimulusSource source(pack, key.study.rendering);
  const LabelledFields fields(key, source);
  const FeltKnowledge knowledge = learn_by_feeling(fields, subject, key.study.rendering.max_force_n,
                                                   options.seed, options.jobs);
  const FeltBank bank(
      fields, key.study, subject,
      {.explorations = options.explorations, .seed = options.seed, .jobs = options.jobs}, progress);
  std::vector<std::string> classes;
  for (const StudyClass& one : key.study.classes) classes.push_back(one.label);
  return {knowledge,
          bank,
          std::move(classes),
          {.directions = options.directions, .seed = options.seed, .jobs = options.jobs}};
}

std::vector<StimulusIndex> stimuli_of(const StudyKey& key) {
  std::vector<StimulusIndex> stimuli;
  for (const KeyedStimulus& keyed : key.stimuli) stimuli.push_back(keyed.stimulus);
  std::ranges::sort(stimuli);
  return stimuli;
}

std::vector<PictureLayout> layouts_of(const Study& study, int participants) {
  std::vector<PictureLayout> layouts;
  for (int number = 1; number <= participants; ++number) {
    PictureLayout layout = make_schedule(study, number).layout;
    if (std::ranges::find(layouts, layout) == layouts.end()) layouts.push_back(std::move(layout));
  }
  return layouts;
}

}  // namespace touchtrial
