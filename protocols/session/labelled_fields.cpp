#include "protocols/session/labelled_fields.hpp"

#include <map>

namespace touchtrial::session {

LabelledFields::LabelledFields(const design::StudyKey& key, const StimulusSource& source)
    : plane_(source.plane()) {
  // By meaning, not by code: codes are random, and what is learnt must not depend on them.
  std::map<design::StimulusIndex, const engine::RenderingModel*> by_meaning;
  for (const design::KeyedStimulus& keyed : key.stimuli) {
    by_meaning[keyed.stimulus] = &source.model(keyed.code);
  }
  for (const auto& [stimulus, model] : by_meaning) {
    fields_.push_back({key.study.classes[stimulus.class_index].label, model, stimulus});
  }
}

}  // namespace touchtrial::session
