/// \file Which sessions enter a study's figures: one rule for all of them.
#pragma once

#include "protocols/store/study_store.hpp"

namespace touchtrial::analysis {

/// Completed, neither excluded, withdrawn nor replaced, and pilot or simulated only if the whole
/// study is.
[[nodiscard]] inline bool session_counts(const store::SessionRow& session,
                                         const store::StudyCommitment& commitment) noexcept {
  return session.state == store::SessionState::completed && !session.excluded &&
         !session.withdrawn && session.replaced_by.empty() && session.pilot == commitment.pilot &&
         session.simulated == commitment.simulated;
}

}  // namespace touchtrial::analysis
