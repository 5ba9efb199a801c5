/// \file What a database says of its study before the first trial.
#pragma once

#include "engine/pack/pack.hpp"
#include "protocols/design/study_key.hpp"
#include "protocols/store/payload.hpp"

namespace touchtrial {

/// The first event of a study's file chain.
[[nodiscard]] StudyCommitment commitment_of(const StudyKey& key, const Pack& pack, bool simulated,
                                            bool pilot);

}  // namespace touchtrial
