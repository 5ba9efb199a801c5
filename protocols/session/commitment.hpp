/// \file What a database says of its study before the first trial.
#pragma once

#include "engine/pack/pack.hpp"
#include "protocols/design/study_key.hpp"
#include "protocols/store/payload.hpp"

namespace touchtrial::session {

/// The first event of a study's file chain.
[[nodiscard]] store::StudyCommitment commitment_of(const design::StudyKey& key,
                                                   const engine::Pack& pack, bool simulated,
                                                   bool pilot);

}  // namespace touchtrial::session
