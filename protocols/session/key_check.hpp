/// \file Proves before the first participant that what a station seals will open with the
/// investigator's key.
#pragma once

#include "engine/pack/pack.hpp"
#include "study/study_key.hpp"

namespace touchtrial::session {

/// Checks that a station's file, the key and the pack belong together, and opens with the key what
/// the station seals: the opening of a session, made in memory as `run` makes it, with the schedule
/// of the station's first participant. Nothing is stored. Takes as long as reading the pack.
/// \throws VerificationError with the first thing that does not hold and the remedy; it names no
///   file
/// \throws FileError as study::require_whole
void require_opens(const study::StudyKey& key, const study::StationKey& station,
                   const engine::Pack& pack);

}  // namespace touchtrial::session
