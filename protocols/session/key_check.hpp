/// \file Checks, before the first participant, that the investigator's key can decrypt a station's
/// records.
#pragma once

#include "engine/pack/pack.hpp"
#include "study/study_key.hpp"

namespace touchtrial::session {

/// Checks that a station file, the key and the pack belong together. As a test, it encrypts the
/// opening of a session with the schedule of the station's first participant in memory, and
/// decrypts it with the key. Takes as long as reading the pack.
/// \throws VerificationError with the first mismatch and its remedy, without a file name
/// \throws FileError as study::require_complete_pack
void require_decryptable(const study::StudyKey& key, const study::StationKey& station,
                         const engine::Pack& pack);

}  // namespace touchtrial::session
