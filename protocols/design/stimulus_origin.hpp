/// \file How a stimulus is made, and whether a field of a pack was made so.
#pragma once

#include "core/plane.hpp"
#include "engine/extraction.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/design/study_key.hpp"

namespace touchtrial::design {

/// The options by which a stimulus' texture is taken: its method's, with a control's seed of its
/// own. \param stimulus  indices within the study
[[nodiscard]] engine::ExtractionOptions presented_method(const Study& study,
                                                         const StimulusIndex& stimulus);

/// Whether a field was made from this image by the stimulus's method and the study's rendering, as
/// the key's study has them and by the computation of this program.
/// \param entry  the field's, in the pack that the key belongs to
/// \throws StudyError if the study does not present the stimulus
[[nodiscard]] bool is_made_from(const engine::PackEntry& entry, const StudyKey& key,
                                const GreyImage& image, const StimulusIndex& stimulus);

}  // namespace touchtrial::design
