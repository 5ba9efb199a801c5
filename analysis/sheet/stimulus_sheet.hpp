/// \file The contact sheet of a prepared study, for the lab book: the stimulus of every code, its
/// picture and its strength. It unblinds whoever reads it.
#pragma once

#include "analysis/report/page/document.hpp"
#include "engine/pack/pack.hpp"
#include "study/study_key.hpp"

#include <functional>

namespace touchtrial::analysis {

/// Documents with more stimuli are too large to open.
inline constexpr std::size_t kMaxSheetStimuli = 500;

/// Reads fields from the pack and pictures from the study's images. There is one section for each
/// method and one for practice, with stimuli by class: first their numbers, then pictures, textures
/// and forces, four stimuli at a time.
/// \param progress  called after each stimulus with the number done and their total; may be empty
/// \throws VerificationError if the pack is not the key's, or a field is damaged or was not made
///   from its image. Preparing the study again repairs this
/// \throws UsageError if there are more than kMaxSheetStimuli
/// \throws FileError if an image or a field cannot be read
/// \throws StudyError as study::plane_of, if there is practice
[[nodiscard]] Document make_stimulus_sheet(
    const study::StudyKey& key, const engine::Pack& pack,
    const std::function<void(int done, int of)>& progress = {});

}  // namespace touchtrial::analysis
