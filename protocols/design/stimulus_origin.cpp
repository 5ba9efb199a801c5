#include "protocols/design/stimulus_origin.hpp"

#include "protocols/design/stimulus_field.hpp"

namespace touchtrial::design {

engine::ExtractionOptions presented_method(const Study& study, const StimulusIndex& stimulus) {
  return method_of(study, stimulus);
}

bool is_made_from(const engine::PackEntry& entry, const StudyKey& key, const GreyImage& image,
                  const StimulusIndex& stimulus) {
  return entry.code == key.code_of(stimulus) &&
         entry.input_tag ==
             input_tag(key.master, image, method_of(key.study, stimulus), key.study.rendering);
}

}  // namespace touchtrial::design
