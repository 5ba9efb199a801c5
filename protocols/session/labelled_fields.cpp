#include "protocols/session/labelled_fields.hpp"

#include <map>

namespace touchtrial {

LabelledFields::LabelledFields(const StudyKey& key, const StimulusSource& source)
    : plane_(source.plane()) {
  // By meaning, not by code: codes are random, and what is learnt must not depend on them.
  std::map<StimulusIndex, const RenderingModel*> by_meaning;
  for (const KeyedStimulus& keyed : key.stimuli) {
    by_meaning[keyed.stimulus] = &source.model(keyed.code);
  }
  for (const auto& [stimulus, model] : by_meaning) {
    fields_.push_back({key.study.classes[stimulus.class_index].label, model, stimulus});
  }
}

}  // namespace touchtrial
