/// \file Which sessions enter a study's figures: one rule for all of them.
#pragma once

#include "protocols/store/study_store.hpp"

namespace touchtrial {

/// Completed, neither excluded, withdrawn nor replaced, and pilot or simulated only if the whole
/// study is.
[[nodiscard]] inline bool session_counts(const SessionRow& session,
                                         const StudyCommitment& commitment) noexcept {
  return session.state == SessionState::completed && !session.excluded && !session.withdrawn &&
         session.replaced_by.empty() && session.pilot == commitment.pilot &&
         session.simulated == commitment.simulated;
}

}  // namespace touchtrial
