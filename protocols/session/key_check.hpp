/// \file Checks before the first participant that the investigator's key opens what a station
///   seals.
#pragma once

#include "engine/pack/pack.hpp"
#include "study/study_key.hpp"

namespace touchtrial::session {

/// Checks that a station's file, the key and the pack belong together. As a test it seals, in
/// memory, the opening of a session with the schedule of the station's first participant, and opens
/// it with the key. Nothing is stored. Takes as long as reading the pack.
/// \throws VerificationError with the first mismatch and its remedy, without a file name
/// \throws FileError as study::require_whole
void require_opens(const study::StudyKey& key, const study::StationKey& station,
                   const engine::Pack& pack);

}  // namespace touchtrial::session
