/// \file The contact sheet of a prepared study, for the lab book: the code of each stimulus, with
/// pictures and force statistics. It unblinds its readers.
#pragma once

#include "analysis/report/page/document.hpp"
#include "engine/pack/pack.hpp"
#include "study/study_key.hpp"

#include <functional>

namespace touchtrial::analysis {

/// Browsers cannot open sheets with more stimuli.
inline constexpr std::size_t kMaxSheetStimuli = 500;

/// Reads fields from the pack and pictures from the study's images. The sheet has one section per
/// method and one for practice. Each lists its stimuli by class in a table; pictures of four
/// stimuli at a time follow.
/// \param progress  called after each stimulus with the number of finished stimuli and their total;
///   may be empty
/// \throws VerificationError if the pack does not belong to the key, or a field is damaged or was
///   not made from its image. Preparing the study again repairs this
/// \throws UsageError if there are more than kMaxSheetStimuli
/// \throws FileError if an image or a field cannot be read
/// \throws StudyError as study::plane_of does, if there is practice
[[nodiscard]] Document make_stimulus_sheet(
    const study::StudyKey& key, const engine::Pack& pack,
    const std::function<void(int finished, int total)>& progress = {});

}  // namespace touchtrial::analysis
